"""Rings: who is around a vertex (definitions 3 and 4, equations 3.1 and 3.2)."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.sparse import csr_array

from beltrami._arrays import Integers
from beltrami._jit import kernel
from beltrami.errors import check_name
from beltrami.mesh.edge_matrix import symmetric_matrix

RING_KINDS = ("exact", "ball", "walk")


def adjacency_matrix(edges: Integers, n: int) -> csr_array:
    """Return the symmetric (n, n) matrix A with A_ij = 1 on the edges, rows sorted; O(n + p).

    Chapter items: Q3.1, U2, P5, P6, P7.
    """
    return symmetric_matrix(edges, np.ones(len(edges)), n)


def incident_faces(faces: Integers, n: int) -> csr_array:
    """Return the (n, m) matrix whose row i marks the faces around vertex i (definition 4, E7).

    Chapter items: D4, U7.
    """
    indptr, indices = _faces_of_vertices(faces, n)
    return csr_array((np.ones(len(indices)), indices, indptr), shape=(n, len(faces)))


def vertex_ring(adjacency: csr_array, i: int, s: int, kind: str) -> Integers:
    """Return the s-ring of vertex i, sorted.

    The recursion (3.2) of the chapter can be read in three ways, which differ (erratum E6):
    ``"exact"`` is {j : distance = s}, ``"ball"`` {j : 0 < distance <= s} and ``"walk"`` the ends
    of the walks of s edges, as printed: i itself is among them for s = 2.

    Chapter items: D3, Q3.1, Q3.2.

    Raises
    ------
    UnknownNameError
        If ``kind`` is none of the three.

    Examples
    --------
    >>> square = adjacency_matrix(np.array([[0, 1], [0, 3], [1, 2], [2, 3]]), 4)
    >>> [vertex_ring(square, 0, 2, kind).tolist() for kind in ("exact", "ball", "walk")]
    [[2], [1, 2, 3], [0, 2]]
    """
    check_name("kind of ring", kind, RING_KINDS)
    indptr, indices = adjacency.indptr, adjacency.indices
    seen = {i}
    front = {i}
    for _ in range(s):
        if not front:
            break  # everything has been reached
        step = {int(j) for v in front for j in indices[indptr[v] : indptr[v + 1]]}
        front = step if kind == "walk" else step - seen
        seen |= front
    members = front if kind in ("exact", "walk") else seen - {i}
    return np.array(sorted(members), dtype=np.int64)


@kernel
def _faces_of_vertices(faces: Any, n: int) -> Any:
    """CSR of the faces of each vertex; a face that names a vertex twice counts once there."""
    m = faces.shape[0]
    indptr = np.zeros(n + 1, np.int32)
    for f in range(m):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        indptr[i + 1] += 1
        if j != i:
            indptr[j + 1] += 1
        if k not in (i, j):
            indptr[k + 1] += 1
    for i in range(n):
        indptr[i + 1] += indptr[i]
    place = indptr[:n].copy()
    indices = np.empty(indptr[n], np.int32)
    for f in range(m):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        indices[place[i]] = f
        place[i] += 1
        if j != i:
            indices[place[j]] = f
            place[j] += 1
        if k not in (i, j):
            indices[place[k]] = f
            place[k] += 1
    return indptr, indices
