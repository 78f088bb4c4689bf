r"""Convolution on (Z/pZ)^d: direct, by FFT, repeated, and its symbol (3.2.4, theorem 4)."""

from __future__ import annotations

from collections.abc import Sequence
from math import prod

import numpy as np
import scipy.fft
from numpy.typing import ArrayLike, NDArray

from beltrami.errors import BeltramiError, DimensionError, check_name
from beltrami.grids.transform import dft
from beltrami.grids.transform_cost import transform_cost
from beltrami.grids.values import Values, as_values, is_whole, refuse_overflow

_MANY = 2**53  # exponents that a float still tells apart
METHODS = ("auto", "direct", "fft")
_PASS = 0.32  # shifts of a value that take as long as one pass of a transform over it
_CALL = 1000  # values that could be moved in the time of the calls for one shift


def convolve(f: ArrayLike, kernel: ArrayLike, method: str = "auto") -> Values:
    r"""Return :math:`(f * w)(i) = \sum_k f(k)\, w(i - k)`, indices modulo p (l. 246, E32).

    So w is the first *column* of the matrix of the operator, :math:`w(k) = W(k, 0)`; for an even
    kernel the first row as well.

    Parameters
    ----------
    f
        Array of any dimension, real or complex: one value for each point of the grid.
    kernel
        Array of the same shape: w at 0..p-1 along each axis, so that w(-1) stands last.
        ``Grid.kernel`` makes it of a short one written around 0, as the chapter does.
    method
        ``"direct"`` (one shift for each w(k) that is not zero), ``"fft"``, or ``"auto"``: the
        cheaper one, see ``cheaper_method``. They differ by rounding.

    Returns
    -------
    Array of the shape of f; real if both are. Units: those of f times those of the kernel.

    Raises
    ------
    DimensionError
        If the two shapes differ.
    UnknownNameError, NonFiniteError
        If there is no such method; if a value is NaN, infinite, or becomes so by overflow.

    Notes
    -----
    Cost: O(n q) for q non-zero values of the kernel, or O(n log n).

    Chapter items: U16, P25, P28.

    Examples
    --------
    >>> convolve([1.0, 0.0, 0.0, 5.0], [0.0, 1.0, 0.0, 0.0]).tolist()  # a shift to the right
    [5.0, 1.0, 0.0, 0.0]
    """
    check_name("method of convolution", method, METHODS)
    values, w = _two(f, kernel)
    if method == "auto":
        method = cheaper_method(values.shape, int(np.count_nonzero(w)))
    result = _direct(values, w) if method == "direct" else _by_fft(values, w, 1)
    return refuse_overflow(result, "the convolution")


def cheaper_method(shape: Sequence[int], nonzeros: int) -> str:
    """Tell whether q shifts, or three FFTs, cost less: ``"direct"`` or ``"fft"``.

    Shifts move q n values, transforms about n log2(n), or more where a length has large prime
    factors; constants as measured (benchmarks, rows ``convolve-*``). So the kernels of local
    operators (2d + 1 values) are convolved directly on all but small grids, as the chapter says
    (l. 268).

    Chapter items: P28.

    Examples
    --------
    >>> cheaper_method((1024, 1024), 5), cheaper_method((1024, 1024), 49)
    ('direct', 'fft')
    """
    n = prod(shape)
    moved = (nonzeros + 1) * (n + _CALL)
    return "direct" if moved <= _PASS * transform_cost(shape) * n else "fft"


def convolve_repeatedly(f: ArrayLike, kernel: ArrayLike, times: int) -> Values:
    r"""Return :math:`w * \dots * w * f`, k times, by two transforms (theorem 4).

    :math:`\Phi(\tilde W^k f)(\omega) = \hat w(\omega)^k \hat f(\omega)` for the transform without
    a factor (``"numpy"``). With definition 12 as printed the right side wants :math:`n^k` (E34).

    Parameters
    ----------
    f, kernel
        As ``convolve``.
    times
        k, a whole number from 0 to 2⁵³ - 1.

    Raises
    ------
    BeltramiError
        If ``times`` is not such a number.
    DimensionError, NonFiniteError
        As ``convolve``.

    Notes
    -----
    Cost: O(n log n), whatever k.

    Chapter items: T4.

    Examples
    --------
    >>> convolve_repeatedly([8.0, 0.0, 0.0, 0.0], [0.0, 0.5, 0.0, 0.5], 2).round(12).tolist()
    [4.0, 0.0, 4.0, 0.0]
    """
    if not is_whole(times) or not 0 <= times < _MANY:
        raise BeltramiError("times must be a whole number from 0 to 2**53 - 1")
    values, w = _two(f, kernel)
    return refuse_overflow(_by_fft(values, w, int(times)), "the convolution")


def symbol(kernel: ArrayLike) -> NDArray[np.complex128]:
    r"""Return :math:`\hat w(\omega)`: the eigenvalues of the convolution with w (l. 256).

    The operator is :math:`F^{-1} \mathrm{diag}(\hat w) F`, for every convention of F; the
    eigenvalues are the transform of w without a factor. They are real for an even kernel.

    Raises
    ------
    DimensionError, NonFiniteError
        As ``dft``.

    Notes
    -----
    Cost: O(n log n).

    Chapter items: P26.

    Examples
    --------
    >>> symbol([2.0, -1.0, 0.0, -1.0]).real.tolist()  # 4 sin²(πω/4)
    [0.0, 2.0, 4.0, 2.0]
    """
    return dft(as_values(kernel, "the kernel"), "numpy")


def _two(f: ArrayLike, kernel: ArrayLike) -> tuple[Values, Values]:
    values, w = as_values(f), as_values(kernel, "the kernel")
    if values.shape != w.shape:
        raise DimensionError(
            f"the kernel has the shape {w.shape}, and the function {values.shape}",
            remedy="A kernel is a function on the same grid; Grid.kernel makes it of a short one.",
        )
    return values, w


def _direct(f: Values, w: Values) -> Values:
    """Add up the shifts of f: windows of one array that goes on beyond both ends of f."""
    out = np.zeros(f.shape, np.result_type(f, w))
    scaled = np.empty_like(out)
    at = np.argwhere(w)
    sizes = np.array(f.shape)
    shifts = np.where(2 * at > sizes, at - sizes, at)  # the shorter way round
    before, after = shifts.max(axis=0, initial=0), -shifts.min(axis=0, initial=0)
    longer = f
    for axis, (b, a) in enumerate(zip(before, after, strict=True)):
        ends = np.split(longer, [a, f.shape[axis] - b], axis)
        longer = np.concatenate([ends[2], longer, ends[0]], axis)
    with np.errstate(over="ignore", invalid="ignore"):  # told by refuse_overflow
        for k, start in zip(at, before - shifts, strict=True):
            window = tuple(slice(b, b + p) for b, p in zip(start, sizes, strict=True))
            out += np.multiply(longer[window], w[tuple(k)], out=scaled)
    return out


def _by_fft(f: Values, w: Values, times: int) -> Values:
    """Multiply the transforms; half of them is enough where both are real."""
    with np.errstate(over="ignore", invalid="ignore"):
        if np.iscomplexobj(f) or np.iscomplexobj(w):
            return np.asarray(scipy.fft.ifftn(scipy.fft.fftn(f) * scipy.fft.fftn(w) ** times))
        half: NDArray[np.complex128] = scipy.fft.rfftn(f.real) * scipy.fft.rfftn(w.real) ** times
        return np.asarray(scipy.fft.irfftn(half, s=f.shape))
