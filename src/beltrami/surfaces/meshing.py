"""Meshes of parametric surfaces: seams closed, poles one vertex (definition 1)."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami.errors import SurfaceError
from beltrami.mesh.geometry import degenerate_faces
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes.concentric import disk_faces, ring_points
from beltrami.mesh.shapes.lattice import lattice_faces
from beltrami.mesh.shapes.parameters import whole
from beltrami.surfaces.charted import Charted
from beltrami.surfaces.domain import Disk, Rectangle
from beltrami.surfaces.seams import glue


def mesh_chart(chart: Charted, nu: int, nv: int) -> Mesh:
    """Mesh a surface over its domain; see ``ParametricSurface.mesh``."""
    nu, nv = whole("nu", nu, least=1), whole("nv", nv, least=1)
    if isinstance(chart.domain, Disk):
        parameters, faces = _disk(chart.domain, whole("nu", nu, least=3), nv)
        points = chart(*parameters.T)
    else:
        parameters, points, faces = _rectangle(chart, chart.domain, nu, nv)
    mesh = Mesh(points, faces, {"parameters": parameters})
    if not (mesh.n_faces and mesh.topology.half_edges.complete and mesh.is_manifold):
        raise SurfaceError(
            f"{nu} by {nv} cells are too few to close the seams and poles of this surface",
            remedy="Take 3 or more along a periodic parameter, 2 or more between two poles.",
        )
    flat = degenerate_faces(mesh.vertices, mesh.faces)
    if len(flat):
        raise SurfaceError(
            f"{len(flat)} of the {mesh.n_faces} faces between {nu} by {nv} cells have no area",
            parameters=parameters[mesh.faces[flat, 0]],
            remedy="Take a domain where the Jacobian of φ has rank 2, or more cells.",
        )
    return mesh


def _disk(domain: Disk, nu: int, nv: int) -> tuple[Floats, Integers]:
    """Fill a disk with nv rings, the outermost of nu vertices."""
    counts = [1, *(max(3, round(nu * ring / nv)) for ring in range(1, nv + 1))]
    radii = [domain.radius * ring / nv for ring in range(nv + 1)]
    points = ring_points(counts, radii)
    numbers = np.split(np.arange(len(points)), np.cumsum(counts)[:-1])
    return points + np.array(domain.center), disk_faces(numbers)


def _rectangle(
    chart: Charted, domain: Rectangle, nu: int, nv: int
) -> tuple[Floats, Floats, Integers]:
    """Cut a rectangle into nv rows of nu cells; glue its sides where they meet on the chart."""
    v, u = np.meshgrid(
        np.linspace(*domain.v, nv + 1), np.linspace(*domain.u, nu + 1), indexing="ij"
    )
    parameters, points = np.stack([u, v], axis=-1), chart(u, v)
    number = glue(points, parameters, domain, chart.size)
    _, kept = np.unique(number, return_index=True)
    faces = number[lattice_faces(nv, nu)]
    a, b, c = faces.T
    faces = faces[(a != b) & (b != c) & (c != a)]  # at a pole one of the two halves of a cell
    return parameters.reshape(-1, 2)[kept], points.reshape(nu * nv + nu + nv + 1, -1)[kept], faces
