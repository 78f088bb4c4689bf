"""Relaxation: a bijection made as isometric as it gets, with no fold on the way."""

from __future__ import annotations

import math
from contextlib import suppress

import numpy as np
from scipy.sparse import csc_array

from beltrami._arrays import Booleans, Floats
from beltrami.errors import BeltramiError
from beltrami.mesh.mesh import Mesh
from beltrami.parameterization.barrier import Barrier, boundary_barrier
from beltrami.parameterization.block_pattern import BlockPattern, block_pattern
from beltrami.parameterization.certificate import turns_left
from beltrami.parameterization.crossings import crossings
from beltrami.parameterization.isometric_energy import (
    IsometricEnergy,
    first_collapse,
    isometric_energy,
)
from beltrami.parameterization.predicates import orientation
from beltrami.parameterization.stars import Stars, stars
from beltrami.solvers.cholesky import factorize_cholesky
from beltrami.solvers.elimination import Elimination
from beltrami.solvers.factorize import factorize
from beltrami.solvers.ordering import as_positions, order

_SHORTEST = 1e-8  # of a step, before it is given up
_LONGER = 1.5  # factor by which a step is made longer, as long as the energy falls
_SHORT = 0.7  # steps below it are followed by sweeps
_SWEEPS = 4
_SHIFT = 1e-9  # of the Hessian, over its mean diagonal: moving and turning cost nothing


def relax(
    mesh: Mesh,
    uv: Floats,
    steps: int,
    held: Booleans | None,
    settled: float,
) -> tuple[Floats, int]:
    r"""Lower the symmetric Dirichlet energy of a bijection; return it and the steps.

    The energy, :math:`\sum_f A_f (\sigma_1^2 + \sigma_2^2 + \sigma_1^{-2} + \sigma_2^{-2})` at
    the best scale, is infinite where a face collapses. Each step is one of Newton, with the
    Hessian of each face projected to the semi-definite matrices. It is shortened so that no face
    turns over (J. Smith, S. Schaefer, Bijective parameterization with free boundaries, 2015), the
    boundary does not cross itself nor turn inside out, all decided exactly, and the energy falls;
    or made longer, as long as it falls. A barrier lets a boundary slide along itself (see
    ``Barrier``). Where a step had to be short, a few rough places were in its way: the inner
    vertices are moved one at a time, which evens these out (see ``Stars``).

    Parameters
    ----------
    mesh
        A surface of n vertices, of which there is such a map.
    uv
        (n, 2) a bijection to start from.
    steps
        How many, at most.
    held
        (n,) vertices that stay where they are, or none. A boundary that may move does not cross
        itself, nor one that is held.
    settled
        It stops when the energy falls by less than this part of itself.

    Returns
    -------
    (n, 2) positions, in the unit of length of the mesh if nothing is held, and the number of
    steps. What folds at the start is only scaled.

    Notes
    -----
    One factorisation for each step, all in one order of elimination.
    """
    energy = isometric_energy(mesh)
    free = np.ones(mesh.n_vertices, np.bool_) if held is None else ~held
    x, done = uv, 0
    sums, around = energy.sums(x), stars(mesh, free)
    if free.any() and all(map(math.isfinite, sums)):
        pattern, plan = block_pattern(mesh, free), None
        loose = bool(free[mesh.topology.on_boundary].any())
        while done < steps:
            t = best_scale(sums)
            barrier = boundary_barrier(mesh, x) if loose else None
            direction, slope, plan = _newton(energy, x, t, barrier, pattern, plan)
            found = _shortened(energy, x, t, barrier, direction, slope)
            if found is None:
                break
            done += 1
            x, before, after, step = found
            if step < _SHORT:
                x, after = _evened(energy, x, t, around, after)
            sums = energy.sums(x)
            if after > (1 - settled) * before:
                break
    return (x if held is not None else x * best_scale(sums)), done


def best_scale(sums: tuple[float, float]) -> float:
    """Return the factor at which the energy of a map is least."""
    ratio = sums[1] / sums[0] if sums[0] > 0 else 1.0
    return float(ratio**0.25) if math.isfinite(ratio) and ratio > 0 else 1.0


def _newton(
    energy: IsometricEnergy,
    x: Floats,
    t: float,
    barrier: Barrier | None,
    pattern: BlockPattern,
    plan: Elimination | None,
) -> tuple[Floats, float, Elimination]:
    """Return the direction of Newton's step, the slope along it, and the order of elimination."""
    free = pattern.number >= 0
    gradient, entries = energy.derivatives(x, t, pattern)
    if barrier is not None:
        barrier.add_derivatives(x, pattern, gradient, entries)
    diagonal = np.add.outer(pattern.vertex_slots, [0, 1]) + np.multiply.outer(
        pattern.widths, [0, 1]
    )
    entries[diagonal] += _SHIFT * entries[diagonal].mean()
    H = pattern.matrix(entries)
    positions = np.repeat(energy.mesh.vertices[free], 2, axis=0)
    if plan is None:
        plan = order(H, as_positions(positions, pattern.size), "auto")
    direction = np.zeros_like(x)
    direction[free] = _solution(H, positions, plan, -gradient.ravel()).reshape(-1, 2)
    return direction, float((gradient * direction[free]).sum()), plan


def _solution(H: csc_array, positions: Floats, plan: Elimination, right: Floats) -> Floats:
    """Solve, in another way where a pivot is lost; 0 where that fails too: no step is made then."""
    try:
        return factorize_cholesky(H, plan).solve(right)
    except BeltramiError:
        with suppress(BeltramiError):
            return factorize(H, positions, "superlu").solve(right)
    return np.zeros_like(right)


def _evened(
    energy: IsometricEnergy, x: Floats, t: float, around: Stars, before: float
) -> tuple[Floats, float]:
    """Sweep over the inner vertices; return the positions, and what the energy becomes."""
    moved = around.swept(x, t, _SWEEPS)
    a, b, c = moved[energy.mesh.faces].transpose(1, 0, 2)
    (grown, shrunk), (grown_before, shrunk_before) = energy.sums(moved), energy.sums(x)
    change = (grown - grown_before) * t**2 + (shrunk - shrunk_before) / t**2
    if not change < 0 or (orientation(a, b, c) <= 0).any():
        return x, before
    return moved, before + change


def _shortened(
    energy: IsometricEnergy,
    x: Floats,
    t: float,
    barrier: Barrier | None,
    direction: Floats,
    slope: float,
) -> tuple[Floats, float, float, float] | None:
    """Return positions after the longest allowed step, energies before and after, and the step."""
    mesh = energy.mesh
    edges = mesh.edges[:0] if barrier is None else barrier.edges
    longest = 0.9 * first_collapse(mesh, x, direction)
    step = min(1.0, longest)

    def total(y: Floats) -> float:
        grown, shrunk = energy.sums(y)
        return grown * t**2 + shrunk / t**2 + (0.0 if barrier is None else barrier.energy(y))

    start, here = total(x), total(x + step * direction)
    while here < start and _LONGER * step < longest:
        farther = total(x + _LONGER * step * direction)
        if not farther < here:
            break
        step, here = _LONGER * step, farther
    while step > _SHORTEST:
        if here < start + 1e-4 * step * slope:
            moved = x + step * direction
            a, b, c = moved[mesh.faces].transpose(1, 0, 2)
            upright = (orientation(a, b, c) > 0).all() and not len(crossings(moved, edges))
            if upright and (barrier is None or _as_before(mesh, x, moved)):
                return moved, start, here, step
        step /= 2
        here = total(x + step * direction)
    return None


def _as_before(mesh: Mesh, x: Floats, moved: Floats) -> bool:
    """Whether each loop runs the same way round as at x.

    Two edges of the boundary with a common end may sweep over each other in one step: no face is
    turned over, nothing crosses any more, but around a hole the image lies twice.
    """
    loops = mesh.topology.boundary_loops
    return all(turns_left(moved[loop]) == turns_left(x[loop]) for loop in loops)
