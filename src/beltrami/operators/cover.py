"""The tufted cover: every face twice, front and back, glued into a closed, oriented surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Integers
from beltrami.mesh.topology import Topology

BACK = [0, 2, 1]  # corner c of the back of a face is corner BACK[c] of the face


def tufted_cover(topology: Topology) -> tuple[Integers, NDArray[np.int32], NDArray[np.int32]]:
    """Return faces, twins and edges of the cover (Sharp and Crane 2020): 2m faces, 3m edges.

    Along an edge with the faces f_1 ... f_k, the copy of f_i that runs up the edge is glued to
    the copy of f_(i+1) that runs down; a face of the boundary thus to its own back. Whatever the
    mesh, each edge of the cover has two faces, and these agree on what is outside. The vertices
    are those of the mesh: a function on them is the same in front and behind.

    Examples
    --------
    >>> faces, twins, edges = tufted_cover(Topology([[0, 1, 2]], 3))
    >>> faces.tolist(), twins.tolist(), edges.max() + 1
    ([[0, 1, 2], [0, 2, 1]], [[3, 5, 4], [0, 2, 1]], np.int32(3))
    """
    m = topology.n_faces
    front = topology.faces
    sides = np.arange(3 * m)
    behind = 3 * (m + sides // 3) + np.take(BACK, sides % 3)
    start, end = (np.roll(front, -k, axis=1).ravel() for k in (1, 2))
    up, down = np.where(start < end, sides, behind), np.where(start < end, behind, sides)
    numbers = topology.face_edges.ravel()
    order = np.argsort(numbers, kind="stable")
    count = topology.edge_face_count
    following = np.roll(order, -1)
    last = np.cumsum(count) - 1
    following[last] = order[last - count + 1]
    twins, edges = np.empty(6 * m, np.int32), np.empty(6 * m, np.int32)
    twins[up[order]], twins[down[following]] = down[following], up[order]
    edges[up[order]] = edges[down[following]] = np.arange(3 * m)
    faces = np.concatenate([front, front[:, BACK]])
    return faces, twins.reshape(-1, 3), edges.reshape(-1, 3)
