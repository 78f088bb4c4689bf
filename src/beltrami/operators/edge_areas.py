"""Areas of the edges: two kinds of cells around them (definition 11, theorem 3, E21, E22)."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats
from beltrami.errors import check_name
from beltrami.mesh.mesh import Mesh
from beltrami.operators.accumulate import NONE, accumulate
from beltrami.operators.soundness import require_sound

EDGE_AREA_KINDS = ("circumcenter", "incenter")


def edge_areas(mesh: Mesh, kind: str = "circumcenter") -> Floats:
    r"""Return the (p,) areas A_e of the cells of the edges; they add to the area of the surface.

    ==================  =====================================================================
    ``"circumcenter"``   :math:`\frac14 |e|^2 (\cot\alpha + \cot\beta)`: the diamond of the edge and
                         the circumcentres of its faces (theorem 3 with its constant corrected,
                         E22). Signed: negative where the weight is.
    ``"incenter"``       :math:`\frac12 |e| r_f` for each face, with r_f the radius of its inscribed
                         circle: the points nearest to the edge (definition 11, E21). Positive.
    ==================  =====================================================================

    The text calls both one cell; they are not (E21). With the circumcentres half of the areas of
    its edges is the area of a vertex, ``vertex_areas(mesh, "circumcentric")``. The unit is
    length². The order is that of ``mesh.edges``. Cost: O(n + m).

    Chapter items: D11, T3, U13, P22.

    Raises
    ------
    UnknownNameError
        If there are no areas of that name.
    EmptyMeshError, NonFiniteError, DegenerateFaceError
        If the mesh is not sound.

    Examples
    --------
    >>> mesh = Mesh([[0, 0], [4, 0], [0, 3]], [[0, 1, 2]])  # inscribed circle of radius 1
    >>> mesh.edges.tolist(), edge_areas(mesh, "incenter").round(12).tolist()
    ([[0, 1], [0, 2], [1, 2]], [2.0, 1.5, 2.5])
    >>> (edge_areas(mesh, "circumcenter") + 0.0).round(12).tolist()
    [3.0, 3.0, 0.0]
    """
    check_name("kind of edge areas", kind, EDGE_AREA_KINDS)
    if kind == "circumcenter":
        weights, _ = accumulate(mesh, True, NONE)
        return mesh.edge_lengths**2 * weights / 2
    require_sound(mesh)
    topology = mesh.topology
    sides = mesh.edge_lengths[topology.face_edges]
    shares = sides * (mesh.face_areas / sides.sum(axis=1))[:, None]  # r_f = 2 area / perimeter
    of_edge = topology.face_edges.ravel()
    return np.asarray(np.bincount(of_edge, shares.ravel(), topology.n_edges), dtype=np.float64)
