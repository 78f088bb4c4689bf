"""beltrami repair: only what is asked for."""

from __future__ import annotations

from typing import Annotated

import typer

from beltrami.cli.console import print_json, waiting
from beltrami.cli.options import Json, MeshFile, MeshOutput
from beltrami.cli.outputs import check_mesh_output

Flag = typer.Option
ALL = "Everything above, but for --keep-largest-component."


def repair(
    mesh: MeshFile,
    output: MeshOutput,
    remove_non_finite: Annotated[
        bool, Flag("--remove-non-finite", help="Drop NaN and infinite vertices, and their faces.")
    ] = False,
    merge_duplicate_vertices: Annotated[
        bool, Flag("--merge-duplicate-vertices", help="Weld vertices at the same place.")
    ] = False,
    tolerance: Annotated[
        float, Flag(help="How near is the same place, as a fraction of the diagonal.")
    ] = 0.0,
    remove_degenerate_faces: Annotated[
        bool, Flag("--remove-degenerate-faces", help="Drop faces without area.")
    ] = False,
    remove_duplicate_faces: Annotated[
        bool, Flag("--remove-duplicate-faces", help="Keep one of faces with the same vertices.")
    ] = False,
    split_non_manifold: Annotated[
        bool, Flag("--split-non-manifold", help="Cut the surface where it is not a manifold.")
    ] = False,
    orient: Annotated[
        bool, Flag("--orient", help="Turn faces until neighbours agree, normals outwards.")
    ] = False,
    keep_largest_component: Annotated[
        bool, Flag("--keep-largest-component", help="Drop all components but one.")
    ] = False,
    remove_unreferenced: Annotated[
        bool, Flag("--remove-unreferenced", help="Drop vertices that no face names.")
    ] = False,
    everything: Annotated[bool, Flag("--all", help=ALL)] = False,
    json: Json = False,
) -> None:
    """Repair a mesh: what the options ask for, in their order, and nothing else."""
    from beltrami.io.registry import read_mesh, write_mesh
    from beltrami.mesh import repair as room

    asked = {
        "remove_non_finite": remove_non_finite or everything,
        "merge_duplicate_vertices": merge_duplicate_vertices or everything,
        "remove_degenerate_faces": remove_degenerate_faces or everything,
        "remove_duplicate_faces": remove_duplicate_faces or everything,
        "split_non_manifold": split_non_manifold or everything,
        "orient": orient or everything,
        "keep_largest_component": keep_largest_component,
        "remove_unreferenced": remove_unreferenced or everything,
    }
    if not any(asked.values()):
        raise typer.BadParameter("say what to repair; `beltrami info` tells what is wrong")
    check_mesh_output(output)
    with waiting(f"repairing {mesh.name}"):
        fixed = room.repair(read_mesh(mesh), tolerance=tolerance, **asked)
        write_mesh(output, fixed.mesh)
    if json:
        maps = {"vertex_map": fixed.vertex_map, "face_map": fixed.face_map}
        print_json({"done": list(fixed.done), **maps, "vertex_origin": fixed.vertex_origin})
        return
    for line in fixed.done or ("nothing to repair",):
        typer.echo(line)
    typer.echo(f"wrote {output}: {fixed.mesh!r}")
