"""Filling: positions of vertices that are not known, from those of the others."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_array, csr_array, eye_array

from beltrami._arrays import Booleans, Floats
from beltrami.diffusion.candidates import EVENING
from beltrami.diffusion.face_rings import face_rings
from beltrami.diffusion.linear_filters import equal_rows, low_passed
from beltrami.diffusion.normal_filters import filtered_normals
from beltrami.diffusion.vertex_update import fit_to_normals
from beltrami.mesh.geometry import vertex_normals
from beltrami.mesh.mesh import Mesh
from beltrami.solvers.conjugate_gradients import conjugate_gradients

_TOLERANCE = 1e-7  # of the solver
_MANY = 64  # neighbours, beyond which a mean tells little, and all of them would be coupled
_RIDGE = 1e-9  # for components of which nothing is known
_CONTRAST, _ROUNDS, _TIMES = 0.3, 6, 3  # of the filter of normals
_STRAIGHT = 0.8  # cosine of the angle between a displacement and the normal
_SMALL = 0.7  # mean edges, that sliding may be
_TRIED = 0.1  # of the known vertices
_SEED = 31


def filled(mesh: Mesh, unknown: Booleans, way: str = "plain") -> Floats:
    r"""Return positions (n, 3) where the unknown vertices are moved along the normals.

    To where :math:`|x - \tilde W x|^2` is least, the others held: a bi-harmonic surface through
    them. Normals are those of this surface; if the others have ``"noise"``, those of a low pass of
    it: an unknown vertex may be far off, and would come down beside its place. On a shape that is
    ``"creased"`` they move to planes of normals that a bilateral filter made of those of the
    surface, and kept creases. Known vertices stay exactly.
    """
    moved = _smoothest(mesh, unknown)
    if way == "noise":
        evened = low_passed(equal_rows(mesh), moved, EVENING)
        return brought_down(mesh, unknown, moved, evened)
    x = brought_down(mesh, unknown, moved, moved)
    if way == "plain":
        return x
    rings, moved = face_rings(mesh.topology), x
    for _ in range(_TIMES):
        normals = filtered_normals(mesh.with_vertices(moved), rings, _CONTRAST, guided=False)
        for _ in range(_ROUNDS - 1):
            next(normals)
        moved = fit_to_normals(mesh.topology, moved, next(normals), ~unknown)
    return brought_down(mesh, unknown, moved, moved)


def brought_down(mesh: Mesh, unknown: Booleans, moved: Floats, surface: Floats) -> Floats:
    """Keep of the displacements what is along the normals of the surface; all, where it turned.

    A vertex far beside its place may fold the faces around it: their normal is far from the
    displacement then. Known vertices stay where the mesh has them.
    """
    i, j, k = mesh.faces.T
    around = mesh.faces[unknown[i] | unknown[j] | unknown[k]]
    normals = vertex_normals(surface, around, "angle")[unknown]
    start, end = mesh.vertices[unknown], moved[unknown]
    away = end - start
    way = np.einsum("ij,ij->i", away, normals)
    far = np.linalg.norm(away, axis=1)
    straight = (np.abs(way) > _STRAIGHT * far) | (far < _SMALL * float(mesh.edge_lengths.mean()))
    x = np.array(mesh.vertices)
    x[unknown] = np.where(straight[:, None], start + way[:, None] * normals, end)
    return x


def _smoothest(mesh: Mesh, unknown: Booleans) -> Floats:
    k = np.flatnonzero(unknown)
    moved = np.array(mesh.vertices)
    if len(k):
        K = _differences(mesh.topology.adjacency, unknown)
        part = csc_array(K[:, k])
        system = csr_array(part.T @ part + _RIDGE * eye_array(len(k)))
        force = -(part.T @ (K @ moved))
        moved[k] += conjugate_gradients(
            system, force, tolerance=_TOLERANCE, kernel=None
        ).solution  # differences, so that the place of the mesh does not matter
    return moved


def _differences(adjacency: csr_array, unknown: Booleans) -> csr_array:
    """Return those rows of Id - W̃ that see an unknown vertex, but for those of many neighbours."""
    degrees = np.diff(adjacency.indptr)
    seen = unknown | (adjacency @ unknown > 0)
    rows = np.flatnonzero(seen & (degrees > 0) & (degrees <= _MANY))
    near, size = adjacency[rows], (len(rows), len(degrees))
    shares = np.repeat(1 / degrees[rows], degrees[rows])
    here = csr_array((np.ones(len(rows)), rows, np.arange(len(rows) + 1)), shape=size)
    return csr_array(here - csr_array((shares, near.indices, near.indptr), shape=size))


def error_of_filling(mesh: Mesh, unknown: Booleans, way: str) -> float:
    """Return how far known vertices are from where they would be filled.

    A tenth of them is left out for it, from a fixed seed: the root mean square, in the unit of
    length; their noise is counted in.
    """
    tried = ~unknown & (np.random.default_rng(_SEED).random(mesh.n_vertices) < _TRIED)
    tried &= mesh.topology.referenced
    if not tried.any():
        return np.inf
    off = (filled(mesh, unknown | tried, way) - mesh.vertices)[tried]
    return float(np.sqrt((off**2).sum(axis=1).mean()))
