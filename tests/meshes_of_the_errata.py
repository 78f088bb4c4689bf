"""The meshes of the errata: irregular, open and closed, obtuse and not Delaunay.

Regular meshes hide most slips of the printed text, so nothing here is regular but ``tor`` and
``pl``, which are kept for what only they show. ``MESHES[name]()`` makes each once.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from scipy.spatial import ConvexHull, Delaunay

from beltrami.mesh.mesh import Mesh


@cache
def closed() -> Mesh:
    """The convex hull of 300 random points of the unit sphere: acute and obtuse, no w < 0."""
    x = np.random.default_rng(918273645).normal(size=(300, 3))
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    f = ConvexHull(x).simplices
    a, b, c = x[f].transpose(1, 0, 2)
    inwards = (np.cross(b - a, c - a) * a).sum(axis=1) < 0
    f[inwards] = f[inwards][:, ::-1]
    return Mesh(x, f)


@cache
def obt() -> Mesh:
    """``closed`` stretched six times along z: many obtuse faces and negative cotangents."""
    return closed().with_vertices(closed().vertices * [1, 1, 6])


@cache
def open_() -> Mesh:
    """A Delaunay triangulation of random points of the unit square, with 32 boundary edges."""
    rng = np.random.default_rng(564738291)
    inner = rng.uniform(0.02, 0.98, size=(160, 2))
    runs = [np.concatenate([[0.0], np.sort(rng.uniform(0.03, 0.97, 7))]) for _ in range(4)]
    sides = [
        np.stack([runs[0], np.zeros(8)], axis=1),
        np.stack([np.ones(8), runs[1]], axis=1),
        np.stack([1 - runs[2], np.ones(8)], axis=1),
        np.stack([np.zeros(8), 1 - runs[3]], axis=1),
    ]
    x = np.concatenate([*sides, inner])
    f = Delaunay(x).simplices
    double = _double_areas(x, f)
    f[double < 0] = f[double < 0][:, ::-1]
    return Mesh(x, f[np.abs(double) > 1e-12])


@cache
def bad() -> Mesh:
    """The points of ``open_`` after random edge flips: planar, and not Delaunay."""
    x = open_().vertices
    f = [tuple(face) for face in open_().faces.tolist()]
    rng = np.random.default_rng(192837465)
    for _ in range(400):
        sides = {(t[c], t[c - 2]): k for k, t in enumerate(f) for c in range(3)}
        i, j = list(sides)[rng.integers(len(sides))]
        if (j, i) not in sides:
            continue
        one, two = sides[i, j], sides[j, i]
        k = next(v for v in f[one] if v not in (i, j))
        m = next(v for v in f[two] if v not in (i, j))
        new = np.array([[k, m, j], [m, k, i]])
        if (_double_areas(x, new) > 1e-4).all():
            f[one], f[two] = tuple(new[0].tolist()), tuple(new[1].tolist())
    return Mesh(x, f)


@cache
def cur() -> Mesh:
    """``open_`` lifted to a curved sheet."""
    x, y = open_().vertices.T
    return open_().with_vertices(np.stack([x, y, 0.4 * np.sin(3 * x) * np.cos(2 * y)], axis=1))


@cache
def tor() -> Mesh:
    """A torus of 24 x 15 quadrilaterals, each cut in two: every vertex has six neighbours."""
    u, v = np.meshgrid(2 * np.pi * np.arange(24) / 24, 2 * np.pi * np.arange(15) / 15)
    r = 1 + 0.4 * np.cos(v)
    x = np.stack([r * np.cos(u), r * np.sin(u), 0.4 * np.sin(v)], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(24), np.arange(15))
    at = [((j + b) % 15 * 24 + (i + a) % 24).ravel() for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    return Mesh(x, np.concatenate([np.stack(at[:3], 1), np.stack([at[0], at[2], at[3]], 1)]))


@cache
def pl() -> Mesh:
    """A planar grid of 8 x 7 vertices, squares cut in two: cotangents vanish on diagonals."""
    i, j = np.meshgrid(np.arange(8), np.arange(7))
    x = np.stack([i.ravel(), j.ravel()], axis=1).astype(float)
    i, j = np.meshgrid(np.arange(7), np.arange(6))
    at = [((j + b) * 8 + i + a).ravel() for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    return Mesh(x, np.concatenate([np.stack(at[:3], 1), np.stack([at[0], at[2], at[3]], 1)]))


def flipped(seed: int, n: int = 40, aspect: float = 1.0) -> Mesh:
    """A small planar mesh with edges flipped at random, stretched along x by ``aspect``."""
    rng = np.random.default_rng(seed)
    x = rng.uniform(size=(n, 2))
    f = [tuple(t) for t in Delaunay(x).simplices.tolist()]
    f = [t if _double_areas(x, np.array([t]))[0] > 0 else t[::-1] for t in f]
    f = [t for t in f if _double_areas(x, np.array([t]))[0] > 1e-5]
    for _ in range(2 * n):
        sides = {(t[c], t[c - 2]): k for k, t in enumerate(f) for c in range(3)}
        i, j = list(sides)[rng.integers(len(sides))]
        if (j, i) not in sides:
            continue
        one, two = sides[i, j], sides[j, i]
        k = next(v for v in f[one] if v not in (i, j))
        m = next(v for v in f[two] if v not in (i, j))
        new = np.array([[k, m, j], [m, k, i]])
        if (_double_areas(x, new) > 1e-5).all():
            f[one], f[two] = tuple(new[0].tolist()), tuple(new[1].tolist())
    used, faces = np.unique(np.array(f), return_inverse=True)
    return Mesh(x[used] * [aspect, 1], faces.reshape(-1, 3))


def triangle(a: float, b: float) -> Mesh:
    """One triangle with the angles a and b (degrees) at its first two corners."""
    ca, cb = 1 / np.tan(np.radians([a, b]))
    return Mesh([[0, 0], [ca + cb, 0], [ca, 1]], [[0, 1, 2]])


def three_leaves() -> Mesh:
    """Three triangles around one edge: not a manifold, and accepted."""
    x = [[0, 0, 0], [0, 0, 1], [1, 0, 0.3], [-0.7, 0.8, 0.4], [-0.5, -1.1, 0.6]]
    return Mesh(x, [[0, 1, 2], [0, 1, 3], [0, 1, 4]])


def _double_areas(x: np.ndarray, f: np.ndarray) -> np.ndarray:
    a, b, c = x[f].transpose(1, 0, 2)
    return (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]


MESHES = {
    "closed": closed,
    "obt": obt,
    "open": open_,
    "bad": bad,
    "cur": cur,
    "tor": tor,
    "pl": pl,
    "leaves": three_leaves,
}
IRREGULAR = ("closed", "obt", "open", "bad", "cur")
