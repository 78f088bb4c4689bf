"""The barrier between parts of the boundary: against every pair, and differences."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import disk, grid
from beltrami.parameterization import relaxation
from beltrami.parameterization.barrier import boundary_barrier
from beltrami.parameterization.block_pattern import block_pattern
from beltrami.parameterization.certificate import certify
from beltrami.parameterization.distortion import distortion
from beltrami.parameterization.parameterize import parameterize
from beltrami.parameterization.relaxation import relax


def squeezed(seed):
    """A disk in the plane of which opposite parts of the boundary come near."""
    mesh = disk(4)
    rng = np.random.default_rng(seed)
    x = mesh.vertices * [1, 0.01 + 0.03 * rng.random()]
    return mesh, x + 0.02 * rng.normal(size=x.shape)


def every_pair(mesh, x):
    """The definition, one pair after the other."""
    edges = mesh.topology.boundary_edges
    lengths = np.linalg.norm(x[edges[:, 0]] - x[edges[:, 1]], axis=1)
    space = np.linalg.norm(mesh.vertices[edges[:, 0]] - mesh.vertices[edges[:, 1]], axis=1)
    total = 0.0
    for v in np.unique(edges):
        own = lengths[(edges == v).any(axis=1)].min()
        for (i, j), length, weight in zip(edges, lengths, space**2 / mesh.area, strict=True):
            if v not in (i, j):
                side = x[j] - x[i]
                (face,) = mesh.faces[np.isin(mesh.faces, (i, j)).sum(axis=1) == 2]
                (far,) = set(face.tolist()) - {i, j}
                up = x[far] - x[i]
                length = min(length, abs(side[0] * up[1] - side[1] * up[0]) / length)
                along = np.clip((x[v] - x[i]) @ side / (side @ side), 0, 1)
                distance = np.linalg.norm(x[v] - x[i] - along * side)
                total += weight * max(0.25 * min(own, length) / distance - 1, 0) ** 2
    return total


@given(st.integers(0, 10**6))
def test_against_every_pair(seed):
    mesh, x = squeezed(seed)
    assert boundary_barrier(mesh, x).energy(x) == pytest.approx(every_pair(mesh, x), rel=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_the_gradient_is_that_of_differences_and_the_hessian_bounds_theirs(seed):
    mesh, x = squeezed(seed)
    barrier = boundary_barrier(mesh, x)
    pattern = block_pattern(mesh, np.ones(mesh.n_vertices, bool))
    gradient, entries = np.zeros_like(x), np.zeros(len(pattern.indices))
    barrier.add_derivatives(x, pattern, gradient, entries)
    H = pattern.matrix(entries).toarray()
    assert np.abs(gradient).max() > 0
    np.testing.assert_allclose(H, H.T)
    rng = np.random.default_rng(seed)
    size = np.abs(x).max()
    for _ in range(10):
        d = rng.normal(size=x.shape)
        h = 1e-7 * size
        ahead, here, behind = (barrier.energy(x + t * d) for t in (h, 0, -h))
        assert gradient.ravel() @ d.ravel() == pytest.approx((ahead - behind) / (2 * h), rel=1e-3)
        h = 1e-4 * size
        ahead, behind = (barrier.energy(x + t * d) for t in (h, -h))
        bend = (ahead + behind - 2 * here) / h**2
        assert d.ravel() @ H @ d.ravel() > 0.9 * bend


def test_nothing_is_felt_far_away_and_touching_is_infinite():
    mesh = grid(6, 6)
    x = mesh.vertices.copy()
    barrier = boundary_barrier(mesh, x)
    assert barrier.energy(x) == 0
    loop = mesh.boundary_loops[0]
    x[loop[0]] = (x[loop[10]] + x[loop[11]]) / 2
    assert barrier.energy(x) == np.inf


def test_a_boundary_slides_along_itself(monkeypatch):
    """A ring of nearly two turns, whose isometry would overlap itself: it does not stick."""
    strip = grid(60, 4)
    t = (strip.vertices[:, 0] + 1) * 1.8 * np.pi
    r = 1 - 0.4 * strip.vertices[:, 1]
    mesh = Mesh(np.stack([r * np.cos(t), r * np.sin(t), 0.02 * t], axis=1), strip.faces)
    spiral = (r + 0.16 * t)[:, None] * np.stack([np.cos(t), np.sin(t)], axis=1)
    assert certify(mesh.topology, spiral).is_bijective
    x, _ = relax(mesh, spiral, 100, None, 1e-4)
    assert certify(mesh.topology, x).is_bijective
    monkeypatch.setattr(relaxation, "boundary_barrier", without_reach)
    stuck, _ = relax(mesh, spiral, 100, None, 1e-4)
    assert certify(mesh.topology, stuck).is_bijective
    reached, left = (distortion(mesh, at).symmetric_dirichlet - 1 for at in (x, stuck))

    assert reached < 0.01 * left


def without_reach(mesh, x):
    found = boundary_barrier(mesh, x)
    return replace(found, near_edges=0 * found.near_edges)


def test_needles_are_laid_out_as_they_are():
    """Two of them hang at vertex 1, which is near to the outer side of each: that is its place.

    With the length of the sides for a reach, it was pushed away in each step anew.
    """
    x = np.array([[0, 1], [6, 1], [12, 1], [3, 1.06], [9, 1.06], [0, 0], [7, 0]]) * [0.01, 1]
    faces = [[5, 1, 0], [6, 2, 1], [0, 1, 3], [1, 2, 4], [1, 4, 3]]
    mesh = Mesh(x, faces)
    assert boundary_barrier(mesh, x).energy(x) == 0
    found = parameterize(mesh, "free")
    assert found.distortion.symmetric_dirichlet == pytest.approx(1, abs=1e-3)
    _, steps = relax(mesh, found.uv * [1.5, 1 / 1.5], 200, None, 1e-6)
    assert steps < 50
