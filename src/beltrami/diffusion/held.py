"""Held vertices: the part of a pair that is free to move, and what holds it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from beltrami._arrays import (
    Booleans,
    Floats,
    Integers,
    as_function,
    as_indices,
    rectangular,
    require_finite,
)
from beltrami.errors import DimensionError, MeshError
from beltrami.mesh.mesh import Mesh
from beltrami.operators.pair import Laplacian


@dataclass(frozen=True, eq=False)
class FreePart:
    r"""The rows and columns of a pair (L, B) that belong to the q vertices that are not held.

    A function with the values u on the free vertices and v on the held ones has
    :math:`(L f)_{free} = K u + K_h v`, and B likewise.

    Attributes
    ----------
    free : (n,) bool
    stiffness, mass : (q, q) csr_array, K and M
    stiffness_border, mass_border : (q, n - q) csr_array, K_h and M_h
    positions : (q, d), or None if the pair knows of none
    """

    free: Booleans
    stiffness: csr_array
    mass: csr_array
    stiffness_border: csr_array
    mass_border: csr_array
    positions: Floats | None

    @cached_property
    def masses(self) -> Floats | None:
        """(q,) the diagonal of M, or None if M is not diagonal."""
        q = self.mass.shape[0]
        diagonal = self.mass.nnz == q and np.array_equal(self.mass.indices, np.arange(q))
        return self.mass.diagonal() if diagonal else None

    @cached_property
    def floating(self) -> csr_array:
        """(q, m) indicators of the m components without a held vertex; K maps them to zero."""
        joined, border = _entries(self.stiffness), _entries(self.stiffness_border)
        count, labels = connected_components(joined, directed=False)
        floats = np.ones(count, np.bool_)
        floats[labels[np.diff(border.indptr) > 0]] = False
        rows = np.flatnonzero(floats[labels])
        columns = (np.cumsum(floats) - 1)[labels[rows]]
        shape = (len(labels), int(floats.sum()))
        return csr_array((np.ones(len(rows)), (rows, columns)), shape=shape)

    @property
    def pins(self) -> Integers:
        """One vertex, the first, of each component without a held vertex."""
        rows, columns = self.floating.nonzero()
        return np.asarray(rows[np.unique(columns, return_index=True)[1]], np.int64)

    @cached_property
    def weights(self) -> Floats:
        """(m,) the mass of each component without a held vertex."""
        return np.asarray(self.floating.T @ (self.mass @ np.ones(self.mass.shape[0])))

    def means(self, load: Floats) -> Floats:
        """Return the means (m,) or (m, c) of M⁻¹ load over the components that float."""
        return np.asarray(((self.floating.T @ load).T / self.weights).T)

    def level(self, load: Floats) -> Floats:
        """Spread those means over their components; zero elsewhere."""
        if not self.floating.shape[1]:
            return np.zeros_like(load)
        return np.asarray(self.floating @ self.means(load))

    def centred(self, u: Floats) -> Floats:
        """Return u less its mean in each component that floats."""
        return u - self.level(np.asarray(self.mass @ u))


def free_part(
    stiffness: csr_array, mass: csr_array, held: Booleans, positions: Floats | None = None
) -> FreePart:
    """Split a pair of matrices; nothing is copied where nothing is held.

    Examples
    --------
    >>> L = csr_array([[1.0, -1, 0], [-1, 2, -1], [0, -1, 1]])
    >>> part = free_part(L, csr_array(np.eye(3)), np.array([False, False, True]))
    >>> part.stiffness.toarray().tolist(), part.stiffness_border.toarray().tolist()
    ([[1.0, -1.0], [-1.0, 2.0]], [[0.0], [-1.0]])
    """
    free = ~held
    if free.all():
        nothing = csr_array((len(free), 0))
        return FreePart(free, stiffness, mass, nothing, nothing, positions)
    rows, weights = csr_array(stiffness[free]), csr_array(mass[free])
    return FreePart(
        free,
        csr_array(rows[:, free]),
        csr_array(weights[:, free]),
        csr_array(rows[:, held]),
        csr_array(weights[:, held]),
        None if positions is None else positions[free],
    )


def positions_of(laplacian: Laplacian) -> Floats | None:
    """Return where the vertices are, if the pair comes from a mesh."""
    return laplacian.domain.vertices if isinstance(laplacian.domain, Mesh) else None


def held_vertices(hold: ArrayLike, n: int) -> Booleans:
    """Turn indices of held vertices, or a mask of them, into a mask.

    Raises
    ------
    MeshError
        If an index is outside, or nothing is left free.
    """
    held = np.zeros(n, np.bool_)
    held[as_indices(hold, n, "held vertices")] = True
    require_free(held)
    return held


def require_free(held: Booleans) -> None:
    """Raise MeshError if all vertices are held, so that there is no problem to solve."""
    if held.all():
        raise MeshError("all vertices are held", remedy="Leave some free.")


def held_values(vertices: ArrayLike, values: ArrayLike, n: int) -> tuple[Booleans, Floats]:
    """Return the mask of h vertices, and their values (h,) or (h, c) in the order of the mask.

    Raises
    ------
    MeshError
        If a vertex is named twice, or nothing is left free.
    DimensionError, NonFiniteError
        If the values are not one number, h of them or (h, c), or not finite.
    """
    places = as_indices(vertices, n, "held vertices")
    unique, counts = np.unique(places, return_counts=True)
    if len(unique) < len(places):
        raise MeshError("vertices are held twice", vertices=unique[counts > 1])
    given = np.asarray(rectangular(values), np.float64)
    if given.ndim == 0:
        given = np.full(len(places), float(given))
    if given.ndim not in (1, 2) or len(given) != len(places):
        raise DimensionError(
            f"values for {len(places)} held vertices have the shape {given.shape}",
            remedy="Give one number, or one row for each held vertex.",
        )
    require_finite(given, "the values of held vertices")
    return held_vertices(places, n), given[np.argsort(places)]


def like_columns(g: ArrayLike, f: Floats, what: str) -> Floats:
    """Return a second function g as an array like f: alike in every column if it has only one."""
    values = as_function(g, len(f), what)
    if values.ndim == 1 and f.ndim == 2:
        values = np.repeat(values[:, None], f.shape[1], axis=1)
    if values.shape != f.shape:
        raise DimensionError(f"{what} has the shape {values.shape}, and the function {f.shape}")
    return values


def _entries(matrix: csr_array) -> csr_array:
    """Return the matrix without entries that are stored and zero."""
    if matrix.data.all():
        return matrix
    kept = matrix.copy()
    kept.eliminate_zeros()
    return kept
