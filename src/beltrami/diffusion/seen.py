"""What is known of a noisy mesh before anything is chosen, and looks at it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from beltrami._arrays import Booleans, Floats
from beltrami.diffusion.bends import unlike_noise
from beltrami.diffusion.candidates import EVENING_IF_STRONG, Bench, Filter
from beltrami.diffusion.choice import (
    ALL,
    CAUTION,
    CAUTION_ON_SMOOTH,
    LOW_PASSES,
    NOTHING,
    Choice,
    apply,
    choose,
    with_borders,
)
from beltrami.diffusion.colour import NoiseColour, colour_beside, noise_colour, with_colour
from beltrami.diffusion.lengths import median_height
from beltrami.diffusion.level import level_beside
from beltrami.diffusion.linear_filters import LINEAR, equal_rows
from beltrami.diffusion.noise import STRONG, Differences, NoiseLevel, noise_level
from beltrami.diffusion.outliers import are_of_shape, rough_part
from beltrami.diffusion.patches import Sample, sample_of, sizes_of_components
from beltrami.mesh.mesh import Mesh

_ENOUGH = 1_500  # vertices, from which noise may be told from creases that are everywhere
SMALL = 200  # vertices below which only linear filters are trusted
_BORDERS = 0.01  # of the vertices, below which they matter less than what more choice costs
_LOOKS, _LOOKS_IF_STRONG = 1, 2  # at the normals, before the choice
_STRONG_BESIDE = 0.77  # of the least height of half of the faces, of the noisy mesh
_TIMES = 2  # that the level is measured without spikes
_ROUNDING = 1e-9  # mean edges, up to which there is no noise
_LITTLE = 0.06, 0.12  # mean edges: from all in doubt to nothing
_SEED = 12


@dataclass(frozen=True, eq=False)
class Seen:
    """What is known of a mesh before anything is chosen.

    Attributes
    ----------
    noise
        Its level, if it was said.
    measured, found
        What was measured of it, and what is known of it: its colour, and what outliers are.
    bench, sample
        Of the mesh.
    colour
        Of the noise, if it has one.
    spikes
        The vertices of the sample that were put in the place of spikes, if there were some.
    largest
        Vertices of the largest component.
    normals, looks
        Of the sample, as they are known; and how often they are to be looked at before the choice.
    linear, on_border
        Whether only linear filters are trusted, and whether borders matter.
    folds
        The warning that the noise is strong beside the faces, if there is one.
    """

    noise: float | None
    measured: NoiseLevel
    found: NoiseLevel
    bench: Bench
    sample: Sample
    colour: NoiseColour | None
    spikes: Booleans | None
    largest: int
    normals: Floats
    looks: int
    linear: bool
    on_border: bool
    folds: str | None

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
    ) -> Seen:
        """Measure the noise; its bench may be known."""
        bench, looks = bench or Bench.of(mesh), _LOOKS
        found = _level(mesh, bench.normals, spikes)
        largest = int(sizes_of_components(mesh)[1].max())
        edge, height = float(mesh.edge_lengths.mean()), median_height(mesh)
        beside = found.sigma > _STRONG_BESIDE * height
        if found.relative > STRONG or beside:
            bench, looks = bench.moved(mesh, EVENING_IF_STRONG), _LOOKS_IF_STRONG
            found = _level(mesh, bench.normals, spikes)
        folds = None
        if beside and not found.relative > STRONG:
            told = f"whose median height is {height / edge:.2f} mean edge lengths"
            folds = f"the noise is strong beside the faces, {told}"
            found = replace(found, warnings=(*found.warnings, folds))
        sample = sample_of(mesh, size)
        there = None if spikes is None else spikes[sample.vertices]
        if there is not None:
            sample = replace(sample, core=sample.core & ~there)
        seen = cls(
            noise,
            found,
            found,
            bench,
            sample,
            None,
            there,
            largest,
            bench.normals[sample.vertices],
            looks,
            linear or mesh.n_vertices < SMALL,
            float(mesh.topology.on_boundary[sample.vertices[sample.core]].mean()) > _BORDERS,
            folds,
        )
        colour = seen._first_colour(edge)
        coloured = None if colour is None else seen._coloured(colour)
        if coloured is not None:
            return coloured
        if found.has_outliers:
            return replace(seen, found=seen._explained())
        return seen

    def _first_colour(self, edge: float) -> NoiseColour | None:
        """Return the colour of the noise, if it has one."""
        mesh = self.sample.mesh
        if min(self.largest, mesh.n_vertices) < _ENOUGH:
            return None
        found = noise_colour(equal_rows(mesh), mesh.vertices, self.normals, self.sample.core)
        return found if found.is_coloured(edge) else None

    def _of_colour(self, colour: NoiseColour) -> Seen:
        found = with_colour(self.measured, colour, equal_rows(self.sample.mesh))
        return replace(self, colour=colour, found=found)

    def _coloured(self, colour: NoiseColour) -> Seen | None:
        """Look, and return it with the colour beside that; nothing, if it bends as shapes do."""
        seen, known = self._of_colour(colour), self.noise is not None
        low, clean = seen._look(self.noise or seen.found.spread, self.normals, known=known)
        alike = seen._colour_beside(colour, clean, low)
        make = partial(alike.noise, equal_rows(self.sample.mesh))
        if unlike_noise(self.sample.mesh, clean, make) > 1:
            return None
        again = seen._of_colour(alike)
        return replace(again, normals=clean.vertex_normals, looks=self.looks - 1)

    def _explained(self) -> NoiseLevel:
        """Return what was found, without the warning of outliers if they are the shape's."""
        _, clean = self._look(self.found.spread, self.normals, known=True)
        shape = are_of_shape(self.sample.mesh, self.normals, clean)
        return self.found.explained() if shape else self.found

    def choice(self) -> tuple[NoiseLevel, Choice]:
        """Look, measure the noise beside what is seen, and choose; return what it is known for."""
        seen, odd = self, bool(self.found.warnings)
        level = self.found.spread if odd else self.found.sigma
        sigma = level if self.noise is None else self.noise
        if sigma <= _ROUNDING * float(self.sample.mesh.edge_lengths.mean()):
            return self.found, NOTHING
        known = self.noise is not None or (odd and self.colour is None)
        normals = self.normals
        for _ in range(self.looks):
            low, clean = seen._look(sigma, normals, known=known)
            normals = clean.vertex_normals
            if seen.colour is not None:
                seen = seen._of_colour(seen._colour_beside(seen.colour, clean, low))
                sigma = seen.found.spread if self.noise is None else self.noise
            elif self.noise is None:
                sigma = self._level_beside(clean, low, sigma)
        filters = self._low_passes()
        if not self.linear and not odd:
            filters = with_borders(ALL) if self.on_border else ALL
        return seen._told(sigma), seen._chosen(sigma, normals, filters, known=known)

    def _told(self, sigma: float) -> NoiseLevel:
        """Return what was found; that the noise is strong was too much, if it is not.

        On few vertices, outliers are said even if they are the shape's: nobody looks for spikes.
        """
        mesh = self.sample.mesh
        found = self.measured if mesh.n_vertices < SMALL else self.found
        found = found.measured_again(sigma, float(mesh.edge_lengths.mean()))
        return found if sigma > _STRONG_BESIDE * median_height(mesh) else found.without(self.folds)

    def _colour_beside(self, colour: NoiseColour, clean: Mesh, low: Choice) -> NoiseColour:
        """Return the colour beside a first result."""
        rows, core = equal_rows(self.sample.mesh), self.sample.core

        def filtered(mesh: Mesh) -> Mesh:
            return self._filtered(mesh, low)

        return colour_beside(colour, rows, self.sample.mesh, clean, filtered, core)

    def _look(self, level: float, normals: Floats, *, known: bool) -> tuple[Choice, Mesh]:
        """Return the low passes for this level, and what they make of the sample."""
        filters, caution = self._low_passes(), CAUTION_ON_SMOOTH
        low = self._chosen(level, normals, filters, known=known, caution=caution)
        return low, self._filtered(self.sample.mesh, low)

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
        """Return the level beside a first result; the root mean square of noise that is odd."""
        mesh = self.sample.mesh
        if self.spikes is not None:
            for white in _whites(self.spikes):
                there = mesh.vertices + sigma * white[:, None] * clean.vertex_normals
                sigma = rough_part(mesh.with_vertices(there), clean).spread
            return sigma
        if self.found.without(self.folds).warnings:  # it is odd in another way too
            level = _level(mesh, clean.vertex_normals).spread
        else:
            level = level_beside(mesh, clean, lambda one: self._filtered(one, low))
        if self.found.has_outliers:  # whose places bend in a way of their own
            return level
        doubt = self._doubt(level)
        if not doubt:
            return level
        return float(
            level / max(unlike_noise(mesh, clean, lambda white: level * white), 1) ** doubt
        )

    def _doubt(self, level: float) -> float:
        """Return how much of the level may be shape: from 0 to 1, if it is little or very strong.

        Between them, the first result has lost shape that noise had hidden, and bends like neither.
        """
        if self.found.relative > STRONG:
            return 1.0
        little, much = _LITTLE
        relative = level / float(self.sample.mesh.edge_lengths.mean())
        return min(max((much - relative) / (much - little), 0.0), 1.0)


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
