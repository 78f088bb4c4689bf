"""Any mesh, sound or damaged, in any unit: numbers, or an error that says why."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import strategies
from beltrami.diffusion.bumps import BUMP_DISTANCES, gaussian_bumps
from beltrami.diffusion.heat import HEAT_METHODS, heat
from beltrami.diffusion.interpolate import interpolate
from beltrami.diffusion.poisson import poisson
from beltrami.diffusion.regularize import FORMS, regularize
from beltrami.diffusion.wave import WAVE_METHODS, wave
from beltrami.errors import BeltramiError
from beltrami.operators.laplacian import laplacian

PAIRS = [
    ("cotangent", "voronoi"),
    ("cotangent", "consistent"),
    ("combinatorial", "degree"),
    ("distance", "unit"),
]


@st.composite
def problems(draw):
    """Draw a pair, a rough function, a time beside its scale, and a mask of a few vertices."""
    mesh = draw(strategies.any_meshes())
    mesh = mesh.with_vertices(mesh.vertices * 10.0 ** draw(st.sampled_from([-9, 0, 9])))
    rng = draw(strategies.generators())
    f = rng.normal(size=mesh.n_vertices)
    try:
        pair = laplacian(mesh, *draw(st.sampled_from(PAIRS)))
        scale = 1 / pair.spectral_bound()
    except BeltramiError:
        pair, scale = None, 0.0
    length = 10.0 ** draw(st.integers(-3, 4))
    return mesh, pair, f, length * scale, rng.uniform(size=len(f)) < 0.2


def agree(call, check):
    """Check what the call returns, unless it says what is wrong."""
    try:
        found = call()
    except BeltramiError:
        return
    assert np.isfinite(found).all()
    check(found)


@settings(max_examples=25)
@given(problems())
def test_heat(problem):
    _, pair, f, time, held = problem
    if pair is None:
        return
    loose = 1e-9 * (1 + np.abs(f).max())
    for method in HEAT_METHODS:
        agree(lambda m=method: heat(pair, f, time, m), lambda g: _near(pair.mean(g - f), loose))
        agree(
            lambda m=method: heat(pair, f, time, m, hold=held, source=f),
            lambda g: _near(g[held] - f[held], 0),
        )


@given(problems())
def test_wave(problem):
    _, pair, f, time, held = problem
    if pair is None:
        return
    time = min(time**0.5, 300 / pair.spectral_bound() ** 0.5)
    for method in WAVE_METHODS:
        agree(
            lambda m=method: [g for _, g in wave(pair, f, None, [0, time], m)],
            lambda g: _near(pair.mean(g[1] - f), 1e-9 * (1 + np.abs(f).max())),
        )
        agree(
            lambda m=method: [g for _, g in wave(pair, f, None, [0, time], m, hold=held)],
            lambda g: _near(g[1][held] - f[held], 0),
        )


@given(problems())
def test_solves(problem):
    mesh, pair, f, time, held = problem
    for kind in BUMP_DISTANCES:
        agree(lambda k=kind: gaussian_bumps(mesh, held, 1.0, distance=k), lambda g: None)
    if pair is None:
        return
    for form in FORMS:
        agree(lambda form=form: regularize(pair, f, time, form), lambda g: None)
    agree(lambda: poisson(pair, f, project=True), lambda g: None)
    agree(lambda: poisson(pair, f, hold=held), lambda g: _near(g[held], 0))
    agree(lambda: poisson(pair, f, screen=1 / max(time, 1e-30)), lambda g: None)
    for order in (1, 2):
        agree(
            lambda order=order: interpolate(pair, held, f[held], order),
            lambda g: _near(g[held] - f[held], 0),
        )


def _near(difference, limit):
    assert np.abs(difference).max(initial=0) <= limit


def test_the_checks_can_fail():
    with pytest.raises(AssertionError):
        agree(lambda: np.array([np.nan]), lambda g: None)
    with pytest.raises(AssertionError):
        _near(np.array([1.0]), 0.5)
