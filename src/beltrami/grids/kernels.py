"""Kernels of a periodic grid: stencils around 0, averaging, the Laplacian (3.2.4, 3.2.6)."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats
from beltrami.errors import BeltramiError, DimensionError
from beltrami.grids.axis import Axes
from beltrami.grids.lattice import axis_weights, require_neighbours
from beltrami.grids.values import Values, as_values, refuse_overflow


def placed(axes: Axes, stencil: ArrayLike) -> Values:
    """Return the function on the grid whose values around 0 are these, modulo p; O(n + q).

    Raises DimensionError if a side is even, so that there is no middle, BeltramiError if an axis
    has ends.
    """
    require_periodic(axes, "a kernel")
    values = as_values(stencil, "the stencil")
    if values.ndim != len(axes):
        raise DimensionError(f"a stencil of {len(axes)} axes is needed, not of {values.ndim}")
    if any(side % 2 == 0 for side in values.shape):
        raise DimensionError(
            f"the stencil has the shape {values.shape}, and no middle",
            remedy="Give an odd number of values along each axis; pad it with zeros.",
        )
    kernel: Any = np.zeros_like(values, shape=tuple(axis.size for axis in axes))
    offsets = [
        (np.arange(side) - side // 2) % axis.size
        for side, axis in zip(values.shape, axes, strict=True)
    ]
    with np.errstate(over="ignore", invalid="ignore"):
        np.add.at(kernel, np.ix_(*offsets), values)  # where the grid is small, values coincide
    return refuse_overflow(cast(Values, kernel), "the kernel")


def averaging_kernel(axes: Axes, weights: str) -> Floats:
    """Return the kernel of D⁻¹W: the weights of the neighbours of 0 over their sum (example 4)."""
    require_neighbours(axes)
    kernel = _neighbours(axes, weights)
    return kernel / kernel.sum()


def laplacian_kernel(axes: Axes, weights: str) -> Floats:
    """Return the kernel of D - W: minus the weights of the neighbours, their sum at 0."""
    kernel = 0.0 - _neighbours(axes, weights)  # without zeros of the other sign
    kernel.flat[0] = 0.0 - kernel.sum()
    return kernel


def _neighbours(axes: Axes, weights: str) -> Floats:
    """Return the kernel of W, whose value at 0 is zero."""
    require_periodic(axes, "a kernel")
    kernel = np.zeros(tuple(axis.size for axis in axes))
    for a, (axis, weight) in enumerate(zip(axes, axis_weights(axes, weights), strict=True)):
        for side in (1, -1) if axis.size > 1 else ():
            at = [0] * len(axes)
            at[a] = side
            kernel[tuple(at)] += weight
    return kernel


def require_periodic(axes: Axes, what: str) -> None:
    """Raise BeltramiError, with the axes, if an axis has ends: nothing is invariant there."""
    ends = [a for a, axis in enumerate(axes) if not axis.periodic]
    if ends:
        raise BeltramiError(
            f"{what} needs a grid that is periodic along each axis, and axes {ends} have ends. "
            "Use the matrices of laplacian(grid)"
        )
