import numpy as np
import pytest
from scipy.sparse import csr_array, eye_array

from beltrami.errors import DimensionError
from beltrami.operators.areas import consistent_mass, diagonal_matrix
from beltrami.operators.laplacian import laplacian
from beltrami.operators.locality import is_local
from beltrami.operators.weights import edge_weights
from meshes_of_the_errata import IRREGULAR, MESHES

pytestmark = pytest.mark.chapter("D7", "D8", "P17")


@pytest.mark.parametrize("name", IRREGULAR)
def test_local_ones_and_others(name):
    mesh = MESHES[name]()
    pair = laplacian(mesh, "combinatorial")
    D = diagonal_matrix(pair.degrees)
    local = (pair.weights, pair.stiffness, D, pair.averaging, pair.normalized,
             consistent_mass(mesh), edge_weights(mesh, "mean_value"), eye_array(pair.n),
             csr_array((pair.n, pair.n)))  # fmt: skip
    for A in local:
        assert is_local(A, mesh)
        assert is_local(A, mesh.topology)
    inverse = np.linalg.inv(np.eye(pair.n) + pair.stiffness.toarray())
    for A in (pair.averaging @ pair.averaging, inverse, inverse - 1e-300):
        assert not is_local(A, mesh)


def test_the_diagonal_is_allowed():
    """The definition as printed has no (i, i), so L would break it n times (E13)."""
    mesh = MESHES["closed"]()
    L = laplacian(mesh).stiffness
    allowed = mesh.topology.adjacency.toarray() > 0
    assert ((L.toarray() != 0) & ~allowed).sum() == 300
    assert is_local(L, mesh)


def test_one_entry_is_enough_and_a_stored_zero_is_none():
    mesh = MESHES["open"]()
    n = mesh.n_vertices
    i = 0
    j = int(np.flatnonzero(mesh.topology.adjacency.toarray()[0] == 0)[-1])
    for row, column in ((i, j), (j, i)):
        for value, verdict in ((1e-200, False), (0.0, True)):
            A = csr_array(([value], ([row], [column])), shape=(n, n))
            assert is_local(A, mesh) is verdict
    cancelled = csr_array(([1.0, -1.0], [j, j], [0, 2] + [2] * (n - 1)), shape=(n, n))
    assert is_local(cancelled, mesh)
    assert cancelled.nnz == 2  # the caller's matrix is as it was


def test_matrices_of_another_size():
    mesh = MESHES["open"]()
    for wrong in (np.eye(5), np.ones(192), csr_array((192, 191)), "L"):
        with pytest.raises(DimensionError):
            is_local(wrong, mesh)
