"""Theorem 10 and equation 3.9: inverse iteration, its limit and its rate (E64 to E68)."""

import numpy as np
import pytest
from scipy.sparse import csr_array

import dense_oracles as oracle
from beltrami.errors import ConvergenceError, SingularMatrixError, UnknownNameError
from beltrami.mesh.shapes import icosphere
from beltrami.operators.laplacian import laplacian
from beltrami.operators.weights import WEIGHTS
from beltrami.solvers import shifted
from beltrami.spectrum.inverse_iteration import inverse_iteration
from meshes_of_the_errata import IRREGULAR, MESHES

pytestmark = pytest.mark.chapter("T10", "Q3.9")


def _normalised(name, kind="combinatorial"):
    """The pair with the degree mass, and L̃ with its spectrum."""
    pair = laplacian(MESHES[name](), kind, "degree")
    values, vectors = np.linalg.eigh(pair.normalized.toarray())
    return pair, values, vectors


def _chapter(step, u, count):
    """Iterates u_1 ... u_count of the chapter, for one step of whichever formula."""
    iterates = []
    for _ in range(count):
        w = step(u)
        u = w / np.linalg.norm(w)
        iterates.append(u)
    return np.array(iterates)


def _inverse(matrix, shift):
    return np.linalg.inv(matrix - shift * np.eye(len(matrix)))


def _between(values, k, part):
    """A shift between λ_k and λ_k+1."""
    return (1 - part) * values[k] + part * values[k + 1]


@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("kind", WEIGHTS)
def test_the_limit_is_the_nearest_eigenvector(name, kind):
    pair, values, vectors = _normalised(name, kind)
    for k in (0, 7, 60):
        shift = _between(values, k, 0.2) if k else -0.3 * values[1]
        found = inverse_iteration(pair, shift, max_iterations=5000)
        nearest = np.abs(values - shift).argmin()
        assert found.eigenvalue == pytest.approx(values[nearest], rel=1e-9, abs=1e-12)
        u = np.sqrt(pair.degrees) * found.eigenvector
        assert abs(u @ vectors[:, nearest]) == pytest.approx(1, abs=1e-12)
        assert found.residual < 1e-7


def test_these_are_the_iterates_of_the_chapter():
    """D^½ v_k is u_k for L̃, step by step: the Rayleigh quotients are the same numbers."""
    pair, values, _ = _normalised("open")
    shift = _between(values, 5, 0.3)
    f = oracle.rough_functions(MESHES["open"](), 1)[:, 0]
    found = inverse_iteration(pair, shift, f)
    inverse = _inverse(pair.normalized.toarray(), shift)
    u = _chapter(lambda u: inverse @ u, np.sqrt(pair.degrees) * f, found.iterations)
    quotients = np.einsum("ki,ij,kj->k", u, pair.normalized.toarray(), u)
    assert np.allclose(found.quotients, quotients, rtol=1e-11)


@pytest.mark.parametrize("name", IRREGULAR)
def test_powers_of_the_shifted_matrix_itself_go_to_the_farthest(name):
    """E64: the text says powers of a shifted version; equation 3.9 has its inverse."""
    pair, values, _ = _normalised(name)
    shift = _between(values, 3, 0.2)
    matrix = pair.normalized.toarray()
    start = oracle.rough_functions(MESHES[name](), 1)[:, 0]

    def limit(step):
        u = _chapter(step, start, 3000)[-1]
        return u @ matrix @ u

    inverse = _inverse(matrix, shift)
    assert limit(lambda u: inverse @ u) == pytest.approx(values[3], abs=1e-10)
    printed = limit(lambda u: matrix @ u - shift * u)
    assert printed == pytest.approx(values[-1], abs=1e-3)


@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("solver", ["lu", "ldl", "minres"])
def test_the_rate_is_the_ratio_of_the_two_smallest_distances(name, solver):
    pair, values, _ = _normalised(name)
    shift = values[4] + 0.4 * (values[5] - values[4])
    found = inverse_iteration(pair, shift, solver=solver)
    one, two = np.sort(np.abs(values - shift))[:2]
    assert found.predicted_rate == pytest.approx(one / two, abs=1e-4)
    assert found.rate == pytest.approx(one / two, abs=1e-2 if solver == "minres" else 5e-4)
    errors = np.abs(found.quotients - values[4])
    told = (errors > 1e-11) & (errors < 1e-5)
    slopes = (errors[1:] / errors[:-1])[told[1:]]
    if solver != "minres":  # inexact solves disturb the single steps
        assert np.sqrt(slopes[-1]) == pytest.approx(one / two, abs=2e-2)  # ρ^2k, not ρ^k (E66)
        assert abs(slopes[-1] - one / two) > 0.1


def test_the_quotient_is_of_the_normalised_laplacian():
    """E66: <L v, v> of the text is another number, for v of (3.9)."""
    pair, values, _ = _normalised("closed")
    found = inverse_iteration(pair, _between(values, 6, 0.2))
    u = np.sqrt(pair.degrees) * found.eigenvector
    assert u @ (pair.normalized @ u) == pytest.approx(values[6], abs=1e-12)
    assert u @ (pair.stiffness @ u) > 3 * values[6]


def test_signs_alternate_above_the_eigenvalue():
    """E65: v_k does not converge where σ > λ; its line does."""
    pair, values, vectors = _normalised("closed")
    matrix = pair.normalized.toarray()
    start = oracle.rough_functions(MESHES["closed"](), 1)[:, 0]
    for part, alternate in ((0.25, True), (-0.25, False)):
        shift = values[9] + part * (values[10] - values[9])
        inverse = _inverse(matrix, shift)
        u = _chapter(lambda u, inverse=inverse: inverse @ u, start, 80)
        last = np.linalg.norm(u[-1] - u[-2])
        assert last == pytest.approx(2 if alternate else 0, abs=1e-9)
        found = inverse_iteration(pair, shift)
        assert found.changes[-1] < 1e-10
        assert found.eigenvector[np.abs(found.eigenvector).argmax()] > 0
        assert abs(u[-1] @ vectors[:, 9]) == pytest.approx(1, abs=1e-9)


@pytest.mark.parametrize("solver", ["lu", "ldl", "minres"])
def test_a_multiple_eigenvalue_gives_the_projection_of_the_start(solver):
    """E65: the hypothesis of the theorem fails, and still it converges."""
    pair = laplacian(icosphere(2))
    f = oracle.rough_functions(icosphere(2), 1)[:, 0]
    found = inverse_iteration(pair, 1.9, f, solver=solver)
    L, B = pair.stiffness.toarray(), pair.masses
    root = np.sqrt(B)
    values, vectors = np.linalg.eigh(L / root[:, None] / root)
    space = vectors[:, 1:4] / root[:, None]
    assert np.ptp(values[1:4]) < 1e-12
    projection = space @ (space.T @ (B * f))
    projection /= pair.norm(projection)
    exact = 1e-4 if solver == "minres" else 1e-14  # residuals of solves turn it a little
    assert pair.inner(found.eigenvector, projection) ** 2 == pytest.approx(1, abs=exact)
    largest = np.flatnonzero(np.abs(projection) > (1 - 1e-6) * np.abs(projection).max())
    assert len(largest) == 2  # antipodes: rounding must not choose between them
    assert found.eigenvector[largest[0]] > 0
    one, two = values[1] - 1.9, 1.9  # λ = 0 is next; another copy of λ would give the rate 1
    assert found.predicted_rate == pytest.approx(one / two, abs=1e-6)


def test_what_the_start_has_no_part_of_comes_in_by_rounding_only():
    """E65: the hypothesis <v_0, u> ≠ 0 is missing in the text."""
    pair, values, vectors = _normalised("closed")
    root = np.sqrt(pair.degrees)
    found = inverse_iteration(pair, values[4] + 1e-3, vectors[:, 20] / root)
    assert found.changes[0] < 1e-10
    assert np.allclose(found.quotients[:3], values[20], atol=1e-9)
    apart = csr_array(np.kron(np.eye(2), pair.weights.toarray()))
    one = np.concatenate([vectors[:, 20] / root, np.zeros(pair.n)])  # rounds to nothing else
    two = inverse_iteration(laplacian(apart, mass="degree"), values[20] - 1e-3, one)
    assert not two.eigenvector[pair.n :].any()
    assert two.iterations <= 3
    assert np.isnan(two.rate)


@pytest.mark.parametrize("name", IRREGULAR)
def test_an_eigenvalue_is_no_shift(name):
    """E64: λ_1 = 0 always."""
    pair, _, _ = _normalised(name)
    edge = laplacian(csr_array([[0.0, 1.0], [1.0, 0.0]]), mass="unit")  # eigenvalues 0 and 2
    for given, shift in ((pair, 0), (edge, 0), (edge, 2)):
        for solver in ("lu", "ldl", "auto"):
            with pytest.raises(SingularMatrixError, match="eigenvalue to working precision"):
                inverse_iteration(given, shift, solver=solver)
        with pytest.raises((ConvergenceError, SingularMatrixError)):
            inverse_iteration(given, shift, solver="minres")


def test_just_beside_an_eigenvalue_is_the_best_shift():
    pair, values, _ = _normalised("open")
    for relative in (1e-6, 1e-9, 1e-12, 0):
        beside = inverse_iteration(pair, values[5] * (1 + relative))
        assert beside.iterations <= 4
        assert beside.eigenvalue == pytest.approx(values[5], rel=1e-12)
        assert beside.residual < 1e-11


def test_in_the_middle_of_two_there_is_no_nearest():
    pair, values, _ = _normalised("open")
    with pytest.raises(ConvergenceError, match="nearer to one eigenvalue"):
        inverse_iteration(pair, (values[5] + values[6]) / 2)


def test_the_rate_is_not_a_condition_number():
    """E67: both get worse or better with the shift, but they are different numbers."""
    pair, values, _ = _normalised("closed")
    for part in (0.1, 0.3):
        shift = _between(values, 12, part)
        distances = np.sort(np.abs(values - shift))
        found = inverse_iteration(pair, shift)
        condition = np.linalg.cond(pair.normalized.toarray() - shift * np.eye(pair.n))
        assert condition == pytest.approx(distances[-1] / distances[0], rel=1e-6)
        assert 1 / found.predicted_rate == pytest.approx(distances[1] / distances[0], rel=1e-3)
        assert condition > 10 / found.predicted_rate


@pytest.mark.chapter("P54")
@pytest.mark.parametrize("solver", ["lu", "ldl"])
def test_one_factorisation_serves_all_iterations(solver, monkeypatch):
    made = []

    def counted(*arguments):
        made.append(arguments)
        return factorize(*arguments)

    factorize = shifted.factorize
    monkeypatch.setattr(shifted, "factorize", counted)
    pair, values, _ = _normalised("open")
    found = inverse_iteration(pair, _between(values, 4, 0.4), solver=solver)
    assert found.iterations > 20
    assert len(made) == 1
    assert found.solver == solver
    assert not found.inner_iterations.any()


@pytest.mark.chapter("P55")
def test_conjugate_gradients_are_not_for_shifted_matrices():
    """E68: p'Ap = 0 in the first step for diag(1, -1); MINRES and LU do not mind."""
    A, b = np.diag([1.0, -1.0]), np.ones(2)
    assert b @ A @ b == 0  # the first direction is the residual of x = 0: b itself
    W = csr_array([[0.0, 1.0], [1.0, 0.0]])
    pair = laplacian(W, mass="unit")  # eigenvalues 0 and 2, so L - Id has 1 and -1
    with pytest.raises(UnknownNameError, match="minres"):
        inverse_iteration(pair, 0.9, solver="cg")
    for solver in ("lu", "minres"):
        assert inverse_iteration(pair, 0.9, solver=solver).eigenvalue == pytest.approx(0, abs=1e-12)


@pytest.mark.chapter("P55")
def test_fewer_iterations_are_dearer_ones_without_a_factorisation():
    """What the text calls contradictory: near an eigenvalue ρ falls, and the condition grows."""
    pair, values, _ = _normalised("open")
    gap = values[5] - values[4]
    runs = [
        inverse_iteration(pair, values[4] + part * gap, solver="minres")
        for part in (0.3, 1e-3, 1e-6)
    ]
    assert [run.iterations for run in runs] == sorted((r.iterations for r in runs), reverse=True)
    assert runs[-1].iterations < runs[0].iterations / 3
    b = oracle.rough_functions(MESHES["open"](), 1)[:, 0]

    def steps(shift):
        A = shifted.shifted_solver(pair.stiffness, pair.mass, shift, "minres")
        return A.solve(b, 1e-8, None)[1]

    assert steps(values[4] + 1e-6 * gap) > steps(values[4] + 0.3 * gap) > 1.5 * steps(-values[-1])


@pytest.mark.chapter("P53")
def test_a_random_start_on_a_large_mesh():
    pair = laplacian(icosphere(5))
    for solver in ("auto", "minres"):
        found = inverse_iteration(pair, 1.9, solver=solver, seed=3)
        assert found.solver == {"auto": "ldl", "minres": "minres"}[solver]
        assert found.eigenvalue == pytest.approx(2, abs=1e-4)
        assert found.residual < 1e-8
    again = inverse_iteration(pair, 5.9, seed=3)
    other = inverse_iteration(pair, 5.9, seed=4)
    assert abs(again.eigenvalue - other.eigenvalue) < 1e-9
    assert abs(pair.inner(again.eigenvector, other.eigenvector)) < 0.999  # five of them
    assert np.array_equal(again.eigenvector, inverse_iteration(pair, 5.9, seed=3).eigenvector)
