"""A barrier between parts of a boundary, so that it slides along itself and does not stick."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami._jit import kernel
from beltrami.mesh.mesh import Mesh
from beltrami.parameterization.block_pattern import BlockPattern

_REACH = 0.25  # of the shorter one of an edge, the height of its face, the edges at a vertex


@dataclass(frozen=True, eq=False)
class Barrier:
    r""":math:`\sum w_e \max(r / d - 1, 0)^2` over the vertices and edges of a boundary.

    With the distance d of a vertex from an edge that does not end there, and a reach r: infinite
    where they touch, 0 where they are not near (J. Smith, S. Schaefer, Bijective parameterization
    with free boundaries, 2015). Reaches are a quarter of the edges as they are now; or of the
    height of the face over an edge if that is less, lest the far corner of a needle is pushed away
    from its own face, for which there is the energy of the face.

    Attributes
    ----------
    vertices : (b,) int, edges : (b, 2) int
        Of the boundary.
    near_vertices, near_edges : (b,)
        Their reaches; of a pair it is the shorter one.
    weights : (b,)
        Squares of the lengths of the edges on the surface, over its area.
    """

    vertices: Integers
    edges: Integers
    near_vertices: Floats
    near_edges: Floats
    weights: Floats

    def energy(self, x: Floats) -> float:
        """Return the sum. Cost: O(b log b) for boundaries that do not run along one line."""
        nothing, none = np.zeros((0, 2)), np.zeros(0, np.int64)
        return self._visit(x, none, none, none, nothing, nothing[:, 0], False)

    def add_derivatives(
        self, x: Floats, pattern: BlockPattern, gradient: Floats, entries: Floats
    ) -> None:
        """Add the gradient, and a bound of the Hessian: blocks on the diagonal alone.

        The square of a sum of three movements is at most the sum of their squares with weights
        that add to the same, so no entries are needed where no edge of the mesh is.
        """
        slots = pattern.number, pattern.widths, pattern.vertex_slots
        self._visit(x, *slots, gradient, entries, True)

    def _visit(self, x: Floats, *rest: Any) -> float:
        order = self.vertices[np.argsort(x[self.vertices, 0], kind="stable")]
        return float(
            _visit(x, order, self.edges, self.near_vertices, self.near_edges, self.weights, *rest)
        )


def boundary_barrier(mesh: Mesh, x: Floats) -> Barrier:
    """Return the barrier whose reaches are those of the positions x."""
    face, corner = np.nonzero(mesh.topology.twins < 0)
    edges = mesh.faces[face[:, None], (corner[:, None] + [1, 2]) % 3]
    side, up = x[edges[:, 1]] - x[edges[:, 0]], x[mesh.faces[face, corner]] - x[edges[:, 0]]
    lengths = np.hypot(side[:, 0], side[:, 1])
    doubled = np.abs(side[:, 0] * up[:, 1] - side[:, 1] * up[:, 0])
    heights = np.divide(doubled, lengths, where=lengths > 0, out=np.zeros_like(lengths))
    near_vertices = np.full(mesh.n_vertices, np.inf)
    np.minimum.at(near_vertices, edges.ravel(), np.repeat(_REACH * lengths, 2))
    ends = mesh.vertices[edges]
    weights = ((ends[:, 1] - ends[:, 0]) ** 2).sum(axis=1) / mesh.area
    near_edges = _REACH * np.minimum(lengths, heights)
    return Barrier(np.unique(edges), edges, near_vertices, near_edges, weights)


@kernel
def _visit(
    x: Any, vertices: Any, edges: Any, near_vertices: Any, near_edges: Any, weights: Any,
    number: Any, widths: Any, slots: Any, gradient: Any, entries: Any, derive: bool,
) -> float:  # fmt: skip
    """Sum over the near pairs; the vertices come from the left to the right."""
    total = 0.0
    count = vertices.size
    for e in range(edges.shape[0]):
        i, j = edges[e, 0], edges[e, 1]
        reach = near_edges[e]
        left, right = min(x[i, 0], x[j, 0]) - reach, max(x[i, 0], x[j, 0]) + reach
        low, high = min(x[i, 1], x[j, 1]) - reach, max(x[i, 1], x[j, 1]) + reach
        sx, sy = x[j, 0] - x[i, 0], x[j, 1] - x[i, 1]
        square = sx * sx + sy * sy
        first, last = 0, count
        while first < last:
            middle = (first + last) // 2
            if x[vertices[middle], 0] < left:
                first = middle + 1
            else:
                last = middle
        for q in range(first, count):
            v = vertices[q]
            if x[v, 0] > right:
                break
            if v in (i, j) or x[v, 1] < low or x[v, 1] > high:
                continue
            along = ((x[v, 0] - x[i, 0]) * sx + (x[v, 1] - x[i, 1]) * sy) / square
            along = min(max(along, 0.0), 1.0)
            nx, ny = x[v, 0] - x[i, 0] - along * sx, x[v, 1] - x[i, 1] - along * sy
            distance = np.hypot(nx, ny)
            r = min(reach, near_vertices[v])
            if distance >= r:
                continue
            if distance == 0.0:
                return np.inf
            ratio = r / distance
            total += weights[e] * (ratio - 1) ** 2
            if not derive:
                continue
            nx, ny = nx / distance, ny / distance
            slope = -2 * weights[e] * (ratio - 1) * ratio / distance
            bend = weights[e] * (2 * ratio * ratio + 4 * (ratio - 1) * ratio) / distance**2
            for u, share in ((v, 1.0), (i, along - 1.0), (j, -along)):
                k = number[u]
                if k < 0:
                    continue
                gradient[k, 0] += share * slope * nx
                gradient[k, 1] += share * slope * ny
                size = 2 * abs(share) * bend
                entries[slots[k]] += size * nx * nx
                entries[slots[k] + widths[k] + 1] += size * ny * ny
                entries[slots[k] + widths[k]] += size * nx * ny
                entries[slots[k] + 1] += size * nx * ny
    return total
