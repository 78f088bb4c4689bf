"""The first and second derivatives of the elementary functions of numpy."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np

# a function at some values, its gradient, and its Hessian: h, (h_p), ((h_pq))
Partials: TypeAlias = tuple[Any, Sequence[Any], Sequence[Sequence[Any]]]

COMPARISONS = frozenset(
    ("greater", "greater_equal", "less", "less_equal", "equal", "not_equal", "isfinite", "isnan")
)


def _power(a: Any, b: Any) -> Partials:
    """a^b with both moving; the logarithm needs a > 0."""
    y, log = np.power(a, b), np.log(a)
    mixed = y / a * (1 + b * log)
    return y, (b * y / a, y * log), ((b * (b - 1) * y / a**2, mixed), (mixed, y * log**2))


def constant_power(x: Any, p: Any) -> Partials:
    """x^p with p fixed: any x for a whole p, and no 0 · ∞ where a factor of p vanishes."""
    x, p = np.asarray(x, np.float64), np.asarray(p, np.float64)
    slope = np.where(p == 0, 0.0, p * np.power(x, np.where(p == 0, 0.0, p - 1)))
    flat = (p == 0) | (p == 1)
    bend = np.where(flat, 0.0, p * (p - 1) * np.power(x, np.where(flat, 0.0, p - 2)))
    return np.power(x, p), (slope,), ((bend,),)


def _arctan2(a: Any, b: Any) -> Partials:
    r2 = a * a + b * b
    aa, ab = -2 * a * b / r2**2, (a * a - b * b) / r2**2
    return np.arctan2(a, b), (b / r2, -a / r2), ((aa, ab), (ab, -aa))


def _hypot(a: Any, b: Any) -> Partials:
    r = np.hypot(a, b)
    x, y = a / r, b / r
    return r, (x, y), ((y * y / r, -x * y / r), (-x * y / r, x * x / r))


def _larger(sign: int) -> Callable[[Any, Any], Partials]:
    """Make the rule of maximum (1) and minimum (-1): NaN where the two meet in an edge."""

    def rule(a: Any, b: Any) -> Partials:
        ahead = np.where(a == b, np.nan, np.heaviside(sign * (np.asarray(a) - b), 0.5))
        value = np.maximum(a, b) if sign > 0 else np.minimum(a, b)
        return value, (ahead, 1 - ahead), ((0.0, 0.0), (0.0, 0.0))

    return rule


_LN2, _LN10 = float(np.log(2)), float(np.log(10))
_NOUGHT = np.zeros_like


def _constant(c: float) -> Callable[[Any], Any]:
    return lambda x: np.full_like(x, c)


# y = function(x): y' and y''
_ONE: dict[str, tuple[Callable[[Any], Any], Callable[[Any], Any]]] = {
    "negative": (_constant(-1), _NOUGHT),
    "positive": (_constant(1), _NOUGHT),
    "conjugate": (_constant(1), _NOUGHT),
    "deg2rad": (_constant(float(np.pi / 180)), _NOUGHT),
    "radians": (_constant(float(np.pi / 180)), _NOUGHT),
    "rad2deg": (_constant(float(180 / np.pi)), _NOUGHT),
    "degrees": (_constant(float(180 / np.pi)), _NOUGHT),
    # these two have no derivative at 0
    "absolute": (lambda x: np.where(x == 0, np.nan, np.sign(x)), _NOUGHT),
    "sign": (lambda x: np.where(x == 0, np.nan, 0.0), _NOUGHT),
    "square": (lambda x: 2 * x, _constant(2)),
    "reciprocal": (lambda x: -(x**-2.0), lambda x: 2 * x**-3.0),
    "sqrt": (lambda x: 0.5 / np.sqrt(x), lambda x: -0.25 / (x * np.sqrt(x))),
    "cbrt": (lambda x: 1 / (3 * np.cbrt(x) ** 2), lambda x: -2 / (9 * x * np.cbrt(x) ** 2)),
    "exp": (np.exp, np.exp),
    "exp2": (lambda x: _LN2 * np.exp2(x), lambda x: _LN2**2 * np.exp2(x)),
    "expm1": (np.exp, np.exp),
    "log": (lambda x: 1 / x, lambda x: -(x**-2.0)),
    "log2": (lambda x: 1 / (_LN2 * x), lambda x: -1 / (_LN2 * x**2)),
    "log10": (lambda x: 1 / (_LN10 * x), lambda x: -1 / (_LN10 * x**2)),
    "log1p": (lambda x: 1 / (1 + x), lambda x: -((1 + x) ** -2.0)),
    "sin": (np.cos, lambda x: -np.sin(x)),
    "cos": (lambda x: -np.sin(x), lambda x: -np.cos(x)),
    "tan": (lambda x: np.cos(x) ** -2.0, lambda x: 2 * np.tan(x) / np.cos(x) ** 2),
    "arcsin": (lambda x: (1 - x * x) ** -0.5, lambda x: x * (1 - x * x) ** -1.5),
    "arccos": (lambda x: -((1 - x * x) ** -0.5), lambda x: -x * (1 - x * x) ** -1.5),
    "arctan": (lambda x: 1 / (1 + x * x), lambda x: -2 * x / (1 + x * x) ** 2),
    "sinh": (np.cosh, np.sinh),
    "cosh": (np.sinh, np.cosh),
    "tanh": (lambda x: np.cosh(x) ** -2.0, lambda x: -2 * np.tanh(x) / np.cosh(x) ** 2),
    "arcsinh": (lambda x: (x * x + 1) ** -0.5, lambda x: -x * (x * x + 1) ** -1.5),
    "arccosh": (lambda x: (x * x - 1) ** -0.5, lambda x: -x * (x * x - 1) ** -1.5),
    "arctanh": (lambda x: 1 / (1 - x * x), lambda x: 2 * x / (1 - x * x) ** 2),
}


def _rule(name: str) -> Callable[[Any], Partials]:
    function, (slope, bend) = getattr(np, name), _ONE[name]
    return lambda x: (function(x), (slope(x),), ((bend(x),),))


_NONE: Sequence[Sequence[float]] = ((0.0, 0.0), (0.0, 0.0))

RULES: dict[str, Callable[..., Partials]] = {
    "add": lambda a, b: (a + b, (1.0, 1.0), _NONE),
    "subtract": lambda a, b: (a - b, (1.0, -1.0), _NONE),
    "multiply": lambda a, b: (a * b, (b, a), ((0.0, 1.0), (1.0, 0.0))),
    "divide": lambda a, b: (
        a / b,
        (1 / b, -a / b**2),
        ((0.0, -1 / b**2), (-1 / b**2, 2 * a / b**3)),
    ),
    "power": _power,
    "float_power": _power,
    "arctan2": _arctan2,
    "hypot": _hypot,
    "maximum": _larger(1),
    "minimum": _larger(-1),
    "fmax": _larger(1),
    "fmin": _larger(-1),
    "fabs": _rule("absolute"),
    **{name: _rule(name) for name in _ONE},
}
