"""Spikes: single vertices far off, and the mesh without them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse import csr_array

from beltrami._arrays import Booleans, Floats, Integers
from beltrami._jit import kernel
from beltrami.diffusion.candidates import EVENING, along_normals
from beltrami.diffusion.filling import error_of_filling, filled
from beltrami.diffusion.linear_filters import equal_rows, low_passed
from beltrami.diffusion.noise import median_level
from beltrami.diffusion.patches import sample_of
from beltrami.mesh.mesh import Mesh

_ROUNDS = 5
_LEAST = 0.01  # mean edges: what is off by little more is no matter
_NEAR = 0.3  # of its distance from most planes, within which a plane holds a vertex
_HELD = 0.3  # of the planes, that hold a vertex of a crease
_BETTER = 0.95  # of the quiet scale: less noise in it than in the other
_MANY = 64  # neighbours, from which vertices are not looked at: their rings are the whole mesh
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
    planes = _Planes.of(mesh)
    found, limit, noisy = _candidates(mesh, planes, edge)
    if not found.any() or found.mean() > _MOST:
        return None
    sample = sample_of(mesh, _TRIED_ON)
    tried = found[sample.vertices]
    ways = ("noise",) if noisy else ("plain", "creased")
    errors = [error_of_filling(sample.mesh, tried, way) for way in ways]
    error, way = min(zip(errors, ways, strict=True))
    found = found & (_away(mesh, filled(mesh, found, way)) > limit * edge)
    x = filled(mesh, found, way)
    away = _away(mesh, x)[found]
    size = math.sqrt(float((away**2).mean())) if len(away) else 0.0
    if size < max(_CLEAR * error, _LARGE * edge) or _together(mesh, found):
        return None
    for _ in range(_MORE_ROUNDS):
        more = _overlooked(mesh, planes, found, x, max(limit * edge, _CLEAR * error))
        more &= _away(mesh, filled(mesh, found | more, way)) > max(limit * edge, _CLEAR * error)
        if not more.any():
            break
        found = found | more
        x = filled(mesh, found, way)
        before, error = (
            error,
            min(error, error_of_filling(sample.mesh, found[sample.vertices], way)),
        )
        if error > _LESS * before:
            break
    return Spikes(found, mesh.with_vertices(x), error)


def _candidates(mesh: Mesh, planes: _Planes, edge: float) -> tuple[Booleans, float, bool]:
    """Return which vertices may be spikes, the least size of those, and whether others have noise.

    If they do, planes are those of the evened mesh too. Not only: a spike that is not known yet
    pulls them to itself.
    """
    rows, x = equal_rows(mesh), mesh.vertices
    found, limit, noisy = np.zeros(mesh.n_vertices, np.bool_), math.inf, False
    for i in range(_ROUNDS):
        off, held = planes.compared(mesh, x)
        limit = _limit(off / edge)
        found = (np.abs(off) > limit * edge) & (held < _HELD)
        if i:
            evened = along_normals(mesh.with_vertices(x), low_passed(rows, x, EVENING))
            other, held = planes.compared(mesh, evened)
            noisy = bool(np.median(np.abs(other)) < _BETTER * np.median(np.abs(off)))
            if noisy:
                limit = _limit(other / edge)
                found |= (np.abs(other) > limit * edge) & (held < _HELD)
        if not found.any():
            break
        x = filled(mesh, found, "noise" if noisy else "plain")
    return found, limit, noisy


def _overlooked(mesh: Mesh, planes: _Planes, found: Booleans, x: Floats, limit: float) -> Booleans:
    """Return which others may be spikes, since there are some: those that planes hold by chance.

    Those of creases stand in lines.
    """
    off, _ = planes.compared(mesh, x)
    more = ~found & (np.abs(off) > limit)
    return np.asarray(more & ~(mesh.topology.adjacency @ more.astype(np.float64) > 0))


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


@dataclass(frozen=True, eq=False)
class _Planes:
    """The faces around the neighbours of each vertex, but its own."""

    indptr: Integers
    faces: Integers

    @classmethod
    def of(cls, mesh: Mesh) -> _Planes:
        A, F = mesh.topology.adjacency, mesh.topology.vertex_faces
        few = np.diff(A.indptr) <= _MANY
        near, own = (_counts(M, few) for M in (A, F))
        far = csr_array(near @ own)
        both = csr_array(far - far.multiply(own > 0))
        both.eliminate_zeros()
        both.sort_indices()
        return cls(both.indptr.astype(np.int64), both.indices.astype(np.int64))

    def compared(self, mesh: Mesh, x: Floats) -> tuple[Floats, Floats]:
        """Return how far the vertices are off the planes of x, and the share that holds them.

        The first less what the neighbours are off themselves at x, as they are where the surface
        bends.
        """
        other = mesh.with_vertices(x)
        centres = x[mesh.faces].mean(axis=1)
        planes = (self.indptr, self.faces, other.face_normals, centres)
        usual = _middles(*planes, x)
        A = mesh.topology.adjacency
        off = _middles(*planes, mesh.vertices) - _medians_around(A.indptr, A.indices, usual)
        return off, _shares(*planes, mesh.vertices, _NEAR * np.abs(off))


def _counts(M: Any, rows: Booleans) -> csr_array:
    """Return M with ones, the other rows left empty."""
    kept = np.repeat(rows, np.diff(M.indptr))
    indptr = np.concatenate([[0], np.cumsum(np.where(rows, np.diff(M.indptr), 0))])
    return csr_array((np.ones(indptr[-1], np.int32), M.indices[kept], indptr), shape=M.shape)


@kernel
def _middles(indptr: Any, faces: Any, normals: Any, centres: Any, x: Any) -> Any:
    """Return the mean of the middle third of the distances of each x from its planes."""
    n = indptr.size - 1
    found, row = np.zeros(n), np.empty(np.max(indptr[1:] - indptr[:-1]) if n else 0)
    for i in range(n):
        count = 0
        for q in range(indptr[i], indptr[i + 1]):
            f = faces[q]
            row[count] = (
                normals[f, 0] * (x[i, 0] - centres[f, 0])
                + normals[f, 1] * (x[i, 1] - centres[f, 1])
                + normals[f, 2] * (x[i, 2] - centres[f, 2])
            )
            count += 1
        if count:
            row[:count].sort()
            found[i] = row[count // 3 : count - count // 3].mean()
    return found


@kernel
def _medians_around(indptr: Any, indices: Any, values: Any) -> Any:
    """Return the median of the values at the neighbours of each vertex."""
    n = indptr.size - 1
    found = np.zeros(n)
    for i in range(n):
        row = np.sort(values[indices[indptr[i] : indptr[i + 1]]])
        if row.size:
            found[i] = 0.5 * (row[(row.size - 1) // 2] + row[row.size // 2])
    return found


@kernel
def _shares(indptr: Any, faces: Any, normals: Any, centres: Any, x: Any, reach: Any) -> Any:
    """Return the share of its planes that are within the reach of each x."""
    n = indptr.size - 1
    found = np.zeros(n)
    for i in range(n):
        count = 0
        for q in range(indptr[i], indptr[i + 1]):
            f = faces[q]
            away = (
                normals[f, 0] * (x[i, 0] - centres[f, 0])
                + normals[f, 1] * (x[i, 1] - centres[f, 1])
                + normals[f, 2] * (x[i, 2] - centres[f, 2])
            )
            count += abs(away) < reach[i]
        if count:
            found[i] = count / (indptr[i + 1] - indptr[i])
    return found
