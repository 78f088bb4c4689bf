"""Relaxation: a bijection made as isometric as it gets, with no fold on the way."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array

from beltrami._arrays import Booleans, Floats
from beltrami.errors import BeltramiError
from beltrami.mesh.mesh import Mesh
from beltrami.parameterization.barrier import Barrier, boundary_barrier
from beltrami.parameterization.block_pattern import BlockPattern, block_pattern
from beltrami.parameterization.isometric_energy import (
    IsometricEnergy,
    isometric_energy,
    shrinking,
)
from beltrami.parameterization.predicates import orientation
from beltrami.parameterization.secants import Secant, descent, secant
from beltrami.parameterization.stars import Stars, stars
from beltrami.parameterization.stepping import stepped
from beltrami.solvers.cholesky import factorize_cholesky
from beltrami.solvers.elimination import Elimination
from beltrami.solvers.factorize import factorize
from beltrami.solvers.ordering import as_positions, order

_SHORT = 0.7  # steps below it are followed by sweeps
_SWEEPS = 8
_LEFT = 0.3  # they are around faces that a whole step would leave less than this of their area
_KEPT = 3  # steps by one factor, if the boundary is held
_FACTOR = 4.0  # what a factorisation costs, in steps without one
_SLOWER = 0.5  # of the mean decrease for this cost: a step below it is the last by a factor
_LITTLE = 0.06  # of the energy: cheap steps, which spread rounding, follow one that gains more
_IDLE = 3  # short steps of a boundary that moves, after which it may get free, are forgiven
_POOR = 4.8  # where the energy is above this: 4 for an isometry
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
    vertices there are moved one at a time, which evens these out (see ``Stars``). If no boundary
    moves, up to two cheaper steps follow by the same factor, corrected by what the steps before
    have shown of the Hessian (see ``descent``): what is projected away is a part of it.

    Parameters
    ----------
    mesh
        A surface of n vertices, of which there is such a map.
    uv
        (n, 2) a bijection to start from.
    steps
        How many of Newton, at most.
    held
        (n,) vertices that stay where they are, or none. A boundary that may move does not cross
        itself, nor one that is held.
    settled
        It stops when the energy falls by less than this part of itself in a step of Newton, or
        for the same cost with those that follow it.

    Returns
    -------
    (n, 2) positions, in the unit of length of the mesh if nothing is held, and the number of
    Newton's steps. What folds at the start is only scaled.

    Notes
    -----
    One factorisation for each step of Newton, all in one order of elimination.
    """
    energy = isometric_energy(mesh)
    free = np.ones(mesh.n_vertices, np.bool_) if held is None else ~held
    x, done, idle = uv, 0, 0
    sums = energy.sums(x)
    if free.any() and all(map(math.isfinite, sums)):
        loose = bool(free[mesh.topology.on_boundary].any())
        around, pattern, plan = stars(mesh, free), block_pattern(mesh, free), None
        while done < steps:
            t = best_scale(sums)
            barrier = boundary_barrier(mesh, x) if loose else None
            model, plan = _model(energy, x, t, barrier, pattern, plan)
            found = _descended(model, x, 1 if loose else _KEPT, around)
            if found is None:
                break
            done += 1
            x, before, after, cost, step = found
            sums = energy.sums(x)
            little = before - after < settled * before * cost / (_FACTOR + 1)
            idle = idle + 1 if little else 0
            jammed = loose and step < _SHORT and after > _POOR
            if idle > (_IDLE if jammed else 0):
                break
    return (x if held is not None else x * best_scale(sums)), done


def best_scale(sums: tuple[float, float]) -> float:
    """Return the factor at which the energy of a map is least."""
    ratio = sums[1] / sums[0] if sums[0] > 0 else 1.0
    return float(ratio**0.25) if math.isfinite(ratio) and ratio > 0 else 1.0


@dataclass(frozen=True, eq=False)
class _Model:
    """The energy around some positions: its gradient there, and how to divide by the Hessian."""

    energy: IsometricEnergy
    scale: float
    barrier: Barrier | None
    pattern: BlockPattern
    gradient: Floats
    solve: Callable[[Floats], Floats]


def _model(
    energy: IsometricEnergy,
    x: Floats,
    t: float,
    barrier: Barrier | None,
    pattern: BlockPattern,
    plan: Elimination | None,
) -> tuple[_Model, Elimination]:
    """Return the model around x, and the order of elimination."""
    gradient, entries = energy.derivatives(x, t, pattern)
    if barrier is not None:
        barrier.add_derivatives(x, pattern, gradient, entries)
    diagonal = np.add.outer(pattern.vertex_slots, [0, 1]) + np.multiply.outer(
        pattern.widths, [0, 1]
    )
    entries[diagonal] += _SHIFT * entries[diagonal].mean()
    H = pattern.matrix(entries)
    positions = np.repeat(energy.mesh.vertices[pattern.number >= 0], 2, axis=0)
    if plan is None:
        plan = order(H, as_positions(positions, pattern.size), "auto")
    solve = _solver(H, positions, plan)
    return _Model(energy, t, barrier, pattern, gradient.ravel(), solve), plan


def _solver(H: csc_array, positions: Floats, plan: Elimination) -> Callable[[Floats], Floats]:
    """Factorise, in another way where a pivot is lost; 0 where that fails: no step is made then."""
    try:
        return factorize_cholesky(H, plan).solve
    except BeltramiError:
        with suppress(BeltramiError):
            return factorize(H, positions, "superlu").solve
    return np.zeros_like


def _descended(
    model: _Model, x: Floats, count: int, around: Stars
) -> tuple[Floats, float, float, float, float] | None:
    """Make up to so many steps; return positions, energies before and after, cost, last step."""
    free = model.pattern.number >= 0
    gradient, moved = model.gradient, np.zeros(0)
    secants: list[Secant] = []
    start = after = math.inf
    cost, step = _FACTOR, 0.0
    for made in range(count):
        if made:
            ahead = model.energy.gradient(x, model.scale, model.pattern).ravel()
            seen = secant(moved, ahead - gradient)
            secants, gradient = secants + ([] if seen is None else [seen]), ahead
        direction = np.zeros_like(x)
        direction[free] = descent(gradient, secants, model.solve).reshape(-1, 2)
        slope = float(gradient @ direction[free].ravel())
        found = stepped(model.energy, x, model.scale, model.barrier, direction, slope)
        if found is None:
            break
        y, before, after, step = found
        if step < _SHORT:
            rough = _rough(model.energy.mesh, x, direction)
            y, after = _evened(model.energy, y, model.scale, around, after, rough)
        moved, x = (y - x)[free].ravel(), y
        start, cost = (start if made else before), cost + 1
        if before - after < max(_SLOWER * (start - after) / cost, _LITTLE * before):
            break
    return None if math.isinf(start) else (x, start, after, cost, step)


def _rough(mesh: Mesh, x: Floats, direction: Floats) -> Booleans:
    """Say which vertices are around faces that a whole step would leave little of."""
    faces, rough = mesh.faces, np.zeros(mesh.n_vertices, np.bool_)
    rough[faces[shrinking(mesh, x, direction, _LEFT)]] = True
    rough[faces[rough[faces].any(axis=1)]] = True
    return rough


def _evened(
    energy: IsometricEnergy, x: Floats, t: float, around: Stars, before: float, rough: Booleans
) -> tuple[Floats, float]:
    """Sweep where it is rough; return the positions, and what the energy becomes."""
    moved = around.swept(x, t, _SWEEPS, rough)
    a, b, c = moved[energy.mesh.faces].transpose(1, 0, 2)
    (grown, shrunk), (grown_before, shrunk_before) = energy.sums(moved), energy.sums(x)
    change = (grown - grown_before) * t**2 + (shrunk - shrunk_before) / t**2
    if not change < 0 or (orientation(a, b, c) <= 0).any():
        return x, before
    return moved, before + change
