"""How a mesh bends at its edges, which tells a coarse shape from noise on a smooth one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from beltrami._arrays import Floats
from beltrami.mesh.mesh import Mesh

_ALLOWED = np.array([0.054, 0.07])  # of ``convex`` and ``along``, off those of noise
_FLAT = 1e-9  # radians: rounding
_CHANCE = 2  # standard deviations
_DRAWS = 8
_SEED = 23


@dataclass(frozen=True)
class Bends:
    """Of a mesh in space; 0 where nothing bends.

    Attributes
    ----------
    convex
        The convex edges less the concave ones, over all that have two faces. A face without an
        area bends to no side.
    along
        Correlation of ranks (Spearman) of how far an edge bends with how long it is beside the
        other diagonal of its two faces: low where long edges lie in what is flat, as in quads that
        were halved.
    """

    convex: float
    along: float

    @classmethod
    def of(cls, mesh: Mesh) -> Bends:
        """Measure them.

        Examples
        --------
        >>> from beltrami.mesh.shapes import icosphere
        >>> Bends.of(icosphere(1)).convex
        1.0
        """
        side, other, agree = pairs = mesh.topology.face_pairs
        corners, (f, g) = mesh.faces.ravel(), pairs.faces.T
        start, end = (mesh.faces[f, (side + more) % 3] for more in (1, 2))
        x, normals = mesh.vertices, mesh.face_normals
        edge, diagonal = x[end] - x[start], x[corners[other]] - x[corners[side]]
        beside = np.where(agree, 1.0, -1.0)[:, None] * normals[g]
        # seen along the edge, the other normal is turned to the left where it is convex
        turn = np.einsum("ij,ij->i", np.cross(normals[f], beside), edge)
        cosine = np.einsum("ij,ij->i", normals[f], beside)
        lengths, across = np.linalg.norm(edge, axis=1), np.linalg.norm(diagonal, axis=1)
        kept = (lengths > 0) & (across > 0)
        if not kept.any():
            return cls(0.0, 0.0)
        angle = np.arctan2(turn[kept] / lengths[kept], cosine[kept])
        angle[np.abs(angle) < _FLAT] = 0.0
        ranks = _ranks(np.abs(angle)), _ranks(lengths[kept] / across[kept])
        spread = float(np.sqrt((ranks[0] ** 2).sum() * (ranks[1] ** 2).sum()))
        along = float(ranks[0] @ ranks[1]) / spread if spread > 0 else 0.0
        return cls(float(np.sign(angle).mean()), along)


def unlike_noise(mesh: Mesh, clean: Mesh, noise: Callable[[Floats], Floats]) -> float:
    r"""Return how unlike noise the mesh bends: above 1, what a first result lacks of it is shape.

    Where few vertices make a shape, its details are as even as noise. But shapes are convex more
    often than concave, or less; and their edges are long where they are flat. Noise knows neither
    sides nor edges. What it does on such a mesh is measured on the first result with noise upon it;
    the more of the details are noise, the less is the mesh unlike that.

    Parameters
    ----------
    mesh, clean
        The noisy mesh, and the first result.
    noise
        Makes noise (n, 1) along the normals of ``clean`` of white noise.

    Notes
    -----
    Two standard deviations of noise count for nothing: on few vertices it may bend like that by
    chance. Cost: O(n), and eight times ``noise``.
    """
    found, random = Bends.of(mesh), np.random.default_rng(_SEED)
    alike = np.empty((_DRAWS, 2))
    for draw in alike:
        way = noise(random.standard_normal((mesh.n_vertices, 1)))
        one = Bends.of(clean.with_vertices(clean.vertices + way * clean.vertex_normals))
        draw[:] = one.convex, one.along
    way = np.array([found.convex, found.along]) - alike.mean(axis=0)
    way[1] = min(way[1], 0.0)
    unlike = (way**2 - (_CHANCE * alike.std(axis=0, ddof=1)) ** 2) / _ALLOWED**2
    return float(np.sqrt(np.maximum(unlike, 0.0).sum()))


def _ranks(values: Floats) -> Floats:
    """Return the ranks, less their mean; equal values share theirs."""
    _, same, count = np.unique(values, return_inverse=True, return_counts=True)
    last = np.cumsum(count)
    ranks = (last - (count - 1) / 2)[same]
    return np.asarray(ranks - ranks.mean())
