"""Remark 1 and l. 309 to 337: symmetry, L1 = 0, unit diagonals, energies (E28, E43, E44)."""

import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.mesh.shapes import tetrahedron
from beltrami.operators.laplacian import laplacian
from beltrami.operators.weights import SYMMETRIC_WEIGHTS, edge_weights
from meshes_of_the_errata import MESHES

CASES = [(name, kind) for name in MESHES for kind in SYMMETRIC_WEIGHTS]


@pytest.mark.chapter("R1", "P18", "P32", "D15")
@pytest.mark.parametrize(("name", "kind"), CASES)
def test_as_stated(name, kind):
    pair = laplacian(MESHES[name](), kind, "degree")
    L, N, ones = pair.stiffness.toarray(), pair.normalized.toarray(), np.ones(pair.n)
    d = pair.degrees
    assert np.array_equal(L, L.T)
    assert np.allclose(N, N.T, rtol=0, atol=1e-14)
    assert np.abs(L @ ones).max() < 1e-13 * d.max()
    assert np.allclose(N.diagonal(), 1, rtol=1e-15)  # normalised operators have a unit diagonal
    assert np.trace(N) == pytest.approx(pair.n)
    assert np.abs(N @ np.sqrt(d)).max() < 1e-12 * np.sqrt(d.max())
    assert np.abs(N @ ones).max() > 1e-3 or np.ptp(d) < 1e-9  # no derivative, unless d is constant
    W = edge_weights(MESHES[name](), kind).toarray()
    literal = np.eye(pair.n) - W / np.sqrt(d)[:, None] * np.sqrt(d)  # as printed (E43)
    assert np.abs(literal - N).max() > 0.1 or np.abs(d - 1).max() < 1e-9
    if pair.properties.non_negative_weights:
        averaged = pair.averaging @ ones
        assert np.abs(averaged - 1).max() < 1e-14


@pytest.mark.chapter("R1")
def test_where_all_degrees_are_equal_it_vanishes_on_constants():
    for kind in SYMMETRIC_WEIGHTS:
        pair = laplacian(tetrahedron(), kind, "degree")
        assert np.abs(pair.normalized @ np.ones(4)).max() < 1e-15


@pytest.mark.chapter("U19", "U20", "P34")
@pytest.mark.parametrize(("name", "kind"), CASES)
def test_energies_are_sums_over_the_edges_once(name, kind):
    pair = laplacian(MESHES[name](), kind)
    f = oracle.rough_functions(MESHES[name](), 1)[:, 0]
    i, j = pair.edges.T
    for function, matrix in ((f, pair.stiffness), (f / np.sqrt(pair.degrees), pair.normalized)):
        once = pair.edge_weight @ (function[i] - function[j]) ** 2
        given = f if matrix is pair.normalized else function
        assert given @ (matrix @ given) == pytest.approx(once, rel=1e-9)
        assert pair.dirichlet_energy(function) == pytest.approx(once, rel=1e-9)
        assert once > 0  # for negative cotangents too (E44)
        W = pair.weights.toarray()
        twice = (W * (function[:, None] - function) ** 2).sum()  # over E as printed (E28)
        assert twice == pytest.approx(2 * once, rel=1e-9)
        if pair.properties.non_negative_weights:
            G = pair.gradient
            assert (G @ function) @ (G @ function) == pytest.approx(once, rel=1e-9)


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


@pytest.mark.chapter("X2", "D5", "D7")
def test_coordinates_are_functions_and_columns_go_by_themselves():
    mesh = MESHES["cur"]()
    pair = laplacian(mesh)
    for A in (pair.stiffness, pair.mass, pair.normalized, edge_weights(mesh, "mean_value")):
        together = A @ mesh.vertices
        for c in range(3):
            assert np.array_equal(together[:, c], A @ mesh.vertices[:, c])
        e = np.zeros(pair.n)
        e[7] = 1
        assert np.array_equal(A @ e, A.toarray()[:, 7])
    moved = mesh.with_vertices(mesh.vertices - 0.01 * pair.apply(mesh.vertices))
    assert np.array_equal(
        moved.vertices[:, 1], mesh.vertices[:, 1] - 0.01 * pair.apply(mesh.vertices[:, 1])
    )


@pytest.mark.chapter("P7", "P16")
@pytest.mark.parametrize("name", MESHES)
def test_the_graph_alone_makes_the_combinatorial_pair(name):
    mesh = MESHES[name]()
    pairs = [laplacian(d, "combinatorial") for d in (mesh, mesh.topology, mesh.topology.adjacency)]
    for pair in pairs[1:]:
        assert abs(pair.stiffness - pairs[0].stiffness).max() == 0
        assert abs(pair.mass - pairs[0].mass).max() == 0
        assert not pair.properties.needs_positions
