"""Large disks: a map of a coarser mesh first, of which the finer ones get theirs."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami.errors import SingularMatrixError
from beltrami.mesh.mesh import Mesh
from beltrami.operators.weights import Weigher, edge_weights
from beltrami.parameterization.harmonic import is_symmetric
from beltrami.parameterization.insertion import inserted
from beltrami.parameterization.isometric_energy import isometric_energy
from beltrami.parameterization.relaxation import best_scale, relax
from beltrami.parameterization.reweighting import Step, assess, reweighted
from beltrami.parameterization.stars import stars
from beltrami.parameterization.thinning import thinned

_STEPS = 30  # of reweighting, at most
_ENOUGH = 30.0  # energy from which Newton's steps are the faster ones
_BAD = 50.0  # symmetric Dirichlet energy above which other weights are tried
_RELAXATIONS = 200  # steps of it, at most
_LARGE = 5000  # vertices from which a coarser mesh comes first
_COARSER = 4  # times fewer vertices
_HARDLY = 1.5  # likewise: if no more can go, it does not pay
_ROUGH = 1000, 8  # likewise, of a rough map
_SWEEPS = 10  # over a map that is made of a coarser one


def disk_map(
    mesh: Mesh,
    weights: tuple[str | Weigher, ...],
    loop: Integers,
    placed: Floats,
    *,
    free: bool,
    settled: float,
    rough: bool = False,
) -> Step:
    """Map a disk by reweighting and relaxation; the next weights only where the map is bad.

    From 5,000 vertices on, the map of a mesh with a quarter of them comes first, and of that in
    the same way; the vertices that it lacks are inserted without a fold, and the map is relaxed.
    Iterations are cheap there, where the way is long. Weights that are no name of weights may not
    be for another mesh: there, and where an insertion folds, the mesh is mapped as it is. So it is
    with a free boundary, which comes to rest elsewhere if it is that of a coarser mesh first;
    unless the map need only be rough: then it is that of a mesh with an eighth of the vertices,
    for disks of 1,000 and more, with the others inserted and not relaxed.
    """
    named = all(isinstance(kind, str) for kind in weights)
    large, coarser = _ROUGH if rough else (_LARGE, _COARSER)
    if named and (rough or not free) and mesh.n_vertices >= large:
        count = mesh.n_vertices // coarser
        step = _from_coarser(mesh, count, weights, loop, placed, free, settled, rough)
        if step is not None:
            return step
    steps: list[Step] = []
    for kind in weights:
        W, symmetric = edge_weights(mesh, kind), is_symmetric(kind)
        start, _ = reweighted(mesh, W, loop, placed, _STEPS, enough=_ENOUGH, symmetric=symmetric)
        steps.append(start if start.flips else _relaxed(mesh, start.uv, free, settled))
        if steps[-1].rank <= (0, _BAD):
            break
    return min(steps, key=lambda step: step.rank)


def _relaxed(mesh: Mesh, uv: Floats, free: bool, settled: float) -> Step:
    held = None if free else mesh.topology.on_boundary
    return assess(mesh, relax(mesh, uv, _RELAXATIONS, held, settled)[0])


def _from_coarser(
    mesh: Mesh,
    count: int,
    weights: tuple[str | Weigher, ...],
    loop: Integers,
    placed: Floats,
    free: bool,
    settled: float,
    rough: bool,
) -> Step | None:
    """Map a mesh of so many vertices, then this one from there; None if that is not possible."""
    coarse = thinned(mesh, count)
    if _HARDLY * coarse.mesh.n_vertices > mesh.n_vertices:
        return None
    number = np.searchsorted(coarse.kept, loop)
    try:
        found = disk_map(
            coarse.mesh, weights, number, placed, free=free, settled=settled, rough=rough
        )
    except SingularMatrixError:  # areas of a map beyond the range of doubles
        return None
    if found.flips:
        return None
    scale = best_scale(isometric_energy(coarse.mesh).sums(found.uv))
    uv = inserted(mesh, coarse, found.uv, scale)
    uv = stars(mesh).swept(uv, scale, _SWEEPS)
    step = assess(mesh, uv)
    if rough or step.flips:
        return None if step.flips else step
    step = _relaxed(mesh, uv, False, settled)
    return None if step.flips else step
