"""beltrami info: what a mesh is, and what is wrong with it."""

from __future__ import annotations

from pathlib import Path

import typer

from beltrami.cli.console import print_json, waiting
from beltrami.cli.options import Json, MeshFile
from beltrami.cli.remedies import as_commands


def info(mesh: MeshFile, json: Json = False) -> None:
    """Diagnose a mesh: sizes, topology, and each defect with its indices and its remedy.

    Of a compressed mesh (.btm): its sections, and its bits per vertex.
    """
    if mesh.suffix.lower() == ".btm":
        _tell_contents(mesh, json)
        return
    from beltrami.io.registry import read_mesh
    from beltrami.mesh.diagnose import diagnose

    with waiting(f"diagnosing {mesh.name}"):
        read = read_mesh(mesh)
        diagnosis = diagnose(read)
    if json:
        extent = {"bounding_box": [read.vertices.min(axis=0), read.vertices.max(axis=0)]}
        data = {name: list(values.shape) for name, values in read.vertex_data.items()}
        facts = diagnosis.to_dict() | extent
        print_json(facts | {"vertex_data": data, "has_uv": read.corner_uv is not None})
        return
    typer.echo(f"{mesh}: {read!r}")
    typer.echo(as_commands(diagnosis.report()))


def _tell_contents(path: Path, json: bool) -> None:
    """Tell what a compressed file says of itself, without decoding it."""
    from beltrami.compression.contents import describe

    contents = describe(path)
    if json:
        print_json(contents.to_dict())
        return
    n = max(contents.n_vertices, 1)
    typer.echo(
        f"{path}: {contents.n_vertices} vertices in {contents.dimension} dimensions, "
        f"error at most {contents.max_error:.6g}, format {contents.version}, "
        f"mode {contents.mode}, effort {contents.effort}"
        + (f", {contents.terms} terms" if contents.terms is not None else "")
    )
    for name, size in (*contents.sections, ("file", contents.size)):
        typer.echo(f"  {name}: {size} bytes, {8 * size / n:.3f} bits per vertex")
    for feature in contents.features:
        typer.echo(f"  {feature}")
