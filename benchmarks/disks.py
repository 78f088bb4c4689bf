"""Disks to map to the plane: natural ones, cut surfaces, spheres less one triangle, tubes.

With the folder of meshes there are 13, 26 and 24 of them, and the tubes, which grow longer.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from benchmarks import surfaces
from benchmarks.cases import FOLDER_VARIABLE
from benchmarks.packages import package
from benchmarks.surfaces import closed, disk_of, largest, less_one, moved, read

GROUPS = ("natural", "cut", "one triangle", "tube")
TUBES = (30, 60, 120, 240, 480)  # rings of 12 vertices

Recipes = dict[str, Callable[[], Any]]


def suite(most: int, names: Sequence[str] = ()) -> Iterator[tuple[str, str, Any]]:
    """Yield (group, name, disk) of these names, all if none; none with more vertices than most."""
    for group, recipes in zip(GROUPS, (natural(), cut(), one_triangle(), tubes()), strict=True):
        for name, make in recipes.items():
            if names and name not in names:
                continue
            mesh = make()
            if mesh.n_vertices <= most:
                yield group, name, mesh


def folder() -> Path | None:
    """Return the folder of meshes, if there is one."""
    found = os.environ.get(FOLDER_VARIABLE)
    return None if found is None else Path(found)


def natural() -> Recipes:
    """Return surfaces that are disks as they are."""
    shapes = package("beltrami").shapes
    made: Recipes = {
        "bump": surfaces.bump,
        "waves": surfaces.waves,
        "scroll": surfaces.scroll,
        "cap": lambda: surfaces.below(shapes.icosphere(4), 0.5),
        "half a blob": lambda: disk_of(surfaces.below(shapes.blob(6000), 0.0)),
    }
    place = folder()
    if place is None:
        return made

    def opened() -> Any:
        """Take of a folded cortex the faces that its flattened twin has kept."""
        whole, flat = read(place / "pial_left.gii.gz"), package("beltrami").read_mesh
        return surfaces.part(whole, flat(place / "flat_left.gii.gz").faces)

    return made | {
        "camel-head.off": lambda: read(place / "camel-head.off"),
        "face.obj": lambda: read(place / "face.obj"),
        "circle.obj": lambda: read(place / "circle.obj"),
        "flat_left.gii.gz": lambda: read(place / "flat_left.gii.gz"),
        "pial_left.gii.gz, opened": opened,
        "capsule.obj": lambda: read(place / "nasty/capsule.obj"),
        "part of armadillo.obj": lambda: surfaces.around(read(place / "armadillo.obj"), 0.25),
        "part of igea.ply": lambda: surfaces.around(read(place / "igea.ply"), 0.2),
    }


def cut() -> Recipes:
    """Return surfaces of any kind, cut to disks."""
    shapes = package("beltrami").shapes
    made: Recipes = {
        "torus": lambda: shapes.torus(48, 24),
        "thin torus": lambda: shapes.torus(200, 10, 1.0, 0.03),
        "cylinder": lambda: shapes.cylinder(40, 30),
        "icosphere": lambda: shapes.icosphere(4),
        "cube": lambda: shapes.cube(16),
        "blob 1500": lambda: shapes.blob(1500),
        "blob 8000": lambda: shapes.blob(8000),
        "plate": surfaces.plate,
        "frame": surfaces.frame,
        "sponge": lambda: surfaces.sponge(2),
    }
    place = folder()
    if place is not None:
        mend = {"split_non_manifold": True, "orient": True, "remove_duplicate_faces": True}
        for name in (
            "torus.obj",
            "fertility.off",
            "spot_triangulated.obj",
            "spot_control_mesh.obj",
            "beetle.obj",
            "halftunnel.off",
            "featuretype.STL",
            "Fandisk0.3/Original.obj",
            "Fandisk0.3/Noisy.obj",
            "bun_zipper.ply",
            "armadillo.obj",
            "conte69_32k_lh.gii",
            "pial_left.gii.gz",
        ):
            made[name] = lambda name=name: read(place / name)
        for name in ("inverted_triangles.obj", "teapot.obj", "bun_zipper_res3.ply"):
            made[name] = lambda name=name: largest(read(place / "nasty" / name, **mend))
    return {name: lambda make=make: disk_of(make()) for name, make in made.items()}


def one_triangle() -> Recipes:
    """Return closed surfaces of genus 0 less one triangle."""
    shapes = package("beltrami").shapes
    made: Recipes = {
        "icosphere": lambda: shapes.icosphere(4),
        "cube": lambda: shapes.cube(16),
        "tetrahedron": lambda: surfaces.subdivide(shapes.tetrahedron(), 5),
        "blob 1500": lambda: shapes.blob(1500),
        "blob 8000": lambda: shapes.blob(8000),
        "blob 20000": lambda: shapes.blob(20_000),
        "needle": lambda: moved(shapes.icosphere(4), lambda x, y, z: (x, y, 8 * z)),
        "lens": lambda: moved(shapes.icosphere(4), lambda x, y, z: (x, y, z / 10)),
        "pill": lambda: shapes.cylinder(48, 24, caps=True),
        "hedgehog": surfaces.hedgehog,
        "dumbbell": surfaces.dumbbell,
        "rough sphere": surfaces.rough,
    }
    place = folder()
    if place is not None:
        for name in (
            "spot_triangulated.obj",
            "spot_control_mesh.obj",
            "Fandisk0.3/Original.obj",
            "Fandisk0.3/Noisy.obj",
            "armadillo.obj",
            "conte69_32k_lh.gii",
            "pial_left.gii.gz",
        ):
            made[name] = lambda name=name: read(place / name)
        for name in ("bun_zipper.ply", "camel-head.off", "face.obj"):
            made[f"{name}, closed"] = lambda name=name: closed(read(place / name))
        turned = place / "nasty/inverted_triangles.obj"
        made["inverted_triangles.obj, closed"] = lambda: closed(read(turned, orient=True))
        welded = place / "nasty/capsule.obj"
        made["capsule.obj, welded"] = lambda: read(welded, merge_duplicate_vertices=True)
    return {name: lambda make=make: less_one(make()) for name, make in made.items()}


def tubes() -> Recipes:
    """Return closed tubes less one triangle."""
    return {f"{n} rings": lambda n=n: less_one(surfaces.tube(n)) for n in TUBES}
