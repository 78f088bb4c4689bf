"""Meshes with noise: those that the constants of ``denoise`` were chosen on, and others."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.cases import plain, subdivided
from benchmarks.packages import package

PAIR = "Fandisk0.3"
TUNED = ("blob", "cube", "spot", "fertility", "fandisk", "sphere", "torus", "camel", "pial",
         "ellipsoid")  # fmt: skip
HELD_OUT = ("bumps", "octahedron", "can", "saddle",
            "beetle", "face", "conte69", "bunny", "armadillo")  # fmt: skip
# of CGAL's data, as in Debian's libcgal-demo; the first ones were looked at while denoise was made
FURTHER_SEEN = ("elephant", "femur", "cow", "man", "mannequin-devil", "bull", "knot1",
                "rotor_small", "dino", "lion", "blade", "turbine", "homer", "retinal",
                "triceratops", "anchor_dense", "cheese", "ChineseDragon-10kv", "knot2",
                "hand", "elk", "elephant-with-holes")  # fmt: skip
FURTHER = (*FURTHER_SEEN, "camel", "bear", "lion-head", "diplodocus", "blobby", "mushroom", "holes",
           "knot", "bear_bis", "mech-holes-shark", "three_peaks", "polygon_mesh",
           "fandisk_large")  # fmt: skip
CREASED = ("cube", "fandisk", "octahedron", "can", "beetle")  # the others are organic
FILES = {
    "spot": "spot_triangulated.obj",
    "fertility": "fertility.off",
    "fandisk": "Fandisk0.3/Original.obj",
    "torus": "torus.obj",
    "camel": "camel-head.off",
    "bunny": "bun_zipper.ply",
    "pial": "pial_left.gii.gz",
    "armadillo": "armadillo.obj",
    "beetle": "beetle.obj",
    "face": "face.obj",
    "conte69": "conte69_32k_lh.gii",
}
SHAPES: dict[str, Callable[[Any], Any]] = {
    "blob": lambda shapes: shapes.blob(8000),
    "cube": lambda shapes: shapes.cube(32),
    "sphere": lambda shapes: shapes.icosphere(5),
    "ellipsoid": lambda shapes: _stretched(shapes.icosphere(4)),
    "bumps": lambda shapes: _bumpy(shapes.icosphere(5)),
    "octahedron": lambda shapes: _cut_in_four(shapes.octahedron(), 5),
    "can": lambda shapes: shapes.cylinder(90, 40, caps=True),
    "saddle": lambda shapes: _bent(shapes.grid(60, 60, dimension=3)),
}


def _stretched(sphere: Any) -> Any:
    return sphere.with_vertices(sphere.vertices * [1, 1.7, 0.6])


def _cut_in_four(mesh: Any, times: int) -> Any:
    arrays = plain(mesh)
    for _ in range(times):
        arrays = subdivided(*arrays)
    return package("beltrami").Mesh(*arrays)


def _bent(grid: Any) -> Any:
    x, y, _ = grid.vertices.T
    height = (x - x.mean()) ** 2 - (y - y.mean()) ** 2
    return grid.with_vertices(np.stack([x, y, height], axis=1))


def _bumpy(sphere: Any) -> Any:
    x, y, z = 5 * sphere.vertices.T
    height = np.sin(x + 1) * np.sin(y) + np.cos(y - z)
    return sphere.with_vertices(sphere.vertices * (1 + 0.06 * height)[:, None])


def truth_of(name: str, folder: Path) -> Any:
    """Make or read a mesh, without vertices and faces that are none."""
    bt = package("beltrami")
    if name in SHAPES:
        return SHAPES[name](bt.shapes)
    read = bt.read_mesh(folder / FILES.get(name, name))
    fixed = bt.repair(read, remove_unreferenced=True, remove_degenerate_faces=True).mesh
    return bt.Mesh(fixed.vertices, fixed.faces)


def is_there(name: str, folder: Path) -> bool:
    return name in SHAPES or (folder / FILES.get(name, name)).exists()


def pair(folder: Path) -> tuple[Any, Any]:
    """Return the truth and the noisy mesh that are published together."""
    bt = package("beltrami")
    truth, mesh = (bt.read_mesh(folder / PAIR / f"{one}.obj") for one in ("Original", "Noisy"))
    return truth, mesh


def noisy(truth: Any, level: float, seed: int) -> Any:
    """Add white noise along the normals, of so many mean edge lengths."""
    sigma = level * truth.edge_lengths.mean()
    noise = np.random.default_rng([seed, int(1000 * level)]).normal(0, sigma, truth.n_vertices)
    return truth.with_vertices(truth.vertices + noise[:, None] * truth.vertex_normals)


def odd_noise(truth: Any, kind: str, seed: int) -> Any:
    """Add noise along the normals that is not white, or very strong: see ``ODD``."""
    random = np.random.default_rng([seed, len(kind)])
    n, edge = truth.n_vertices, truth.edge_lengths.mean()
    noise = random.normal(0, 1, n)
    if kind == "impulses":
        noise *= random.random(n) < 0.1
    elif kind == "correlated":
        A = truth.topology.adjacency
        noise = 0.3 * (noise + A @ noise) / np.sqrt(1 + A.sum(axis=1))
    else:
        noise *= 0.7
    return truth.with_vertices(truth.vertices + (edge * noise)[:, None] * truth.vertex_normals)


ODD = {
    "impulses": "a tenth of the vertices, off by one mean edge",
    "correlated": "means over neighbours, of 0.3 mean edges",
    "strong": "white, of 0.7 mean edges",
}


def errors(truth: Any, vertices: Any) -> tuple[float, float]:
    """Mean angle of the normals in degrees, and distance of the vertices in mean edges."""
    normals = truth.with_vertices(vertices).face_normals
    cosine = np.clip(np.einsum("ij,ij->i", normals, truth.face_normals), -1, 1)
    away = ((vertices - truth.vertices) ** 2).sum(axis=1)
    angle = float(np.degrees(np.arccos(cosine)).mean())
    return angle, float(np.sqrt(away.mean()) / truth.edge_lengths.mean())
