"""beltrami parameterize: texture coordinates without a fold, and the certificate."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from beltrami.cli.console import print_json, waiting
from beltrami.cli.options import Json, MeshFile
from beltrami.cli.outputs import check_texture_output

if TYPE_CHECKING:
    from beltrami.parameterization.certificate import Certificate
    from beltrami.parameterization.parameterization import Parameterization

TexturedOutput = Annotated[
    Path, typer.Option("-o", "--output", metavar="FILE", help="OBJ or GLB with these coordinates.")
]


def parameterize(
    mesh: MeshFile,
    output: TexturedOutput,
    method: Annotated[
        str,
        typer.Option(
            help="auto; free: with a free boundary; tutte: one solve; least_squares_conformal; "
            "spectral_conformal."
        ),
    ] = "auto",
    boundary: Annotated[
        str, typer.Option(help="circle, square, or the number of sides of a regular polygon.")
    ] = "circle",
    weights: Annotated[
        str | None,
        typer.Option(
            help="clamped, mean_value, combinatorial, distance or cotangent.",
            show_default="clamped; of tutte mean_value",
        ),
    ] = None,
    spacing: Annotated[
        str, typer.Option(help="arclength or uniform, along the boundary.")
    ] = "arclength",
    bulge: Annotated[
        float, typer.Option(help="Bend straight sides outwards, by this part of their length.")
    ] = 0.0,
    seams: Annotated[
        int, typer.Option(min=0, help="Up to so many more cuts, each to lower the distortion.")
    ] = 0,
    no_cut: Annotated[
        bool, typer.Option("--no-cut", help="Refuse what is not a disk, rather than cut it.")
    ] = False,
    fill_holes: Annotated[
        bool,
        typer.Option("--fill-holes", help="Let all boundaries but the longest be holes: no cut."),
    ] = False,
    allow_folds: Annotated[
        bool, typer.Option("--allow-folds", help="Write the map even if it is no bijection.")
    ] = False,
    json: Json = False,
) -> None:
    """Map a surface to the plane, cut where it must be; prove that nothing folds."""
    from beltrami.io.registry import read_mesh, write_mesh
    from beltrami.parameterization import parameterize as room

    check_texture_output(output)
    curve = int(boundary) if boundary.isdigit() else boundary
    with waiting(f"reading {mesh.name}"):
        read = read_mesh(mesh)
    with waiting("mapping"):
        found = room.parameterize(
            read,
            method,
            weights,
            curve,
            spacing=spacing,
            bulge=bulge,
            seams=seams,
            cut=not no_cut,
            holes="fill" if fill_holes else "cut",
            strict=not allow_folds,
        )
    write_mesh(output, found.textured)
    report(output, found, json=json)


def report(output: Path, found: Parameterization, *, json: bool) -> None:
    """Tell the certificate, the cut and the distortion."""
    certificate, distortion = found.certificate, found.distortion
    written = _as_written(output, found)
    if json:
        print_json(
            {
                "bijective": found.is_bijective,
                "bijective_as_written": written.is_bijective,
                "flipped": found.flipped,
                "crossings": certificate.crossings,
                "cut_edges": found.cut_edges,
                "method": found.method,
                "conformal": distortion.mean_conformal,
                "area": distortion.mean_area,
                "symmetric_dirichlet": distortion.symmetric_dirichlet,
            }
        )
        return
    typer.echo(f"wrote {output}: {found.textured!r}")
    typer.echo(f"map: {found.method}; {len(found.cut_edges)} edges cut")
    typer.echo(
        f"certificate: {'a bijection' if found.is_bijective else 'NOT a bijection'}; "
        f"{len(found.flipped)} of {found.mesh.n_faces} faces flipped, "
        f"{len(certificate.crossings)} crossings of the boundary (exact)"
    )
    if found.is_bijective and not written.is_bijective:
        typer.echo(
            f"warning: rounded to the 32 bits of GLB it is none: {len(written.flipped)} faces "
            f"flipped, {len(written.crossings)} crossings; OBJ keeps it as it is",
            err=True,
        )
    typer.echo(
        f"distortion (1 = isometry): conformal {distortion.mean_conformal:.4g}, area "
        f"{distortion.mean_area:.4g}, symmetric Dirichlet {distortion.symmetric_dirichlet:.4g}"
    )


def _as_written(output: Path, found: Parameterization) -> Certificate:
    """Certify what the file holds: GLB has u and 1 - v in single precision, where they may fold."""
    import numpy as np

    from beltrami.parameterization.certificate import certify

    if ".glb" not in output.name.lower():
        return found.certificate
    held = np.column_stack([found.uv[:, 0], 1 - found.uv[:, 1]]).astype(np.float32)
    return certify(found.mesh.topology, held * np.array([1.0, -1.0]))
