"""Definitions 5 and 7: functions are vectors, operators are matrices; example 2."""

import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.diffusion.heat import heat
from beltrami.diffusion.smooth_mesh import smooth_mesh
from beltrami.diffusion.smoothing import smooth
from beltrami.errors import DimensionError
from beltrami.mesh.shapes import torus
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import IRREGULAR, MESHES

OPERATORS = {
    "apply": lambda pair, f: pair.apply(f),
    "averaging": lambda pair, f: pair.averaging @ f,
    "smooth": lambda pair, f: smooth(pair, f, 3, 0.7),
    "implicit": lambda pair, f: heat(pair, f, 0.8, steps=2),
    "explicit": lambda pair, f: heat(pair, f, 0.8, "explicit", 2),
}


@pytest.mark.chapter("D5")
@pytest.mark.parametrize("name", IRREGULAR)
def test_a_function_of_the_positions_is_one_of_the_indices(name):
    mesh = MESHES[name]()
    f = (mesh.vertices**2).sum(axis=1)
    by_position = dict(zip(map(tuple, mesh.vertices.tolist()), f, strict=True))
    kept = mesh.with_data(f=f).vertex_data["f"]
    for i, x in enumerate(mesh.vertices.tolist()):
        assert kept[i] == by_position[tuple(x)] == pytest.approx(sum(c**2 for c in x))
    pair = laplacian(mesh, "combinatorial")
    for wrong in (f[:-1], np.append(f, 0), f[None], f[:, None, None]):
        with pytest.raises(DimensionError):
            pair.apply(wrong)


@pytest.mark.chapter("D5", "D7", "P47")
@pytest.mark.parametrize("operator", OPERATORS)
@pytest.mark.parametrize("name", ["obt", "bad", "leaves"])
def test_operators_are_linear_and_act_on_each_column(name, operator):
    mesh = MESHES[name]()
    pair, A = laplacian(mesh, "distance"), OPERATORS[operator]
    f = oracle.rough_functions(mesh, 4)
    together = A(pair, f)
    for c in range(4):
        assert np.allclose(A(pair, f[:, c]), together[:, c], rtol=1e-10, atol=1e-10)
    combined = A(pair, 2.5 * f[:, 0] - 0.3 * f[:, 1])
    assert np.allclose(combined, 2.5 * together[:, 0] - 0.3 * together[:, 1], atol=1e-9)
    matrix = A(pair, np.eye(pair.n))  # A e_j is column j
    assert np.allclose(matrix @ f, together, rtol=1e-8, atol=1e-8)


@pytest.mark.chapter("D7", "P17")
def test_matrices_are_sparse():
    """Memory of order n: a diagonal and two entries an edge, at n = 100 000."""
    mesh = torus(400, 250)
    pair = laplacian(mesh, "combinatorial")
    n, p = mesh.n_vertices, len(mesh.edges)
    assert (n, p) == (100_000, 300_000)
    assert pair.stiffness.nnz == n + 2 * p
    assert pair.weights.nnz == pair.normalized.nnz - n == 2 * p
    assert pair.mass.nnz == n
    assert pair.incidence.nnz == 2 * p
    matrices = (pair.stiffness, pair.mass, pair.weights, pair.incidence, pair.normalized)
    held = sum(m.data.nbytes + m.indices.nbytes + m.indptr.nbytes for m in matrices)
    assert held < 600 * n  # a dense matrix has 800 000 bytes for each vertex


@pytest.mark.chapter("X2")
@pytest.mark.parametrize("name", ["closed", "cur", "bad"])
def test_the_coordinates_are_functions(name):
    mesh = MESHES[name]()
    pair = laplacian(mesh, "combinatorial")
    columns = [smooth(pair, mesh.vertices[:, c], 4) for c in range(mesh.dimension)]
    assert np.allclose(smooth_mesh(mesh, steps=4).vertices, np.stack(columns, axis=1), atol=1e-13)
    moved = mesh.with_vertices(np.stack(columns, axis=1))
    assert moved.topology is mesh.topology
    for c in range(mesh.dimension):
        assert np.array_equal(moved.vertices[:, c], columns[c])
