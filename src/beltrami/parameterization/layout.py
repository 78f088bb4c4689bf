"""Components side by side in the plane, in the proportion of their areas."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Booleans, Floats, Integers
from beltrami.mesh.mesh import Mesh

_GAP = 0.05  # between neighbours, over the widest


def side_by_side(mesh: Mesh, uv: Floats, labels: Integers) -> Floats:
    """Move and scale the images of the components so that they lie in a row, apart.

    One component is left as it is. Otherwise the ratio of areas, plane to surface, becomes that
    of the component with the largest surface.

    Parameters
    ----------
    mesh
        The mesh of n vertices.
    uv
        (n, 2) positions.
    labels
        (m,) component of each face; no two have a vertex in common.
    """
    count = int(labels.max(initial=-1)) + 1
    if count < 2:
        return uv
    a, b, c = uv[mesh.faces].transpose(1, 0, 2)
    u, v = b - a, c - a
    image = np.bincount(labels, np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2, count)
    surface = np.bincount(labels, mesh.face_areas, count)
    largest = int(surface.argmax())
    density = np.where(image > 0, image, 1) / surface
    factor = np.sqrt(density[largest] / density)
    label = np.empty(mesh.n_vertices, np.int64)
    label[mesh.faces.ravel()] = np.repeat(labels, 3)
    placed = uv * factor[label][:, None]
    left, right = np.full(count, np.inf), np.full(count, -np.inf)
    np.minimum.at(left, label, placed[:, 0])
    np.maximum.at(right, label, placed[:, 0])
    widths = right - left
    starts = np.cumsum(widths + _GAP * widths.max()) - widths
    placed[:, 0] += (starts - starts[0] + left[0] - left)[label]
    return placed


def part_of(mesh: Mesh, faces: Booleans) -> tuple[Mesh, Integers]:
    """Return the mesh of some faces, and the number in the whole of each of its vertices."""
    if faces.all():
        return mesh, np.arange(mesh.n_vertices)
    number, local = np.unique(mesh.faces[faces], return_inverse=True)
    return Mesh(mesh.vertices[number], local.reshape(-1, 3)), number
