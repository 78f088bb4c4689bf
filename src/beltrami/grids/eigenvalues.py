r"""Closed-form eigenvalues of the Laplacians of a grid (theorems 11 and 12, E69, E70)."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats
from beltrami.errors import BeltramiError, MeshError
from beltrami.grids.axis import Axes, Axis
from beltrami.grids.lattice import Kinds, axis_weights, cell_measure, require_neighbours


def grid_eigenvalues(axes: Axes, names: Kinds) -> Floats:
    """Return the eigenvalues of the pair, frequency by frequency, in the shape of the grid."""
    weights = axis_weights(axes, names.weights)
    if names.mass == "degree" and is_path_by_degree(axes):
        return _along_each([_path_roots(axis) for axis in axes])
    roots = [weight * _roots(axis) for weight, axis in zip(weights, axes, strict=True)]
    mass = uniform_mass(axes, names)
    with np.errstate(over="ignore"):
        eigenvalues = np.asarray(_along_each(roots) / mass)
    if not np.isfinite(eigenvalues).all():
        raise MeshError(f"the mass {mass:g} is too small for floats: scale the steps of the grid")
    return eigenvalues


def uniform_mass(axes: Axes, names: Kinds) -> float:
    """Return the mass of every point, where all have the same.

    Raises
    ------
    MeshError
        For the degree mass of a grid of one point.
    BeltramiError
        For the degree mass where it varies: between ends, in more than one dimension. Then D⁻¹W
        does not split into axes, and no closed form is known.
    """
    if names.mass != "degree":
        return cell_measure(axes) if names.mass == "voronoi" else 1.0
    require_neighbours(axes)
    if not all(axis.periodic or axis.size <= 2 for axis in axes):
        raise BeltramiError(
            "the degrees vary towards the ends of this grid, and its normalised Laplacian has no "
            'closed form. Use mass="unit" or "voronoi", or the matrices of laplacian(grid)'
        )
    neighbours = [2 if axis.periodic else 1 for axis in axes]
    weights = axis_weights(axes, names.weights)
    used = (w * k for axis, w, k in zip(axes, weights, neighbours, strict=True) if axis.size > 1)
    return float(sum(used))


def is_path_by_degree(axes: Axes) -> bool:
    """Whether the grid is one path between two ends: its degrees are 1, 2, ..., 2, 1."""
    long = [axis for axis in axes if axis.size > 1]
    return len(long) == 1 and not long[0].periodic


def folded(axis: Axis) -> Floats:
    """Return min(ω, p - ω) on a circle, so that a frequency and its mirror agree to the bit."""
    frequency = np.arange(axis.size, dtype=np.float64)
    return np.minimum(frequency, axis.size - frequency) if axis.periodic else frequency


def _roots(axis: Axis) -> Floats:
    """Return 4 sin²(πω/p) on a circle (not 2πω/p: E69), 4 sin²(πω/2p) between ends."""
    period = axis.size if axis.periodic else 2 * axis.size
    return np.asarray(4 * np.sin(np.pi * folded(axis) / period) ** 2)


def _path_roots(axis: Axis) -> Floats:
    """Return 1 - cos(πω/(p - 1)): the pair (L, D) of a path."""
    return np.asarray(2 * np.sin(np.pi * np.arange(axis.size) / (2 * max(axis.size - 1, 1))) ** 2)


def _along_each(roots: list[Floats]) -> Floats:
    """Add up the axes: the eigenvalues of a sum over the axes are the sums."""
    total = np.zeros(())
    for values in roots:
        total = total[..., None] + values
    return total
