"""The choice for a mesh of which nothing is known: measure its noise, choose, and look again."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from beltrami._arrays import Floats
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
from beltrami.diffusion.colour import NoiseColour, noise_colour, with_colour
from beltrami.diffusion.linear_filters import LINEAR, Linear, equal_rows
from beltrami.diffusion.noise import STRONG, NoiseLevel, noise_level
from beltrami.diffusion.patches import Sample, sample_of, sizes_of_components
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


def blind_choice(
    mesh: Mesh, noise: float | None, size: int, *, linear: bool = False
) -> tuple[NoiseLevel, Choice, Bench]:
    """Measure the noise, and choose on a sample of about ``size`` faces; safely, if it is odd."""
    edge = float(mesh.edge_lengths.mean())
    bench, looks = Bench.of(mesh), _LOOKS
    found = noise_level(mesh.topology.adjacency, mesh.vertices, edge, bench.normals)
    largest = int(sizes_of_components(mesh)[1].max())
    if noise is None and largest < FEW:
        return replace(found, warnings=(_TOO_FEW,)), _nothing(), bench
    if found.relative > STRONG:
        bench, looks = Bench.of(mesh, EVENING_IF_STRONG), _LOOKS_IF_STRONG
        found = noise_level(mesh.topology.adjacency, mesh.vertices, edge, bench.normals)
    sample = sample_of(mesh, size)
    normals = bench.normals[sample.vertices]
    colour = _colour(sample, normals, edge) if largest >= _ENOUGH else None
    if colour is not None:
        found = with_colour(found, colour, equal_rows(sample.mesh))
    odd = bool(found.warnings)
    sigma = noise if noise is not None else found.spread if odd else found.sigma
    if sigma == 0:
        return found, _nothing(), bench
    few = linear or mesh.n_vertices < _SMALL
    known = noise is not None or (odd and colour is None)
    alike = partial(choose, sample, known=known, evening=bench.evening, colour=colour)
    low_passes, filters = (
        LINEAR if few else LOW_PASSES,
        LINEAR if few else LOW_PASSES if odd else ALL,
    )
    if mesh.topology.on_boundary[sample.vertices[sample.core]].mean() > _BORDERS:
        low_passes, filters = with_borders(low_passes), with_borders(filters)
    for _ in range(looks):
        low = alike(float(sigma), normals, low_passes, caution=CAUTION_ON_SMOOTH)
        normals = _normals(sample.mesh, bench.evening, low)
        if noise is None and colour is None:
            A = sample.mesh.topology.adjacency
            again = noise_level(A, sample.mesh.vertices, edge, normals)
            sigma = again.spread if odd else again.sigma
    return found, alike(float(sigma), normals, filters), bench


def _nothing() -> Choice:
    return Choice(0.0, (), np.zeros(0), np.zeros(0), 0.0)


def _normals(mesh: Mesh, evening: Linear, choice: Choice) -> Floats:
    """Return those of the filtered mesh, along which the noise is more truly than along its own.

    The estimate of the error needs the directions of the noise. Those of the evened mesh have
    noise of their own, or have lost the ridges, and agree with some filters more than with others.
    """
    return mesh.with_vertices(apply(mesh, Bench.of(mesh, evening), choice)).vertex_normals


def _colour(sample: Sample, normals: Floats, edge: float) -> NoiseColour | None:
    """Return the colour of the noise, if it has one."""
    if sample.mesh.n_vertices < _ENOUGH:
        return None
    found = noise_colour(equal_rows(sample.mesh), sample.mesh.vertices, normals, sample.core)
    return found if found.is_coloured(edge) else None
