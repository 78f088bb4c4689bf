import numpy as np
import pytest
from scipy.sparse import coo_array, csc_matrix, csr_array, csr_matrix, random_array
from scipy.sparse.linalg import norm

from beltrami.errors import (
    DimensionError,
    NonFiniteError,
    SingularMatrixError,
    UnknownNameError,
)
from beltrami.operators.laplacian import laplacian
from beltrami.solvers.factorize import factorize
from meshes_of_the_errata import IRREGULAR, MESHES


def _residual(A, x, b):
    return np.linalg.norm(A @ x - b) / (norm(csr_array(A)) * np.linalg.norm(x))


@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("shift", [1.0, 1e-6, -0.3])  # the last one is indefinite
def test_solves_with_shifted_pairs(name, shift):
    pair = laplacian(MESHES[name](), mass="degree")
    A = pair.stiffness + shift * pair.mass
    b = np.random.default_rng(31415).normal(size=(pair.n, 3))
    assert _residual(A, factorize(A).solve(b), b) < 1e-13


@pytest.mark.parametrize("seed", [1618033, 2236067, 5477225])
def test_solves_unsymmetric_systems(seed):
    rng = np.random.default_rng(seed)
    A = random_array((60, 60), density=0.1, rng=rng).toarray()
    A[np.arange(60), rng.permutation(60)] = 3.0  # the large entries are off the diagonal
    A = csr_array(A)
    b = rng.normal(size=60)
    assert np.allclose(factorize(A).solve(b), np.linalg.solve(A.toarray(), b), rtol=1e-9)


@pytest.mark.parametrize("corner", [0.0, 1e-20, -1e-14])
def test_a_symmetric_indefinite_matrix_needs_its_pivots(corner):
    """Without them [[1e-20, 1], [1, 1e-20]] gives x = (0, 1) where (1, 1) is right."""
    A = csr_array([[corner, 1.0], [1.0, corner]])
    assert np.allclose(factorize(A).solve([1.0, 1.0]), [1, 1], rtol=1e-12)


def test_a_saddle_point_system_is_solved_to_rounding():
    rng = np.random.default_rng(141421)
    C = rng.normal(size=(10, 30))
    A = np.block([[1e-12 * np.diag(rng.uniform(0.1, 1, 30)), C.T], [C, np.zeros((10, 10))]])
    b = A @ rng.normal(size=40)
    assert _residual(csr_array(A), factorize(csr_array(A)).solve(b), b) < 1e-13


@pytest.mark.parametrize("make", [csr_array, csr_matrix, csc_matrix, coo_array])
def test_every_sparse_format(make):
    factor = factorize(make(np.array([[2, 1], [0, 4]])))
    assert np.allclose(factor.solve([4, 8]), [1, 2])
    assert (factor.n, factor.backend) == (2, "superlu")


def test_the_matrix_is_not_changed():
    A = laplacian(MESHES["bad"](), mass="degree")
    matrix = csr_array(A.stiffness + A.mass)
    before = matrix.copy()
    factorize(matrix)
    assert abs(matrix - before).max() == 0


@pytest.mark.parametrize(
    "A",
    [np.zeros((2, 2)), np.ones((2, 2)), np.diag([1.0, 0]), [[1.0, 2], [2, 4]], [[0, 1], [0, 2]]],
)
def test_singular_matrices_are_told(A):
    with pytest.raises(SingularMatrixError, match="singular"):
        factorize(csr_array(np.asarray(A, float)))


@pytest.mark.parametrize(("name", "weights"), [("bad", "cotangent"), ("tor", "combinatorial")])
def test_a_stiffness_alone_is_singular(name, weights):
    """Its kernel is the constants; in floating point the last pivot is only nearly zero."""
    with pytest.raises(SingularMatrixError, match="Add a mass"):
        factorize(laplacian(MESHES[name](), weights).stiffness)


def test_what_is_refused():
    for wrong in (np.eye(3), [[1.0]], csr_array(np.ones((2, 3))), None):
        with pytest.raises(DimensionError, match="square scipy sparse"):
            factorize(wrong)
    A = csr_array(np.eye(3))
    with pytest.raises(DimensionError, match=r"coordinates have the shape"):
        factorize(A, coordinates=np.zeros((2, 3)))
    assert factorize(A, coordinates=np.zeros((3, 2))).n == 3
    with pytest.raises(UnknownNameError) as caught:
        factorize(A, backend="umfpack")
    assert caught.value.choices[:4] == ("auto", "cholesky", "ldl", "superlu")
    assert factorize(A, backend="superlu").backend == "superlu"
    for value in (np.nan, np.inf):
        with pytest.raises(NonFiniteError):
            factorize(csr_array([[1.0, 0], [0, value]]))


def test_units_do_not_make_a_matrix_singular():
    factor = factorize(csr_array(np.diag([1.0, 1e-15, 1e15])))
    assert factor.solve([1.0, 1e-15, 1e15]).tolist() == [1, 1, 1]


def test_complex_and_empty_matrices_are_refused():
    for wrong in (csr_array(np.diag([1 + 1j, 2])), csr_array((0, 0))):
        with pytest.raises(DimensionError):
            factorize(wrong)


@pytest.mark.parametrize(("x", "b"), [((3,), (3,)), ((4,), (4, 1)), ((3, 4), (3, 4)), ((), ())])
def test_the_backward_error_is_that_of_solutions_of_this_matrix(x, b):
    factor = factorize(csr_array(np.eye(4)))
    with pytest.raises(DimensionError, match="where 4 rows are needed"):
        factor.backward_error(np.ones(x), np.ones(b))
