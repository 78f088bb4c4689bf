import numpy as np
import pytest

from beltrami.diffusion.denoise_function import denoise_function
from beltrami.diffusion.heat import heat
from beltrami.errors import BeltramiError, DimensionError, MeshError, NonFiniteError
from beltrami.operators.laplacian import laplacian
from made_once import creature

BLOB = creature(2500)
PAIR = laplacian(BLOB)
SMOOTH = np.sin(2 * BLOB.vertices[:, 0]) + BLOB.vertices[:, 1]


def rms(x):
    return np.sqrt(np.mean(x**2))


@pytest.mark.chapter("P43")
@pytest.mark.parametrize(("sigma", "factor"), [(0.05, 1.07), (0.5, 1.1), (2.0, 1.3)])
def test_it_is_near_the_best_time_of_heat(sigma, factor):
    noisy = SMOOTH + np.random.default_rng(0).normal(0, sigma, len(SMOOTH))
    found = denoise_function(PAIR, noisy)
    assert found.sigma[0] == pytest.approx(sigma, rel=0.1)
    times = np.geomspace(1e-5, 1, 16)
    best = min(rms(heat(PAIR, noisy, time, steps=1) - SMOOTH) for time in times)
    error = rms(found.values - SMOOTH)
    assert error < factor * best
    # as near as Stein's estimate is with one sample of the noise
    uncertain = 4 * sigma**2 * np.sqrt(2 / len(SMOOTH))
    assert abs(found.predicted_error[0] ** 2 - error**2) < uncertain


def test_columns_are_denoised_one_by_one():
    rng = np.random.default_rng(1)
    columns = np.stack([SMOOTH, 0 * SMOOTH, SMOOTH**2], axis=1)
    noisy = columns + rng.normal(size=columns.shape) * [0.1, 1.0, 0.3]
    found = denoise_function(PAIR, noisy)
    assert found.sigma == pytest.approx([0.1, 1.0, 0.3], rel=0.1)
    for j in range(3):
        alone = denoise_function(PAIR, noisy[:, j])
        assert np.allclose(alone.values, found.values[:, j], atol=1e-9)
        assert alone.mixture[0][0][0] == found.mixture[j][0][0]
    assert rms(found.values[:, 1]) < 0.1  # nothing there but noise


def test_unit_of_length_and_of_values_do_not_matter():
    noisy = SMOOTH + np.random.default_rng(2).normal(0, 0.3, len(SMOOTH))
    expected = denoise_function(PAIR, noisy).values
    for unit in (1e-6, 1e6):
        pair = laplacian(BLOB.with_vertices(unit * BLOB.vertices))
        assert np.allclose(denoise_function(pair, noisy).values, expected, atol=1e-4)
        scaled = denoise_function(PAIR, unit * noisy).values
        assert np.allclose(scaled / unit, expected, atol=1e-4)


def test_graphs_and_degree_masses():
    pair = laplacian(BLOB.topology, "combinatorial")
    noisy = SMOOTH + np.random.default_rng(3).normal(0, 0.5, len(SMOOTH))
    assert rms(denoise_function(pair, noisy).values - SMOOTH) < 0.25


def test_outliers_are_said_and_counted():
    rng = np.random.default_rng(4)
    noisy = SMOOTH + (rng.random(len(SMOOTH)) < 0.1) * rng.normal(0, 2, len(SMOOTH))
    found = denoise_function(PAIR, noisy)
    assert any("outliers" in text for text in found.warnings)
    assert found.sigma[0] == found.noise[0].spread
    small = denoise_function(PAIR, noisy, noise=found.noise[0].sigma)
    assert rms(found.values - SMOOTH) < 0.9 * rms(small.values - SMOOTH)


def test_what_is_refused():
    with pytest.raises(DimensionError):
        denoise_function(PAIR, [1.0])
    with pytest.raises(NonFiniteError):
        denoise_function(PAIR, np.full(PAIR.n, np.nan))
    with pytest.raises(MeshError, match="diagonal mass"):
        denoise_function(laplacian(BLOB, mass="consistent"), SMOOTH)
    with pytest.raises(BeltramiError, match="noise must be"):
        denoise_function(PAIR, SMOOTH, noise=-1)
