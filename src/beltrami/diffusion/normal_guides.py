"""Guides: for each face the mean normal of the most even patch around it (Zhang 2015)."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._arrays import Floats
from beltrami._jit import kernel, unsigned
from beltrami.diffusion.face_rings import FaceRings
from beltrami.mesh.topology import Topology

_TINY = 1e-9


def guide_normals(topology: Topology, rings: FaceRings, normals: Floats, areas: Floats) -> Floats:
    r"""Return (m, 3) unit normals: the mean of A n over the most even ring, among those around i.

    The unevenness of the ring P of a face is
    :math:`\max_{j \in P} |n_j - g_P| \cdot \max_{e \in P} \varphi_e / \sum_{e \in P} \varphi_e`:
    how far its normals are spread, times how much of the difference
    :math:`\varphi_e = |n_f - n_g|` across its edges is in one of them. (The paper takes the
    largest difference of two normals for the spread.)
    """
    jumps = np.empty((topology.n_faces, 3))
    _jump(normals, topology.twins, jumps)
    highest, total = np.zeros(topology.n_vertices), np.zeros(topology.n_vertices)
    _gather(topology.faces, topology.twins, jumps, highest, total)
    means, uneven = np.empty_like(normals), np.empty(len(normals))
    around = unsigned(rings.indptr), unsigned(rings.indices)
    _judge(*around, topology.faces, normals, areas, jumps, highest, total, means, uneven)
    guides = np.empty_like(normals)
    _choose(*around, means, uneven, guides)
    return guides


@kernel
def _jump(normals: Any, twins: Any, jumps: Any) -> None:
    """Write |n_f - n_g| across the side opposite each corner; 0 at the boundary."""
    for i in range(normals.shape[0]):
        for c in range(3):
            twin = twins[i, c]
            if twin < 0:
                jumps[i, c] = 0
                continue
            j = twin // 3
            x = normals[i, 0] - normals[j, 0]
            y = normals[i, 1] - normals[j, 1]
            z = normals[i, 2] - normals[j, 2]
            jumps[i, c] = np.sqrt(x * x + y * y + z * z)


@kernel
def _gather(faces: Any, twins: Any, jumps: Any, highest: Any, total: Any) -> None:
    """Gather at each vertex the highest jump of its edges, and their sum; each edge once."""
    for i in range(faces.shape[0]):
        for c in range(3):
            if twins[i, c] > 3 * i + c:
                for d in range(1, 3):
                    v = faces[i, (c + d) % 3]
                    highest[v] = max(highest[v], jumps[i, c])
                    total[v] += jumps[i, c]


@kernel
def _judge(
    indptr: Any,
    indices: Any,
    faces: Any,
    normals: Any,
    areas: Any,
    jumps: Any,
    highest: Any,
    total: Any,
    means: Any,
    uneven: Any,
) -> None:
    """Write the mean normal and the unevenness of each ring."""
    one = np.uint64(1)
    for i in range(np.uint64(faces.shape[0])):
        a = b = c = 0.0
        begin, end = indptr[i], indptr[i + one]
        for q in range(begin, end):
            j = np.uint64(indices[q])
            a += areas[j] * normals[j, 0]
            b += areas[j] * normals[j, 1]
            c += areas[j] * normals[j, 2]
        size = np.sqrt(a * a + b * b + c * c)
        if not size > 0:
            a, b, c, size = normals[i, 0], normals[i, 1], normals[i, 2], 1.0
        a, b, c = a / size, b / size, c / size
        means[i, 0], means[i, 1], means[i, 2] = a, b, c
        alike = 1.0
        for q in range(begin, end):
            j = np.uint64(indices[q])
            alike = min(alike, a * normals[j, 0] + b * normals[j, 1] + c * normals[j, 2])
        largest, sum_ = 0.0, _TINY
        for k in range(3):
            v = np.uint64(faces[i, k])
            largest = max(largest, highest[v])
            sum_ += total[v] - jumps[i, k]  # sides of i are met at two of its corners
        uneven[i] = np.sqrt(2 - 2 * alike) * largest / sum_


@kernel
def _choose(indptr: Any, indices: Any, means: Any, uneven: Any, guides: Any) -> None:
    """Copy the mean of the most even ring around each face; the first of equals."""
    one = np.uint64(1)
    for i in range(np.uint64(means.shape[0])):
        begin, end = indptr[i], indptr[i + one]
        best = np.uint64(indices[begin])
        least = uneven[best]
        for q in range(begin + one, end):
            j = np.uint64(indices[q])
            less = uneven[j] < least  # both are chosen by it without a jump
            best = j if less else best
            least = uneven[j] if less else least
        for k in range(3):
            guides[i, k] = means[best, k]
