r"""dft, idft: one transform, three conventions (definition 12, E35)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import scipy.fft
from numpy.typing import ArrayLike, NDArray

from beltrami.errors import check_name
from beltrami.grids.values import as_values, refuse_overflow

CONVENTIONS = ("text", "unitary", "numpy")


def dft(f: ArrayLike, convention: str = "unitary") -> NDArray[np.complex128]:
    r"""Return the discrete Fourier transform along every axis (definition 12).

    =============  =========================================================================
    ``"unitary"``  :math:`n^{-1/2} \sum_k f_k e^{-2i\pi\langle k,\omega/p\rangle}`, which is
                   :math:`\langle f, u_\omega\rangle` of theorem 11: it keeps the norm (Parseval)
    ``"numpy"``    :math:`\sum_k f_k e^{-2i\pi\langle k,\omega/p\rangle}`: convolutions become
                   products, with no factor (theorem 4, E34)
    ``"text"``     :math:`\frac1n \sum_k f_k e^{+2i\pi\langle k,\omega/p\rangle}`: definition
                   12 as it is printed, which is numpy's *inverse* transform (E35)
    =============  =========================================================================

    with :math:`\langle k, \omega/p\rangle = \sum_a k_a\omega_a/p_a` and n the number of values.

    Parameters
    ----------
    f
        Array of any dimension, real or complex: one value for each point of the grid. For a
        function of n rows give ``f.reshape(grid.shape)``.
    convention
        ``"unitary"``, ``"numpy"`` or ``"text"``.

    Returns
    -------
    Complex array of the shape of f, frequencies 0..p-1 along each axis. Units: those of f.

    Raises
    ------
    UnknownNameError
        If there is no such convention.
    DimensionError, NonFiniteError
        If f is not an array of finite numbers with one axis or more.

    Notes
    -----
    Cost: O(n log n), for any sizes, by ``scipy.fft``.

    Chapter items: D12, P27, P28.

    Examples
    --------
    >>> dft([1.0, 0.0, 0.0, 0.0]).real.tolist()
    [0.5, 0.5, 0.5, 0.5]
    >>> (dft([0.0, 1.0, 0.0, 0.0], "text").imag + 0.0).tolist()
    [0.0, 0.25, 0.0, -0.25]
    """
    return _transform(f, convention, forward=True)


def idft(coefficients: ArrayLike, convention: str = "unitary") -> NDArray[np.complex128]:
    """Return the function with these coefficients: the inverse of ``dft`` in its convention.

    Parameters
    ----------
    coefficients
        Array of any dimension, frequencies in the order of ``dft``.
    convention
        The one of the transform: ``"unitary"``, ``"numpy"`` or ``"text"``.

    Returns
    -------
    Complex array of the same shape; take ``.real`` where the function was real.

    Raises
    ------
    UnknownNameError, DimensionError, NonFiniteError
        As ``dft``.

    Notes
    -----
    Cost: O(n log n).

    Chapter items: D12, P27.

    Examples
    --------
    >>> idft(dft([3.0, 1.0, 2.0], "text"), "text").real.round(12).tolist()
    [3.0, 1.0, 2.0]
    """
    return _transform(coefficients, convention, forward=False)


def _transform(f: ArrayLike, convention: str, *, forward: bool) -> NDArray[np.complex128]:
    """Run one of scipy's two transforms: the text's exponent has the sign of the inverse one."""
    check_name("convention of the Fourier transform", convention, CONVENTIONS)
    values = as_values(f, "the function" if forward else "the array of coefficients")
    minus = forward != (convention == "text")
    run: Callable[..., Any] = scipy.fft.fftn if minus else scipy.fft.ifftn
    result = run(values, norm="ortho" if convention == "unitary" else "backward")
    return np.asarray(refuse_overflow(result, "the transform"), np.complex128)
