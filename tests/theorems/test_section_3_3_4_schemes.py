"""Section 3.3.4: both schemes of heat, their factor on each frequency, and the flow (E50, E51)."""

import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.diffusion.heat import heat
from beltrami.diffusion.smoothing import smooth
from beltrami.mesh.shapes import icosphere
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import IRREGULAR, MESHES

STEPS = 5
SYMBOLS = {
    "explicit": (
        lambda d, v: 1 - d * v,
        {
            "sign": lambda d, v: 1 + d * v,
            "half": lambda d, v: 1 - d * v / 2,
            "other scheme": lambda d, v: 1 / (1 + d * v),
            "exact flow": lambda d, v: np.exp(-d * v),
        },
    ),
    "implicit": (
        lambda d, v: 1 / (1 + d * v),
        {
            "sign": lambda d, v: 1 / (1 - d * v),
            "half": lambda d, v: 1 / (1 + d * v / 2),
            "other scheme": lambda d, v: 1 - d * v,
            "Crank and Nicolson": lambda d, v: (1 - d * v / 2) / (1 + d * v / 2),
        },
    ),
    "crank_nicolson": (
        lambda d, v: (1 - d * v / 2) / (1 + d * v / 2),
        {
            "sign": lambda d, v: (1 + d * v / 2) / (1 - d * v / 2),
            "explicit": lambda d, v: 1 - d * v,
            "implicit": lambda d, v: 1 / (1 + d * v),
            "two implicit halves": lambda d, v: 1 / (1 + d * v / 2) ** 2,
        },
    ),
}


@pytest.mark.chapter("U32", "Q3.6", "Q3.7")
@pytest.mark.parametrize("method", SYMBOLS)
@pytest.mark.parametrize("name", IRREGULAR)
def test_k_steps_multiply_each_coefficient_by_the_kth_power(name, method):
    pair = laplacian(MESHES[name](), "cotangent", "degree")
    values, U = np.linalg.eigh(pair.normalized.toarray())
    root = np.sqrt(pair.degrees)
    f = oracle.rough_functions(MESHES[name](), 1)[:, 0]
    before = U.T @ (root * f)  # the transform of definition 19
    after = U.T @ (root * heat(pair, f, STEPS * 0.45, method, STEPS))

    def check(symbol):
        assert np.allclose(after, symbol(0.45, values) ** STEPS * before, atol=1e-9)

    right, wrong = SYMBOLS[method]
    check(right)
    for symbol in wrong.values():
        with pytest.raises(AssertionError):
            check(symbol)
    with pytest.raises(AssertionError):  # one long step is not five
        assert np.allclose(after, right(STEPS * 0.45, values) * before, atol=1e-9)


@pytest.mark.chapter("U30")
@pytest.mark.parametrize("kind", ["combinatorial", "distance"])
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_flow_is_the_identity_minus_averaging(name, kind):
    mesh = MESHES[name]()
    pair = laplacian(mesh, kind, "degree")
    f = oracle.rough_functions(mesh)
    W = oracle.weights(mesh, kind)

    def check(averaging):
        assert np.allclose(pair.apply(f), f - averaging @ f, atol=1e-10)

    check(pair.averaging)
    check(W / W.sum(axis=1)[:, None])
    for wrong in (W, W / W.sum(), W / W.sum(axis=1)):  # the last: by columns
        with pytest.raises(AssertionError):
            check(wrong)


@pytest.mark.chapter("U31", "Q3.6", "Q3.7")
@pytest.mark.parametrize("name", IRREGULAR)
def test_both_schemes_as_they_are_printed_with_the_index_set_right(name):
    """The left side of the first is F_{k+1}: with F_k on both sides nothing would move (E51)."""
    mesh = MESHES[name]()
    pair, delta = laplacian(mesh, "combinatorial", "degree"), 0.4
    f = oracle.rough_functions(mesh)
    A, one = pair.averaging.toarray(), np.eye(pair.n)

    def check_explicit(matrix):
        assert np.allclose(heat(pair, f, delta, "explicit", 1), matrix @ f, atol=1e-12)
        assert np.allclose(smooth(pair, f, 1, delta), matrix @ f, atol=1e-12)

    def check_implicit(matrix):
        assert np.allclose(matrix @ heat(pair, f, delta, steps=1), f, atol=1e-10)

    check_explicit((1 - delta) * one + delta * A)
    for wrong in ((one - delta) + delta * A, (1 + delta) * one - delta * A, one, A):
        with pytest.raises(AssertionError):
            check_explicit(wrong)
    check_implicit((1 + delta) * one - delta * A)
    for wrong in ((1 - delta) * one + delta * A, (1 + delta) * one + delta * A, one + delta):
        with pytest.raises(AssertionError):
            check_implicit(wrong)


@pytest.mark.chapter("D17", "P35")
def test_only_with_the_areas_is_the_time_that_of_the_surface():
    """On the unit sphere z decays by exp(-2 t): no other mass, and no other constant (E50)."""
    mesh = icosphere(4)
    z = mesh.vertices[:, 2]

    def check(mass, time):
        pair = laplacian(mesh, mass=mass)
        decay = pair.inner(heat(pair, z, time, steps=200), z) / pair.inner(z, z)
        assert decay == pytest.approx(np.exp(-0.1), abs=2e-4)

    for mass in ("voronoi", "barycentric", "consistent"):
        check(mass, 0.05)
        for wrong in (0.025, 0.1):  # the constant of the text, (cot α + cot β), doubles the time
            with pytest.raises(AssertionError):
                check(mass, wrong)
    for mass in ("degree", "unit"):
        with pytest.raises(AssertionError):
            check(mass, 0.05)
