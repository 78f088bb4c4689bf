"""Kernel: a function h of the eigenvalue, which makes the filter h(B⁻¹L), and their sums."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from numbers import Real
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beltrami._arrays import Floats, as_floats, rectangular
from beltrami.errors import BeltramiError, DimensionError, NonFiniteError

Response: TypeAlias = "Kernel | Callable[[Floats], ArrayLike]"

_OPERATIONS: dict[str, Callable[..., Any]] = {
    "+": np.add,
    "-": np.subtract,
    "*": np.multiply,
    "/": np.divide,
}


class Kernel:
    r"""A function :math:`h(\lambda)`; with it goes the filter :math:`h(B^{-1}L)`.

    Kernels add, subtract, multiply and divide, with each other and with numbers: one filter after
    the other is ``h * g``, what a filter removes is ``1 - h``. They say where they jump, since no
    polynomial comes near them there. Any function of an array works as a kernel as well.

    Chapter items: P46.
    """

    @property
    def jumps(self) -> tuple[float, ...]:
        """The eigenvalues at which h jumps."""
        return ()

    def __call__(self, eigenvalues: ArrayLike) -> Floats:
        """Return h(λ), in the shape of λ."""
        return self._at(as_floats(eigenvalues))

    def _at(self, x: Floats) -> Floats:
        raise NotImplementedError

    def __add__(self, other: object) -> Combined:
        return Combined("+", self, _operand(other))

    def __radd__(self, other: object) -> Combined:
        return Combined("+", _operand(other), self)

    def __sub__(self, other: object) -> Combined:
        return Combined("-", self, _operand(other))

    def __rsub__(self, other: object) -> Combined:
        return Combined("-", _operand(other), self)

    def __mul__(self, other: object) -> Combined:
        return Combined("*", self, _operand(other))

    def __rmul__(self, other: object) -> Combined:
        return Combined("*", _operand(other), self)

    def __truediv__(self, other: object) -> Combined:
        return Combined("/", self, _operand(other))

    def __rtruediv__(self, other: object) -> Combined:
        return Combined("/", _operand(other), self)


@dataclass(frozen=True, repr=False)
class Combined(Kernel):
    """Two kernels, or a kernel and a number, joined by ``+``, ``-``, ``*`` or ``/``.

    Examples
    --------
    >>> from beltrami.spectrum.kernels import Heat, LowPass
    >>> h = 2 * Heat(0.5) - LowPass(3.0)
    >>> h
    ((2.0 * Heat(time=0.5)) - LowPass(cutoff=3.0, width=0.0))
    >>> h([0.0, 4.0]).round(4).tolist(), h.jumps
    ([1.0, 0.2707], (3.0,))
    """

    operation: str
    left: Kernel | float
    right: Kernel | float

    def __repr__(self) -> str:
        return f"({self.left!r} {self.operation} {self.right!r})"

    @property
    def jumps(self) -> tuple[float, ...]:
        """The eigenvalues at which one of the two jumps."""
        parts = [part.jumps for part in (self.left, self.right) if isinstance(part, Kernel)]
        return tuple(sorted({jump for part in parts for jump in part}))

    def _at(self, x: Floats) -> Floats:
        left, right = (
            part(x) if isinstance(part, Kernel) else part for part in (self.left, self.right)
        )
        return np.asarray(_OPERATIONS[self.operation](left, right))


def _operand(other: object) -> Kernel | float:
    """Return a kernel as it is, a number as a float."""
    if isinstance(other, Kernel):
        return other
    if isinstance(other, Real) and math.isfinite(other):
        return float(other)
    raise BeltramiError(f"a kernel combines with kernels and finite numbers, not with {other!r}")


def evaluate(h: Response, eigenvalues: Floats) -> Floats:
    """Return h at the eigenvalues, (k,); check what a function of the user gives.

    Raises
    ------
    BeltramiError
        If h is not a function, or one of single numbers only.
    DimensionError
        If it does not return a real number for each eigenvalue.
    NonFiniteError
        If a value is NaN or infinite; the message names the eigenvalue.

    Examples
    --------
    >>> evaluate(lambda x: 1 / (1 + x), np.array([0.0, 1.0])).tolist()
    [1.0, 0.5]
    """
    if not callable(h):
        raise BeltramiError(f"h is a function of the eigenvalues, not of type {type(h).__name__}")
    try:
        given: Any = h(eigenvalues)
    except BeltramiError:
        raise
    except (TypeError, ValueError) as cause:
        raise BeltramiError(
            f"h cannot be called with an array of eigenvalues: {cause}. Write it with numpy's "
            "functions, and conditions with numpy.where"
        ) from cause
    found: NDArray[Any] = given if isinstance(given, np.ndarray) else rectangular(given)
    if found.dtype.kind not in "biuf" or found.shape not in ((), eigenvalues.shape):
        raise DimensionError(
            f"h gave an array of type {found.dtype} and shape {found.shape} for "
            f"{eigenvalues.shape} eigenvalues, where a real number for each is needed"
        )
    values = np.broadcast_to(found.astype(np.float64), eigenvalues.shape)
    wrong = np.flatnonzero(~np.isfinite(values))
    if len(wrong):
        raise NonFiniteError(f"h is not finite at the eigenvalue {eigenvalues[wrong[0]]:g}")
    return values
