"""denoise_function: a function on a mesh without its noise, and without a knob."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from beltrami._arrays import Floats, as_function
from beltrami._kinds import checked
from beltrami._progress import Progress
from beltrami.diffusion.noise import Differences, NoiseLevel, noise_level
from beltrami.diffusion.risk import best_mixture, mixture_risk
from beltrami.errors import BeltramiError, MeshError
from beltrami.mesh.edge_matrix import symmetric_matrix
from beltrami.operators.areas import diagonal_matrix
from beltrami.operators.domain import require_laplacian
from beltrami.operators.pair import Laplacian
from beltrami.solvers.factorize import factorize

_STRENGTHS = np.geomspace(0.05, 2e4, 9)  # of δ λ̄, λ̄ the mean eigenvalue
_LEAST = 0.005  # weights below this are not told
_SEED = 20_110
_PROBED = 20_000  # vertices probed at least, by several probes where there are fewer
_MOST_PROBES = 16


@dataclass(frozen=True, eq=False, repr=False)
class DenoisedFunction:
    """A denoised function, and what was found and done; one entry for each column.

    Attributes
    ----------
    values
        (n,) or (n, c), the result.
    noise
        What was found of the noise.
    sigma
        The standard deviation it was taken for.
    mixture
        (filter, weight) of the mixture applied.
    predicted_error
        Root mean square error that is expected (Stein).
    warnings
        Why the error may be larger.
    """

    values: Floats
    noise: tuple[NoiseLevel, ...]
    sigma: tuple[float, ...]
    mixture: tuple[tuple[tuple[str, float], ...], ...]
    predicted_error: tuple[float, ...]
    warnings: tuple[str, ...]

    def __repr__(self) -> str:
        levels = ", ".join(f"{sigma:.3g}" for sigma in self.sigma)
        return f"<DenoisedFunction: σ = {levels}>"


@checked
def denoise_function(
    laplacian: Laplacian,
    f: ArrayLike,
    noise: float | None = None,
    *,
    progress: Progress | None = None,
) -> DenoisedFunction:
    r"""Remove white noise from a function; how much there is, and how, is found from it.

    The filters :math:`(B + \delta L)^{-1}B` (implicit heat) and
    :math:`(B + \delta L B^{-1}L)^{-1}B`, δ from far too small to far too large, are mixed with
    those weights that make Stein's unbiased estimate of the error least, column by column.

    Parameters
    ----------
    laplacian
        The pair (L, B), B diagonal: the cotangent one for functions that are smooth on the
        surface.
    f
        (n,) or (n, c); the noise has one level in each column, at all vertices.
    noise
        Its standard deviation, if it is known.

    Raises
    ------
    MeshError
        If the mass is not diagonal.
    BeltramiError
        If ``noise`` is negative.
    DimensionError, NonFiniteError
        If f does not fit the mesh, or is not finite.

    Notes
    -----
    All filters are linear, so the estimate is unbiased for white noise of any distribution; if
    there are outliers, the level is the root mean square, outliers included.
    Cost: 18 factorisations. The traces of the filters are measured by random signs from a fixed
    seed (Hutchinson), so the same input gives the same result.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> from beltrami.operators.laplacian import laplacian
    >>> sphere = icosphere(4)
    >>> truth = sphere.vertices[:, 2]
    >>> noisy = truth + np.random.default_rng(0).normal(0, 0.3, sphere.n_vertices)
    >>> clean = denoise_function(laplacian(sphere), noisy)
    >>> round(clean.sigma[0], 1), bool(np.std(clean.values - truth) < 0.03)
    (0.3, True)
    """
    require_laplacian(laplacian, "denoising a function")
    values = as_function(f, laplacian.n)
    if noise is not None and not (math.isfinite(noise) and noise >= 0):
        raise BeltramiError(f"the noise must be finite and >= 0, not {noise}")
    if laplacian.mass_kind == "consistent":
        raise MeshError(
            "denoising needs a diagonal mass, and the consistent mass is not",
            remedy='Use mass="voronoi".',
        )
    columns = values.reshape(laplacian.n, -1)
    ones = np.ones(len(laplacian.edges))
    adjacency = symmetric_matrix(laplacian.edges, ones, laplacian.n)
    differences = Differences.of(adjacency)
    found = tuple(noise_level(adjacency, f, differences=differences) for f in columns.T)
    levels = [
        noise if noise is not None else level.spread if level.warnings else level.sigma
        for level in found
    ]
    signs = np.random.default_rng(_SEED).choice(
        [-1.0, 1.0], (laplacian.n, min(_MOST_PROBES, math.ceil(_PROBED / laplacian.n)))
    )
    names, moved, traces = ["nothing"], [columns], [1.0]
    for name, both in _filtered(laplacian, np.concatenate([columns, signs], axis=1), progress):
        names.append(name)
        moved.append(both[:, : columns.shape[1]])
        traces.append(float(np.vdot(signs, both[:, columns.shape[1] :]) / signs.size))
    parts = [
        _mixed(np.stack([x[:, j] for x in moved]), np.array(traces), sigma, names)
        for j, sigma in enumerate(levels)
    ]
    return DenoisedFunction(
        np.stack([part[0] for part in parts], axis=1).reshape(values.shape),
        found,
        tuple(float(sigma) for sigma in levels),
        tuple(part[1] for part in parts),
        tuple(part[2] for part in parts),
        tuple(dict.fromkeys(text for level in found for text in level.warnings)),
    )


def _mixed(
    filtered: Floats, traces: Floats, sigma: float, names: list[str]
) -> tuple[Floats, tuple[tuple[str, float], ...], float]:
    """Mix what the filters made of one column, which comes first; say how, and the error."""
    moves = filtered - filtered[0]
    gram = moves @ moves.T / filtered.shape[1]
    weights = best_mixture(gram, traces, sigma)
    order = np.argsort(-weights, kind="stable")
    mixture = tuple((names[int(i)], float(weights[i])) for i in order if weights[i] > _LEAST)
    error = math.sqrt(max(mixture_risk(weights, gram, traces, sigma), 0.0))
    return np.asarray(filtered[0] + weights @ moves), mixture, error


def _filtered(
    laplacian: Laplacian, values: Floats, progress: Progress | None
) -> Iterator[tuple[str, Floats]]:
    """Yield the name of each filter and what it makes of the columns."""
    L, B = laplacian.stiffness, laplacian.mass
    mean = float(L.diagonal().sum() / laplacian.masses.sum())
    if not mean > 0:  # no edges, or weights that vanish: nothing to average with
        return
    bent = csr_array(L @ diagonal_matrix(1 / laplacian.masses) @ L)
    right = laplacian.masses[:, None] * values
    positions = getattr(laplacian.domain, "vertices", None)
    for i, strength in enumerate(_STRENGTHS):
        for name, matrix, delta in (
            ("implicit heat", L, strength / mean),
            ("bi-Laplacian", bent, (strength / mean) ** 2),
        ):
            factor = factorize(csr_array(B + delta * matrix), positions)
            yield f"{name}, δ = {delta:.3g}", factor.solve(right)
        if progress is not None:
            progress(i + 1, len(_STRENGTHS))
