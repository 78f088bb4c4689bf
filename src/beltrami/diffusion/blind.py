"""The choice for a mesh of which nothing is known: measure its noise, choose, and look again."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from beltrami._arrays import Booleans, Floats, Integers
from beltrami.diffusion.candidates import EVENING, EVENING_IF_STRONG, Bench, Filter
from beltrami.diffusion.choice import (
    ALL,
    CAUTION,
    CAUTION_ON_SMOOTH,
    LOW_PASSES,
    Choice,
    apply,
    choose,
    with_borders,
)
from beltrami.diffusion.colour import NoiseColour, noise_colour, with_colour
from beltrami.diffusion.level import level_beside, rough_part
from beltrami.diffusion.linear_filters import LINEAR, equal_rows
from beltrami.diffusion.noise import STRONG, Differences, NoiseLevel, noise_level
from beltrami.diffusion.patches import Sample, sample_of, sizes_of_components
from beltrami.diffusion.spikes import Spikes, find_spikes
from beltrami.mesh.mesh import Mesh

_ENOUGH = 1_500  # vertices, from which noise may be told from creases that are everywhere
FEW = 40  # vertices of a component, below which nobody can tell noise from shape
_TOO_FEW = (
    f"components of less than {FEW} vertices are left as they are: nobody can tell their noise "
    "from their shape (say with noise= how much there is)"
)
_SMALL = 200  # vertices below which only linear filters are trusted
_BORDERS = 0.01  # of the vertices, below which they matter less than what more choice costs
_LOOKS, _LOOKS_IF_STRONG = 1, 2  # at the normals, before the choice
_STRONG_BESIDE = 0.77  # of the least height of half of the faces, of the noisy mesh
_TIMES = 2  # that the level is measured without spikes
_FAINTEST = 1e-3  # mean edges, that noise is taken for beside the outliers of a shape
_ROUNDING = 1e-9  # mean edges, up to which there is no noise
_LEFT = 0.55  # of the square that goes beside a first result, of outliers that are the shape's
_SEED = 12


@dataclass(frozen=True, eq=False)
class Blind:
    """What was found and chosen.

    Attributes
    ----------
    noise
        Of the mesh as it is.
    choice, bench, mesh
        What is to be applied, and to which mesh: the same without the spikes.
    spikes
        The vertices that were taken for such.
    risk
        Mean square error that is expected.
    """

    noise: NoiseLevel
    choice: Choice
    bench: Bench
    mesh: Mesh
    spikes: Integers
    risk: float


def blind_choice(mesh: Mesh, noise: float | None, size: int, *, linear: bool = False) -> Blind:
    """Measure the noise, and choose on a sample of about ``size`` faces; safely, if it is odd.

    Spikes are put where their neighbours say before, and do not count.
    """
    seen = _Seen.of(mesh, noise, size, linear=linear)
    none = np.zeros(0, np.int64)
    if noise is None and seen.largest < FEW:
        told = replace(seen.found, warnings=(_TOO_FEW,))
        return Blind(told, _nothing(), seen.bench, mesh, none, 0.0)
    if noise is None and not linear and seen.found.has_outliers and seen.largest >= _SMALL:
        spikes = find_spikes(mesh)
        if spikes is not None:
            return _without(spikes, seen, size)
    choice = seen.choice()
    return Blind(seen.found, choice, seen.bench, mesh, none, choice.risk)


def _without(spikes: Spikes, before: _Seen, size: int) -> Blind:
    """Choose for the mesh without them; what is left of its kurtosis is small beside them."""
    bench = before.bench.moved(spikes.mesh, EVENING)
    seen = _Seen.of(spikes.mesh, None, size, linear=False, bench=bench, spikes=spikes.found)
    choice = seen.choice()
    count, share = int(spikes.found.sum()), float(spikes.found.mean())
    text = f"{count} vertices were taken for spikes, and put where their neighbours say"
    others = seen.found.explained().warnings
    noise = replace(before.found, warnings=(*before.found.warnings, text, *others))
    of_filling = max(spikes.error**2 - choice.sigma**2, choice.risk)
    risk = (1 - share) * choice.risk + share * of_filling
    return Blind(noise, choice, seen.bench, spikes.mesh, np.flatnonzero(spikes.found), risk)


@dataclass(frozen=True, eq=False)
class _Seen:
    """What is known of a mesh before anything is chosen.

    Attributes
    ----------
    noise
        Its level, if it was said.
    found
        What was measured of it.
    bench, sample
        Of the mesh.
    colour
        Of the noise, if it has one.
    spikes
        The vertices of the sample that were put in the place of spikes, if there were some.
    largest
        Vertices of the largest component.
    looks
        At the normals, before the choice.
    linear, on_border
        Whether only linear filters are asked for, and whether borders matter.
    """

    noise: float | None
    found: NoiseLevel
    bench: Bench
    sample: Sample
    colour: NoiseColour | None
    spikes: Booleans | None
    largest: int
    looks: int
    linear: bool
    on_border: bool

    @classmethod
    def of(
        cls,
        mesh: Mesh,
        noise: float | None,
        size: int,
        *,
        linear: bool,
        bench: Bench | None = None,
        spikes: Booleans | None = None,
    ) -> _Seen:
        """Measure the noise; its bench may be known."""
        bench, looks = bench or Bench.of(mesh), _LOOKS
        found = _level(mesh, bench.normals, spikes)
        largest = int(sizes_of_components(mesh)[1].max())
        edge, height = float(mesh.edge_lengths.mean()), _height(mesh)
        beside = found.sigma > _STRONG_BESIDE * height
        if found.relative > STRONG or beside:
            bench, looks = bench.moved(mesh, EVENING_IF_STRONG), _LOOKS_IF_STRONG
            found = _level(mesh, bench.normals, spikes)
        if beside and not found.relative > STRONG:
            told = (
                f"the noise is strong beside the faces, whose median height is {height / edge:.2f}"
            )
            found = replace(found, warnings=(*found.warnings, f"{told} mean edge lengths"))
        sample = sample_of(mesh, size)
        there = None if spikes is None else spikes[sample.vertices]
        if there is not None:
            sample = replace(sample, core=sample.core & ~there)
        colour = None
        if largest >= _ENOUGH and spikes is None:
            colour = _colour(sample, bench.normals[sample.vertices], edge)
        if colour is not None:
            found = with_colour(found, colour, equal_rows(sample.mesh))
        borders = float(mesh.topology.on_boundary[sample.vertices[sample.core]].mean())
        few = linear or mesh.n_vertices < _SMALL
        seen = cls(
            noise, found, bench, sample, colour, there, largest, looks, few, borders > _BORDERS
        )
        if found.has_outliers and colour is None and mesh.n_vertices >= _SMALL:
            return replace(seen, found=seen._explained(_FAINTEST * edge))
        return seen

    def _explained(self, least: float) -> NoiseLevel:
        """Return what was found, without the warning of outliers if they are the shape's.

        They are if more of them goes than is left beside a first result, for which outliers did
        not count: it tells on which side of a crease a vertex is.
        """
        level = max(self.found.sigma if self.noise is None else self.noise, least)
        normals, low_passes = self.bench.normals[self.sample.vertices], self._low_passes()
        low = self._chosen(level, normals, low_passes, known=True, caution=CAUTION_ON_SMOOTH)
        rough = rough_part(self.sample.mesh, self._filtered(self.sample.mesh, low))
        left, gone = rough.spread**2 - rough.level**2, self.found.spread**2 - rough.spread**2
        return self.found.explained() if left < _LEFT * gone else self.found

    def choice(self) -> Choice:
        """Look, measure the level beside what is seen, and choose."""
        odd = bool(self.found.warnings)
        level = self.found.spread if odd else self.found.sigma
        sigma = level if self.noise is None else self.noise
        if sigma <= _ROUNDING * float(self.sample.mesh.edge_lengths.mean()):
            return _nothing()
        known = self.noise is not None or (odd and self.colour is None)
        normals, low_passes = self.bench.normals[self.sample.vertices], self._low_passes()
        for _ in range(self.looks):
            low = self._chosen(sigma, normals, low_passes, known=known, caution=CAUTION_ON_SMOOTH)
            clean = self._filtered(self.sample.mesh, low)
            normals = clean.vertex_normals
            if self.noise is None and self.colour is None:
                sigma = self._level_beside(clean, low, sigma)
        filters = low_passes
        if not self.linear and not odd:
            filters = with_borders(ALL) if self.on_border else ALL
        return self._chosen(sigma, normals, filters, known=known)

    def _low_passes(self) -> tuple[Filter, ...]:
        low_passes = LINEAR if self.linear else LOW_PASSES
        return with_borders(low_passes) if self.on_border else low_passes

    def _chosen(
        self,
        sigma: float,
        normals: Floats,
        filters: tuple[Filter, ...],
        *,
        known: bool,
        caution: float = CAUTION,
    ) -> Choice:
        return choose(
            self.sample,
            sigma,
            normals,
            filters,
            known=known,
            caution=caution,
            evening=self.bench.evening,
            colour=self.colour,
        )

    def _filtered(self, mesh: Mesh, choice: Choice) -> Mesh:
        """Return the filtered mesh, along whose normals the noise is more truly than along its own.

        The estimate of the error needs the directions of the noise. Those of the evened mesh have
        noise of their own, or have lost the ridges, and agree with some filters more than others.
        """
        return mesh.with_vertices(apply(mesh, Bench.of(mesh, self.bench.evening), choice))

    def _level_beside(self, clean: Mesh, low: Choice, sigma: float) -> float:
        """Return the level beside a first result; the root mean square if some of it is odd."""
        mesh = self.sample.mesh
        if self.spikes is not None:
            for white in _whites(self.spikes):
                there = mesh.vertices + sigma * white[:, None] * clean.vertex_normals
                sigma = rough_part(mesh.with_vertices(there), clean).spread
            return sigma
        if self.found.warnings:
            return _level(mesh, clean.vertex_normals).spread
        return level_beside(mesh, clean, lambda one: self._filtered(one, low))


def _level(mesh: Mesh, normals: Floats, spikes: Booleans | None = None) -> NoiseLevel:
    """Measure it; where there were spikes, by the root mean square: some small ones are left."""
    A, x, edge = mesh.topology.adjacency, mesh.vertices, float(mesh.edge_lengths.mean())
    differences = Differences.of(A)
    found = noise_level(A, x, edge, normals, differences)
    if spikes is None:
        return found
    for white in _whites(spikes):
        there = x + found.spread * white[:, None] * normals
        found = noise_level(A, there, edge, normals, differences)
    return replace(found, sigma=found.spread)


def _whites(spikes: Booleans) -> list[Floats]:
    """Return noise for what was put in the place of spikes, which has none of its own.

    It has to be as strong as the others', whose level is measured with it: so, some times.
    """
    white = np.random.default_rng(_SEED).standard_normal(len(spikes)) * spikes
    return [white] * _TIMES


def _height(mesh: Mesh) -> float:
    """Return the median of the least heights of the faces; infinity, if none has an edge."""
    i, j, k = mesh.edge_lengths[mesh.topology.face_edges].T
    longest = np.maximum(np.maximum(i, j), k)
    kept = longest > 0
    if not kept.any():
        return np.inf
    return float(np.median(2 * mesh.face_areas[kept] / longest[kept]))


def _nothing() -> Choice:
    return Choice(0.0, (), np.zeros(0), np.zeros(0), 0.0)


def _colour(sample: Sample, normals: Floats, edge: float) -> NoiseColour | None:
    """Return the colour of the noise, if it has one."""
    if sample.mesh.n_vertices < _ENOUGH:
        return None
    found = noise_colour(equal_rows(sample.mesh), sample.mesh.vertices, normals, sample.core)
    return found if found.is_coloured(edge) else None
