"""Small corrections of a denoised mesh: some of what was removed, and of what is left."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from beltrami._arrays import Booleans, Floats
from beltrami.diffusion.lengths import lengths_around
from beltrami.diffusion.noise import averaging_matrix
from beltrami.mesh.mesh import Mesh

_REMOVED = (2, 3, 4, 5, 6)  # rounds of averaging
_LEFT = (1, 2, 3, 4, 5, 6)
_REMOVED_HERE, _LEFT_HERE = (2, 4), (1, 2, 4)  # of those that depend on the place
_LENGTH, _LENGTHS = 1.0, 0.15  # what is usual, and how much that differs, in the unit
_BENDS = 0.15
_BENT, _MORE_BENT = 0.1, 0.1
_MOST = 3.0  # a place is not more unusual than that
_CHANCE = 4.0  # squares of directions below so many times those of chance count for nothing
_SURE = 4.0  # standard deviations that are no chance
_CHEAP, _DEAR = 0.015, 0.06  # of the risk: what fitting so many weights to the noise may cost
_ALIKE = 1e-6  # eigenvalue of the correlations, below which a direction is none
TERMS = len(_REMOVED) + len(_LEFT) + 3 * (len(_REMOVED_HERE) + len(_LEFT_HERE))


@dataclass(frozen=True, eq=False)
class Corrections:
    """Weights of the terms, none of them if nothing is corrected.

    Attributes
    ----------
    unit
        Mean length of the edges of the noisy mesh.
    weights
        (26,) or (0,), without a unit.
    size
        Root mean square of what they move.
    """

    unit: float
    weights: Floats
    size: float

    def of(self, mesh: Mesh, x: Floats) -> Floats:
        """Correct x (n, 3), which ``mesh`` was filtered to."""
        if not len(self.weights):
            return x
        normals = mesh.with_vertices(x).vertex_normals
        way = np.zeros(len(x))
        for weight, term in zip(self.weights, _terms(mesh, x, normals, self.unit), strict=True):
            way += weight * term
        return np.asarray(x + way[:, None] * normals)


NONE = Corrections(0.0, np.zeros(0), 0.0)


def best_corrections(
    mesh: Mesh,
    core: Booleans,
    x: Floats,
    changed: Sequence[tuple[Floats, Floats]],
    sigma: float,
    risk: float,
) -> Corrections:
    r"""Return those that make Stein's estimate of the error of :math:`x + \sum_k a_k f_k n` least.

    The terms :math:`f_k` are lengths along the normals n of x: what was removed from the mesh y,
    averaged over neighbours :math:`\tilde W^k ((y - x) \cdot n)` some times, and how x would move
    by averages, :math:`(\tilde W^k x - x) \cdot n`. Some of them are also taken times the mean
    length of the edges at the vertex, the mean curvature, and its size, from what is usual: short
    edges and bent places want another filter than the rest. No mixture of filters that are the
    same everywhere can do that.

    The gain :math:`2 a \cdot c - a^T G a` with :math:`G = \langle f_j, f_k \rangle / n` and
    :math:`c = (\langle f_k n, y - x \rangle - \sigma^2 \mathrm{div}(f_k n)) / n` is unbiased (Stein
    1981; Luisier, Blu and Unser 2007). In each eigendirection of the correlations of the terms,
    the coefficient z, of the variance :math:`\sigma^2/n` by chance, is shrunk by
    :math:`\max(0, 1 - s\sigma^2/(n z^2))` (James and Stein 1961), s = 4, or more where fitting all
    the weights to the noise would cost more than 1.5 % of the risk.

    Parameters
    ----------
    mesh, core
        The noisy mesh y, and (n,) the vertices that count.
    x
        (n, 3) positions it was filtered to.
    changed
        Small random changes of y along its normals, and what y + change is filtered to.
    sigma, risk
        The level of the noise, and the estimated mean square error of x.

    Returns
    -------
    Corrections: ``NONE`` if there are so few vertices that fitting the weights to the noise may
    cost more than 6 % of the risk, if the gain may be chance, or if they are larger than the error
    is said to be: nothing can gain that. Cost: O(n), for each change 12
    averages over neighbours.
    """
    n = int(core.sum())
    if not TERMS * sigma**2 <= _DEAR * n * risk:
        return NONE
    chance = _CHANCE * max(1.0, TERMS * sigma**2 / (_CHEAP * n * risk))
    unit = float(mesh.edge_lengths.mean())
    gram, agreement = _gain(mesh, core, x, changed, sigma, unit)
    weights = shrunk_weights(gram, agreement, sigma**2 / n, chance)
    size = math.sqrt(max(float(weights @ gram @ weights), 0.0))
    gain = 2 * float(weights @ agreement) - size**2
    if not gain > _SURE * 2 * sigma * size / math.sqrt(n) or size**2 > risk:
        return NONE  # chance, or more than there is to gain
    return Corrections(unit, weights, size)


def _gain(
    mesh: Mesh,
    core: Booleans,
    x: Floats,
    changed: Sequence[tuple[Floats, Floats]],
    sigma: float,
    unit: float,
) -> tuple[Floats, Floats]:
    """Return G and c, the divergences measured by the changes."""
    n = int(core.sum())
    normals = mesh.with_vertices(x).vertex_normals
    terms = np.stack([f[core] for f in _terms(mesh, x, normals, unit)])
    divergence = np.zeros(TERMS)
    for change, moved in changed:
        other, there = mesh.with_vertices(mesh.vertices + change), mesh.with_vertices(moved)
        toward = np.einsum("ij,ij->i", there.vertex_normals, change)[core]
        square = float((change[core] ** 2).sum()) / n
        for k, f in enumerate(_terms(other, moved, there.vertex_normals, unit)):
            divergence[k] += float(f[core] @ toward) / square
        divergence -= terms @ np.einsum("ij,ij->i", normals, change)[core] / square
    removed = np.einsum("ij,ij->i", mesh.vertices - x, normals)[core]
    agreement = (terms @ removed - sigma**2 * divergence / len(changed)) / n
    return terms @ terms.T / n, np.asarray(agreement)


def shrunk_weights(
    gram: Floats, agreement: Floats, variance: float, chance: float = _CHANCE
) -> Floats:
    r"""Return the shrunk solution a of :math:`G a = c`, c with errors of the covariance v G.

    Parameters
    ----------
    gram, agreement, variance
        G, (k, k), c, (k,), and v.
    chance
        Squares of z below so many times v count for nothing.

    Examples
    --------
    >>> shrunk_weights(np.diag([4.0, 1.0]), np.array([8.0, 0.1]), 0.01).round(3).tolist()
    [1.995, 0.0]
    """
    norms = np.sqrt(np.diag(gram))
    norms[norms == 0] = 1.0
    values, vectors = np.linalg.eigh(gram / norms / norms[:, None])
    kept = values > _ALIKE
    roots = np.sqrt(values[kept])
    z = vectors[:, kept].T @ (agreement / norms) / roots
    squares = np.maximum(z**2, np.finfo(float).tiny)
    shares = np.maximum(1 - chance * variance / squares, 0.0)
    return np.asarray(vectors[:, kept] @ (shares * z / roots) / norms)


def _terms(mesh: Mesh, x: Floats, normals: Floats, unit: float) -> Iterator[Floats]:
    """Yield (n,) terms in the unit of length, of positions x with these normals."""
    W = averaging_matrix(mesh.topology.adjacency)
    removed, left = {}, {}
    f, z = np.einsum("ij,ij->i", mesh.vertices - x, normals), x
    for k in range(1, max(*_REMOVED, *_LEFT) + 1):
        f, z = W @ f, W @ z
        removed[k], left[k] = f, np.einsum("ij,ij->i", z - x, normals)
    yield from (removed[k] for k in _REMOVED)
    yield from (left[k] for k in _LEFT)
    for factor in _places(mesh, x, W @ left[1], unit):
        yield from (factor * removed[k] for k in _REMOVED_HERE)
        yield from (factor * left[k] for k in _LEFT_HERE)


def _places(mesh: Mesh, x: Floats, bend: Floats, unit: float) -> Iterator[Floats]:
    """Yield how unusual the edges at each vertex, its mean curvature and the size of that are."""
    for value in (
        (lengths_around(mesh, x) / unit - _LENGTH) / _LENGTHS,
        bend / unit / _BENDS,
        (np.abs(bend) / unit - _BENT) / _MORE_BENT,
    ):
        yield np.clip(value, -_MOST, _MOST)
