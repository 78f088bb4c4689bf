"""Positions that fit given normals (Sun, Rosin, Martin and Langbein 2007)."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._arrays import Booleans, Floats
from beltrami._jit import kernel
from beltrami.errors import DimensionError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.requirements import require_oriented
from beltrami.mesh.topology import Topology
from beltrami.operators.soundness import require_faces, require_positions


def fit_to_normals(
    topology: Topology, vertices: Floats, normals: Floats, held: Booleans, rounds: int = 20
) -> Floats:
    r"""Move each vertex by the mean over its faces f of :math:`n_f (n_f \cdot (c_f - x_i))`.

    That is towards the planes through the centroids c_f with the normals n_f that are wanted. It
    is descent of :math:`\sum_f \sum_{i \in f} (n_f \cdot (c_f - x_i))^2`, all vertices
    at once. Faces with the normal 0 have no say.

    Parameters
    ----------
    topology, vertices
        Of the mesh; (n, 3).
    normals
        (m, 3) unit normals wanted, 0 where a face has none.
    held
        (n,) bool: vertices that stay.

    Returns
    -------
    (n, 3) positions. Cost: O(rounds m).
    """
    around = topology.vertex_faces
    x, y = np.array(vertices, np.float64), np.empty_like(vertices)
    planes = np.empty((topology.n_faces, 6))  # normals and centroids side by side
    planes[:, :3] = normals
    for _ in range(rounds):
        _centre(topology.faces, x, planes)
        _update(around.indptr, around.indices, planes, held, x, y)
        x, y = y, x
    return x


def require_agreeing_normals(mesh: Mesh) -> None:
    """Raise, with the edges, unless normals can be compared: in space, faces turned alike.

    Raises
    ------
    DimensionError
        If the mesh is not in space.
    NotOrientableError
        If faces that share an edge disagree about the outside.
    EmptyMeshError, DegenerateFaceError, NonFiniteError
        If there are no faces, one names a vertex twice, or a coordinate is not finite.
    """
    require_faces(mesh.topology)
    require_positions(mesh)
    if mesh.dimension != 3:
        raise DimensionError(
            f"normals need a mesh in space, and this one has dimension {mesh.dimension}"
        )
    require_oriented(
        mesh.topology,
        "faces that share an edge disagree about the outside, so their normals cannot be compared",
        one_sided="The surface has one side, so no repair gives it a normal: smooth_mesh with "
        '"averaging", "taubin" or "implicit" needs none.',
    )


@kernel
def _centre(faces: Any, x: Any, planes: Any) -> None:
    """Write the centroids behind the normals."""
    for j in range(faces.shape[0]):
        f, g, h = faces[j, 0], faces[j, 1], faces[j, 2]
        planes[j, 3] = (x[f, 0] + x[g, 0] + x[h, 0]) / 3
        planes[j, 4] = (x[f, 1] + x[g, 1] + x[h, 1]) / 3
        planes[j, 5] = (x[f, 2] + x[g, 2] + x[h, 2]) / 3


@kernel
def _update(around: Any, members: Any, planes: Any, held: Any, x: Any, y: Any) -> None:
    """Write one round from x to y."""
    for i in range(x.shape[0]):
        a, b, c, count = 0.0, 0.0, 0.0, 0
        if not held[i]:
            for q in range(around[i], around[i + 1]):
                j = members[q]
                n0, n1, n2 = planes[j, 0], planes[j, 1], planes[j, 2]
                if n0 == 0 and n1 == 0 and n2 == 0:
                    continue
                away = (
                    n0 * (planes[j, 3] - x[i, 0])
                    + n1 * (planes[j, 4] - x[i, 1])
                    + n2 * (planes[j, 5] - x[i, 2])
                )
                a += n0 * away
                b += n1 * away
                c += n2 * away
                count += 1
        share = 1 / count if count else 0.0
        y[i, 0] = x[i, 0] + share * a
        y[i, 1] = x[i, 1] + share * b
        y[i, 2] = x[i, 2] + share * c
