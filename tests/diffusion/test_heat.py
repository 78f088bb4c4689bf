import numpy as np
import pytest
from scipy.linalg import expm

import dense_oracles as oracle
from beltrami.diffusion.heat import heat
from beltrami.errors import (
    BeltramiError,
    DimensionError,
    MeshError,
    NonFiniteError,
    StepTooLongError,
    UnknownNameError,
)
from beltrami.mesh import shapes
from beltrami.operators.laplacian import laplacian
from beltrami.operators.pair import MASSES
from meshes_of_the_errata import IRREGULAR, MESHES, triangle


def _dense(pair):
    return pair.stiffness.toarray(), pair.mass.toarray()


@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("weights", ["combinatorial", "cotangent"])
@pytest.mark.parametrize("columns", [None, 1, 3])
def test_implicit_steps_against_a_dense_solve(mass, weights, columns):
    mesh = MESHES["bad"]()
    pair = laplacian(mesh, weights, mass)
    L, B = _dense(pair)
    rng = np.random.default_rng(100003)
    f = rng.normal(size=pair.n if columns is None else (pair.n, columns))
    time, steps = 0.3, 4
    S = np.linalg.solve(B + time / steps * L, B)
    expected = np.linalg.matrix_power(S, steps) @ f
    assert np.allclose(heat(pair, f, time, steps=steps), expected, rtol=1e-8, atol=1e-10)
    held = rng.uniform(size=pair.n) < 0.2
    M = B + time / steps * L
    M[held] = np.eye(pair.n)[held]
    expected = f
    for _ in range(steps):
        right = B @ expected
        right[held] = f[held]
        expected = np.linalg.solve(M, right)
    for hold in (held, np.flatnonzero(held)):
        result = heat(pair, f, time, steps=steps, hold=hold)
        assert np.allclose(result, expected, rtol=1e-8, atol=1e-10)
        assert np.array_equal(result[held], f[held])


@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("weights", ["combinatorial", "cotangent"])
@pytest.mark.parametrize("columns", [None, 1, 3])
def test_explicit_steps_against_dense_products(mass, weights, columns):
    mesh = MESHES["bad"]()
    pair = laplacian(mesh, weights, mass)
    L, B = _dense(pair)
    rng = np.random.default_rng(100019)
    f = rng.normal(size=pair.n if columns is None else (pair.n, columns))
    steps = 7
    delta = 1.3 / pair.spectral_bound()
    held = rng.uniform(size=pair.n) < 0.2
    for hold in (np.zeros(pair.n, bool), held):
        S = np.eye(pair.n)
        free = ~hold
        S[free] -= delta * np.linalg.solve(B[np.ix_(free, free)], L[free])
        expected = np.linalg.matrix_power(S, steps) @ f
        result = heat(pair, f, delta * steps, "explicit", steps, hold=hold)
        assert np.allclose(result, expected, rtol=1e-8, atol=1e-10)
        assert np.array_equal(result[hold], f[hold])


@pytest.mark.chapter("D17")
@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_mean_of_b_is_kept(mass, name):
    mesh = MESHES[name]()
    pair = laplacian(mesh, mass=mass)
    f = oracle.rough_functions(mesh, 2) + 1
    short = 20 / pair.spectral_bound()
    for result in (
        heat(pair, f, 0.5),
        heat(pair, f, 1e6, steps=2),
        heat(pair, f, short, "explicit"),
    ):
        assert np.allclose(pair.mean(result), pair.mean(f), rtol=1e-7, atol=1e-9)
        assert pair.dirichlet_energy(result) < pair.dirichlet_energy(f)
        assert pair.norm(result) < pair.norm(f)
    constant = heat(pair, np.full(pair.n, 3.0), 2.0)
    assert np.allclose(constant, 3, rtol=1e-8)


@pytest.mark.parametrize("name", IRREGULAR)
def test_maximum_principle_of_positive_weights(name):
    mesh = MESHES[name]()
    spike = np.zeros(mesh.n_vertices)
    spike[17] = 1
    for weights in ("combinatorial", "distance"):
        for mass in ("degree", "voronoi"):
            pair = laplacian(mesh, weights, mass)
            for result in (
                heat(pair, spike, 0.01 / pair.spectral_bound(), steps=1),
                heat(pair, spike, 5.0, steps=3),
                heat(pair, spike, 30 / pair.spectral_bound(), "explicit"),  # δ <= 1/bound
            ):
                assert result.min() > -1e-13
                assert result.max() <= 1


def test_negative_cotangents_break_it_also_in_the_exact_flow():
    """The triangle 15, 150, 15 of the errata (S3): smallest entry of exp(-t D⁻¹L) is -0.244."""
    pair = laplacian(triangle(15, 150), mass="degree")
    L, B = _dense(pair)
    times = np.linspace(0.1, 5, 50)
    least = min(expm(-t * np.linalg.solve(B, L)).min() for t in times)
    assert least == pytest.approx(-0.244, abs=1e-3)
    spikes = np.eye(3)
    assert heat(pair, spikes, 1.2, steps=200).min() < -0.2


def test_no_time_changes_nothing():
    mesh = MESHES["bad"]()
    f = oracle.rough_functions(mesh, 2)
    for method in ("implicit", "explicit"):
        result = heat(laplacian(mesh), f, 0, method)
        assert np.array_equal(result, f)
        assert not np.shares_memory(result, f)


def test_the_input_is_not_changed():
    mesh = MESHES["bad"]()
    f = oracle.rough_functions(mesh, 3)
    before = f.copy()
    pair = laplacian(mesh, mass="degree")
    for method in ("implicit", "explicit"):
        heat(pair, f, 1.0, method)
        heat(pair, f, 1.0, method, hold=[4, 5])
    assert np.array_equal(f, before)


def test_defaults_of_the_number_of_steps():
    mesh = MESHES["bad"]()
    pair = laplacian(mesh, mass="degree")
    f = oracle.rough_functions(mesh, 1)
    seen = []
    heat(pair, f, 3.0, progress=lambda done, total: seen.append((done, total)))
    assert seen == [(k + 1, 10) for k in range(10)]
    seen.clear()
    heat(pair, f, 3.0, "explicit", progress=lambda done, total: seen.append((done, total)))
    count = int(np.ceil(3.0 * pair.spectral_bound()))
    assert seen[-1] == (count, count)
    assert len(seen) == count
    assert np.array_equal(heat(pair, f, 3.0, "explicit", count), heat(pair, f, 3.0, "explicit"))


@pytest.mark.parametrize("mass", MASSES)
def test_explicit_steps_beyond_the_proven_bound_are_refused(mass):
    """On one face the bound is the eigenvalue itself, so the longest step is the longest one."""
    pair = laplacian(triangle(15, 150), mass=mass)
    L, B = _dense(pair)
    true = 2 / oracle.spectrum(L, B)[-1]
    f = np.array([1.0, 0, 0])
    with pytest.raises(StepTooLongError, match="longest allowed") as caught:
        heat(pair, f, 1.001 * true, "explicit", 1)
    assert caught.value.longest == pytest.approx(true, rel=1e-7)
    assert caught.value.step == pytest.approx(1.001 * true)
    calm = heat(pair, f, 2000 * 0.99 * true, "explicit", 2000)
    assert np.allclose(calm, pair.mean(f), atol=1e-9)
    # what it protects from: the printed limit δ < 1 blows up
    S = np.eye(3) - 1.01 * true * np.linalg.solve(B, L)
    assert np.abs(np.linalg.matrix_power(S, 2000) @ f).max() > 1e10


@pytest.mark.chapter("T16", "R3")
@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("mass", MASSES)
def test_the_longest_step_is_stable(name, mass):
    mesh = MESHES[name]()
    pair = laplacian(mesh, mass=mass)
    f = oracle.rough_functions(mesh, 1)
    with pytest.raises(StepTooLongError) as caught:
        heat(pair, f, 1e9 / pair.spectral_bound(), "explicit", 3)
    longest = caught.value.longest
    result = heat(pair, f, 100 * longest, "explicit", 100)
    assert pair.norm(result) <= pair.norm(f)


def test_what_is_refused():
    pair = laplacian(MESHES["open"]())
    f = np.zeros(192)
    with pytest.raises(UnknownNameError, match="Did you mean 'implicit'") as caught:
        heat(pair, f, 1, "implicite")
    assert caught.value.choices[:2] == ("implicit", "explicit")
    for time in (-1.0, np.nan, np.inf):
        with pytest.raises(BeltramiError, match="time must be"):
            heat(pair, f, time)
    for steps in (0, -3):
        with pytest.raises(BeltramiError, match="whole number >= 1"):
            heat(pair, f, 1.0, steps=steps)
    with pytest.raises(DimensionError):
        heat(pair, f[:-1], 1.0)
    with pytest.raises(NonFiniteError):
        heat(pair, np.full(192, np.inf), 1.0)
    with pytest.raises(MeshError, match="held vertices"):
        heat(pair, f, 1.0, hold=[192])


@pytest.mark.parametrize("method", ["implicit", "explicit"])
@pytest.mark.parametrize("steps", [2.5, "3"])
def test_a_number_of_steps_is_whole(method, steps):
    """Two steps and a half would be three of the length time / 2.5: another time."""
    pair = laplacian(MESHES["open"](), "combinatorial")
    with pytest.raises((BeltramiError, TypeError)):
        heat(pair, np.zeros(192), 1.0, method, steps)
    assert heat(pair, np.zeros(192), 1.0, method, np.int64(3)).shape == (192,)


@pytest.mark.parametrize("method", ["implicit", "explicit"])
@pytest.mark.parametrize("mass", ["voronoi", "consistent"])
def test_held_ends_lead_to_the_harmonic_function(method, mass):
    """With cotangent weights on a planar mesh that is x itself, whatever the mass."""
    sheet = shapes.grid(5, 5)
    rng = np.random.default_rng(40_817_211)
    inner = np.abs(sheet.vertices - 0.5).max(axis=1) < 0.45
    moved = sheet.vertices + 0.04 * inner[:, None] * rng.uniform(-1, 1, sheet.vertices.shape)
    pair = laplacian(sheet.with_vertices(moved), "cotangent", mass)
    x = moved[:, 0]
    ends = (x < 1e-9) | (x > 1 - 1e-9)
    start = np.where(ends, x, 0.3)
    steps = 40 if method == "implicit" else None
    assert heat(pair, start, 20.0, method, steps, hold=ends) == pytest.approx(x, abs=1e-8)


def test_an_endless_number_of_explicit_steps_is_refused():
    pair = laplacian(shapes.icosphere(1))
    for time in (1e12, 1e308):
        with pytest.raises(BeltramiError, match="implicit"):
            heat(pair, np.zeros(pair.n), time, "explicit")
