"""Surfaces of several parts and handles, and whether a cell of faces is a disk."""

from __future__ import annotations

import numpy as np

from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import torus
from beltrami.mesh.topology import Topology


def of_cell(faces, labels, cell):
    """The faces of one cell, as a topology of their own."""
    own = faces[labels == cell]
    return Topology(np.unique(own, return_inverse=True)[1].reshape(-1, 3))


def is_disk(faces, labels, cell):
    part = of_cell(faces, labels, cell)
    alone = part.components("edges").max() == 0
    return bool(
        alone
        and part.is_manifold
        and part.euler_characteristic == 1
        and len(part.boundary_loops) == 1
    )


def side_by_side(*meshes):
    """Put surfaces in a row, as one mesh."""
    starts = np.cumsum([0, *(mesh.n_vertices for mesh in meshes)])
    moved = [mesh.vertices + np.array([9.0 * k, 0, 0]) for k, mesh in enumerate(meshes)]
    faces = [mesh.faces + start for mesh, start in zip(meshes, starts[:-1], strict=True)]
    return Mesh(np.concatenate(moved), np.concatenate(faces))


def two_holes():
    """Genus 2: a torus and its mirror image, glued along the rim of a face taken out of each."""
    ring = torus(12, 8)
    n = ring.n_vertices
    glued = np.arange(2 * n)
    rim = ring.faces[-1]
    glued[rim + n] = rim
    x = np.concatenate([ring.vertices, ring.vertices * [1, 1, -1] + [0, 0, 3]])
    faces = glued[np.concatenate([ring.faces[:-1], ring.faces[:-1][:, [0, 2, 1]] + n])]
    used, local = np.unique(faces, return_inverse=True)
    return Mesh(x[used], local.reshape(-1, 3))
