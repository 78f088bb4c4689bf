"""The level of the noise of a mesh, once a first result tells its normals and creases."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.sparse import csr_array, eye_array

from beltrami._arrays import Booleans, Floats
from beltrami.diffusion.linear_filters import weights_by_normals
from beltrami.diffusion.noise import median_level
from beltrami.diffusion.smoothing import shares_of
from beltrami.mesh.edge_matrix import symmetric_matrix
from beltrami.mesh.mesh import Mesh

_ORDER = 3  # the other one is twice as large
_CONTRAST = 0.5  # of normals, beyond which neighbours have little say
_CUT = 1.4  # levels beyond which values count as that much
_OF_CUT = 0.7358158819487548  # mean of min(z², _CUT²) of a standard normal variable
_ROUNDS = 40
_MOST = 0.25  # of the square, that the shape may be said to be of it
_SEED = 1972


def level_beside(mesh: Mesh, clean: Mesh, filtered: Callable[[Mesh], Mesh]) -> float:
    r"""Return the level of white noise along the normals of ``clean``, a first result.

    The rough parts are :math:`R y`, :math:`R = (Id - \tilde W)^3` and its square, along the normals
    n of the first result. W̃ averages by weights that fall with the length of the edge and with the
    angle of the normals at its ends, so that uneven edges and creases leave little there. As noise
    moves each vertex along its own normal, white noise of the level 1 has the variance
    :math:`\sum_j R_{ij}^2 (n_i \cdot n_j)^2` at the vertex i.

    Two things make the levels of the rough parts wrong. What the shape leaves makes them too high:
    white noise has the same level in both, but a shape less in the higher order. On folded
    surfaces, like the brain's, its square falls as one over the order, so that what is lost from
    the first to the second is as much as is left. And normals and lengths with errors of their own
    make the levels too low: by how much is measured on noise of the same level, put on the first
    result and filtered the same way.

    Parameters
    ----------
    mesh, clean
        The noisy mesh, and the first result.
    filtered
        The filter that leads from one to the other.

    Notes
    -----
    Cost: O(n), and one run of the filter.
    """
    found = _levels(mesh, clean)
    if not found.min() > 0:
        return float(found[0])
    noise = np.random.default_rng(_SEED).normal(0, found[0], mesh.n_vertices)
    again = mesh.with_vertices(clean.vertices + noise[:, None] * clean.vertex_normals)
    seen = _levels(again, filtered(again))
    if seen.min() > 0:
        found = found * _levels(again, clean) / seen
    low, high = found.tolist()
    return without_shape(low, high, mesh.n_vertices)


def without_shape(low: float, high: float, n: int) -> float:
    """Return the level without what the shape adds, from those of two orders on n vertices.

    A loss that may be chance, up to 1/√n of the squares, counts for nothing; twice that, fully.

    Examples
    --------
    >>> noise, shape = 2.0, 0.6  # squares: the shape has half of it in twice the order
    >>> round(without_shape((noise + shape) ** 0.5, (noise + shape / 2) ** 0.5, 10_000) ** 2, 9)
    2.0
    >>> without_shape(1.0, 1.001, 10_000)
    1.0
    """
    lost = min(max(1 - (high / low) ** 2, 0.0), _MOST)
    sure = min(max(lost * np.sqrt(n) - 1, 0.0), 1.0)
    return float(low * np.sqrt(1 - 2 * sure * lost))


def _levels(mesh: Mesh, clean: Mesh) -> Floats:
    """Return the levels by differences of the two orders."""
    return np.array([clipped_level(values) for values, _ in rough_values(mesh, clean, (1, 2))])


def rough_values(
    mesh: Mesh, clean: Mesh, powers: tuple[int, ...] = (1,)
) -> list[tuple[Floats, Booleans]]:
    """Return the rough parts :math:`R^p y` of ``level_beside``, and at which vertices there is one.

    They have the variance of the noise.
    """
    K, inner = _differences(mesh, clean)
    R = _power(K, _ORDER)
    return [_rough(_power(R, power), mesh, clean, inner) for power in powers]


def _differences(mesh: Mesh, clean: Mesh) -> tuple[csr_array, Booleans]:
    """Return Id - W̃ by the normals of ``clean``, and which vertices have neighbours."""
    weights = symmetric_matrix(mesh.edges, weights_by_normals(clean, _CONTRAST), mesh.n_vertices)
    W = csr_array((shares_of(weights), weights.indices, weights.indptr), shape=weights.shape)
    return csr_array(eye_array(mesh.n_vertices, format="csr") - W), np.diff(weights.indptr) > 0


def _power(K: csr_array, order: int) -> csr_array:
    R = K
    for _ in range(order - 1):
        R = csr_array(R @ K)
    return R


def _rough(R: csr_array, mesh: Mesh, clean: Mesh, inner: Booleans) -> tuple[Floats, Booleans]:
    """Return what R leaves along the normals, of the variance of the noise, and where it does."""
    normals = clean.vertex_normals
    rows = np.repeat(np.arange(mesh.n_vertices), np.diff(R.indptr))
    toward = np.einsum("ij,ij->i", normals[rows], normals[R.indices])
    norms = np.sqrt(np.bincount(rows, (R.data * toward) ** 2, mesh.n_vertices))
    rough = np.einsum("ij,ij->i", R @ mesh.vertices, normals)
    kept = inner & (norms > 0)
    return np.asarray(rough[kept] / norms[kept]), kept


def clipped_level(values: Floats) -> float:
    """Return the standard deviation of Gaussian values, of which some may be too large.

    The mean of min(v², c²s²), c = 1.4, is for the level s what it is for Gaussian ones (Huber
    1981): this errs by chance a quarter less than a median, and three in eight values may be
    anything.

    Examples
    --------
    >>> values = np.random.default_rng(0).normal(0, 2, 10_000)
    >>> values[:100] = 1000
    >>> round(clipped_level(values), 1)
    2.0
    """
    level = median_level(values)
    for _ in range(_ROUNDS):
        square = np.mean(np.minimum(values**2, (_CUT * level) ** 2)) / _OF_CUT
        level = float(np.sqrt(square))
    return level
