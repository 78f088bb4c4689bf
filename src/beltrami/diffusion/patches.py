"""Patches of a large mesh, on which parameters are chosen for all of it."""

from __future__ import annotations

import numpy as np
from scipy.sparse.csgraph import breadth_first_order

from beltrami._arrays import Integers
from beltrami.mesh.mesh import Mesh

_PATCHES = 8


def sample_of(mesh: Mesh, faces: int) -> tuple[Mesh, Integers]:
    """Return patches of about ``faces`` faces in all, as one mesh, and its vertices' numbers.

    Eight patches grow from vertices at even distances in the numbering, neighbour by neighbour.
    A mesh that has not more faces is its own sample.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> sample, vertices = sample_of(icosphere(5), 4000)
    >>> sample.n_faces, len(vertices) == sample.n_vertices
    (3417, True)
    """
    n = mesh.n_vertices
    if mesh.n_faces <= faces:
        return mesh, np.arange(n)
    each = max(1, faces * n // (mesh.n_faces * _PATCHES))
    inside = np.zeros(n, np.bool_)
    referenced = np.flatnonzero(mesh.topology.referenced)
    adjacency = mesh.topology.adjacency
    for seed in referenced[np.linspace(0, len(referenced) - 1, _PATCHES + 2).astype(int)[1:-1]]:
        order = breadth_first_order(adjacency, int(seed), return_predecessors=False)
        inside[order[:each]] = True
    kept = mesh.faces[inside[mesh.faces].all(axis=1)]
    vertices = np.unique(kept)
    return Mesh(mesh.vertices[vertices], np.searchsorted(vertices, kept)), vertices
