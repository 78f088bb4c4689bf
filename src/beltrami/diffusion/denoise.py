"""denoise: a mesh without its noise, and without a knob."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from beltrami._arrays import Floats
from beltrami._carded import Carded
from beltrami._progress import Progress
from beltrami.diffusion.candidates import (
    LINEAR,
    OF_NORMALS,
    SECOND,
    Bench,
    Filter,
    along_normals,
    filtered,
    smooth_normals,
)
from beltrami.diffusion.noise import NoiseLevel, noise_level
from beltrami.diffusion.patches import sample_of
from beltrami.diffusion.risk import best_mixture, mixture_risk
from beltrami.diffusion.smoothing import average
from beltrami.diffusion.vertex_update import require_agreeing_normals
from beltrami.errors import BeltramiError, check_name
from beltrami.mesh.mesh import Mesh

DENOISING_METHODS = ("auto", "linear")
_SAMPLE = 40_000  # faces on which the mixture is chosen
_SMALL = 200  # vertices below which only linear filters are trusted
_PROBE = 0.1  # size of the probe that measures divergences, in σ
_PROBED = 16_000  # vertices that are probed, at least, by probing small meshes several times
_MOST_PROBES = 4
_SEED = 20_110
_ROUGHNESS = (0.3, 1.0, 2.0)  # weights of the roughness beside the risk
_SLACK = 1.03  # the smoother mixture is taken if its risk is no larger than by this factor
_LEAST = 0.005  # weights below this are left out


@dataclass(frozen=True, eq=False, repr=False)
class Denoised(Carded):
    """A denoised mesh, and what was found and done.

    Attributes
    ----------
    mesh
        The result; the topology is the same.
    noise
        What was found of the noise.
    sigma
        The level it was taken for: standard deviation along the normals, in the unit of length.
    mixture, second
        (filter, weight) of the mixture that was applied, and of the one that was applied to its
        result.
    predicted_error
        Root mean square distance of the vertices from the truth that is expected (Stein), in the
        unit of length.
    volume_change
        Relative; NaN if the mesh has a boundary.
    warnings
        Why the result may be worse than predicted; only linear filters were used then.
    """

    mesh: Mesh
    noise: NoiseLevel
    sigma: float
    mixture: tuple[tuple[str, float], ...]
    second: tuple[tuple[str, float], ...]
    predicted_error: float
    volume_change: float
    warnings: tuple[str, ...]

    def __repr__(self) -> str:
        main = self.mixture[0][0] if self.mixture else "nothing to do"
        return f"<Denoised: σ = {self.sigma:.3g}, mostly {main}>"


@dataclass(frozen=True, eq=False)
class _Choice:
    filters: tuple[Filter, ...]
    first: Floats
    second: Floats
    risk: float


def denoise(
    mesh: Mesh,
    method: str = "auto",
    noise: float | None = None,
    *,
    progress: Progress | None = None,
) -> Denoised:
    r"""Remove the noise of a mesh; how much there is, and how, is found from the mesh.

    The level of the noise is measured along the normals (``noise_level``). Then 63 filters are
    tried: linear ones, bilateral and guided filters of the normals, and normals of small total
    variation, of many strengths; and mixed with those weights that make Stein's unbiased estimate
    of the error least. The result is filtered once more, by normals, if that lowers the estimate.
    The first displacements are along the normals, so that little shrinks or slides; the estimate
    counts what the second ones move sideways as error.

    Chapter items: P15, P42, P43, P45.

    Parameters
    ----------
    mesh
        In space, its faces turned alike; open, of several components or not manifold is fine.
    method
        ``"auto"``, or ``"linear"`` for linear filters alone.
    noise
        Standard deviation of the noise along the normals, in the unit of length, if it is known.

    Returns
    -------
    Denoised: the mesh first. If the noise does not look white and Gaussian, or is very strong, it
    says so in ``warnings``, and only linear filters are used: the estimate of their error needs no
    Gaussian. Then the level is the root mean square, outliers included.

    Raises
    ------
    DimensionError, EmptyMeshError, NonFiniteError, DegenerateFaceError
        If the mesh is not in space, has no faces, or a coordinate or face is not valid.
    MeshError
        If faces that share an edge disagree about the outside.
    BeltramiError
        If ``noise`` is negative.

    Notes
    -----
    On more than 40,000 faces the mixture is chosen on eight patches; below 200 vertices it is of
    linear filters alone. The divergences in Stein's estimate are measured by one to four small
    random changes of the input, from a fixed seed (Ramani, Blu and Unser 2008), so the same mesh
    gives the same result. Each mixture is chosen with a small
    penalty on roughness, and the second with the largest one that costs less than 3 % of risk:
    so normals, which ask for more smoothing than positions, are served too.

    References: Stein 1981; Luisier, Blu and Unser 2007; Zheng et al. 2011; Zhang et al. 2015.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> sphere = icosphere(4)
    >>> noise = np.random.default_rng(0).normal(0, 0.01, sphere.n_vertices)
    >>> noisy = sphere.with_vertices(sphere.vertices * (1 + noise)[:, None])
    >>> clean = denoise(noisy)
    >>> round(clean.sigma, 3)
    0.01
    >>> error = np.linalg.norm(clean.mesh.vertices - sphere.vertices, axis=1)
    >>> bool(np.sqrt((error**2).mean()) < 0.003)
    True
    """
    check_name("method of denoising", method, DENOISING_METHODS)
    if noise is not None and not (math.isfinite(noise) and noise >= 0):
        raise BeltramiError(f"the noise must be finite and >= 0, not {noise}")
    require_agreeing_normals(mesh)
    tell = progress or (lambda _done, _total: None)
    bench = Bench.of(mesh)
    normals = smooth_normals(mesh, bench)
    found = noise_level(
        mesh.topology.adjacency, mesh.vertices, float(mesh.edge_lengths.mean()), normals
    )
    sigma = noise if noise is not None else found.spread if found.warnings else found.sigma
    if sigma == 0:
        unchanged = 0.0 if mesh.is_closed else math.nan
        return Denoised(mesh, found, 0.0, (), (), 0.0, unchanged, found.warnings)
    tell(1, 4)
    plain = method == "linear" or bool(found.warnings) or mesh.n_vertices < _SMALL
    sample, vertices = sample_of(mesh, _SAMPLE)
    choice = _choose(sample, sigma, normals[vertices], plain)
    tell(3, 4)
    moved = _applied(mesh, bench, choice)
    result = mesh.with_vertices(moved)
    tell(4, 4)
    return Denoised(
        result,
        found,
        float(sigma),
        _named(choice.filters, choice.first),
        _named(SECOND, choice.second[1:]),
        math.sqrt(max(choice.risk, 0.0)),
        result.volume / mesh.volume - 1 if mesh.is_closed else math.nan,
        found.warnings,
    )


def _choose(mesh: Mesh, sigma: float, normals: Floats, plain: bool) -> _Choice:
    """Choose both mixtures on a mesh, by the same filters on slightly changed copies."""
    bench = Bench.of(mesh)
    n = mesh.n_vertices
    random = np.random.default_rng(_SEED)
    probes = [
        _PROBE * sigma * random.choice([-1.0, 1.0], n)[:, None] * normals
        for _ in range(min(_MOST_PROBES, math.ceil(_PROBED / n)))
    ]
    others = [mesh.with_vertices(mesh.vertices + probe) for probe in probes]

    def mixtures(here: list[Floats], there: list[list[Floats]]) -> list[tuple[Floats, float]]:
        """Return the best mixtures, smoother and smoother, with their risks."""
        moves = np.stack([(x - mesh.vertices).ravel() for x in here])
        gram = moves @ moves.T / n
        change = np.array(
            [
                [np.vdot(y - x, probe) for x, y in zip(here, changed, strict=True)]
                for changed, probe in zip(there, probes, strict=True)
            ]
        )
        divergence = change.mean(axis=0) / (_PROBE * sigma) ** 2 / n
        rough = np.stack([(x - average(bench.rows, x, np.ones(1))).ravel() for x in here])
        penalty = rough @ rough.T / n
        tried = [best_mixture(gram, divergence, sigma, weight * penalty) for weight in _ROUGHNESS]
        return [(w, mixture_risk(w, gram, divergence, sigma)) for w in tried]

    filters = LINEAR if plain else (*LINEAR, *OF_NORMALS)
    here = filtered(mesh, bench, filters)
    there = [filtered(other, bench, filters) for other in others]
    tried = mixtures(here, there)
    if plain:
        first, risk = _smoothest(tried)
        return _Choice(filters, first, np.ones(1), risk)
    first, _ = tried[0]
    x = along_normals(mesh, _mixed(first, here))
    here = [x, *filtered(mesh, bench, SECOND, x)]
    for i, other in enumerate(others):
        y = along_normals(other, _mixed(first, there[i]))
        there[i] = [y, *filtered(other, bench, SECOND, y)]
    second, risk = _smoothest(mixtures(here, there))
    return _Choice(filters, first, second, risk)


def _smoothest(tried: list[tuple[Floats, float]]) -> tuple[Floats, float]:
    """Return the last mixture whose risk is hardly larger than that of the first."""
    limit = _SLACK * tried[0][1]
    return next((one for one in reversed(tried) if one[1] <= limit), tried[0])


def _mixed(weights: Floats, positions: list[Floats]) -> Floats:
    total = np.zeros_like(positions[0])
    for weight, x in zip(weights, positions, strict=True):
        total += weight * x
    return total


def _applied(mesh: Mesh, bench: Bench, choice: _Choice) -> Floats:
    """Apply the mixtures to the whole mesh, without the filters of hardly any weight."""
    filters, weights = _heaviest(choice.filters, choice.first)
    x = along_normals(mesh, _mixed(weights, filtered(mesh, bench, filters)))
    seconds, weights = _heaviest((None, *SECOND), choice.second)
    chosen = [one for one in seconds if one is not None]
    moved = filtered(mesh, bench, chosen, x)
    if len(chosen) < len(seconds):
        moved.insert(seconds.index(None), x)
    return _mixed(weights, moved)


T = TypeVar("T")


def _heaviest(filters: Sequence[T], weights: Floats) -> tuple[list[T], Floats]:
    kept = np.flatnonzero(weights >= _LEAST)
    chosen = weights[kept]
    return [filters[int(i)] for i in kept], np.asarray(chosen / chosen.sum())


def _named(filters: Sequence[Filter], weights: Floats) -> tuple[tuple[str, float], ...]:
    order = [i for i in np.argsort(-weights, kind="stable") if weights[i] >= _LEAST]
    return tuple((str(filters[i]), float(weights[i])) for i in order)
