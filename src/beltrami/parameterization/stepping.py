"""A step along a direction: as long as pays, and without a fold."""

from __future__ import annotations

from beltrami._arrays import Floats
from beltrami.mesh.mesh import Mesh
from beltrami.parameterization.barrier import Barrier
from beltrami.parameterization.certificate import turns_left
from beltrami.parameterization.crossings import crossings
from beltrami.parameterization.isometric_energy import IsometricEnergy, first_collapse
from beltrami.parameterization.predicates import orientation

_SHORTEST = 1e-8  # of a step, before it is given up
_LONGER = 1.5  # factor by which a step is made longer, as long as the energy falls


def stepped(
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
