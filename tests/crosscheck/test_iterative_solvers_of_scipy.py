"""Our conjugate gradients and minres beside those of scipy."""

import numpy as np
import pytest
from scipy.sparse import csr_array
from scipy.sparse import linalg as peer

from beltrami.operators.laplacian import laplacian
from beltrami.solvers.conjugate_gradients import conjugate_gradients
from beltrami.solvers.minres import minres
from meshes_of_the_errata import IRREGULAR, MESHES


@pytest.mark.parametrize("name", IRREGULAR)
def test_as_many_iterations_and_the_same_iterates(name):
    pair = laplacian(MESHES[name](), mass="degree")
    A = csr_array(pair.stiffness + 0.1 * pair.mass)
    b = np.random.default_rng(123).normal(size=pair.n)
    M = peer.LinearOperator(A.shape, matvec=lambda r: r / A.diagonal())
    residuals = [1.0]

    def note(x):
        residuals.append(np.linalg.norm(b - A @ x) / np.linalg.norm(b))

    x, _ = peer.cg(A, b, rtol=1e-10, M=M, callback=note)
    ours = conjugate_gradients(A, b)
    assert abs(ours.iterations - (len(residuals) - 1)) <= 1
    assert np.allclose(ours.residuals[:12], residuals[:12], rtol=1e-6)
    assert np.allclose(ours.solution, x, atol=1e-8 * abs(x).max())


@pytest.mark.parametrize("name", IRREGULAR)
def test_the_same_solution_of_an_indefinite_system(name):
    pair = laplacian(MESHES[name](), mass="degree")
    A = csr_array(pair.stiffness - 0.31 * pair.mass)
    b = np.random.default_rng(321).normal(size=pair.n)
    residuals = [1.0]

    def note(x):
        residuals.append(np.linalg.norm(b - A @ x) / np.linalg.norm(b))

    x, _ = peer.minres(A, b, rtol=1e-12, callback=note)
    ours = minres(A, b, preconditioner="none")
    assert np.allclose(ours.residuals[:10], residuals[:10], rtol=1e-5)
    assert np.allclose(ours.solution, x, atol=1e-5 * abs(x).max())
    assert np.linalg.norm(A @ ours.solution - b) <= 1.001e-10 * np.linalg.norm(b)
