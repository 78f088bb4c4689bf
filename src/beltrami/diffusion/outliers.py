"""Outliers of the rough part of a mesh: made by sharp features, or by spikes of the noise."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from beltrami._arrays import Booleans, Floats
from beltrami.diffusion.bends import unlike_noise
from beltrami.diffusion.lengths import lengths_around
from beltrami.diffusion.level import clipped_level, rough_values
from beltrami.diffusion.noise import Differences
from beltrami.mesh.mesh import Mesh

_SHORT = 1.5  # times the median
# over what goes beside a first result, of the square of the shape's outliers; if it bends so
_LEFT, _LEFT_IF_UNLIKE = 0.55, 0.9


@dataclass(frozen=True)
class RoughPart:
    """Of a noisy mesh, beside a first result.

    Sharp features make outliers of the rough part, but not of this one, as averages by the normals
    of the first result stay on their side; spikes are far off all their neighbours.

    Attributes
    ----------
    level, spread
        Standard deviation, outliers left out and counted in, in the unit of length.
    """

    level: float
    spread: float


def rough_part(mesh: Mesh, clean: Mesh) -> RoughPart:
    """Measure it, as ``level_beside``; on a mesh without edges, of no size."""
    return _part(rough_values(mesh, clean)[0][0])


def are_of_shape(mesh: Mesh, normals: Floats, clean: Mesh) -> bool:
    """Whether outliers of the rough part along the normals are the shape's.

    They are if more of their square goes than is left beside ``clean``, a first result, which tells
    on which side of a crease a vertex is; or nearly as much, on a mesh that does not bend like one
    with noise. What a shape leaves in a rough part grows with the edges, and spikes do not: so it
    is enough if this is so where edges are short.

    Notes
    -----
    Cost: O(n), with some hundred operations for each vertex, and nine times ``Bends.of``.
    """
    values, kept = rough_values(mesh, clean)[0]
    K, norms = Differences.of(mesh.topology.adjacency)
    before = np.einsum("ij,ij->i", K @ (K @ mesh.vertices), normals) / norms[1]
    everywhere = np.ones(mesh.n_vertices, np.bool_)
    left = np.inf
    for where in (everywhere, among_short_edges(clean)):
        rough = _part(values[where[kept]])
        gone = float(np.mean(before[where] ** 2)) - rough.spread**2
        if gone > 0:
            left = min(left, (rough.spread**2 - rough.level**2) / gone)
    if left < _LEFT or left >= _LEFT_IF_UNLIKE:
        return left < _LEFT
    spread = _part(values).spread
    return unlike_noise(mesh, clean, lambda white: spread * white) > 1


def among_short_edges(mesh: Mesh) -> Booleans:
    """(n,) bool: vertices whose edges are not much longer than those of half of the vertices."""
    length = lengths_around(mesh, mesh.vertices)
    return np.asarray(length <= _SHORT * np.median(length))


def _part(values: Floats) -> RoughPart:
    if not len(values):
        return RoughPart(0.0, 0.0)
    return RoughPart(clipped_level(values), float(np.sqrt(np.mean(values**2))))
