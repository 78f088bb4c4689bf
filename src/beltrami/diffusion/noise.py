"""The level of the noise of a mesh or of a function, from the data alone."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_array, eye_array

from beltrami._arrays import Floats
from beltrami.diffusion.power_norms import power_norms
from beltrami.operators.areas import diagonal_matrix

ORDERS = (1, 2, 3)
_NORMAL = 0.6744897501960817  # median of the absolute values of a standard normal variable
SPIKED = 4.5  # kurtosis beyond which noise is not taken for Gaussian, whose kurtosis is 3
_COLOURED = -0.025  # correlation of neighbours, less that of white noise, of smoothed noise
_CLIP = 3.0  # standard deviations beyond which values do not count for the correlation
STRONG = 0.42  # mean edge lengths, of the noisy mesh, beyond which normals tell little


@dataclass(frozen=True)
class NoiseLevel:
    """What is known of the noise.

    Attributes
    ----------
    sigma
        Standard deviation, in the unit of the data: of a mesh, along its normals.
    spread
        Root mean square of the differences of order 2, outliers counted in.
    by_order
        Estimates of sigma by differences of the order 1, 2 and 3: what is smooth, or noise that
        is, makes the first ones larger.
    kurtosis
        Of the differences of order 2; 3 if the noise is Gaussian, larger if it has spikes.
    correlation
        Of the differences of order 2 at neighbours, less that which white noise has there: about
        0 if the noise is white, negative if it was smoothed; what is left of the shape adds to it.
    relative
        sigma in mean edge lengths; NaN for functions.
    warnings
        Why the noise does not look white and Gaussian, if so.
    """

    sigma: float
    spread: float
    by_order: tuple[float, float, float]
    kurtosis: float
    correlation: float
    relative: float
    warnings: tuple[str, ...]

    @property
    def has_outliers(self) -> bool:
        """Whether a warning says so."""
        return _outliers(self.kurtosis) in self.warnings

    def explained(self) -> NoiseLevel:
        """Return it without the warning of outliers: what they are is known."""
        return self.without(_outliers(self.kurtosis))

    def measured_again(self, sigma: float, edge_length: float) -> NoiseLevel:
        """Return it without the warning of strong noise, if there is less beside the edges."""
        return self if sigma > STRONG * edge_length else self.without(_strong(self.relative))

    def without(self, warning: str | None) -> NoiseLevel:
        """Return it without this warning."""
        return replace(self, warnings=tuple(one for one in self.warnings if one != warning))


class Differences(NamedTuple):
    """Id - W̃, and the norms of the rows of its powers, (3, n): one where there is no neighbour."""

    matrix: csr_array
    norms: Floats

    @classmethod
    def of(cls, adjacency: csr_array) -> Differences:
        """Make them, for all that is measured on one topology."""
        identity = eye_array(adjacency.shape[0], format="csr")
        matrix = csr_array(identity - averaging_matrix(adjacency))
        norms = power_norms(matrix, len(ORDERS))
        norms[:, np.diff(adjacency.indptr) == 0] = 1
        return cls(matrix, norms)


def noise_level(
    adjacency: csr_array,
    f: Floats,
    edge_length: float | None = None,
    directions: Floats | None = None,
    differences: Differences | None = None,
) -> NoiseLevel:
    r"""Estimate the level of white noise on f: median absolute deviation of its rough part.

    The rough part is :math:`R f`, :math:`R = (Id - \tilde W)^3`, each row over its norm, so that
    white noise of the level σ stays so; smooth functions leave little there. The median does not
    see the few vertices at creases, or outliers.

    Parameters
    ----------
    adjacency
        (n, n) symmetric, 1 where two vertices are neighbours; W̃ takes the mean over them.
    f
        (n,), or (n, 3) with ``directions``: then the component along them is taken, after the
        differences.
    edge_length
        Mean length of the edges, if f are positions.
    differences
        Those of the adjacency, if they are known.

    Notes
    -----
    The correlation that white noise has after the differences is measured on white noise, from a
    fixed seed. Cost: O(n) with some hundred operations for each vertex.
    """
    K, norms = differences or Differences.of(adjacency)
    inner = np.diff(adjacency.indptr) > 0
    rough, levels, standard = f, [], {}
    for order, norm in zip(ORDERS, norms, strict=True):
        rough = K @ rough
        along = rough if directions is None else np.einsum("ij,ij->i", rough, directions)
        standard[order] = along / norm
        levels.append(median_level(standard[order][inner]))
    white = K @ (K @ np.random.default_rng(0).standard_normal(len(f))) / norms[1]
    second = standard[2][inner]
    square = float(np.mean(second**2))
    kurtosis = float(np.mean((second / np.sqrt(square)) ** 4)) if square > 0 else 3.0
    excess = _correlation(adjacency, standard[2]) - _correlation(adjacency, white)
    relative = levels[2] / edge_length if edge_length else np.nan
    return NoiseLevel(
        levels[2],
        float(np.sqrt(square)),
        (levels[0], levels[1], levels[2]),
        kurtosis,
        excess,
        float(relative),
        tuple(_warnings(kurtosis, excess, adjacency.nnz // 2, relative)),
    )


def median_level(values: Floats) -> float:
    """Return the standard deviation of Gaussian values: their median absolute deviation from 0."""
    return float(np.median(np.abs(values)) / _NORMAL)


def _correlation(adjacency: csr_array, values: Floats) -> float:
    """Return the mean product of neighbours over the mean square, outliers cut off."""
    level = median_level(values)
    cut = np.clip(values, -_CLIP * level, _CLIP * level)
    square = float(np.mean(cut**2))
    if not square > 0 or not adjacency.nnz:
        return 0.0
    return float(cut @ (adjacency @ cut)) / adjacency.nnz / square


def averaging_matrix(adjacency: csr_array) -> csr_array:
    """Return W̃ (n, n), with the identity where a vertex has no neighbours."""
    degrees = np.diff(adjacency.indptr)
    shares = diagonal_matrix(1 / np.maximum(degrees, 1)) @ adjacency
    return csr_array(shares + diagonal_matrix(np.where(degrees == 0, 1.0, 0.0)))


def _warnings(kurtosis: float, excess: float, edges: int, relative: float) -> list[str]:
    found = []
    if kurtosis > SPIKED:
        found.append(_outliers(kurtosis))
    if edges and excess < _COLOURED - 2 / np.sqrt(edges):
        found.append(
            f"the noise is not white: neighbours are alike (the correlation is off by {excess:.3f})"
        )
    if relative > STRONG:
        found.append(_strong(relative))
    return found


def _strong(relative: float) -> str:
    return f"the noise is very strong: {relative:.2f} mean edge lengths"


def _outliers(kurtosis: float) -> str:
    return (
        f"the rough part has outliers (its kurtosis is {kurtosis:.1f}, that of Gaussian noise "
        "is 3): the noise has spikes, or there is little noise beside sharp features"
    )
