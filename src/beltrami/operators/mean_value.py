"""Mean value weights: positive, linearly precise, and not symmetric (l. 683 of the chapter)."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._arrays import Floats
from beltrami._jit import kernel, unsigned
from beltrami.mesh.geometry import in_space, well_scaled
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.triangle import is_flat, measure
from beltrami.operators.soundness import refuse_flat_faces, require_faces, require_positions


def mean_value_weights(mesh: Mesh) -> Floats:
    r"""Return the (p, 2) weights :math:`(w_{ij}, w_{ji})` of the edges i < j.

    :math:`w_{ij} = (\tan(\gamma_{ij} / 2) + \tan(\delta_{ij} / 2)) / |e_{ij}|` with γ, δ the angles
    at i between the edge and the next sides (M. S. Floater, Mean value coordinates, 2003). An
    edge of the boundary has one term. Unit: 1/length. Cost: O(n + m).

    Raises
    ------
    EmptyMeshError, NonFiniteError, DegenerateFaceError
        If the mesh is not sound.

    Examples
    --------
    >>> half = Mesh([[0, 0], [2, 0], [0, 1]], [[0, 1, 2]])
    >>> mean_value_weights(half).round(4).tolist()  # tan(45°) / 2 and tan(26.6° / 2) / 2 first
    [[0.5, 0.118], [1.0, 0.618], [0.1056, 0.2764]]
    """
    require_faces(mesh.topology)
    require_positions(mesh)
    scaled, unit = well_scaled(mesh.vertices)
    positions, corners = in_space(scaled, mesh.faces)
    out = np.zeros((mesh.topology.n_edges, 2))
    sides = unsigned(mesh.topology.face_edges)
    if _mean_values(positions, unsigned(corners), unsigned(mesh.faces), sides, out):
        refuse_flat_faces(mesh)
    return out if unit == 1 else out / unit


@kernel
def _mean_values(x: Any, corners: Any, faces: Any, face_edges: Any, out: Any) -> int:
    """Add up the faces; return how many are flat.

    tan(γ/2) = sin / (1 + cos) = (1 - cos) / sin: the form without cancellation is taken.
    """
    flat = 0
    for f in range(corners.shape[0]):
        at = measure(x, corners[f, 0], corners[f, 1], corners[f, 2])
        double = at[3]
        if is_flat(at[0], at[1], at[2], double):
            flat += 1
            continue
        dots = (at[0], at[1], at[2])
        for c in range(3):
            a, b = (c + 1) % 3, (c + 2) % 3
            to_a = (dots[c] + dots[a]) ** 0.5  # length of the side from c to a
            to_b = (dots[c] + dots[b]) ** 0.5
            if dots[c] > 0:
                tangent = double / (to_a * to_b + dots[c])
            else:
                tangent = (to_a * to_b - dots[c]) / double
            i, j, k = faces[f, c], faces[f, a], faces[f, b]
            out[face_edges[f, b], 0 if i < j else 1] += tangent / to_a
            out[face_edges[f, a], 0 if i < k else 1] += tangent / to_b
    return flat
