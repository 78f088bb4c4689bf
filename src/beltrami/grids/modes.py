r"""Fourier modes of a grid: waves around its circles, cosines between its ends (theorem 11, 12)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, Integers, read_only
from beltrami.errors import BeltramiError, shown
from beltrami.grids.axis import Axes, Axis
from beltrami.grids.eigenvalues import grid_eigenvalues, is_path_by_degree, uniform_mass
from beltrami.grids.lattice import Kinds, axis_weights
from beltrami.grids.values import Values, is_whole


@dataclass(frozen=True, eq=False)
class GridModes:
    r"""Eigenvectors of the pair (L, B) of a grid, in closed form.

    Attributes
    ----------
    modes : (n, k) complex, or real
        One mode in each column; orthonormal for the mass, :math:`\varphi^* B\varphi` = Id. With
        the unit mass they are the :math:`u_\omega` of theorems 11 and 12; with the degree mass
        :math:`D^{-1/2} u_\omega`, those of definition 19.
    eigenvalues : (k,) ascending
    frequencies : (k, d) int
        ω of each mode, 0..p-1 along each axis: the order of ``dft`` is not this order (E71). In
        a real basis ω > p/2 along a circle is the sine of p - ω.
    """

    modes: Values
    eigenvalues: Floats
    frequencies: Integers


def grid_modes(axes: Axes, names: Kinds, k: int | None, real: bool) -> GridModes:
    """Return the k modes with the smallest eigenvalues; equal ones by frequency."""
    eigenvalues = grid_eigenvalues(axes, names)
    n = eigenvalues.size
    count = n if k is None else k
    if not is_whole(count) or not 1 <= count <= n:
        raise BeltramiError(f"a grid of {n} points has 1 to {n} modes, not {shown(k)}")
    order = np.argsort(eigenvalues, axis=None, kind="stable")[:count]
    frequencies = np.stack(np.unravel_index(order, eigenvalues.shape), axis=1).astype(np.int64)
    path = names.mass == "degree" and is_path_by_degree(axes)
    modes: NDArray[Any] = np.ones((1, count))
    for axis, frequency in zip(axes, frequencies.T, strict=True):
        wave = _path_modes(axis, frequency) if path else _axis_modes(axis, frequency, real)
        modes = (modes[:, None, :] * wave).reshape(-1, count)
    modes = modes / np.sqrt(_path_mass(axes, names) if path else uniform_mass(axes, names))
    ascending = eigenvalues.ravel()[order]
    return GridModes(read_only(modes), read_only(ascending), read_only(frequencies))


def _axis_modes(axis: Axis, frequency: Integers, real: bool) -> Values:
    """Return the (p, k) modes of L along one axis, orthonormal for the plain inner product."""
    p = axis.size
    here = np.arange(p)[:, None]
    if not axis.periodic:  # whole multiples of π/2p, reduced before they are rounded
        turns = frequency * (2 * here + 1) % (4 * p)
        return np.cos(np.pi / (2 * p) * turns) * np.sqrt(np.where(frequency == 0, 1, 2) / p)
    angle = 2 * np.pi / p * (frequency * here % p)
    if not real:
        return np.asarray(np.exp(1j * angle) / np.sqrt(p))
    alone = (frequency == 0) | (2 * frequency == p)  # 1 and (-1)^k have no partner
    wave = np.where(2 * frequency <= p, np.cos(angle), -np.sin(angle))
    return np.asarray(wave * np.sqrt(np.where(alone, 1, 2) / p))


def _path_mass(axes: Axes, names: Kinds) -> float:
    """Return the weight of the one axis that has edges: the degrees are 1 or 2 times this."""
    longest = max(range(len(axes)), key=lambda a: axes[a].size)
    return float(axis_weights(axes, names.weights)[longest])


def _path_modes(axis: Axis, frequency: Integers) -> Values:
    """Return cos(πωk/(p - 1)), orthonormal for the degrees 1, 2, ..., 2, 1."""
    last = axis.size - 1
    if not last:
        return np.ones((1, len(frequency)))
    turns = frequency * np.arange(last + 1)[:, None] % (2 * last)
    extreme = (frequency == 0) | (frequency == last)
    return np.asarray(np.cos(np.pi / last * turns) / np.sqrt(np.where(extreme, 2, 1) * last))
