"""Exact distances on a polyhedral surface: windows of straight lines, carried over the faces."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Booleans, Floats, Integers
from beltrami.geodesics.edge_paths import edge_distance
from beltrami.geodesics.windows import carry_windows
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.requirements import require_edge_manifold
from beltrami.operators.face_parts import face_numbers

_ANGLE = 1e-10  # of an excess that is none


def exact_distance(mesh: Mesh, sources: Integers) -> Floats:
    """Return the (n,) lengths of the shortest paths on the surface of the faces.

    A shortest path is straight where the faces that it crosses are laid flat. It turns only at
    saddles, whose angles add to more than 2π, and at reflex vertices of the boundary, more than
    π; each of these sends out rays of its own. A window is an interval of an edge, the image of
    its source, and the length of the path to that source. Windows are carried into the next
    face, nearest first, and dropped when the way through a vertex of the face that they come
    from is shorter (Chen and Han 1990, with the order and the filter of Xin and Wang 2009). The
    paths of edges are the bound to begin with.

    Parameters
    ----------
    mesh
        A sound mesh; it may be open, and need not be oriented or orientable.
    sources
        Indices of vertices.

    Raises
    ------
    NotManifoldError
        If an edge has more than two faces; ``error.edges`` lists them.

    Notes
    -----
    Cost: O(n²) windows at worst, about n^1.5 in practice.

    Examples
    --------
    >>> from beltrami.mesh.shapes import tetrahedron
    >>> solid = tetrahedron()
    >>> across = exact_distance(solid, np.array([0]))
    >>> bool(np.allclose(across[1:], solid.edge_lengths[0]))
    True
    """
    topology = mesh.topology
    require_edge_manifold(
        topology, "exact distances need edges of one or two faces", ', or use method="heat"'
    )
    dots, double, unit = face_numbers(mesh)
    sides = np.sqrt(np.roll(dots, -1, axis=1) + np.roll(dots, -2, axis=1))
    distance = edge_distance(mesh, sources) / unit
    around = topology.vertex_faces
    carry_windows(
        mesh.faces,
        topology.twins.ravel(),
        sides,
        dots,
        double,
        around.indptr,
        around.indices,
        _turning(mesh),
        np.unique(sources),
        distance,
    )
    return distance * unit


def _turning(mesh: Mesh) -> Booleans:
    """Mark the vertices where a shortest path may turn."""
    topology = mesh.topology
    total = np.bincount(mesh.faces.ravel(), mesh.corner_angles.ravel(), mesh.n_vertices)
    straight = np.where(topology.on_boundary, np.pi, 2 * np.pi)
    return np.asarray((total > straight + _ANGLE) | (topology.fans.of_vertex > 1))
