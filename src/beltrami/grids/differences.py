r"""Partial derivatives by differences along the axes of a grid (3.2.5, E41)."""

from __future__ import annotations

from math import prod

import numpy as np
from scipy.sparse import csr_array, eye_array, kron, vstack

from beltrami.errors import check_name
from beltrami.grids.axis import Axes, Axis

SCHEMES = ("forward", "backward", "centered")


def grid_gradient(axes: Axes, scheme: str) -> csr_array:
    """Return the (d n, n) matrix of the differences along each axis, the first axis on top."""
    check_name("scheme of differences", scheme, SCHEMES)
    shape = [axis.size for axis in axes]
    blocks = []
    for a, axis in enumerate(axes):
        before, after = eye_array(prod(shape[:a])), eye_array(prod(shape[a + 1 :]))
        blocks.append(kron(kron(before, _difference(axis, scheme)), after, format="csr"))
    matrix = csr_array(vstack(blocks, format="csr"))
    matrix.eliminate_zeros()  # those of kron, and those where both ends are one point
    return matrix


def _difference(axis: Axis, scheme: str) -> csr_array:
    """Return the (p, p) differences; beyond an end the value of the end is repeated."""
    p, h = axis.size, axis.spacing
    here = np.arange(p)
    after = (here + 1) % p if axis.periodic else np.minimum(here + 1, p - 1)
    before = (here - 1) % p if axis.periodic else np.maximum(here - 1, 0)
    left = here if scheme == "forward" else before
    right = here if scheme == "backward" else after
    step = 2 * h if scheme == "centered" else h
    rows = np.concatenate([here, here])
    values = np.repeat([-1 / step, 1 / step], p)
    return csr_array((values, (rows, np.concatenate([left, right]))), shape=(p, p))
