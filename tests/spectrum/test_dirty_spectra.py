"""Any mesh, in any unit, into what finds eigenvectors: numbers, or an error that says why."""

import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import beltrami as bt
import strategies
from beltrami.errors import BeltramiError

PAIRS = [("cotangent", "voronoi"), ("cotangent", "consistent"), ("combinatorial", "degree"),
         ("distance", "unit"), ("clamped", "barycentric"), ("tufted", "voronoi")]  # fmt: skip


@pytest.mark.parametrize("solver", ["lu", "ldl", "minres"])
@settings(max_examples=40)
@given(
    strategies.any_meshes(),
    st.sampled_from([0, 0, -12, 12, -40, 40]),
    st.sampled_from(PAIRS),
    st.sampled_from([-1.0, 0.0, 0.3, 1.7, 40.0]),
    strategies.generators(),
)
def test_inverse_iteration(solver, mesh, unit, pair, shift, rng):
    mesh = bt.Mesh(mesh.vertices * 10.0**unit, mesh.faces)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            given_pair = bt.laplacian(mesh, *pair)
            sigma = shift * given_pair.stiffness.diagonal().sum() / given_pair.masses.sum()
            held = np.flatnonzero(rng.random(given_pair.n) < 0.1)
            found = bt.inverse_iteration(
                given_pair, sigma, solver=solver, hold=held, max_inner_iterations=1000
            )
        except BeltramiError:
            return
    assert np.isfinite(found.eigenvector).all()
    assert np.isfinite(found.eigenvalue)
    assert not found.eigenvector[held].any()
    assert given_pair.norm(found.eigenvector) == pytest.approx(1, abs=1e-9)
    rest = given_pair.stiffness @ found.eigenvector
    rest -= found.eigenvalue * (given_pair.mass @ found.eigenvector)
    rest[held] = 0
    size = np.linalg.norm(abs(given_pair.stiffness) @ abs(found.eigenvector))
    size += abs(sigma) * np.linalg.norm(given_pair.mass @ found.eigenvector)
    assert np.linalg.norm(rest) <= 1e-6 * size


@given(strategies.any_meshes(), strategies.generators(), st.sampled_from(["strong", "weak"]))
def test_nodal_domains(mesh, rng, kind):
    f = rng.normal(size=mesh.n_vertices) * 10.0 ** rng.integers(-200, 200)
    found = bt.nodal_domains(mesh, f, kind)
    used = np.concatenate(
        [found.positive[found.positive >= 0], found.negative[found.negative >= 0]]
    )
    assert np.array_equal(np.unique(used), np.arange(found.count))
    assert (found.positive[f > 0] >= 0).all()
    assert (found.negative[f < 0] >= 0).all()
