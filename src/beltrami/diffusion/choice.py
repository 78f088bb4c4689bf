"""How to filter a mesh: the mixtures of filters with the least estimate of the error."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from beltrami._arrays import Booleans, Floats
from beltrami.diffusion.candidates import (
    EVENING,
    OF_NORMALS,
    SECOND,
    Bench,
    Filter,
    OfNormals,
    along_normals,
    filtered,
)
from beltrami.diffusion.colour import NoiseColour
from beltrami.diffusion.corrections import NONE, Corrections, best_corrections
from beltrami.diffusion.linear_filters import AT_BORDERS, IN_PARTS, LINEAR, Linear
from beltrami.diffusion.patches import Sample
from beltrami.diffusion.risk import best_mixture, mixture_risk
from beltrami.mesh.mesh import Mesh
from beltrami.solvers.locality import LocalRows

_PROBE = 0.3  # size of the probe that measures divergences, in σ
_PROBED = 16_000  # vertices that are probed, at least, by probing small meshes twice
_MOST_PROBES = 2
_SEED = 20_110
_SAME = 0.005  # relative change of a level from cut to cut, twice
_MANY = 10_000  # vertices; of fewer, changes are larger by chance
_NEAR = 0.15  # relative change of the level by that at most
_NEAR_IF_COLOURED = 0.4  # where lower frequencies are guessed
CAUTION = 1.05  # of σ: see the notes of denoise
CAUTION_ON_SMOOTH = 1.15  # where a mixture fits the noise more than the shape
_SURE = 1.5  # standard deviations that are no chance
_SURE_OF_MORE = 4.0  # where low passes seem to do all, or all was done once
_BLIND_TO_CREASES = 0.15  # weight of low passes that are; where they have less, corrections harm
_LEAST = 0.005  # weights below this are left out
LOW_PASSES: tuple[Filter, ...] = (*LINEAR, *IN_PARTS)
ALL = (*LOW_PASSES, *OF_NORMALS)
AS_IT_IS, ALONG_NORMALS = "as it is", "along normals"  # the first mixture, seconded by itself


@dataclass(frozen=True, eq=False)
class Choice:
    """Weights of the filters of the mesh, of those of the result, and the risk that is left.

    ``second`` has two weights more than ``SECOND``, for the result as it is, and with only what is
    along the normals of its displacements. The risk is the estimated mean square error, for noise
    of the level sigma, before the corrections: what they gain is left to make up for the choice,
    which was made on the same noise.
    """

    sigma: float
    filters: tuple[Filter, ...]
    first: Floats
    second: Floats
    risk: float
    corrections: Corrections = NONE


NOTHING = Choice(0.0, (), np.zeros(0), np.zeros(0), 0.0)


@dataclass(frozen=True, eq=False)
class _Trial:
    """A mesh, where it counts, and changes of it of the mean square ``square``.

    Mixtures are chosen as if σ were ``caution`` times as large, for noise of the colour along the
    normals; ``rows`` are those of W̃.
    """

    mesh: Mesh
    core: Booleans
    probes: list[Floats]
    square: float
    caution: float
    normals: Floats
    colour: NoiseColour | None
    rows: LocalRows

    def mixture(
        self, here: list[Floats], there: list[list[Floats]], sigma: float, simple: int, sure: float
    ) -> tuple[Floats, float]:
        """Return the best mixture of the positions ``here``, and its risk.

        ``there`` is what they are for the changed copies. Unless the mixture of all is better by
        ``sure`` times what may be chance, the best one of the first ``simple`` is taken. Where the
        noise has a colour, more may be chance, and the result goes a part of the way from that one
        to the mixture of all: see ``sure_share``.
        """
        core, n = self.core, int(self.core.sum())
        moves = np.stack([(x - self.mesh.vertices)[core].ravel() for x in here])
        change = [
            [np.vdot((y - x)[core], probe[core]) for x, y in zip(here, moved, strict=True)]
            for moved, probe in zip(there, self.probes, strict=True)
        ]
        gram = moves @ moves.T / n
        # no filter that takes noise away turns it over: below 0 is chance, or a probe too small
        divergence = np.maximum(np.mean(change, axis=0) / self.square / n, 0.0)
        cautious = self.caution * sigma
        weights = best_mixture(gram, divergence, cautious)
        plain = np.zeros_like(weights)
        plain[:simple] = best_mixture(gram[:simple, :simple], divergence[:simple], cautious)
        costs = [mixture_risk(w, gram, divergence, cautious) for w in (weights, plain)]
        chance = self.chance(_mixed(weights, here), _mixed(plain, here), sigma)
        if self.colour is not None:
            share = sure_share(costs[1] - costs[0], sure * chance)
            weights = share * weights + (1 - share) * plain
        elif costs[1] - costs[0] < sure * chance:
            weights = plain
        risk = mixture_risk(weights, gram, divergence, sigma)
        # the noise that is left is at least what a filter of this divergence must leave
        return weights, max(risk, (sigma * float(weights @ divergence)) ** 2)

    def chance(self, x: Floats, y: Floats, sigma: float) -> float:
        """Return the standard deviation of what the noise adds to the difference of two risks.

        It adds 2⟨x - y, noise⟩/n: of the deviation 2σ |x - y|/n if it is white, but noise that is
        strong at low frequencies has more in common with what two low passes leave.
        """
        apart, n = (x - y) * self.core[:, None], int(self.core.sum())
        if self.colour is None:
            return 2 * sigma * float(np.linalg.norm(apart)) / n
        degrees = np.diff(self.mesh.topology.adjacency.indptr)
        along = np.einsum("ij,ij->i", apart, self.normals)
        deviation = self.colour.deviation(self.rows, degrees, along)
        return 2 * sigma * deviation / self.colour.level(self.rows) / n

    def level(
        self, here: list[Floats], there: list[list[Floats]], sigma: float, near: float
    ) -> float | None:
        """Return the level of what low passes remove, if it is the same for a range of cuts.

        The most even place of the longest such range counts; None, if there is none ``near`` σ.

        What a low pass H removes is (Id - H) of the noise, and of the shape: that the level of
        this noise does not change from cut to cut says that nothing is removed of the shape, and
        then no estimate uses the data better. On shapes with details there is no such range.
        """
        core = self.core
        removed = [((x - self.mesh.vertices)[core] ** 2).sum() for x in here]
        of_probe = [
            [((y - x - probe)[core] ** 2).sum() for x, y in zip(here, moved, strict=True)]
            for moved, probe in zip(there, self.probes, strict=True)
        ]
        shares = np.mean(of_probe, axis=0) / self.square
        if not min(removed) > 0 or not shares.min() > 0:
            return None
        levels = np.sqrt(np.array(removed) / shares)
        change = np.abs(np.diff(np.log(levels)))
        worst = np.maximum(change[1:], change[:-1])
        worst[np.abs(np.log(levels[1:-1] / sigma)) > near] = np.inf
        alike = worst < _SAME * max(1.0, math.sqrt(_MANY / core.sum()))
        ends = np.flatnonzero(np.diff(np.concatenate([[False], alike, [False]])))
        if not len(ends):
            return None
        begin, end = max(ends.reshape(-1, 2).tolist(), key=lambda run: run[1] - run[0])
        return float(levels[begin + 1 + worst[begin:end].argmin()])


def sure_share(gain: float, chance: float) -> float:
    """Return how much of a step is taken that gains something, of which much may be chance.

    At its end, where the estimate is least, the step agrees with the data by twice the gain:
    shrunk as James and Stein (1961) do, by the square of what may be chance over that.

    Examples
    --------
    >>> [round(sure_share(gain, 2.0), 2) for gain in (0.0, 0.9, 2.0, 10.0)]
    [0.0, 0.0, 0.75, 0.99]
    """
    if not gain > 0:
        return 0.0
    least = chance / (2 * gain)
    return max(1 - least * least, 0.0)


def choose(
    sample: Sample,
    sigma: float,
    normals: Floats,
    filters: tuple[Filter, ...] = ALL,
    *,
    known: bool = True,
    caution: float = CAUTION,
    evening: Linear = EVENING,
    colour: NoiseColour | None = None,
) -> Choice:
    """Choose mixtures and corrections for noise of the level σ along ``normals``, on a sample.

    Of ``filters``, the first ones are ``LINEAR``; there is only the first mixture unless some are
    ``OfNormals``. If σ is not ``known``, a better one may be found. Mixtures are chosen as if σ
    were ``caution`` times as large, and more where there is little but noise to fit; filters look
    at the mesh after ``evening``. Noise of a ``colour`` is probed by noise of the same: Stein's
    estimate with its covariance.
    """
    plain = not any(isinstance(one, OfNormals) for one in filters)
    simple = sum(isinstance(one, Linear) and not one.in_parts for one in filters)
    mesh = sample.mesh
    bench = Bench.of(mesh, evening)
    probes = [_PROBE * sigma * along[:, None] * normals for along in _directions(bench, colour)]
    others = [mesh.with_vertices(mesh.vertices + probe) for probe in probes]
    benches = [bench.moved(other) for other in others]  # the weights depend on the noise too
    here = filtered(mesh, bench, filters)
    there = [filtered(other, b, filters) for other, b in zip(others, benches, strict=True)]
    square = (_PROBE * sigma) ** 2
    trial = _Trial(mesh, sample.core, probes, square, caution, normals, colour, bench.rows)
    k = sum(not one.by_length for one in LINEAR)
    near = _NEAR if colour is None else _NEAR_IF_COLOURED
    level = trial.level(here[1:k], [moved[1:k] for moved in there], sigma, near)
    sure = _SURE if level is None else _SURE_OF_MORE
    if level is not None:  # what is left of the noise is all there is of the error
        trial = replace(trial, caution=max(caution, CAUTION_ON_SMOOTH))
    sigma = sigma if known or level is None else level
    first, risk = trial.mixture(here, there, sigma, simple, sure)
    if plain:
        return Choice(sigma, filters, first, np.zeros(0), risk)
    here = _seconds(mesh, bench, _mixed(first, here))
    there = [
        _seconds(other, b, _mixed(first, x))
        for other, b, x in zip(others, benches, there, strict=True)
    ]
    trial = replace(trial, caution=max(caution, CAUTION_ON_SMOOTH))
    second, risk = trial.mixture(here, there, sigma, 1, _SURE_OF_MORE)
    chosen = Choice(sigma, filters, first, second, risk)
    if first[:simple].sum() < _BLIND_TO_CREASES:
        return chosen
    moved = [(probe, _mixed(second, x)) for probe, x in zip(probes, there, strict=True)]
    done = _mixed(second, here)
    corrections = best_corrections(mesh, sample.core, done, moved, sigma, risk)
    return replace(chosen, corrections=corrections)


def with_borders(filters: tuple[Filter, ...]) -> tuple[Filter, ...]:
    """Return them, and those low passes that average borders along themselves, after ``LINEAR``."""
    return (*filters[: len(LINEAR)], *AT_BORDERS, *filters[len(LINEAR) :])


def _directions(bench: Bench, colour: NoiseColour | None) -> Floats:
    """Return random changes along the normals, of the mean square 1 and of the colour."""
    n = len(bench.normals)
    random = np.random.default_rng(_SEED)
    count = min(_MOST_PROBES, math.ceil(_PROBED / n))
    white = np.stack([random.choice([-1.0, 1.0], n) for _ in range(count)])
    if colour is None:
        return white
    noise = colour.noise(bench.rows, white.T).T
    return np.asarray(noise / np.sqrt((noise**2).mean(axis=1, keepdims=True)))


def _seconds(mesh: Mesh, bench: Bench, x: Floats) -> list[Floats]:
    return [x, along_normals(mesh, x), *filtered(mesh, bench, SECOND, x)]


def apply(mesh: Mesh, bench: Bench, choice: Choice) -> Floats:
    """Apply the mixtures, without the filters of hardly any weight; nothing, if none was chosen."""
    if not choice.filters:
        return mesh.vertices
    filters, weights = _heaviest(choice.filters, choice.first)
    x = _mixed(weights, filtered(mesh, bench, filters))
    if not len(choice.second):
        return x
    seconds, weights = _heaviest((AS_IT_IS, ALONG_NORMALS, *SECOND), choice.second)
    moved = filtered(mesh, bench, [one for one in seconds if not isinstance(one, str)], x)
    if ALONG_NORMALS in seconds:
        moved.insert(0, along_normals(mesh, x))
    if AS_IT_IS in seconds:
        moved.insert(0, x)
    return choice.corrections.of(mesh, _mixed(weights, moved))


def _mixed(weights: Floats, positions: list[Floats]) -> Floats:
    """Return Σ w x for weights that add to 1; what all leave in its place stays there exactly."""
    total = positions[0].copy()
    for weight, x in zip(weights[1:], positions[1:], strict=True):
        total += weight * (x - positions[0])
    return total


T = TypeVar("T")


def _heaviest(filters: Sequence[T], weights: Floats) -> tuple[list[T], Floats]:
    kept = np.flatnonzero(weights >= _LEAST)
    chosen = weights[kept]
    return [filters[int(i)] for i in kept], np.asarray(chosen / chosen.sum())


def named(filters: Sequence[Filter | str], weights: Floats) -> tuple[tuple[str, float], ...]:
    """Return (name, weight) of the filters that are applied, the heaviest first."""
    order = [i for i in np.argsort(-weights, kind="stable") if weights[i] >= _LEAST]
    return tuple((str(filters[i]), float(weights[i])) for i in order)
