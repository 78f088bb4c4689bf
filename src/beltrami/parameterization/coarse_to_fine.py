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
_HIGH = 5.0  # symmetric Dirichlet energy above which the relaxation starts once more
_BAD = 50.0  # likewise, of a coarser mesh or with a free boundary
_RELAXATIONS = 800  # steps of it, at most
_LARGE = 5000  # vertices from which a coarser mesh comes first
_COARSER = 4  # times fewer vertices
_HARDLY = 1.5  # likewise: if no more can go, it does not pay
_ROUGH = 1000, 8  # likewise, of a rough map
_SWEEPS, _FEW_SWEEPS = 10, 3  # over a map that is made of a coarser one; a rough one
_LOOSER = 0.15  # power of the size, over the least large one, by which a large mesh settles sooner


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
    """Map a disk by reweighting and relaxation; the next weights only where the start is bad.

    Of several starts the best one is relaxed, and the next ones too where that ends at a high
    energy: they may come to rest elsewhere.

    From 5,000 vertices on, the map of a mesh with a quarter of them comes first, and of that in
    the same way; the vertices that it lacks are inserted without a fold, and the map is relaxed.
    Iterations are cheap there, where the way is long; here they end the sooner, the dearer they
    are. Weights that are no name of weights may not be for another mesh: there, and where an
    insertion folds, the mesh is mapped as it is. So it is with a free boundary, which comes to
    rest elsewhere if it is that of a coarser mesh first; unless the map need only be rough: then
    it is that of a mesh with an eighth of the vertices, for disks of 1,000 and more, with the
    others inserted and not relaxed.
    """
    named = all(isinstance(kind, str) for kind in weights)
    step = None
    if named and (rough or not free):
        last = settled * (mesh.n_vertices / _LARGE) ** _LOOSER
        step = _from_coarser(mesh, weights, loop, placed, free, settled, last, rough)
    if step is None:
        high = _BAD if free or rough else _HIGH
        step = _as_it_is(mesh, weights, loop, placed, free=free, settled=settled, high=high)
    return step


def _as_it_is(
    mesh: Mesh,
    weights: tuple[str | Weigher, ...],
    loop: Integers,
    placed: Floats,
    *,
    free: bool,
    settled: float,
    high: float,
) -> Step:
    """Map a disk without a coarser one; from several starts where one ends at a high energy."""
    pending = list(weights)
    starts: list[Step] = []
    steps: list[Step] = []
    good = (0, np.inf if free else _ENOUGH)  # one start is enough to let a boundary go
    while not steps or steps[-1].rank > (0, high):
        while pending and not any(start.rank <= good for start in starts):
            kind = pending.pop(0)
            W, symmetric = edge_weights(mesh, kind), is_symmetric(kind)
            starts.append(
                reweighted(mesh, W, loop, placed, _STEPS, enough=_ENOUGH, symmetric=symmetric)[0]
            )
        if not starts:
            break
        start = starts.pop(min(range(len(starts)), key=lambda q: starts[q].rank))
        steps.append(start if start.flips else _relaxed(mesh, start.uv, free, settled))
    return min(steps, key=lambda step: step.rank)


def _relaxed(mesh: Mesh, uv: Floats, free: bool, settled: float) -> Step:
    held = None if free else mesh.topology.on_boundary
    return assess(mesh, relax(mesh, uv, _RELAXATIONS, held, settled)[0])


def _from_coarser(
    mesh: Mesh,
    weights: tuple[str | Weigher, ...],
    loop: Integers,
    placed: Floats,
    free: bool,
    settled: float,
    last: float,
    rough: bool,
) -> Step | None:
    """Map a coarser mesh, then this one from there; None if that is not possible.

    ``last`` says when this one is settled, ``settled`` when those before are.
    """
    large, coarser = _ROUGH if rough else (_LARGE, _COARSER)
    if mesh.n_vertices < large:
        return None
    coarse = thinned(mesh, mesh.n_vertices // coarser)
    if _HARDLY * coarse.mesh.n_vertices > mesh.n_vertices:
        return None
    given = coarse.mesh, weights, np.searchsorted(coarse.kept, loop), placed
    try:
        found = _from_coarser(*given, free, settled, settled, rough)
        if found is None:
            found = _as_it_is(*given, free=free, settled=settled, high=_BAD)
    except SingularMatrixError:  # areas of a map beyond the range of doubles
        return None
    if found.flips:
        return None
    scale = best_scale(isometric_energy(coarse.mesh).sums(found.uv))
    uv = inserted(mesh, coarse, found.uv, scale)
    uv = stars(mesh).swept(uv, scale, _FEW_SWEEPS if rough else _SWEEPS)
    step = assess(mesh, uv)
    if rough or step.flips:
        return None if step.flips else step
    step = _relaxed(mesh, uv, False, last)
    return None if step.flips else step
