"""Components of a mesh, and patches of a large one, on which parameters are chosen for it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse.csgraph import breadth_first_order

from beltrami._arrays import Booleans, Integers
from beltrami.mesh.connectivity import component_labels
from beltrami.mesh.mesh import Mesh

_PATCHES = 8
_CORE = 0.8  # of the vertices of a patch, the first ones


@dataclass(frozen=True, eq=False)
class Sample:
    """Some vertices as a mesh, their numbers, and which are far from borders that are new."""

    mesh: Mesh
    vertices: Integers
    core: Booleans


def sizes_of_components(mesh: Mesh) -> tuple[Integers, Integers]:
    """Return the component of each vertex, and how many vertices each component has."""
    labels = component_labels(mesh.edges, mesh.n_vertices)
    return labels, np.bincount(labels)


def components_of(mesh: Mesh, least: int, most: int, few: int = 0) -> list[Integers]:
    """Return the vertices of the largest components, and then those of all others together.

    Components are ``least`` vertices large, and at most ``most`` are told apart; vertices of no
    face are among the others. Those of less than ``few`` vertices come last, together. A mesh of
    one component is one list.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> small, large = icosphere(1), icosphere(2)
    >>> x = np.concatenate([small.vertices, large.vertices + 3])
    >>> both = Mesh(x, np.concatenate([small.faces, large.faces + small.n_vertices]))
    >>> [len(part) for part in components_of(both, 100, 8)]
    [162, 42]
    """
    labels, sizes = sizes_of_components(mesh)
    order = np.argsort(-sizes, kind="stable")[:most]
    own = order[sizes[order] >= least]
    parts = [np.flatnonzero(labels == one) for one in own]
    others, tiny = ~np.isin(labels, own), sizes[labels] < few
    groups = (np.flatnonzero(others & ~tiny), np.flatnonzero(others & tiny))
    return [*parts, *(group for group in groups if len(group))]


def part_of(mesh: Mesh, vertices: Integers) -> Mesh:
    """Return the faces of these vertices (increasing numbers) alone, as a mesh."""
    inside = np.zeros(mesh.n_vertices, np.bool_)
    inside[vertices] = True
    kept = mesh.faces[inside[mesh.faces].all(axis=1)]
    return Mesh(mesh.vertices[vertices], np.searchsorted(vertices, kept))


def sample_of(mesh: Mesh, faces: int) -> Sample:
    """Return patches of about ``faces`` faces in all.

    Eight patches grow from vertices at even distances in the numbering, neighbour by neighbour;
    the core of each is what it had at four fifths. A mesh that has not more faces is its own
    sample.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> sample = sample_of(icosphere(5), 4000)
    >>> sample.mesh.n_faces, sample.mesh.n_vertices
    (3417, 1878)
    """
    n = mesh.n_vertices
    if mesh.n_faces <= faces:
        return Sample(mesh, np.arange(n), np.ones(n, np.bool_))
    each = max(1, faces * n // (mesh.n_faces * _PATCHES))
    inside, core = np.zeros(n, np.bool_), np.zeros(n, np.bool_)
    referenced = np.flatnonzero(mesh.topology.referenced)
    adjacency = mesh.topology.adjacency
    for seed in referenced[np.linspace(0, len(referenced) - 1, _PATCHES + 2).astype(int)[1:-1]]:
        order = breadth_first_order(adjacency, int(seed), return_predecessors=False)
        inside[order[:each]] = True
        core[order[: int(_CORE * each)]] = True
    part = part_of(mesh, np.flatnonzero(inside))
    used = part.topology.referenced  # some vertices of a patch are in no face of it
    vertices = np.flatnonzero(inside)[used]
    return Sample(part_of(mesh, vertices), vertices, core[vertices])
