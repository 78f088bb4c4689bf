import numpy as np
import pytest
from scipy.sparse import csr_array

from beltrami.mesh.shapes import icosphere
from beltrami.solvers.locality import local_rows
from meshes_of_the_errata import MESHES


def _wheel(n):
    """A vertex with n - 1 neighbours: more than the 62 degrees that are told apart."""
    A = np.zeros((n, n))
    A[0, 1:] = A[1:, 0] = 1
    around = np.arange(1, n)
    A[around, np.roll(around, 1)] = A[np.roll(around, 1), around] = 1
    return csr_array(A)


def _two_parts():
    A = np.zeros((9, 9))
    for i, j in ((0, 8), (8, 4), (1, 7), (7, 2), (2, 1)):  # 3, 5 and 6 are alone
        A[i, j] = A[j, i] = i + j
    return csr_array(A)


GRAPHS = {
    "two parts": _two_parts,
    "wheel": lambda: _wheel(100),
    "bad": lambda: MESHES["bad"]().topology.adjacency,
    "more than a block": lambda: icosphere(5).topology.adjacency,
}


@pytest.mark.parametrize("name", GRAPHS)
@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_the_rows_are_those_of_the_permuted_matrix(name, share):
    A = GRAPHS[name]()
    n = A.shape[0]
    rng = np.random.default_rng(66260701)
    A = csr_array((rng.uniform(1, 2, A.nnz), A.indices, A.indptr), shape=A.shape)
    held = rng.uniform(size=n) < share
    rows = local_rows(A.indptr, A.indices, A.data, held)
    assert not len(local_rows(A.indptr, A.indices, np.zeros(0), held).data)
    order = rows.order.astype(int)
    assert sorted(order) == list(range(n))
    number = np.argsort(order)
    assert rows.number.tolist() == number.tolist()
    assert len(rows.indptr) == n + 1
    for r in range(n):
        begin, end = rows.indptr[r], rows.indptr[r + 1]
        old = slice(A.indptr[order[r]], A.indptr[order[r] + 1])
        entries = [] if held[order[r]] else number[A.indices[old]].tolist()
        assert rows.indices[begin:end].tolist() == entries  # in the order that they had
        if not held[order[r]]:
            assert np.array_equal(rows.data[begin:end], A.data[old])


def test_neighbours_come_near_each_other():
    mesh = icosphere(5)
    n = mesh.n_vertices
    shuffled = np.random.default_rng(16021766).permutation(n)
    A = mesh.topology.adjacency[shuffled][:, shuffled]
    rows = local_rows(A.indptr, A.indices, np.zeros(0), np.zeros(n, bool))
    own = np.repeat(np.arange(n), np.diff(rows.indptr))
    far = np.abs(rows.indices.astype(int) - own)
    before = np.abs(A.indices - np.repeat(np.arange(n), np.diff(A.indptr)))
    assert np.median(far) < np.median(before) / 5


def test_degrees_ascend_within_a_block():
    A = MESHES["bad"]().topology.adjacency
    rows = local_rows(A.indptr, A.indices, np.zeros(0), np.zeros(A.shape[0], bool))
    assert (np.diff(np.diff(rows.indptr.astype(int))) >= 0).all()
