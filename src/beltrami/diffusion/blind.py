"""The choice for a mesh of which nothing is known: measure its noise, choose, and look again."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from beltrami._arrays import Booleans, Floats, Integers
from beltrami.diffusion.candidates import EVENING_IF_STRONG, Bench
from beltrami.diffusion.choice import (
    ALL,
    CAUTION_ON_SMOOTH,
    LOW_PASSES,
    Choice,
    apply,
    choose,
    with_borders,
)
from beltrami.diffusion.colour import NoiseColour, colour_beside, noise_colour, with_colour
from beltrami.diffusion.level import level_beside
from beltrami.diffusion.linear_filters import LINEAR, Linear, equal_rows
from beltrami.diffusion.noise import SPIKED, STRONG, NoiseLevel, noise_level
from beltrami.diffusion.patches import Sample, sample_of, sizes_of_components
from beltrami.diffusion.spikes import Spikes, find_spikes
from beltrami.mesh.mesh import Mesh
from beltrami.solvers.locality import LocalRows

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
    bench = Bench.of(mesh)
    found = _level(mesh, bench.normals)
    largest = int(sizes_of_components(mesh)[1].max())
    none = np.zeros(0, np.int64)
    if noise is None and largest < FEW:
        told = replace(found, warnings=(_TOO_FEW,))
        return Blind(told, _nothing(), bench, mesh, none, 0.0)
    if noise is None and not linear and found.kurtosis > SPIKED and largest >= _SMALL:
        spikes = find_spikes(mesh)
        if spikes is not None:
            return _without(spikes, found, size, largest)
    told, choice, bench = _chosen(mesh, bench, found, noise, size, largest, linear=linear)
    return Blind(told, choice, bench, mesh, none, choice.risk)


def _without(spikes: Spikes, found: NoiseLevel, size: int, largest: int) -> Blind:
    """Choose for the mesh without them; what is left of its kurtosis is small beside them."""
    bench = Bench.of(spikes.mesh)
    rest = _level(spikes.mesh, bench.normals, spikes.found)
    told, choice, bench = _chosen(
        spikes.mesh, bench, rest, None, size, largest, linear=False, spikes=spikes.found
    )
    count, share = int(spikes.found.sum()), float(spikes.found.mean())
    text = f"{count} vertices were taken for spikes, and put where their neighbours say"
    others = tuple(one for one in told.warnings if "kurtosis" not in one)
    noise = replace(found, warnings=(*found.warnings, text, *others))
    of_filling = max(spikes.error**2 - choice.sigma**2, choice.risk)
    risk = (1 - share) * choice.risk + share * of_filling
    return Blind(noise, choice, bench, spikes.mesh, np.flatnonzero(spikes.found), risk)


def _level(mesh: Mesh, normals: Floats, spikes: Booleans | None = None) -> NoiseLevel:
    """Measure it; where there were spikes, by the root mean square: some small ones are left.

    What was put in their place has no noise of its own, so it gets some as strong as the others'.
    """
    A, x, edge = mesh.topology.adjacency, mesh.vertices, float(mesh.edge_lengths.mean())
    found = noise_level(A, x, edge, normals)
    if spikes is None:
        return found
    white = np.random.default_rng(_SEED).standard_normal(len(x)) * spikes
    for _ in range(_TIMES):
        found = noise_level(A, x + found.spread * white[:, None] * normals, edge, normals)
    return replace(found, sigma=found.spread)


def _chosen(
    mesh: Mesh,
    bench: Bench,
    found: NoiseLevel,
    noise: float | None,
    size: int,
    largest: int,
    *,
    linear: bool,
    spikes: Booleans | None = None,
) -> tuple[NoiseLevel, Choice, Bench]:
    edge, looks = float(mesh.edge_lengths.mean()), _LOOKS
    height = _height(mesh)
    beside = found.sigma > _STRONG_BESIDE * height
    if found.relative > STRONG or beside:
        bench, looks = Bench.of(mesh, EVENING_IF_STRONG), _LOOKS_IF_STRONG
        found = _level(mesh, bench.normals, spikes)
    if beside and not found.relative > STRONG:
        text = f"the noise is strong beside the faces, whose median height is {height / edge:.2f}"
        found = replace(found, warnings=(*found.warnings, f"{text} mean edge lengths"))
    sample = sample_of(mesh, size)
    there = None if spikes is None else spikes[sample.vertices]
    if there is not None:
        sample = replace(sample, core=sample.core & ~there)
    normals = bench.normals[sample.vertices]
    colour, rows, uncoloured = None, equal_rows(sample.mesh), found
    if largest >= _ENOUGH and spikes is None:
        colour = _colour(sample, rows, normals, edge)
    if colour is not None:
        found = with_colour(uncoloured, colour, rows)
    odd = bool(found.warnings)
    sigma = noise if noise is not None else found.spread if odd else found.sigma
    if sigma == 0:
        return found, _nothing(), bench
    few = linear or mesh.n_vertices < _SMALL
    known = noise is not None or (odd and colour is None)
    alike = partial(choose, sample, known=known, evening=bench.evening)
    low_passes, filters = (
        LINEAR if few else LOW_PASSES,
        LINEAR if few else LOW_PASSES if odd else ALL,
    )
    if mesh.topology.on_boundary[sample.vertices[sample.core]].mean() > _BORDERS:
        low_passes, filters = with_borders(low_passes), with_borders(filters)
    for _ in range(looks):
        low = alike(float(sigma), normals, low_passes, caution=CAUTION_ON_SMOOTH, colour=colour)
        once_more = partial(_filtered, evening=bench.evening, choice=low)
        clean = once_more(sample.mesh)
        normals = clean.vertex_normals
        if colour is not None:
            colour = colour_beside(colour, rows, sample.mesh, clean, once_more, sample.core)
            found = with_colour(uncoloured, colour, rows)
            sigma = found.spread if noise is None else noise
        elif noise is None:
            sigma = (
                level_beside(sample.mesh, clean, once_more)
                if there is None and not odd
                else _level(sample.mesh, normals, there).spread
            )
    return found, alike(float(sigma), normals, filters, colour=colour), bench


def _height(mesh: Mesh) -> float:
    """Return the median of the least heights of the faces; infinity, if none has an edge."""
    x = mesh.vertices[mesh.faces]
    longest = np.linalg.norm(x - np.roll(x, 1, axis=1), axis=2).max(axis=1)
    kept = longest > 0
    if not kept.any():
        return np.inf
    return float(np.median(2 * mesh.face_areas[kept] / longest[kept]))


def _nothing() -> Choice:
    return Choice(0.0, (), np.zeros(0), np.zeros(0), 0.0)


def _filtered(mesh: Mesh, evening: Linear, choice: Choice) -> Mesh:
    """Return the filtered mesh, along whose normals the noise is more truly than along its own.

    The estimate of the error needs the directions of the noise. Those of the evened mesh have
    noise of their own, or have lost the ridges, and agree with some filters more than with others.
    """
    return mesh.with_vertices(apply(mesh, Bench.of(mesh, evening), choice))


def _colour(sample: Sample, rows: LocalRows, normals: Floats, edge: float) -> NoiseColour | None:
    """Return the colour of the noise, if it has one."""
    if sample.mesh.n_vertices < _ENOUGH:
        return None
    found = noise_colour(rows, sample.mesh.vertices, normals, sample.core)
    return found if found.is_coloured(edge) else None
