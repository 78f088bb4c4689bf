"""The certificate: whether a map to the plane is a bijection, decided exactly (theorem 21)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Booleans, Floats, Integers, as_function, read_only
from beltrami.errors import DimensionError
from beltrami.mesh.door import topology_of
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.topology import Topology
from beltrami.operators.soundness import require_faces
from beltrami.parameterization.crossings import crossings
from beltrami.parameterization.predicates import orientation


@dataclass(frozen=True, eq=False, repr=False)
class Certificate:
    """What is known, exactly, of a map of the vertices to the plane.

    Attributes
    ----------
    flipped : int array
        The faces whose image does not turn counter-clockwise: turned over, or without area.
    crossings : (q, 2, 2) int
        Pairs of boundary edges whose images meet where they should not.
    turned_loops : tuple of int arrays
        Boundary loops that run the wrong way round: all but one of each component are to run
        clockwise, as the edges of holes do.
    nested : (q, 2) int
        Components of which one lies inside another.
    """

    flipped: Integers
    crossings: Integers
    turned_loops: tuple[Integers, ...]
    nested: Integers

    @property
    def is_bijective(self) -> bool:
        """Whether each point of the image has one original: nothing of the above was found."""
        return not (
            len(self.flipped) or len(self.crossings) or len(self.turned_loops) or len(self.nested)
        )

    def __repr__(self) -> str:
        verdict = "a bijection" if self.is_bijective else "no bijection"
        return (
            f"<Certificate: {verdict}; {len(self.flipped)} flipped faces, {len(self.crossings)} "
            f"crossings of the boundary>"
        )


def certify(domain: Mesh | Topology, uv: ArrayLike) -> Certificate:
    r"""Decide whether a map to the plane, linear on the faces, is a bijection onto its image.

    All faces turn counter-clockwise and the boundary crosses itself nowhere: then the number of
    originals of a point is the number of times that the boundary winds around it, which is 1 or
    0 if one loop of each component runs counter-clockwise and the holes run clockwise. Positive
    areas alone do not tell: a boundary that winds twice has them too (E89).

    Chapter items: T21, U38.

    Parameters
    ----------
    domain
        The faces, oriented: a Mesh, whose positions do not matter, or a Topology.
    uv
        (n, 2) positions.

    Raises
    ------
    EmptyMeshError, DegenerateFaceError
        If there are no faces, or one names a vertex twice.
    DimensionError, NonFiniteError
        If ``uv`` has another shape, or values that are not finite.

    Notes
    -----
    Signs are those of the exact determinants of the given doubles. Cost: O(m) and the crossings.

    Examples
    --------
    >>> square = Topology([[0, 1, 2], [0, 2, 3]])
    >>> certify(square, [[0, 0], [1, 0], [1, 1], [0, 1]]).is_bijective
    True
    >>> certify(square, [[0, 0], [1, 0], [1, 1], [2, 0.5]])
    <Certificate: no bijection; 1 flipped faces, 1 crossings of the boundary>
    """
    topology = topology_of(domain)
    require_faces(topology)
    x = as_map(uv, topology.n_vertices)
    faces = topology.faces
    signs = orientation(x[faces[:, 0]], x[faces[:, 1]], x[faces[:, 2]])
    edges = topology.boundary_edges
    met = crossings(x, edges)
    loops = topology.boundary_loops
    label = np.full(topology.n_vertices, -1)
    label[faces.ravel()] = np.repeat(topology.components(), 3)
    own: list[list[Integers]] = [[] for _ in range(int(label.max(initial=-1)) + 1)]
    for loop in loops:
        own[label[loop[0]]].append(loop)
    return Certificate(
        read_only(np.flatnonzero(signs <= 0)),
        read_only(edges[met]),
        _turned(x, own),
        read_only(_nested(x, own, label)),
    )


def as_map(uv: ArrayLike, n: int) -> Floats:
    """Check a map of n vertices to the plane."""
    x = as_function(uv, n, "the map")
    if x.shape != (n, 2):
        raise DimensionError(f"the map has the shape {x.shape} where ({n}, 2) is needed")
    return x


def _turned(x: Floats, loops: list[list[Integers]]) -> tuple[Integers, ...]:
    """Return the loops too many that run counter-clockwise, and those of components without one."""
    wrong: list[Integers] = []
    for own in loops:
        outer = [loop for loop in own if turns_left(x[loop])]
        wrong += outer[1:] if outer else own[:1]
    return tuple(wrong)


def turns_left(polygon: Floats) -> bool:
    """Whether a simple polygon runs counter-clockwise: so it turns at its lowest corner."""
    count = len(polygon)
    lowest = int(np.lexsort(polygon.T)[0])
    if count < 3:
        return False
    a, b, c = (polygon[(lowest + step) % count][None] for step in (-1, 0, 1))
    return bool(orientation(a, b, c)[0] > 0)


def _nested(x: Floats, loops: list[list[Integers]], label: Integers) -> Integers:
    """Return pairs (inner, outer) of components whose boundary winds around another one."""
    count = len(loops)
    if count < 2:
        return np.zeros((0, 2), np.int64)
    named = np.flatnonzero(label >= 0)
    low, high = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
    np.minimum.at(low, label[named], x[named])
    np.maximum.at(high, label[named], x[named])
    _, first = np.unique(label[named], return_index=True)
    found = []
    for inner in range(count):
        point = x[named[first[inner]]]
        inside = ((low < point) & (point < high)).all(axis=1)
        for outer in np.flatnonzero(inside):
            if outer != inner and sum(_winding(x[loop], point) for loop in loops[outer]):
                found.append((inner, int(outer)))
    return np.array(found, np.int64).reshape(-1, 2)


def _winding(polygon: Floats, point: Floats) -> int:
    """Return how often a polygon winds around a point that is not on it."""
    after = np.roll(polygon, -1, axis=0)
    below: Booleans = polygon[:, 1] <= point[1]
    up, down = below & (after[:, 1] > point[1]), ~below & (after[:, 1] <= point[1])
    side = orientation(polygon, after, np.broadcast_to(point, polygon.shape))
    return int(np.count_nonzero(up & (side > 0)) - np.count_nonzero(down & (side < 0)))
