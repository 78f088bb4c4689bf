import numpy as np
import pytest
from scipy.sparse import csc_array

from beltrami.errors import SingularMatrixError
from beltrami.operators.laplacian import laplacian
from beltrami.solvers.superlu import factorize_superlu
from meshes_of_the_errata import MESHES


def test_the_symmetric_order_fills_less():
    pair = laplacian(MESHES["closed"](), mass="degree")
    A = csc_array(pair.stiffness + pair.mass)
    b = np.random.default_rng(299792458).normal(size=pair.n)
    symmetric, general = factorize_superlu(A, True), factorize_superlu(A, False)
    assert symmetric.fill < general.fill
    assert np.allclose(symmetric.solve(b), general.solve(b), rtol=1e-10)


def test_a_zero_pivot_is_a_singular_matrix():
    for symmetric in (True, False):
        with pytest.raises(SingularMatrixError):
            factorize_superlu(csc_array(np.ones((2, 2))), symmetric)
