"""Section 3.2.5: what semi-definite means for solving, and what a graph alone determines (E44)."""

import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.mesh.shapes import tetrahedron
from beltrami.operators.laplacian import laplacian
from beltrami.operators.weights import SYMMETRIC_WEIGHTS
from meshes_of_the_errata import MESHES


@pytest.mark.chapter("R1")
def test_where_all_degrees_are_equal_it_vanishes_on_constants():
    for kind in SYMMETRIC_WEIGHTS:
        pair = laplacian(tetrahedron(), kind, "degree")
        assert np.abs(pair.normalized @ np.ones(4)).max() < 1e-15


@pytest.mark.chapter("P34", "P36")
@pytest.mark.parametrize("name", ["closed", "obt", "open", "bad"])
def test_semi_definite_and_the_poisson_equation(name):
    """A solution exists exactly where the sum of the right hand side vanishes."""
    L = laplacian(MESHES[name]()).stiffness.toarray()
    n = len(L)
    rough = oracle.rough_functions(MESHES[name](), 1)[:, 0]
    for b, solvable in ((rough - rough.mean(), True), (rough - rough.mean() + 0.1, False)):
        f = np.linalg.lstsq(L, b, rcond=1e-10)[0]
        left = np.abs(L @ f - b).max()
        assert left < 1e-9 if solvable else left == pytest.approx(0.1, rel=1e-6)
    with pytest.raises(np.linalg.LinAlgError):  # it is not definite (E44)
        np.linalg.cholesky(L - 1e-12 * np.eye(n))
    assert np.ones(n) @ L @ np.ones(n) == pytest.approx(0, abs=1e-9)


@pytest.mark.chapter("P7", "P16")
@pytest.mark.parametrize("name", MESHES)
def test_the_graph_alone_makes_the_combinatorial_pair(name):
    mesh = MESHES[name]()
    pairs = [laplacian(d, "combinatorial") for d in (mesh, mesh.topology, mesh.topology.adjacency)]
    for pair in pairs[1:]:
        assert abs(pair.stiffness - pairs[0].stiffness).max() == 0
        assert abs(pair.mass - pairs[0].mass).max() == 0
        assert not pair.properties.needs_positions
