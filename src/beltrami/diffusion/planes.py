"""Planes around a vertex: how far it is off the faces beside its own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats
from beltrami._jit import kernel, part_of_kernels, unsigned
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.topology import Topology

_MANY = 64  # neighbours, from which vertices are not looked at: their rings are the whole mesh
_SHORT = 64  # values, up to which all of them are compared faster than they are sorted


@dataclass(frozen=True, eq=False)
class PlanesAround:
    """The faces around the neighbours of each vertex, but its own.

    Attributes
    ----------
    indptr, faces
        Those of the vertex i are ``faces[indptr[i] : indptr[i + 1]]``; none, if it has more than 64
        neighbours, and none around such a neighbour.
    """

    indptr: NDArray[np.uint64]
    faces: NDArray[np.uint32]

    @classmethod
    def of(cls, topology: Topology) -> PlanesAround:
        """Collect them. Cost: O(n), some 40 looks for a vertex.

        Examples
        --------
        >>> around = PlanesAround.of(Topology([[0, 1, 2], [2, 1, 3], [3, 4, 5]]))
        >>> around.indptr.tolist(), around.faces.tolist()
        ([0, 1, 2, 3, 4, 5, 6], [1, 2, 2, 0, 1, 1])
        """
        A, F = topology.adjacency, topology.vertex_faces
        near = unsigned(A.indptr), unsigned(A.indices)
        around = unsigned(F.indptr), unsigned(F.indices)
        indptr = np.zeros(topology.n_vertices + 1, np.uint64)
        faces = np.empty(_bound(*near, around[0]), np.uint32)
        size = _collect(*near, *around, topology.n_faces, indptr, faces)
        return cls(indptr, faces[:size].copy())

    def off(self, planes: Floats, mesh: Mesh, x: Floats) -> Floats:
        """Return how far vertices are off the planes of x, (n,), less what their neighbours are.

        That is the mean of the middle third of the distances, less the median of those that the
        neighbours have at x, as they have where the surface bends.

        Parameters
        ----------
        planes
            Those of x: see ``planes_of``.
        """
        here, usual = np.empty(len(x)), np.empty(len(x))
        most = int(np.diff(self.indptr).max(initial=0))
        _middles(self.indptr, self.faces, planes, x, mesh.vertices, most, usual, here)
        A = mesh.topology.adjacency
        most = int(np.diff(A.indptr).max(initial=0))
        _less_medians(unsigned(A.indptr), unsigned(A.indices), usual, most, here)
        return here

    def shares(self, planes: Floats, x: Floats, reach: Floats) -> Floats:
        """Return the share of its planes that each x is nearer to than its reach, (n,)."""
        found = np.zeros(len(x))
        _share(self.indptr, self.faces, planes, x, reach, found)
        return found


def planes_of(mesh: Mesh) -> Floats:
    """Return the normals and the centroids of the faces side by side, (m, 6)."""
    planes = np.empty((mesh.n_faces, 6))
    _lay_out(mesh.faces, mesh.vertices, mesh.face_normals, planes)
    return planes


@kernel
def _lay_out(faces: Any, x: Any, normals: Any, planes: Any) -> None:
    """Write them."""
    for j in range(np.uint64(planes.shape[0])):
        f, g, h = np.uint64(faces[j, 0]), np.uint64(faces[j, 1]), np.uint64(faces[j, 2])
        for k in range(3):
            planes[j, k] = normals[j, k]
            planes[j, 3 + k] = (x[f, k] + x[g, k] + x[h, k]) / 3


@kernel
def _bound(indptr: Any, indices: Any, around: Any) -> int:
    """Return how many faces there are around the neighbours, those of two counted twice."""
    one, bound = np.uint64(1), 0
    for i in range(np.uint64(indptr.size - 1)):
        if indptr[i + one] - indptr[i] <= _MANY:
            for q in range(np.uint64(indptr[i]), np.uint64(indptr[i + one])):
                j = np.uint64(indices[q])
                if indptr[j + one] - indptr[j] <= _MANY:
                    bound += around[j + one] - around[j]
    return bound


@kernel
def _collect(
    indptr: Any, indices: Any, around: Any, members: Any, m: int, starts: Any, faces: Any
) -> int:
    """Write each face once; a stamp says which ones the vertex has, or has met."""
    one, size = np.uint64(1), np.uint64(0)
    stamp = np.full(m, indptr.size, np.uint32)  # no vertex
    for i in range(np.uint64(indptr.size - 1)):
        if indptr[i + one] - indptr[i] <= _MANY:
            for q in range(np.uint64(around[i]), np.uint64(around[i + one])):
                stamp[np.uint64(members[q])] = i
            for q in range(np.uint64(indptr[i]), np.uint64(indptr[i + one])):
                j = np.uint64(indices[q])
                if indptr[j + one] - indptr[j] > _MANY:
                    continue
                for p in range(np.uint64(around[j]), np.uint64(around[j + one])):
                    f = np.uint64(members[p])
                    if stamp[f] != i:
                        stamp[f] = i
                        faces[size] = f
                        size += one
        starts[i + one] = size
    return int(size)


@part_of_kernels
def _order(row: Any, n: Any, ordered: Any) -> None:
    """Write the first n values in ascending order; the row has room for three more.

    The place of a value is the number of smaller ones; equal ones have the same, and leave the
    places after it empty. To count them all takes n² comparisons, but no jumps that the processor
    might guess wrong: for some twenty values, a fifth of the time of sorting.
    """
    if n > _SHORT:
        ordered[: np.int64(n)] = np.sort(row[: np.int64(n)])
        return
    four, three = np.uint64(4), np.uint64(3)
    full = (n + three) // four * four  # as many as the processor compares at a time
    for k in range(n, full):
        row[k] = np.inf
    for k in range(n):
        ordered[k] = -np.inf
    for k in range(n):
        value, place = row[k], np.uint64(0)
        for p in range(full):
            place += np.uint64(row[p] < value)
        ordered[place] = value
    last = -np.inf
    for k in range(n):
        last = max(last, ordered[k])
        ordered[k] = last


@part_of_kernels
def _distance(planes: Any, f: Any, x: Any, y: Any, z: Any) -> Any:
    return (
        planes[f, 0] * (x - planes[f, 3])
        + planes[f, 1] * (y - planes[f, 4])
        + planes[f, 2] * (z - planes[f, 5])
    )


@part_of_kernels
def _middle(
    planes: Any, faces: Any, begin: Any, end: Any, x: Any, i: Any, row: Any, ordered: Any
) -> float:
    """Return the mean of the middle third of the distances of x_i from the planes."""
    n = end - begin
    a, b, c = x[i, 0], x[i, 1], x[i, 2]
    for k in range(n):
        row[k] = _distance(planes, np.uint64(faces[begin + k]), a, b, c)
    _order(row, n, ordered)
    third, total = n // np.uint64(3), 0.0
    for k in range(third, n - third):
        total += ordered[k]
    return total / np.float64(n - third - third)


@kernel
def _middles(
    indptr: Any, faces: Any, planes: Any, x: Any, y: Any, most: int, of_x: Any, of_y: Any
) -> None:
    """Write the mean of the middle third of the distances from its planes, of each x and y.

    At most vertices x and y are the same. ``most`` is the largest number of planes.
    """
    one = np.uint64(1)
    row, ordered = np.empty(most + 3), np.empty(most)
    for i in range(np.uint64(indptr.size - 1)):
        begin, end = indptr[i], indptr[i + one]
        if begin == end:
            of_x[i] = of_y[i] = 0.0
            continue
        of_x[i] = of_y[i] = _middle(planes, faces, begin, end, x, i, row, ordered)
        if x[i, 0] != y[i, 0] or x[i, 1] != y[i, 1] or x[i, 2] != y[i, 2]:
            of_y[i] = _middle(planes, faces, begin, end, y, i, row, ordered)


@kernel
def _less_medians(indptr: Any, indices: Any, values: Any, most: int, found: Any) -> None:
    """Subtract the median of the values at the neighbours of each vertex; ``most`` has the most."""
    one, two = np.uint64(1), np.uint64(2)
    row, ordered = np.empty(most + 3), np.empty(most)
    for i in range(np.uint64(indptr.size - 1)):
        begin, end = np.uint64(indptr[i]), np.uint64(indptr[i + one])
        n = end - begin
        if n > 0:
            for k in range(n):
                row[k] = values[np.uint64(indices[begin + k])]
            _order(row, n, ordered)
            found[i] -= 0.5 * (ordered[(n - one) // two] + ordered[n // two])


@kernel
def _share(indptr: Any, faces: Any, planes: Any, x: Any, reach: Any, found: Any) -> None:
    """Write the share of the planes within reach; nothing is within 0."""
    one = np.uint64(1)
    for i in range(np.uint64(indptr.size - 1)):
        begin, end = indptr[i], indptr[i + one]
        if reach[i] > 0 and end > begin:
            count = 0
            for q in range(begin, end):
                f = np.uint64(faces[q])
                count += abs(_distance(planes, f, x[i, 0], x[i, 1], x[i, 2])) < reach[i]
            found[i] = count / np.float64(end - begin)
