"""Jets against derivatives taken by other means: contour integrals and closed forms."""

import numpy as np
import pytest

from beltrami.errors import NotDifferentiableError
from beltrami.surfaces.jet_rules import RULES
from beltrami.surfaces.jets import Jet, variables

U, V = np.array([[0.31], [0.77], [0.52]]), np.array([[0.45], [0.23], [0.86]])


def _by_circle(f, x, order, radius=0.02, nodes=16):
    """n-th derivative by Cauchy's formula on a circle: exact to rounding for analytic f."""
    z = np.exp(2j * np.pi * np.arange(nodes) / nodes)
    values = f(x[..., None] + radius * z)
    factorial = (1, 1, 2)[order]
    return (factorial * (values * z**-order).mean(axis=-1) / radius**order).real


ANALYTIC = [
    "negative",
    "positive",
    "square",
    "reciprocal",
    "sqrt",
    "exp",
    "exp2",
    "expm1",
    "log",
    "log2",
    "log10",
    "log1p",
    "sin",
    "cos",
    "tan",
    "arcsin",
    "arccos",
    "arctan",
    "sinh",
    "cosh",
    "tanh",
    "arcsinh",
    "arctanh",
]


@pytest.mark.parametrize("name", ANALYTIC)
def test_functions_of_one_variable(name):
    function = getattr(np, name)
    jet = function(variables(U, V)[0])
    assert np.array_equal(jet.value, function(U))
    assert np.allclose(jet.first[0], _by_circle(function, U, 1), rtol=1e-11, atol=1e-12)
    assert np.allclose(jet.second[0], _by_circle(function, U, 2), rtol=1e-9, atol=1e-9)
    for nothing in (jet.first[1], jet.second[1], jet.second[2]):
        assert np.all(np.asarray(nothing) == 0)


@pytest.mark.parametrize("name", ["cbrt", "arccosh", "deg2rad", "radians", "rad2deg", "degrees"])
def test_functions_without_a_complex_form(name):
    function, h = getattr(np, name), 1e-4
    jet = function(variables(U + 1, V)[0])
    a, b, c = function(U + 1 - h), function(U + 1), function(U + 1 + h)
    assert np.allclose(jet.first[0], (c - a) / (2 * h), rtol=1e-6)
    assert np.allclose(jet.second[0], (a - 2 * b + c) / h**2, rtol=1e-4, atol=1e-4)


@pytest.mark.parametrize(
    "f",
    [
        lambda u, v: u + v**2,
        lambda u, v: u**2 - v * u,
        lambda u, v: u * v,
        lambda u, v: u / v,
        lambda u, v: 3 / (u * u + v),
        lambda u, v: u ** (1 + v),
        lambda u, v: 2**u * v,
        lambda u, v: np.float_power(u, 2.5) * v,
        lambda u, v: np.arctan2(u, v),
        lambda u, v: np.hypot(u, v),
        lambda u, v: np.sin(u * np.exp(v)) / (1 + u**2) ** 1.5,
    ],
)
def test_functions_of_two_variables(f):
    h = 1e-4
    jet = f(*variables(U, V))
    assert np.array_equal(jet.value, f(U, V))
    differences = (
        (f(U + h, V) - f(U - h, V)) / (2 * h),
        (f(U, V + h) - f(U, V - h)) / (2 * h),
        (f(U + h, V) - 2 * f(U, V) + f(U - h, V)) / h**2,
        (f(U + h, V + h) - f(U + h, V - h) - f(U - h, V + h) + f(U - h, V - h)) / (4 * h**2),
        (f(U, V + h) - 2 * f(U, V) + f(U, V - h)) / h**2,
    )
    for mine, other in zip((*jet.first, *jet.second), differences, strict=True):
        assert np.allclose(mine, other, rtol=2e-6, atol=2e-6)


def test_every_rule_is_tested_above_or_here():
    here = {"absolute", "fabs", "sign", "conjugate", "maximum", "minimum", "fmax", "fmin"}
    other = {"cbrt", "arccosh", "deg2rad", "radians", "rad2deg", "degrees", "float_power"}
    two = {"add", "subtract", "multiply", "divide", "power", "arctan2", "hypot"}
    assert set(RULES) == set(ANALYTIC) | here | other | two
    u, v = variables(U, V)
    assert np.array_equal(np.abs(-u).first[0], np.ones_like(U))
    assert np.array_equal(np.fabs(-u).first[0], np.ones_like(U))
    assert np.all(np.sign(u).first[0] == 0)
    assert np.array_equal(np.conjugate(u * v).second[1], np.ones_like(U))
    for larger, smaller in ((np.maximum, np.minimum), (np.fmax, np.fmin)):
        assert np.array_equal(larger(u, v).first[0], np.where(U > V, 1, 0))
        assert np.array_equal(smaller(u, v).first[0], np.where(U > V, 0, 1))


def test_edges_have_no_derivative():
    u, v = variables(np.zeros(1), np.zeros(1))
    for edge in (np.abs(u), np.sign(u), np.maximum(u, v), np.hypot(u, v), np.sqrt(u)):
        assert not np.isfinite(edge.first[0]).all()


def test_whole_powers_at_zero():
    u, _ = variables(np.zeros(1), np.zeros(1))
    for power, value, slope, bend in ((0, 1, 0, 0), (1, 0, 1, 0), (2, 0, 0, 2), (3, 0, 0, 0)):
        jet = u**power
        assert (jet.value[0], jet.first[0][0], jet.second[0][0]) == (value, slope, bend)
    assert ((u - 2) ** 3).second[0][0] == -12


def test_stacks_branches_and_comparisons():
    u, v = variables(U, V)
    stack = np.stack([u, u * v, np.zeros_like(u)], axis=-1)
    assert stack.shape == (3, 1, 3)
    assert np.array_equal(stack.second[1][..., 1], np.ones_like(U))
    branch = np.where(u > v, u * u, 5.0)
    assert np.array_equal(branch.first[0], np.where(U > V, 2 * U, 0))
    assert np.array_equal((u > 0.5), U > 0.5)


def test_arrays_of_objects_are_followed():
    u, v = variables(U, V)
    assert np.array_equal(np.cos(np.asarray(u)).first[0], -np.sin(U))
    array = np.array([u, v, 1.0]) * u
    assert array.shape == (3,)
    assert isinstance(array[1], Jet)
    assert np.array_equal(array[1].second[1], np.ones_like(U))


@pytest.mark.parametrize(
    "f",
    [
        lambda u: np.floor(u),
        lambda u: np.linalg.norm(u),
        lambda u: np.add.reduce(u),
        lambda u: np.sin(u, where=True),
        lambda u: np.asarray(u, dtype=float),
        lambda u: float(u),
    ],
)
def test_what_is_not_known_is_refused(f):
    with pytest.raises(NotDifferentiableError, match="not known"):
        f(variables(U, V)[0])
