"""Planes around a vertex: the kernels against numpy."""

import numpy as np
import pytest

from beltrami.diffusion.planes import PlanesAround, planes_of
from beltrami.mesh import shapes
from beltrami.mesh.mesh import Mesh


def noisy(mesh):
    random = np.random.default_rng(4)
    return mesh.with_vertices(mesh.vertices + 0.1 * random.standard_normal(mesh.vertices.shape))


def wheel(n):
    """Return two cones of n faces on one rim, which is not even."""
    angle = 2 * np.pi * (np.arange(n) / n) ** 1.3
    rim = np.stack([np.cos(angle), np.sin(angle), 0.1 * np.sin(5 * angle)], axis=1)
    i = np.arange(n)
    cones = [np.stack(f, 1) for f in ((i, (i + 1) % n, i * 0 + n), ((i + 1) % n, i, i * 0 + n + 1))]
    return Mesh(np.concatenate([rim, [[0, 0, 1], [0, 0, -1.0]]]), np.concatenate(cones))


MESHES = {
    "sphere": noisy(shapes.icosphere(3)),
    "open": noisy(shapes.grid(9, 12, dimension=3)),
    "flat": shapes.grid(9, 12, dimension=3),  # all distances are the same
    "cube": shapes.cube(5),
    "wheel": wheel(60),  # 120 planes: more than are put in order by counting
    "strays": Mesh(np.random.default_rng(0).random((7, 3)), [[0, 1, 2], [2, 1, 4]]),
}


def distances(mesh, x, i, most=64):
    """Return the distances of x from the planes around the neighbours of i, but its own."""
    t = mesh.topology
    few = [j for j in t.ring(i) if len(t.ring(j)) <= most] if len(t.ring(i)) <= most else []
    faces = sorted({f for j in few for f in t.face_ring(j)} - set(t.face_ring(i)))
    away = x - mesh.vertices[mesh.faces[faces]].mean(axis=1)
    return np.einsum("ij,ij->i", mesh.face_normals[faces], away)


def middle(values):
    third = len(values) // 3
    return np.sort(values)[third : len(values) - third].mean() if len(values) else 0.0


@pytest.mark.parametrize("name", MESHES)
def test_off_and_shares(name):
    mesh = MESHES[name]
    n, x = mesh.n_vertices, mesh.vertices.copy()
    x[::3] += 0.05 * np.random.default_rng(1).standard_normal((len(x[::3]), 3))
    there = mesh.with_vertices(x)
    around, planes = PlanesAround.of(mesh.topology), planes_of(there)
    off = around.off(planes, mesh, x)
    usual, here = (
        np.array([middle(distances(there, y[i], i)) for i in range(n)]) for y in (x, mesh.vertices)
    )
    rings = [mesh.topology.ring(i) for i in range(n)]
    medians = np.array([np.median(usual[ring]) if len(ring) else 0.0 for ring in rings])
    assert off == pytest.approx(here - medians, abs=1e-14)
    reach = np.linspace(0, 0.5, n) * (np.arange(n) % 4 > 0)
    shares = around.shares(planes, mesh.vertices, reach)
    for i in range(n):
        away = np.abs(distances(there, mesh.vertices[i], i))
        assert shares[i] == (np.mean(away < reach[i]) if len(away) else 0.0)


def test_those_of_many_neighbours_have_none_and_are_none():
    around = PlanesAround.of(wheel(65).topology)
    sizes = np.diff(around.indptr.astype(int))
    assert sizes[-2:].tolist() == [0, 0]
    assert (sizes[:-2] == 4).all()  # of two neighbours on the rim: two on each side
    assert (np.diff(PlanesAround.of(wheel(64).topology).indptr.astype(int))[:-2] > 100).all()
