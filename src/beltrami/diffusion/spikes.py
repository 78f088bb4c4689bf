"""Spikes: single vertices far off, and the mesh without them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from beltrami._arrays import Booleans, Floats
from beltrami.diffusion.candidates import EVENING, along_normals
from beltrami.diffusion.filling import error_of_filling, filled
from beltrami.diffusion.linear_filters import equal_rows, low_passed
from beltrami.diffusion.noise import median_level
from beltrami.diffusion.patches import Sample, sample_of
from beltrami.diffusion.planes import PlanesAround, planes_of
from beltrami.mesh.mesh import Mesh

_ROUNDS = 5
_LEAST = 0.01  # mean edges: what is off by little more is no matter
_NEAR = 0.3  # of its distance from most planes, within which a plane holds a vertex
_HELD = 0.3  # of the planes, that hold a vertex of a crease
_BETTER = 0.95  # of the quiet scale: less noise in it than in the other
_FITTED = 40_000  # values that scales are fitted to
_STEPS, _CONVERGED = 200, 1e-5
_FAR = 30.0  # quiet scales, beyond which there is no doubt
_TRIED_ON = 40_000  # faces
_CLEAR = 4.5  # errors of filling, that spikes are large
_LARGE = 0.25  # mean edges, that they are
_ALONE, _BY_CHANCE = 1.2, 1.5  # neighbours that are spikes: of a pair, and times the expected
_MOST = 0.35  # of the vertices
_MORE_ROUNDS, _LESS = 4, 0.9  # that look for overlooked ones, while the error of filling falls


@dataclass(frozen=True, eq=False)
class Spikes:
    """The vertices that were found, and the mesh with them where their neighbours say.

    Attributes
    ----------
    found
        (n,) bool.
    mesh
        All other vertices are where they were.
    error
        Root mean square error of filling, noise of the vertices counted in; in the unit of length.
    """

    found: Booleans
    mesh: Mesh
    error: float


def find_spikes(mesh: Mesh) -> Spikes | None:
    r"""Find vertices that are far off while those around them are not; None if there are none.

    A vertex is compared with the planes of the faces around its neighbours, but its own: the mean
    of the middle third of its distances, less the median of those that the neighbours have, is
    robust against other spikes. This is a mixture of two normal variables, of the quiet vertices
    and of the spikes, fitted by expectation and maximisation (Dempster, Laird and Rubin 1977);
    spikes are more likely of the second. They are put where the others say (``filled``), and all
    is done again with planes of the mesh without them, evened too if that makes the quiet scale
    less. A vertex that many of the planes hold is one of a crease or a corner.

    A shape has details of all sizes, and nobody can tell which are its own. So they are spikes only
    if they are large (4.5 times the error that filling makes for other vertices, and 0.25 mean
    edges), and if they stand alone or in pairs, but for what chance brings together. Where there
    are some, others that planes hold are looked at once more: alone, they are none of a crease,
    and they are spikes too if filling puts them elsewhere. So the error of filling falls, and with
    it the size from which on they are seen.

    Parameters
    ----------
    mesh
        In space, its faces turned alike.

    Notes
    -----
    Robust predictions from planes: Fleishman, Drori and Cohen-Or 2003; Jones, Durand and Desbrun
    2003. Cost: O(n), about ten rounds over the some twenty faces around the neighbours.
    """
    edge = float(mesh.edge_lengths.mean())
    if not edge > 0:
        return None
    around = PlanesAround.of(mesh.topology)
    first = _candidates(mesh, around, edge)
    found, limit = first.found, first.limit
    if not found.any() or found.mean() > _MOST:
        return None
    sample = sample_of(mesh, _TRIED_ON)
    tried = found[sample.vertices]
    ways = ("noise",) if first.way == "noise" else ("plain", "creased")
    errors = [error_of_filling(sample.mesh, tried, way) for way in ways]
    error, way = min(zip(errors, ways, strict=True))
    x = first.x if way == first.way else filled(mesh, found, way)
    far = found & (_away(mesh, x) > limit * edge)
    if (far != found).any():
        found, x = far, filled(mesh, far, way)
    away = _away(mesh, x)[found]
    size = math.sqrt(float((away**2).mean())) if len(away) else 0.0
    if size < max(_CLEAR * error, _LARGE * edge) or _together(mesh, found):
        return None
    spikes = Spikes(found, mesh.with_vertices(x), error)
    return _with_overlooked(mesh, around, spikes, way, limit * edge, sample)


def _with_overlooked(
    mesh: Mesh, around: PlanesAround, spikes: Spikes, way: str, limit: float, sample: Sample
) -> Spikes:
    """Return them with those that planes held by chance, as long as the error falls by them."""
    for _ in range(_MORE_ROUNDS):
        least = max(limit, _CLEAR * spikes.error)
        more = _alone_and_off(mesh, around, spikes, least)
        found = spikes.found | more
        x = filled(mesh, found, way)
        far = more & (_away(mesh, x) > least)
        if not far.any():
            break
        if (far != more).any():
            found = spikes.found | far
            x = filled(mesh, found, way)
        before = spikes.error
        error = min(before, error_of_filling(sample.mesh, found[sample.vertices], way))
        spikes = Spikes(found, mesh.with_vertices(x), error)
        if error > _LESS * before:
            break
    return spikes


def _alone_and_off(mesh: Mesh, around: PlanesAround, spikes: Spikes, least: float) -> Booleans:
    """Return which others are off the planes without spikes; those of creases stand in lines."""
    off = around.off(planes_of(spikes.mesh), mesh, spikes.mesh.vertices)
    more = ~spikes.found & (np.abs(off) > least)
    return np.asarray(more & ~(mesh.topology.adjacency @ more.astype(np.float64) > 0))


@dataclass(frozen=True, eq=False)
class _Candidates:
    """Vertices that may be spikes, more likely than not if so many mean edges large.

    The positions x have them filled, in this way.
    """

    found: Booleans
    limit: float
    way: str
    x: Floats


def _candidates(mesh: Mesh, around: PlanesAround, edge: float) -> _Candidates:
    """Return which vertices may be spikes, filled as the noise of the others wants it.

    If they have some, planes are those of the evened mesh too. Not only: a spike that is not known
    yet pulls them to itself.
    """
    rows, x = equal_rows(mesh), mesh.vertices
    found, limit, way = np.zeros(mesh.n_vertices, np.bool_), math.inf, "plain"
    for i in range(_ROUNDS):
        planes = planes_of(mesh.with_vertices(x))
        off = around.off(planes, mesh, x)
        found, limit = _far_off(mesh, around, planes, off, edge)
        if i:
            evened = along_normals(mesh.with_vertices(x), low_passed(rows, x, EVENING))
            planes = planes_of(mesh.with_vertices(evened))
            other = around.off(planes, mesh, evened)
            less = np.median(np.abs(other)) < _BETTER * np.median(np.abs(off))
            way = "noise" if less else "plain"
            if less:
                more, limit = _far_off(mesh, around, planes, other, edge)
                found = found | more
        if not found.any():
            break
        x = filled(mesh, found, way)
    return _Candidates(found, limit, way, x)


def _far_off(
    mesh: Mesh, around: PlanesAround, planes: Floats, off: Floats, edge: float
) -> tuple[Booleans, float]:
    """Return which vertices are so far off that few planes hold them, and from where on that is."""
    limit = _limit(off / edge)
    far = np.abs(off) > limit * edge
    shares = around.shares(planes, mesh.vertices, np.where(far, _NEAR * np.abs(off), 0.0))
    return far & (shares < _HELD), limit


def _limit(r: Floats) -> float:
    """Return from which size on r (n,) is more likely a spike; infinite if there are none."""
    r = np.abs(r[:: max(1, len(r) // _FITTED)])
    quiet = max(median_level(r), _LEAST)
    share, loud = 0.1, max(math.sqrt(float((r**2).mean())), 3 * quiet)
    for _ in range(_STEPS):
        with np.errstate(under="ignore"):
            of_quiet = (1 - share) / quiet * np.exp(-0.5 * (r / quiet) ** 2)
            of_loud = share / loud * np.exp(-0.5 * (r / loud) ** 2)
        likely = of_loud / np.maximum(of_quiet + of_loud, np.finfo(float).tiny)
        likely[r > _FAR * quiet] = 1
        before, share = share, float(likely.mean())
        if not 0 < share < 1:
            return math.inf
        quiet = max(math.sqrt(float(((1 - likely) * r**2).sum() / (1 - likely).sum())), _LEAST)
        loud = max(math.sqrt(float((likely * r**2).sum() / likely.sum())), quiet)
        if abs(share - before) < _CONVERGED * share:
            break
    odds = (1 - share) / share * loud / quiet
    if not loud > quiet or odds <= 1:
        return math.inf
    return quiet * math.sqrt(2 * math.log(odds) / (1 - (quiet / loud) ** 2))


def _away(mesh: Mesh, x: Floats) -> Floats:
    return np.asarray(np.linalg.norm(x - mesh.vertices, axis=1))


def _together(mesh: Mesh, found: Booleans) -> bool:
    """Whether more of them are neighbours than chance and pairs would make: a feature."""
    A = mesh.topology.adjacency
    neighbours = float((A @ found.astype(float))[found].mean())
    expected = float(found.mean()) * A.nnz / mesh.n_vertices
    return neighbours > _ALONE + _BY_CHANCE * expected
