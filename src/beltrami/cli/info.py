"""beltrami info: what a mesh is, and what is wrong with it."""

from __future__ import annotations

import typer

from beltrami.cli.console import print_json, waiting
from beltrami.cli.options import Json, MeshFile
from beltrami.cli.remedies import as_commands


def info(mesh: MeshFile, json: Json = False) -> None:
    """Diagnose a mesh: sizes, topology, and each defect with its indices and its remedy."""
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
