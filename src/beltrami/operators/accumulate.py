"""One pass over the faces: cotangents to the edges, areas to the vertices."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._arrays import Floats
from beltrami._jit import kernel, unsigned
from beltrami.mesh.door import require_mesh
from beltrami.mesh.geometry import in_space, well_scaled
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.triangle import is_flat, measure, shares
from beltrami.operators.soundness import refuse_flat_faces, require_faces, require_positions

NONE = -1  # no areas


def accumulate(mesh: Mesh, cotangents: bool, areas: int) -> tuple[Floats, Floats]:
    """Return the (p,) cotangent weights and the (n,) vertex areas, or empty arrays.

    Both want the same four numbers of each triangle, so who needs both asks for both.

    Parameters
    ----------
    mesh
        Any mesh; it is checked here.
    cotangents
        Whether the weights (cot α + cot β)/2 are wanted.
    areas
        ``BARYCENTRIC``, ``VORONOI``, ``CIRCUMCENTRIC`` or ``NONE``.

    Raises
    ------
    EmptyMeshError, NonFiniteError, DegenerateFaceError
        If the mesh is not sound.
    """
    topology = require_mesh(mesh).topology
    require_faces(topology)
    require_positions(mesh)
    scaled, unit = well_scaled(mesh.vertices)
    positions, corners = in_space(scaled, mesh.faces)
    weights = np.zeros(topology.n_edges if cotangents else 0)
    sums = np.zeros(0 if areas == NONE else mesh.n_vertices)
    sides, named = unsigned(topology.face_edges), unsigned(mesh.faces)
    if _accumulate(positions, unsigned(corners), named, sides, areas, weights, sums):
        refuse_flat_faces(mesh)
    return weights, sums if unit == 1 else sums * unit**2


@kernel
def _accumulate(
    x: Any, corners: Any, faces: Any, face_edges: Any, areas: int, weights: Any, sums: Any
) -> Any:
    """Add up the faces; return how many of them are flat."""
    one = np.uint64(1)
    flat = f = np.uint64(0)
    m = np.uint64(corners.shape[0])
    with_weights = weights.size > 0
    while f < m:
        at_i, at_j, at_k, double = measure(x, corners[f, 0], corners[f, 1], corners[f, 2])
        if is_flat(at_i, at_j, at_k, double):
            flat += one
        else:
            if with_weights:
                half = 0.5 / double
                weights[face_edges[f, 0]] += at_i * half
                weights[face_edges[f, 1]] += at_j * half
                weights[face_edges[f, 2]] += at_k * half
            if areas >= 0:
                of_i, of_j, of_k = shares(at_i, at_j, at_k, double, areas)
                sums[faces[f, 0]] += of_i
                sums[faces[f, 1]] += of_j
                sums[faces[f, 2]] += of_k
        f += one
    return flat
