"""Tangent frames at the vertices, and the gradient in them: what networks on surfaces use."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from beltrami._arrays import Floats, Integers
from beltrami.errors import MeshError
from beltrami.mesh.geometry import well_scaled
from beltrami.mesh.mesh import Mesh

_UPRIGHT = 0.9  # cosine from which the normal is too near to the first axis
_THIN = 1e-8  # part of the squared lengths of the edges below which a direction has none


def tangent_frames(mesh: Mesh) -> Floats:
    """Return the (n, 3, 3) frames: the rows are X, Y and the normal of each vertex.

    They are orthonormal and right-handed. The normal is weighted by the angles (E10); X is the
    first axis of space projected into the tangent plane, the second axis where the normal is
    within 26° of the first. Flat meshes lie in z = 0.

    Raises
    ------
    DimensionError
        If the vertices have more than three coordinates.
    MeshError
        If the normals of the faces around a vertex cancel; ``error.vertices``.

    Examples
    --------
    >>> tangent_frames(Mesh([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]]))[0].tolist()
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    """
    normals = mesh.vertex_normals
    without = np.flatnonzero(~normals.any(axis=1))
    if len(without):
        raise MeshError(
            "vertices have no normal, because those of their faces cancel, and so no tangent plane",
            vertices=without,
            remedy="Turn faces alike with repair(mesh, orient=True), or drop doubled ones with "
            "repair(mesh, remove_duplicate_faces=True).",
        )
    steep = np.abs(normals[:, 0]) >= _UPRIGHT
    axis = np.zeros_like(normals)
    axis[np.arange(len(axis)), steep.astype(int)] = 1
    x = axis - (axis * normals).sum(axis=1)[:, None] * normals
    x /= np.linalg.norm(x, axis=1)[:, None]
    return np.stack([x, np.cross(normals, x), normals], axis=1)


def tangent_gradient(mesh: Mesh, frames: Floats) -> tuple[csr_array, csr_array]:
    r"""Return the (n, n) matrices of the X and the Y component of the gradient at each vertex.

    The gradient at i is the g that fits the differences along the edges best,
    :math:`\min_g \sum_{j \sim i} (\langle g, t_{ij}\rangle - (f_j - f_i))^2` with the edge
    :math:`t_{ij}` projected into the tangent plane (N. Sharp et al. 2022, "DiffusionNet:
    discretization agnostic learning on surfaces"; their 1e-5 in the normal equations, which has
    a unit, is left out). Linear functions on flat meshes are met exactly. In a direction in which
    the edges of a vertex do not extend (1e-8 of their squared lengths) the component is 0.

    Notes
    -----
    Cost: O(n + p). Unit: one over length.

    Examples
    --------
    >>> from beltrami.mesh.shapes import grid
    >>> mesh = grid(3, 3)
    >>> x, y = tangent_gradient(mesh, tangent_frames(mesh))
    >>> f = 3 * mesh.vertices[:, 0] - mesh.vertices[:, 1]
    >>> bool((abs(x @ f - 3) < 1e-12).all()), bool((abs(y @ f + 1) < 1e-12).all())
    (True, True)
    """
    n = mesh.n_vertices
    positions, unit = well_scaled(mesh.vertices)
    tail, tip = np.concatenate([mesh.edges, mesh.edges[:, ::-1]]).T
    arms = np.zeros((len(tail), 3))
    arms[:, : mesh.dimension] = positions[tip] - positions[tail]
    flat = np.einsum("ec,eac->ea", arms, frames[tail, :2])
    inverse = _inverses(tail, arms, flat, n)
    parts = np.einsum("eab,eb->ea", inverse[tail], flat) / unit
    return _differences(tail, tip, parts[:, 0], n), _differences(tail, tip, parts[:, 1], n)


def _inverses(tail: Integers, arms: Floats, flat: Floats, n: int) -> Floats:
    """Return the (n, 2, 2) pseudo-inverses of the sums of t t' over the edges of each vertex."""
    sums = np.empty((n, 2, 2))
    for a in range(2):
        for b in range(2):
            sums[:, a, b] = np.bincount(tail, flat[:, a] * flat[:, b], n)
    size = np.bincount(tail, (arms**2).sum(axis=1), n)
    values, vectors = np.linalg.eigh(sums)
    kept = values > _THIN * size[:, None]
    turned = vectors * (kept / np.where(kept, values, 1))[:, None, :]
    return np.asarray(turned @ vectors.transpose(0, 2, 1))


def _differences(tail: Integers, tip: Integers, values: Floats, n: int) -> csr_array:
    """Return the matrix of sums of value (f_tip - f_tail): its rows add to zero."""
    each = np.arange(n)
    rows, columns = np.concatenate([tail, each]), np.concatenate([tip, each])
    entries = np.concatenate([values, -np.bincount(tail, values, n)])
    matrix = csr_array((entries, (rows, columns)), shape=(n, n))
    matrix.sum_duplicates()
    return matrix
