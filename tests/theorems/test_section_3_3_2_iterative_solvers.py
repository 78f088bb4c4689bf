"""Sections 3.2.5, 3.3.1 and 3.3.2: what conjugate gradients solve, and what they do not (E68)."""

import numpy as np
import pytest
from scipy.sparse import csr_array, diags_array, eye_array

import dense_oracles as oracle
from beltrami.diffusion.heat import heat
from beltrami.errors import BeltramiError, NotPositiveDefiniteError, SingularMatrixError
from beltrami.operators.laplacian import laplacian
from beltrami.solvers.conjugate_gradients import conjugate_gradients
from beltrami.solvers.factorize import factorize
from beltrami.solvers.minres import minres
from meshes_of_the_errata import IRREGULAR, MESHES


@pytest.mark.chapter("P41")
@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("weights", ["combinatorial", "cotangent"])
@pytest.mark.parametrize("delta", [0.5, 50.0])
def test_implicit_steps_by_conjugate_gradients_are_those_by_factors(name, weights, delta):
    mesh = MESHES[name]()
    pair = laplacian(mesh, weights, "degree")
    A = csr_array(pair.mass + delta * pair.stiffness)
    F = G = oracle.rough_functions(mesh)
    factor = factorize(A)
    for _ in range(3):
        F = factor.solve(pair.mass @ F)
        G = conjugate_gradients(A, pair.mass @ G, tolerance=1e-12, start=G).solution
    assert np.allclose(F, G, atol=1e-9 * abs(F).max())
    assert np.allclose(G, heat(pair, oracle.rough_functions(mesh), 3 * delta, steps=3), atol=1e-8)
    printed = (
        (1 + delta) * eye_array(pair.n) - delta * pair.averaging
        if (weights == "combinatorial")
        else diags_array(1 / pair.degrees) @ A
    )
    with pytest.raises(BeltramiError, match="symmetric matrix"):  # equation 3.7 as printed (E54)
        conjugate_gradients(csr_array(printed), F)


@pytest.mark.chapter("P34")
@pytest.mark.parametrize("name", IRREGULAR)
def test_poisson_is_solvable_exactly_where_the_sum_vanishes(name):
    mesh = MESHES[name]()
    pair = laplacian(mesh)
    rough = oracle.rough_functions(mesh, 2)
    b = rough - rough.mean(axis=0)
    u = conjugate_gradients(pair.stiffness, b, tolerance=1e-11).solution
    expected = np.linalg.lstsq(pair.stiffness.toarray(), b, rcond=1e-10)[0]
    assert np.allclose(u, expected, atol=1e-7 * abs(expected).max())
    energies = np.einsum("ij,ij->j", u, pair.stiffness @ u)
    assert np.allclose(energies, np.einsum("ij,ij->j", u, b), rtol=1e-8)
    assert (energies > 0).all()
    with pytest.raises(SingularMatrixError, match="no solution"):
        conjugate_gradients(pair.stiffness, b + 0.1)


@pytest.mark.chapter("P55")
def test_two_equations_that_conjugate_gradients_divide_by_zero_in():
    """A = diag(1, -1), b = (1, 1): <Ap, p> = 0 in the first step (E68)."""
    A, b = csr_array(np.diag([1.0, -1.0])), np.ones(2)
    assert b @ (A @ b) == 0
    with pytest.raises(NotPositiveDefiniteError) as caught:
        conjugate_gradients(A, b)
    assert caught.value.rows.tolist() == [1]
    assert np.allclose(minres(A, b).solution, [1, -1])


@pytest.mark.chapter("P55")
@pytest.mark.parametrize("name", ["closed", "obt", "open", "bad"])
def test_shifts_below_the_spectrum_and_inside_it(name):
    pair = laplacian(MESHES[name](), mass="degree")
    normalized, identity = csr_array(pair.normalized), eye_array(pair.n)
    values = np.linalg.eigvalsh(normalized.toarray())
    b = np.random.default_rng(2020).normal(size=pair.n)
    below = csr_array(normalized + 0.05 * identity)
    assert np.allclose(below @ conjugate_gradients(below, b).solution, b, atol=1e-8)
    middle = pair.n // 2
    inside = csr_array(normalized - (values[middle] + values[middle + 1]) / 2 * identity)
    assert np.allclose(inside @ minres(inside, b).solution, b, atol=1e-7)
    with pytest.raises(NotPositiveDefiniteError):
        conjugate_gradients(inside, b)


@pytest.mark.chapter("P55")
def test_the_nearer_the_shift_the_faster_the_outer_iteration_and_the_slower_the_inner():
    """Both go with the distance to the eigenvalue, though 1/ρ is not the condition (E67)."""
    pair = laplacian(MESHES["closed"](), mass="degree")
    normalized, identity = csr_array(pair.normalized), eye_array(pair.n)
    values = np.linalg.eigvalsh(normalized.toarray())
    b = np.random.default_rng(2021).normal(size=pair.n)
    gap = values[1] - values[0]
    rates, steps = [], []
    for distance in (0.3 * gap, 1e-2 * gap, 1e-4 * gap):
        shift = values[0] - distance
        rates.append(distance / (values[1] - shift))
        A = csr_array(normalized - shift * identity)
        conditions = (values[-1] - shift) / distance
        assert conditions > 2 / rates[-1]  # E67: not the same number
        steps.append(conjugate_gradients(A, b, preconditioner="none").iterations)
    assert rates[0] > rates[1] > rates[2]
    assert steps[0] < steps[1] < steps[2]
