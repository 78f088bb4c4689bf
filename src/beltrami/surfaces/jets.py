"""Jets: numbers that carry their first and second derivatives in (u, v) through numpy."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin
from numpy.typing import ArrayLike

from beltrami._arrays import Floats
from beltrami.errors import DimensionError, NotDifferentiableError
from beltrami.surfaces.jet_rules import COMPARISONS, RULES, Partials, constant_power

REMEDY = "Write it with the elementary functions of numpy, or give its derivatives."


class Jet(NDArrayOperatorsMixin):
    """An array with its derivatives: f, (f_u, f_v), (f_uu, f_uv, f_vv).

    A function of (u, v) written with numpy, called with the two jets of ``variables``, returns
    jets whose derivatives are exact to rounding: the chain rule is applied operation by
    operation, with no step to choose. What is not known here raises NotDifferentiableError.

    Examples
    --------
    >>> u, v = variables([1.0], [2.0])
    >>> f = u**2 * np.sin(v) + np.hypot(u, v)
    >>> f.value.round(6), f.first[0].round(6), f.second[1].round(6)
    (array([3.145365]), array([2.265808]), array([-1.011179]))
    """

    __slots__ = ("first", "second", "value")

    def __init__(self, value: ArrayLike, first: Sequence[Any], second: Sequence[Any]) -> None:
        if np.iscomplexobj(value):
            raise DimensionError(
                "a function of (u, v) has complex values where real ones are needed"
            )
        self.value: Floats = np.asarray(value, dtype=np.float64)
        self.first: Sequence[Any] = first
        self.second: Sequence[Any] = second

    def __repr__(self) -> str:
        return f"<Jet: {self.value}>"

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        name = ufunc.__name__
        if method != "__call__" or options:
            raise _unknown(
                f"numpy.{name}.{method}" if not options else f"numpy.{name} with options"
            )
        if any(isinstance(x, np.ndarray) and x.dtype == object for x in inputs):
            return ufunc(*(_boxed(x) for x in inputs))  # element by element
        values = [plain(x) for x in inputs]
        if name in COMPARISONS:
            return ufunc(*values)
        with np.errstate(all="ignore"):  # what is not finite is told by who asked
            if name in ("power", "float_power") and not isinstance(inputs[1], Jet):
                return compose(constant_power(*values), inputs[:1])
            if name not in RULES:
                raise _unknown(f"numpy.{name}")
            return compose(RULES[name](*values), inputs)

    def __array_function__(
        self, function: Callable[..., Any], types: Any, args: Any, kwargs: Any
    ) -> Any:
        if function is np.stack:
            return _stacked(*args, **kwargs)
        if function is np.where:
            condition, a, b = args
            return _linear(lambda x, y: np.where(plain(condition), x, y), a, b)
        if function in (np.zeros_like, np.ones_like, np.full_like):
            return function(args[0].value, *args[1:], **kwargs)
        if function in (np.shape, np.ndim, np.size):
            return function(args[0].value)
        raise _unknown(f"numpy.{function.__name__}")

    def __getattr__(self, name: str) -> Any:
        """Let arrays of objects find the functions: np.cos(np.asarray(jet)) asks jet.cos()."""
        if name in RULES:
            return lambda *others: getattr(np, name)(self, *others)
        if name.startswith("_"):  # protocols that numpy asks about
            raise AttributeError(f"a Jet has no attribute {name!r}")
        raise _unknown(f"the method or attribute .{name}")

    def __float__(self) -> float:
        raise _unknown("float(), the functions of math or a conversion to an array of numbers")

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the values."""
        return self.value.shape


def variables(u: ArrayLike, v: ArrayLike) -> tuple[Jet, Jet]:
    """Return u and v as jets: derivatives (1, 0) and (0, 1)."""
    a, b = np.broadcast_arrays(np.asarray(u, np.float64), np.asarray(v, np.float64))
    one, nil = np.ones(a.shape), np.zeros(a.shape)
    return Jet(a, (one, nil), (nil, nil, nil)), Jet(b, (nil, one), (nil, nil, nil))


def plain(x: Any) -> Any:
    """Return the values of a jet, and anything else as it is."""
    return x.value if isinstance(x, Jet) else x


def parts(x: Any) -> tuple[Floats, ...]:
    """Return f, f_u, f_v, f_uu, f_uv, f_vv, of one shape; of a constant, zeros after f."""
    value = np.asarray(plain(x), np.float64)
    derivatives = (*x.first, *x.second) if isinstance(x, Jet) else (0.0,) * 5
    return (value, *(np.broadcast_to(d, value.shape) for d in derivatives))


def unstack(x: Any, axis: int) -> list[Any]:
    """Split an array, or a jet of a stack, along an axis."""
    if isinstance(x, Jet):
        return [
            Jet(p[0], p[1:3], p[3:])
            for p in zip(*(np.moveaxis(d, axis, 0) for d in parts(x)), strict=True)
        ]
    return list(np.moveaxis(x, axis, 0))


def compose(partials: Partials, inputs: Sequence[Any]) -> Jet:
    """Apply the chain rule to h(x_1, x_2 ...): h_i = Σ_p h_p x_i^p, and once more for h_ij.

    Parameters
    ----------
    partials
        h, its gradient (h_p) and its Hessian (h_pq) at the values of the inputs.
    inputs
        The jets x^p; what is no jet is constant.
    """
    value, gradient, hessian = partials
    active = [p for p, x in enumerate(inputs) if isinstance(x, Jet)]
    first = [sum(gradient[p] * inputs[p].first[i] for p in active) for i in range(2)]
    second = []
    for at, (i, j) in enumerate(((0, 0), (0, 1), (1, 1))):
        total = sum(gradient[p] * inputs[p].second[at] for p in active)
        for p in active:
            for q in active:
                total = total + hessian[p][q] * inputs[p].first[i] * inputs[q].first[j]
        second.append(total)
    return Jet(value, first, second)


def _linear(function: Callable[..., Any], *inputs: Any) -> Jet:
    """Apply a function that is linear: to the values and to each derivative."""
    done = [function(*some) for some in zip(*(parts(x) for x in inputs), strict=True)]
    return Jet(done[0], done[1:3], done[3:])


def _stacked(inputs: Sequence[Any], axis: int = 0) -> Jet:
    return _linear(lambda *some: np.stack(np.broadcast_arrays(*some), axis=axis), *inputs)


def _boxed(x: Any) -> Any:
    """Put a jet into an array of one object, so that numpy goes through the other array."""
    if not isinstance(x, Jet):
        return x
    box = np.empty((), dtype=object)
    box[()] = x
    return box


def _unknown(what: str) -> NotDifferentiableError:
    return NotDifferentiableError(f"the derivatives of {what} are not known", remedy=REMEDY)
