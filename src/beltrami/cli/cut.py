"""beltrami cut: make disks of a surface."""

from __future__ import annotations

import typer

from beltrami.cli.console import print_json, waiting
from beltrami.cli.options import Json, MeshFile, MeshOutput
from beltrami.cli.outputs import check_mesh_output


def cut(mesh: MeshFile, output: MeshOutput, json: Json = False) -> None:
    """Cut a surface along edges so that each component becomes a disk."""
    from beltrami.io.registry import read_mesh, write_mesh
    from beltrami.mesh.tree_cotree import cut_to_disk

    check_mesh_output(output)
    with waiting(f"reading {mesh.name}"):
        read = read_mesh(mesh)
    with waiting("cutting"):
        found = cut_to_disk(read)
    write_mesh(output, found.mesh)
    if json:
        print_json({"edges": found.edges, "vertex_map": found.vertex_map})
        return
    pieces = found.mesh.topology.n_components
    typer.echo(f"wrote {output}: {found.mesh!r}")
    typer.echo(f"cut {len(found.edges)} edges: {pieces} {'disk' if pieces == 1 else 'disks'}")
