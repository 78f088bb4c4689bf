"""Discrete curvatures: angle defects, and the mean curvature vector (l. 35 of the chapter)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from beltrami._arrays import Floats, read_only
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.requirements import require_manifold, require_oriented
from beltrami.operators.areas import vertex_areas
from beltrami.operators.laplacian import laplacian
from beltrami.operators.soundness import require_sound


@dataclass(frozen=True, eq=False)
class Curvature:
    """Curvatures at the vertices; the inside of a sphere of radius r has K = 1/r², H = 1/r.

    Attributes
    ----------
    gaussian
        (n,) K = angle defect / area, 1/length²; 0 on the boundary, where there is none.
    mean
        (n,) H = (k1 + k2) / 2, 1/length: positive where the surface bends away from the normal,
        as a sphere does whose normals point outwards; 0 on the boundary, where Lx holds its
        conormal and measures no curvature.
    principal
        (n, 2) k1 >= k2, the roots of k² - 2Hk + K, 1/length; both H where H² < K, which happens
        near umbilics by the error of the two.
    angle_defect
        (n,) ∫K over the cell of an inner vertex, 2π - Σ angles, without unit; 0 on the boundary.
    turning
        (n,) ∫ of the geodesic curvature at a vertex of the boundary, π - Σ angles; 0 inside. All
        defects and all turnings add to 2πχ (Gauss-Bonnet).
    areas
        (n,) the areas of the cells, length².
    """

    gaussian: Floats
    mean: Floats
    principal: Floats
    angle_defect: Floats
    turning: Floats
    areas: Floats


def curvature(mesh: Mesh) -> Curvature:
    r"""Measure Gaussian, mean and principal curvatures at the vertices.

    :math:`K_i = (2\pi - \sum_f \theta_i^f) / A_i` depends on lengths only, so bending keeps it;
    :math:`H_i = \langle (Lx)_i, n_i \rangle / (2 A_i)` does not (l. 35): with cotangent weights
    :math:`B^{-1} L x = -\Delta x = 2 H n`. A_i is the mixed Voronoi area (M. Meyer et al., 2003).

    Chapter items: P3.

    Raises
    ------
    NotManifoldError
        If the faces around a vertex are no disk or half disk; ``error.vertices`` lists them.
    NotOrientableError
        If neighbouring faces disagree on the side of the normal; ``error.edges`` lists where.
    DimensionError
        If the vertices have more than three coordinates: then there is no one normal.
    EmptyMeshError, NonFiniteError, DegenerateFaceError, UnreferencedVertexError
        If the mesh is not sound.

    Notes
    -----
    Averages over pieces of the surface converge. Values at single vertices converge on regular
    meshes, and need not on irregular ones (E30). Cost: O(n + m).

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> found = curvature(icosphere(3, radius=2))
    >>> round(float(found.mean.mean()), 3), round(float(found.gaussian.mean()), 3)
    (0.5, 0.251)
    >>> round(float(found.angle_defect.sum() / np.pi), 9)  # 2 χ
    4.0
    """
    require_sound(mesh)
    require_manifold(
        mesh.topology, "curvature needs the faces around each vertex in one disk or half disk"
    )
    require_oriented(
        mesh.topology,
        "neighbouring faces disagree on which side is outside, so H has no sign",
        one_sided="The surface has one side, so no repair gives it a normal; of what curvature "
        "measures, areas and angles alone are left: vertex_areas, mesh.corner_angles.",
    )
    normals = mesh.vertex_normals
    pair = laplacian(mesh)
    bending = (pair.stiffness @ mesh.vertices * normals[:, : mesh.dimension]).sum(axis=1) / 2
    boundary = mesh.topology.on_boundary
    angles = np.bincount(mesh.faces.ravel(), mesh.corner_angles.ravel(), mesh.n_vertices)
    defect = np.where(boundary, 0.0, 2 * np.pi - angles)
    areas = vertex_areas(mesh)
    gaussian, mean = defect / areas, np.where(boundary, 0.0, bending / areas)
    spread = np.sqrt(np.maximum(mean**2 - gaussian, 0))
    return Curvature(
        gaussian=read_only(gaussian),
        mean=read_only(mean),
        principal=read_only(np.stack([mean + spread, mean - spread], axis=1)),
        angle_defect=read_only(defect),
        turning=read_only(np.where(boundary, np.pi - angles, 0.0)),
        areas=read_only(areas),
    )
