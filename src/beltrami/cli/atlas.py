"""beltrami atlas: charts of any surface in one square, with a picture on them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from beltrami.cli.console import print_json, waiting
from beltrami.cli.functions import read_drawn
from beltrami.cli.options import Data, DataName, Json, MeshFile
from beltrami.cli.outputs import check_texture_output

if TYPE_CHECKING:
    from beltrami.mesh.mesh import Mesh
    from beltrami.parameterization.texture_atlas import TextureAtlas

Option = typer.Option
_BOARD = 4096  # texels along a side of a checkerboard: more show nothing more


def atlas(
    mesh: MeshFile,
    output: Annotated[
        Path,
        Option(
            "-o",
            "--output",
            metavar="FILE",
            help="OBJ with texture coordinates (a texture goes beside it: .mtl, .png), or GLB.",
        ),
    ],
    count: Annotated[int, Option(min=1, help="How many charts to begin with.")] = 1,
    max_distortion: Annotated[
        float, Option(help="Symmetric Dirichlet energy of a chart, above 1 = isometry.")
    ] = 1.1,
    cells: Annotated[str, Option(help="farthest or spectral: of the first charts.")] = "farthest",
    cut_holes: Annotated[
        bool, Option("--cut-holes", help="Make disks of all charts, rather than keep holes.")
    ] = False,
    seams: Annotated[
        int, Option(min=0, help="Up to so many cuts into a chart before it is cut in two.")
    ] = 1,
    size: Annotated[int, Option(help="Texels along a side.")] = 1024,
    padding: Annotated[int, Option(help="Texels kept free around each chart.")] = 2,
    texture: Annotated[
        str | None,
        Option(
            metavar="FILE", help="Picture to write with it, or checkerboard.", show_default=False
        ),
    ] = None,
    data: Data = None,
    data_name: DataName = None,
    colormap: Annotated[str | None, Option(help="Colours of --data.", show_default=False)] = None,
    limits: Annotated[
        tuple[float, float] | None, Option(help="Range of the colours.", show_default=False)
    ] = None,
    allow_folds: Annotated[
        bool, Option("--allow-folds", help="Write the map even if it is no bijection.")
    ] = False,
    json: Json = False,
) -> None:
    """Part a surface into charts, packed in a square; bake --data into a texture."""
    from beltrami.io.registry import read_mesh, write_mesh
    from beltrami.parameterization import atlas as room

    check_texture_output(output)
    if data is None and (colormap, limits, data_name) != (None, None, None):
        raise typer.BadParameter("--colormap, --limits and --data-name go with --data")
    if data is not None and texture is not None:
        raise typer.BadParameter("--data makes the texture: leave out --texture")
    with waiting(f"reading {mesh.name}"):
        read = read_mesh(mesh)
        baked = None if data is None else read_drawn(data, read, data_name)
        picture = None if texture is None else _picture(texture, size)
    with waiting("mapping") as progress:
        found = room.atlas(
            read,
            count,
            max_distortion=max_distortion,
            cells=cells,
            holes="cut" if cut_holes else "fill",
            seams=seams,
            size=size,
            padding=padding,
            strict=not allow_folds,
            progress=progress,
        )
    if baked is not None:
        picture = _baked(found, baked, colormap, limits)
    write_mesh(output, found.mesh, texture=picture)
    report(output, found, json=json)


def _picture(texture: str, size: int) -> Any:
    """Read the picture now, before the work."""
    from beltrami.display.texture import checkerboard
    from beltrami.io.picture import as_picture

    return (
        checkerboard(min(size, _BOARD)) if texture == "checkerboard" else as_picture(Path(texture))
    )


def _baked(found: TextureAtlas, values: Any, colormap: Any, limits: Any) -> Any:
    """Make a picture; colours that go on beyond the charts stay colours."""
    from beltrami.display.bake import bake, colorize

    texels = bake(found, values)
    return colorize(texels, colormap, limits) if texels.ndim == 2 else texels.clip(0, 1)


def report(output: Path, found: TextureAtlas, *, json: bool) -> None:
    """Tell the charts, the certificate and the distortion."""
    certificate, distortion = found.certificate, found.distortion
    flipped, crossed = len(certificate.flipped), len(certificate.crossings)
    if json:
        print_json(
            {
                "charts": found.count,
                "labels": found.labels,
                "seams": found.seams,
                "bijective": found.is_bijective,
                "flipped": certificate.flipped,
                "crossings": certificate.crossings,
                "fill": found.fill,
                "chart_distortion": found.chart_distortion,
                "conformal": distortion.mean_conformal,
                "area": distortion.mean_area,
                "symmetric_dirichlet": distortion.symmetric_dirichlet,
            }
        )
        return
    written: Mesh = found.mesh
    typer.echo(f"wrote {output}: {written!r}")
    typer.echo(
        f"atlas: {found.count} {'chart' if found.count == 1 else 'charts'}, {len(found.seams)} "
        f"edges cut, {found.fill:.0%} of the square filled"
    )
    typer.echo(
        f"certificate: {'no overlap' if found.is_bijective else 'NOT a bijection'}; {flipped} of "
        f"{written.n_faces} faces flipped, {crossed} crossings of the boundary (exact)"
    )
    typer.echo(
        f"distortion (1 = isometry): conformal {distortion.mean_conformal:.4g}, area "
        f"{distortion.mean_area:.4g}, symmetric Dirichlet {distortion.symmetric_dirichlet:.4g}, "
        f"of the worst chart {found.chart_distortion.max():.4g}"
    )
