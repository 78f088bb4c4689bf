import numpy as np
from hypothesis import given

from beltrami.mesh.edge_matrix import laplacian_matrix, symmetric_matrix
from beltrami.mesh.half_edges import pair_sides
from strategies import any_arrays, generators


@given(any_arrays(), generators())
def test_symmetric_matrix_against_a_dense_loop(pair, rng):
    vertices, faces = pair
    n = len(vertices)
    edges = pair_sides(faces, n).edges
    values, diagonal = rng.normal(size=len(edges)), rng.normal(size=n)
    for own in (None, diagonal):
        dense = np.zeros((n, n))
        for (i, j), value in zip(edges, values, strict=True):
            dense[i, j] = dense[j, i] = value
        if own is not None:
            dense[np.diag_indices(n)] = own
        matrix = symmetric_matrix(edges, values, n, own)
        assert matrix.shape == (n, n)
        assert np.array_equal(matrix.toarray(), dense)
        assert matrix.nnz == 2 * len(edges) + (0 if own is None else n)
        for i in range(n):  # rows sorted, without repetition
            assert (np.diff(matrix.indices[matrix.indptr[i] : matrix.indptr[i + 1]]) > 0).all()


@given(any_arrays(), generators())
def test_laplacian_matrix_against_dense_sums(pair, rng):
    vertices, faces = pair
    n = len(vertices)
    edges = pair_sides(faces, n).edges
    values = rng.integers(-9, 9, size=len(edges)).astype(float)
    W = symmetric_matrix(edges, values, n).toarray()
    matrix = laplacian_matrix(edges, values, n)
    assert np.array_equal(matrix.toarray(), np.diag(W.sum(axis=1)) - W)
    assert matrix.nnz == 2 * len(edges) + n


def test_a_stored_zero_stays_stored():
    matrix = symmetric_matrix(np.array([[0, 1]]), np.zeros(1), 2, np.zeros(2))
    assert matrix.nnz == 4


def test_no_edges():
    none = np.zeros((0, 2), np.int64)
    assert symmetric_matrix(none, np.zeros(0), 3).toarray().tolist() == np.zeros((3, 3)).tolist()
    assert symmetric_matrix(none, np.zeros(0), 2, np.array([3.0, 4.0])).toarray().tolist() == [
        [3, 0],
        [0, 4],
    ]
    assert symmetric_matrix(none, np.zeros(0), 0).shape == (0, 0)
