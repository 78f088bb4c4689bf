"""Meshes that nobody thought of: hypothesis strategies for clean and for damaged meshes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, Delaunay

from beltrami.mesh.mesh import Mesh

Arrays = tuple[NDArray[np.float64], NDArray[np.int64]]


def generators() -> st.SearchStrategy[np.random.Generator]:
    """Draw random number generators, by their seeds."""
    return st.integers(0, 2**63 - 1).map(np.random.default_rng)


# ------------------------------------------------------------------------------ clean meshes


def hull(rng: np.random.Generator, n: int) -> Arrays:
    """Wrap n random points: closed, convex, genus 0, seen from outside; inner points are free."""
    points = rng.normal(size=(n, 3))
    found = ConvexHull(points)
    faces = found.simplices.astype(np.int64)
    a, b, c = points[faces].transpose(1, 0, 2)
    inward = (np.cross(b - a, c - a) * found.equations[:, :3]).sum(axis=1) < 0
    faces[inward] = faces[inward][:, [0, 2, 1]]
    return points, faces


def delaunay(rng: np.random.Generator, n: int) -> Arrays:
    """Triangulate n random points of the square: an oriented planar disk (in R²)."""
    points = rng.uniform(-1, 1, size=(n, 2))
    faces = Delaunay(points).simplices.astype(np.int64)
    a, b, c = points[faces].transpose(1, 0, 2)
    turn = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    faces[turn < 0] = faces[turn < 0][:, [0, 2, 1]]
    return points, faces


def sheet(rng: np.random.Generator, n: int) -> Arrays:
    """Lift a planar triangulation to a random height: an oriented disk in R³."""
    points, faces = delaunay(rng, n)
    return np.column_stack([points, rng.normal(size=n)]), faces


def ring_torus(rng: np.random.Generator, n: int) -> Arrays:
    """Roll up a grid both ways: closed, genus 1."""
    p = 3 + n % 3
    q = 3 + int(rng.integers(3))
    faces = []
    for i in range(p):
        for j in range(q):
            a, b = i * q + j, i * q + (j + 1) % q
            c, d = (i + 1) % p * q + (j + 1) % q, (i + 1) % p * q + j
            faces += [[a, d, c], [a, c, b]]
    u, v = np.divmod(np.arange(p * q), q)
    u, v = 2 * np.pi * u / p, 2 * np.pi * v / q
    r = 2 + np.cos(v)
    points = np.stack([r * np.cos(u), r * np.sin(u), np.sin(v)], axis=1)
    return points, np.array(faces)


def moebius(rng: np.random.Generator, n: int) -> Arrays:
    """Glue a strip to itself with half a turn: one boundary loop, not orientable."""
    n = max(n, 5)
    u = 2 * np.pi * np.arange(n) / n
    points = []
    for t in (-0.4, 0.4):
        r = 1 + t * np.cos(u / 2)
        points.append(np.stack([r * np.cos(u), r * np.sin(u), t * np.sin(u / 2)], axis=1))
    faces = []
    for i in range(n):
        a, b = i, i + n
        c, d = (i + 1, i + 1 + n) if i < n - 1 else (n, 0)  # the half turn swaps the sides
        faces += [[a, c, d], [a, d, b]]
    return np.concatenate(points), np.array(faces)


CLEAN: tuple[Callable[[np.random.Generator, int], Arrays], ...] = (
    hull,
    delaunay,
    sheet,
    ring_torus,
    moebius,
)


def arrays(*makers: Callable[[np.random.Generator, int], Arrays]) -> st.SearchStrategy[Arrays]:
    """Draw (vertices, faces) from some makers, of 4 to 16 points."""
    return st.builds(
        lambda make, rng, n: make(rng, n),
        st.sampled_from(makers or CLEAN),
        generators(),
        st.integers(4, 16),
    )


def closed_meshes() -> st.SearchStrategy[Mesh]:
    """Draw closed, oriented manifolds, perhaps with unreferenced vertices."""
    return arrays(hull, ring_torus).map(lambda pair: Mesh(*pair))


def planar_meshes() -> st.SearchStrategy[Mesh]:
    """Draw oriented disks in R²."""
    return arrays(delaunay).map(lambda pair: Mesh(*pair))


# ------------------------------------------------------------------------------ damages


def _delete(rng: np.random.Generator, x: NDArray, f: NDArray) -> Arrays:
    return x, f[rng.random(len(f)) < rng.random()]


def _flip(rng: np.random.Generator, x: NDArray, f: NDArray) -> Arrays:
    turned = rng.random(len(f)) < rng.random()
    return x, np.where(turned[:, None], f[:, [0, 2, 1]], f)


def _repeat(rng: np.random.Generator, x: NDArray, f: NDArray) -> Arrays:
    """Say some faces twice, the second time starting elsewhere, perhaps turned."""
    if not len(f):
        return x, f
    again = f[rng.integers(len(f), size=2)]
    return x, np.concatenate([f, again[:, rng.permutation(3)]])


def _collapse(rng: np.random.Generator, x: NDArray, f: NDArray) -> Arrays:
    """Add faces that name a vertex twice or three times, anywhere in the list."""
    made = rng.integers(len(x), size=(3, 3))
    made[np.arange(3), rng.integers(3, size=3)] = made[:, 0]
    made[:, 1] = np.where(rng.random(3) < 0.5, made[:, 0], made[:, 1])
    made[:, 2] = np.where(made[:, 1] == made[:, 0], made[:, 2], made[:, 1])
    return x, np.insert(f, rng.integers(len(f) + 1, size=3), made, axis=0)


def _fan(rng: np.random.Generator, x: NDArray, f: NDArray) -> Arrays:
    """Hang new faces on an edge, most with new vertices: more than two faces there."""
    if not len(f):
        return x, f
    a, b = f[rng.integers(len(f)), :2]
    tips = len(x) + np.arange(int(rng.integers(1, 4)))
    x = np.concatenate([x, rng.normal(size=(len(tips), x.shape[1]))])
    return x, np.concatenate([f, [[a, b, tip] for tip in tips]])


def _pinch(rng: np.random.Generator, x: NDArray, f: NDArray) -> Arrays:
    """Make one vertex of two: fans that meet in a vertex, faces that name one twice."""
    a, b = rng.integers(len(x), size=2)
    return x, np.where(f == a, b, f)


def _join(rng: np.random.Generator, x: NDArray, f: NDArray) -> Arrays:
    """Put another mesh beside."""
    y, g = CLEAN[int(rng.integers(len(CLEAN)))](rng, 6)
    d = max(x.shape[1], y.shape[1])
    x, y = (np.pad(z, ((0, 0), (0, d - z.shape[1]))) for z in (x, y + 5))
    return np.concatenate([x, y]), np.concatenate([f, g + len(x)])


def _stray(rng: np.random.Generator, x: NDArray, f: NDArray) -> Arrays:
    """Insert a vertex that no face names."""
    at = int(rng.integers(len(x) + 1))
    return np.insert(x, at, rng.normal(size=x.shape[1]), axis=0), f + (f >= at)


def _number(rng: np.random.Generator, x: NDArray, f: NDArray) -> Arrays:
    """Number vertices and faces anew, and let faces begin at any corner."""
    p = rng.permutation(len(x))
    f = np.argsort(p)[f[rng.permutation(len(f))]]
    start = (rng.integers(3, size=(len(f), 1)) + np.arange(3)) % 3
    return x[p], np.take_along_axis(f, start, axis=1)


def _twin_vertex(rng: np.random.Generator, x: NDArray, f: NDArray) -> Arrays:
    """Add a vertex at the place of another, and give it to one of the faces (a crack)."""
    old = int(rng.integers(len(x)))
    x = np.concatenate([x, x[old : old + 1]])
    f = f.copy()
    rows, columns = np.nonzero(f == old)
    if len(rows):
        f[rows[0], columns[0]] = len(x) - 1
    return x, f


DAMAGES = (
    _delete, _flip, _repeat, _collapse, _fan, _pinch, _join, _stray, _number, _twin_vertex,
)  # fmt: skip


@st.composite
def any_arrays(draw: st.DrawFn) -> Arrays:
    """Draw (vertices, faces) with up to five damages, one on top of the other."""
    x, f = draw(arrays())
    for damage in draw(st.lists(st.sampled_from(DAMAGES), max_size=5)):
        x, f = damage(draw(generators()), x, f)
    return x, np.asarray(f, dtype=np.int64).reshape(-1, 3)


def any_meshes() -> st.SearchStrategy[Mesh]:
    """Draw meshes with any damage."""
    return any_arrays().map(lambda pair: Mesh(*pair))
