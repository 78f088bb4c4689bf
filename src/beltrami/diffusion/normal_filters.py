"""Bilateral and guided filters of the normals of faces (Zheng 2011, Zhang 2015)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from beltrami._arrays import Floats
from beltrami._jit import kernel
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
    centres = np.asarray(mesh.vertices[mesh.faces].mean(axis=1))
    areas = mesh.face_areas
    normals = np.array(mesh.face_normals)
    sigma = _mean_distance(mesh, centres) * (2 if guided else 1)
    near = np.empty(len(rings.indices))
    _weigh(*rings, centres, areas, -0.5 / sigma**2 if sigma > 0 else 0.0, near)
    while True:
        guides = guide_normals(mesh.topology, rings, normals, areas) if guided else normals
        filtered = np.empty_like(normals)
        _filter(*rings, near, guides, -1 / contrast**2, normals, filtered)
        normals = filtered
        yield normals


def _mean_distance(mesh: Mesh, centres: Floats) -> float:
    """Return the mean distance of the centroids of faces that share an edge."""
    twins = mesh.topology.twins.ravel()
    paired = np.flatnonzero(twins >= 0)
    if not len(paired):
        return 0.0
    apart = centres[paired // 3] - centres[twins[paired] // 3]
    return float(np.linalg.norm(apart, axis=1).mean())


@kernel
def _weigh(indptr: Any, indices: Any, centres: Any, areas: Any, factor: float, near: Any) -> None:
    """Write A_j exp(factor |c_i - c_j|²) for each face j of the ring of i."""
    for i in range(centres.shape[0]):
        for q in range(indptr[i], indptr[i + 1]):
            j = indices[q]
            a = centres[i, 0] - centres[j, 0]
            b = centres[i, 1] - centres[j, 1]
            c = centres[i, 2] - centres[j, 2]
            near[q] = areas[j] * np.exp(factor * (a * a + b * b + c * c))


@kernel
def _filter(
    indptr: Any, indices: Any, near: Any, guides: Any, factor: float, normals: Any, filtered: Any
) -> None:
    """Write one round; |g_i - g_j|² / 2 is 1 - g_i g_j, and ``factor`` is -1/σ²."""
    for i in range(normals.shape[0]):
        a = b = c = 0.0
        g0, g1, g2 = guides[i, 0], guides[i, 1], guides[i, 2]
        for q in range(indptr[i], indptr[i + 1]):
            j = indices[q]
            alike = g0 * guides[j, 0] + g1 * guides[j, 1] + g2 * guides[j, 2]
            w = near[q] * np.exp(factor * (1 - alike))
            a += w * normals[j, 0]
            b += w * normals[j, 1]
            c += w * normals[j, 2]
        size = np.sqrt(a * a + b * b + c * c)
        if size > 0:
            filtered[i, 0] = a / size
            filtered[i, 1] = b / size
            filtered[i, 2] = c / size
        else:
            filtered[i] = normals[i]
