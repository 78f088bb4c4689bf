"""Low passes: the linear filters that denoise mixes, as series of W̃."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.polynomial import Chebyshev
from scipy.sparse import csr_array

from beltrami._arrays import Floats
from beltrami.diffusion.averaging_series import filter_rows_by
from beltrami.diffusion.smoothing import shares_of
from beltrami.mesh.edge_matrix import symmetric_matrix
from beltrami.mesh.mesh import Mesh
from beltrami.operators.areas import diagonal_matrix
from beltrami.solvers.locality import LocalRows, local_rows

_TAIL = 1e-3  # of the gain, that the cut series may leave out
_DEGREE = 500  # at most
_CUTS = np.geomspace(2, 0.004, 16)
_CUTS_IN_PARTS = np.geomspace(2, 0.01, 8)
_CONTRASTS = (0.15, 0.3, 0.5)
_CUTS_AT_BORDERS = np.geomspace(0.8, 0.006, 12)
_SHORTEST = 1e-3  # mean lengths: edges below it weigh no more
_LEAST = 1e-12  # of the weight of an edge, that a crease leaves


@dataclass(frozen=True)
class Linear:
    """The gain 1/(1 + (k/cut)^p) of the frequencies 0 <= k <= 2 of Id - W̃.

    W̃ averages over the neighbours, with equal weights, p = 10, or, ``by_length``, with weights
    1/length, p = 4. With a ``contrast`` s these are times exp(-|n_i - n_j|²/2s²), p = 6, n the
    normals of the evened mesh: what is across a crease has no say, and along a ridge there is more
    smoothing than over it. So sharp a low pass spares what is below the cut; mixtures make others.

    All neighbours of a vertex on the border are on one side. With a share δ of averaging ``along``
    the border, W̃ is (1 - δ) Id + δ C there, C the mean over the neighbours on the border: what the
    mean over all becomes, if those inside have mirror images 2x - x_j behind the border.
    """

    cut: float
    by_length: bool = False
    contrast: float = math.inf
    along: float = 0.0

    def gain(self, k: Floats) -> Floats:
        """Return the gain at the frequencies k."""
        order = 6 if self.in_parts else 4 if self.by_length else 10
        return np.asarray(1 / (1 + (np.maximum(k, 0) / self.cut) ** order))

    @property
    def in_parts(self) -> bool:
        """Whether the normals matter."""
        return self.contrast < math.inf

    @property
    def kind(self) -> Linear:
        """That of its kind with the cut 1: those have W̃ in common."""
        return replace(self, cut=1.0)

    def __str__(self) -> str:
        if self.in_parts:
            weights = f", weights by length and by normals, contrast {self.contrast:g}"
        else:
            weights = ", weights by length" if self.by_length else ""
        if self.along:
            weights += f", {self.along:g} along borders"
        return f"linear, frequencies below {self.cut:.2g}{weights}"


LINEAR = tuple(Linear(float(cut), by_length) for by_length in (False, True) for cut in _CUTS)
IN_PARTS = tuple(
    Linear(float(cut), True, contrast) for contrast in _CONTRASTS for cut in _CUTS_IN_PARTS
)
AT_BORDERS = tuple(
    Linear(float(cut), by_length, along=along)
    for by_length, along in ((False, 0.5), (False, 1.0), (True, 0.7))
    for cut in _CUTS_AT_BORDERS
)


def low_passed(rows: LocalRows, x: Floats, one: Linear) -> Floats:
    """Filter the columns of x (n, 3); ``rows`` are those of the W̃ of the filter.

    Cost: O(degree n), degree about 25 / √cut.
    """
    return low_passes(rows, x, [one])[0]


def low_passes(rows: LocalRows, x: Floats, some: Sequence[Linear]) -> list[Floats]:
    """Filter by each of some filters of one kind: they share the products with W̃."""
    return filter_rows_by(rows, x, [np.array(_series(one)) for one in some])


@cache
def _series(one: Linear) -> Sequence[float]:
    """Return c with gain(k) near Σ c_i T_i(1 - k) on 0 <= k <= 2, and equal at 0."""
    c = np.asarray(Chebyshev.interpolate(lambda x: one.gain(1 - x), _DEGREE).coef, np.float64)
    tails = np.cumsum(np.abs(c[::-1]))[::-1]
    c = c[: max(2, int(np.count_nonzero(tails > _TAIL)))]
    return tuple((c / c.sum()).tolist())


def equal_rows(mesh: Mesh) -> LocalRows:
    """W̃ with equal weights; vertices of no face are left alone."""
    A = mesh.topology.adjacency
    return local_rows(A.indptr, A.indices, shares_of(A), np.diff(A.indptr) == 0)


def rows_by_length(mesh: Mesh) -> LocalRows:
    """W̃ with the weights 1/length: what is near has more to say."""
    return _rows(mesh, _by_length(mesh))


def rows_by_normals(mesh: Mesh, contrast: float) -> LocalRows:
    """W̃ with the weights by length and by normals."""
    return _rows(mesh, weights_by_normals(mesh, contrast))


def weights_by_normals(mesh: Mesh, contrast: float) -> Floats:
    """Return exp(-|n_i - n_j|²/2s²)/length of each edge, s the contrast of the normals."""
    normals, (i, j) = mesh.vertex_normals, mesh.edges.T
    apart = ((normals[i] - normals[j]) ** 2).sum(axis=1)
    return _by_length(mesh) * np.maximum(np.exp(-0.5 * apart / contrast**2), _LEAST)


def rows_along_borders(mesh: Mesh, along: float, *, by_length: bool) -> LocalRows:
    """W̃ with borders averaged along themselves: see ``Linear``.

    Its spectrum is real and in [-1, 1], as that without borders: borders look at nothing else.
    """
    weights = _by_length(mesh) if by_length else np.ones(len(mesh.edges))
    on_border = mesh.topology.on_boundary.astype(np.float64)
    W, C = (
        _means(symmetric_matrix(mesh.edges, w, mesh.n_vertices))
        for w in (weights, weights * (mesh.topology.edge_face_count == 1))
    )
    inside = diagonal_matrix(1 - on_border) @ W + diagonal_matrix((1 - along) * on_border)
    rows = csr_array(inside + diagonal_matrix(along * on_border) @ C)
    return local_rows(rows.indptr, rows.indices, rows.data, np.diff(W.indptr) == 0)


def _means(W: csr_array) -> csr_array:
    total = np.asarray(W.sum(axis=1))
    return csr_array(diagonal_matrix(1 / np.where(total > 0, total, 1.0)) @ W)


def _by_length(mesh: Mesh) -> Floats:
    lengths = mesh.edge_lengths
    floor = _SHORTEST * float(lengths.mean()) if len(lengths) else 0.0
    return np.asarray(1 / np.maximum(lengths, floor)) if floor > 0 else np.ones(len(lengths))


def _rows(mesh: Mesh, weights: Floats) -> LocalRows:
    W = symmetric_matrix(mesh.edges, weights, mesh.n_vertices)
    return local_rows(W.indptr, W.indices, shares_of(W), np.diff(W.indptr) == 0)
