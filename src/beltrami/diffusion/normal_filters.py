"""Bilateral and guided filters of the normals of faces (Zheng 2011, Zhang 2015)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from beltrami._arrays import Floats
from beltrami._jit import kernel, unsigned
from beltrami.diffusion.face_rings import FaceRings
from beltrami.diffusion.normal_guides import guide_normals
from beltrami.mesh.mesh import Mesh


def filtered_normals(
    mesh: Mesh, rings: FaceRings, contrast: float, *, guided: bool = False
) -> Iterator[Floats]:
    r"""Yield the normals (m, 3) after one round of the filter, after two, and so on.

    One round is :math:`n_i \leftarrow \sum_j A_j e^{-|c_i - c_j|^2 / 2\sigma_c^2}
    e^{-|g_i - g_j|^2 / 2\sigma^2} n_j`, made of length 1, over the faces j that share a vertex
    with i: A are areas, c centroids, σ the ``contrast``, and σ_c the mean distance of the
    centroids of faces that share an edge. Faces whose normals g differ by much more than σ have no
    say: creases stay.

    Bilateral: g = n, the normals of the last round (Zheng, Fu, Au and Tai 2011). Guided: g are
    means over the most even patch around each face, which noise disturbs less, and σ_c is twice as
    large (Zhang, Deng, Zhang, Bouaziz and Liu 2015).

    Cost of a round: O(13 m), guided about three times that.
    """
    corners = mesh.vertices[mesh.faces]
    centres = np.asarray((corners[:, 0] + corners[:, 1] + corners[:, 2]) / 3)
    areas = mesh.face_areas
    normals = np.array(mesh.face_normals)
    sigma = _mean_distance(mesh.topology.twins, centres) * (2 if guided else 1)
    starts, later = np.empty(len(normals) + 1, np.int64), np.empty(len(rings.indices), np.int32)
    later = unsigned(later[: _later(*rings, starts, later)].copy())
    near, weights = np.empty(len(later)), np.empty(int(np.diff(starts).max(initial=0)))
    _weigh(starts, later, centres, -0.5 / sigma**2 if sigma > 0 else 0.0, near)
    state = np.empty((len(normals), 9))
    while True:
        guides = guide_normals(mesh.topology, rings, normals, areas) if guided else normals
        _lay_out(guides, areas, normals, state)
        filtered = np.empty_like(normals)
        _filter(unsigned(starts), later, near, -1 / contrast**2, state, normals, weights, filtered)
        normals = filtered
        yield normals


@kernel
def _mean_distance(twins: Any, centres: Any) -> float:
    """Return the mean distance of the centroids of faces that share an edge."""
    total, count = 0.0, 0
    for i in range(twins.shape[0]):
        for k in range(3):
            j = twins[i, k] // 3
            if j > i:
                a = centres[i, 0] - centres[j, 0]
                b = centres[i, 1] - centres[j, 1]
                c = centres[i, 2] - centres[j, 2]
                total += np.sqrt(a * a + b * b + c * c)
                count += 1
    return total / count if count else 0.0


@kernel
def _later(indptr: Any, indices: Any, starts: Any, later: Any) -> int:
    """Keep of each ring the faces of larger numbers, so that each pair of faces is met once."""
    size = 0
    starts[0] = 0
    for i in range(starts.size - 1):
        for q in range(indptr[i], indptr[i + 1]):
            if indices[q] > i:
                later[size] = indices[q]
                size += 1
        starts[i + 1] = size
    return size


@kernel
def _weigh(starts: Any, later: Any, centres: Any, factor: float, near: Any) -> None:
    """Write exp(factor |c_i - c_j|²) of each pair."""
    for i in range(centres.shape[0]):
        for q in range(starts[i], starts[i + 1]):
            j = later[q]
            a = centres[i, 0] - centres[j, 0]
            b = centres[i, 1] - centres[j, 1]
            c = centres[i, 2] - centres[j, 2]
            near[q] = np.exp(factor * (a * a + b * b + c * c))


@kernel
def _lay_out(guides: Any, areas: Any, normals: Any, state: Any) -> None:
    """Write rows of g, A n and 0, as ``_filter`` reads them."""
    for i in range(areas.size):
        for k in range(3):
            state[i, k] = guides[i, k]
            state[i, 3 + k] = areas[i] * normals[i, k]
            state[i, 6 + k] = 0.0


@kernel
def _filter(
    starts: Any,
    later: Any,
    near: Any,
    factor: float,
    state: Any,
    normals: Any,
    weights: Any,
    filtered: Any,
) -> None:
    """Write one round; |g_i - g_j|² / 2 is 1 - g_i g_j, and ``factor`` is -1/σ².

    A row of ``state`` has g, A n, and the sum over the faces before; what lies together is
    loaded together. ``weights`` has room for the pairs of a face: powers are computed side by side.
    """
    one = np.uint64(1)
    for i in range(np.uint64(normals.shape[0])):
        g0, g1, g2 = state[i, 0], state[i, 1], state[i, 2]
        n0, n1, n2 = state[i, 3], state[i, 4], state[i, 5]
        a, b, c = state[i, 6] + n0, state[i, 7] + n1, state[i, 8] + n2
        begin = starts[i]
        count = starts[i + one] - begin
        for q in range(count):
            j = np.uint64(later[begin + q])
            alike = g0 * state[j, 0] + g1 * state[j, 1] + g2 * state[j, 2]
            weights[q] = factor * (1 - alike)
        for q in range(count):
            weights[q] = near[begin + q] * np.exp(weights[q])
        for q in range(count):
            j, w = np.uint64(later[begin + q]), weights[q]
            a += w * state[j, 3]
            b += w * state[j, 4]
            c += w * state[j, 5]
            state[j, 6] += w * n0
            state[j, 7] += w * n1
            state[j, 8] += w * n2
        size = np.sqrt(a * a + b * b + c * c)
        if size > 0:
            filtered[i, 0] = a / size
            filtered[i, 1] = b / size
            filtered[i, 2] = c / size
        else:
            for k in range(3):
                filtered[i, k] = normals[i, k]
