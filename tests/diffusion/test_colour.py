"""The colour of noise: white noise and clean shapes have none, averaged noise has its own."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from beltrami.diffusion.candidates import Bench, along_normals, filtered
from beltrami.diffusion.choice import _Trial, sure_share
from beltrami.diffusion.colour import (
    NoiseColour,
    colour_beside,
    noise_colour,
    start_of_line,
    with_colour,
)
from beltrami.diffusion.denoise import denoise
from beltrami.diffusion.linear_filters import LINEAR, Linear, equal_rows, low_passed
from beltrami.diffusion.noise import noise_level
from beltrami.diffusion.seen import Seen
from beltrami.mesh import shapes
from beltrami.mesh.mesh import Mesh
from made_once import creature

BLOB = creature(2500)
TORUS = shapes.torus(80, 40)
ALL = [BLOB, TORUS, shapes.cube(16), shapes.icosphere(4), shapes.cylinder(60, 30, caps=True),
       shapes.grid(40, 40, dimension=3)]  # fmt: skip
PEAKS = np.array([6, 8, 8, 10]) / np.array([11, 11, 8, 8])


def moved(truth, noise):
    """Along the normals, noise in mean edges."""
    way = truth.edge_lengths.mean() * noise
    return truth.with_vertices(truth.vertices + way[:, None] * truth.vertex_normals)


def white(truth, level, seed=0):
    return level * np.random.default_rng(seed).normal(size=truth.n_vertices)


def averaged(truth, level, own, rounds=1, seed=0):
    """White noise after rounds of own Id + (1 - own) W̃, which is told the level."""
    A = truth.topology.adjacency
    noise = white(truth, 1, seed)
    for _ in range(rounds):
        noise = own * noise + (1 - own) * (A @ noise) / A.sum(axis=1)
    return level * noise / noise.std()


def colour_of(mesh):
    bench = Bench.of(mesh)
    everywhere = np.ones(mesh.n_vertices, np.bool_)
    return noise_colour(bench.rows, mesh.vertices, bench.normals, everywhere)


def said(mesh):
    return colour_of(mesh).is_coloured(float(mesh.edge_lengths.mean()))


def rms(mesh, truth):
    return np.sqrt(((mesh.vertices - truth.vertices) ** 2).sum(axis=1).mean())


@pytest.mark.parametrize("truth", ALL)
def test_clean_shapes_and_white_noise_have_no_colour(truth):
    assert not said(truth)
    for level in (0.01, 0.05, 0.1, 0.2, 0.35):
        assert not said(moved(truth, white(truth, level, seed=1)))


@pytest.mark.parametrize("around", [4, 5, 6, 8])
@pytest.mark.parametrize("level", [0.1, 0.3])
def test_thin_tubes_are_no_noise(around, level):
    """What goes round a tube with few vertices is as even as noise, and not Gaussian."""
    rows = 2400 // around
    tube = shapes.cylinder(around, rows, caps=True)
    tube = tube.with_vertices(tube.vertices * [1, 1, 5 * rows / around])
    mesh = moved(tube, white(tube, level))
    assert not said(mesh)
    if (around, level) in {(5, 0.1), (8, 0.3)}:
        assert rms(denoise(mesh).mesh, tube) < 0.5 * rms(mesh, tube)


def test_white_noise_upon_an_even_shape_is_a_floor():
    """A coarse shape is as strong in the middle, but its noise is as strong in all bands."""
    coarse = NoiseColour((3.0, 1.8, 1.15, 1.06, 1.0), (1.1,) * 5, 3.0)
    averaged_once = NoiseColour((3.0, 1.8, 1.1, 0.86, 1.0), (1.1,) * 5, 3.0)
    averaged_half = NoiseColour((3.0, 1.8, 1.5, 1.25, 1.0), (1.1,) * 5, 3.0)
    assert not coarse.is_coloured(5.0)
    assert averaged_once.is_coloured(5.0)
    assert averaged_half.is_coloured(5.0)


@pytest.mark.parametrize("truth", ALL)
def test_averaged_noise_has_one(truth):
    assert said(moved(truth, averaged(truth, 0.3, own=1 / 7)))
    assert said(moved(truth, averaged(truth, 0.3, own=0.5)))
    assert said(moved(truth, averaged(truth, 0.3, own=0.5, rounds=2, seed=3)))


def test_spikes_are_no_colour():
    for truth in (BLOB, TORUS):
        few = np.random.default_rng(2).random(truth.n_vertices) < 0.1
        assert not said(moved(truth, few * white(truth, 1.0)))


def test_white_noise_is_as_strong_in_all_bands():
    found = colour_of(moved(TORUS, white(TORUS, 0.2)))
    edge = TORUS.edge_lengths.mean()
    assert np.array(found.levels) / edge == pytest.approx([0.2] * 5, rel=0.15)
    assert found.uneven == pytest.approx([1] * 5, abs=0.25)
    assert found.kurtosis == pytest.approx(3, abs=0.3)


def test_the_amplitude_is_that_of_the_average():
    """Id/2 + W̃/2 multiplies the frequency k by 1 - k/2."""
    A, noise = TORUS.topology.adjacency, white(TORUS, 0.3)
    noise = (noise + (A @ noise) / A.sum(axis=1)) / 2
    found = colour_of(moved(TORUS, noise))
    k = np.array([0, 0.1, 0.3, *PEAKS])
    gain = found.amplitude(k) / TORUS.edge_lengths.mean() / 0.3
    assert gain == pytest.approx(1 - k / 2, rel=0.2)


def test_shape_is_taken_off_where_it_is_uneven():
    even = NoiseColour((4.0, 3.0, 2.0, 1.0, 1.0), (1.0,) * 5, 3.0)
    bent = NoiseColour((4.0, 3.0, 2.0, 1.0, 1.0), (1.4, 1.4, 1.0, 1.0, 1.0), 3.0)
    k = np.array([0.0, *PEAKS])
    assert even.amplitude(k)[1:] == pytest.approx([4, 3, 2, 1])
    assert (bent.amplitude(k)[:3] < 0.8 * even.amplitude(k)[:3]).all()
    assert bent.amplitude(k)[3:] == pytest.approx([2, 1])


@pytest.mark.parametrize(
    ("levels", "uneven", "kurtosis", "expected"),
    [
        ((2.0, 2.0, 1.2, 1.0, 1.0), (1.0, 1.0, 1, 1, 1), 3.0, True),
        ((2.0, 2.0, 1.2, 1.0, 1.0), (1.4, 1.4, 1, 1, 1), 3.0, False),  # may be shape
        ((9.0, 9.0, 1.2, 1.0, 1.0), (1.6, 1.6, 1, 1, 1), 3.0, False),  # is shape
        ((2.0, 2.0, 1.2, 1.0, 1.0), (1.0, 1.0, 1, 1, 1), 9.0, False),  # spikes
        ((1.1, 1.1, 1.0, 1.0, 1.0), (1.0, 1.0, 1, 1, 1), 3.0, False),
        ((1.1, 1.1, 0.7, 1.0, 1.0), (1.4, 1.4, 1, 1, 1), 3.0, True),  # no shape makes a gap
        ((2.0, 0.0, 1.0, 1.0, 1.0), (1.0, 9.0, 1, 1, 1), 3.0, False),
    ],
)
def test_what_tells_noise_from_shape(levels, uneven, kurtosis, expected):
    found = NoiseColour(levels, uneven, kurtosis)
    assert found.is_coloured(5.0) is expected
    assert not found.is_coloured(50.0)  # faint


@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_the_unit_and_the_place_do_not_matter(unit):
    mesh = moved(BLOB, averaged(BLOB, 0.3, own=1 / 7))
    found = colour_of(mesh)
    other = colour_of(mesh.with_vertices(unit * (mesh.vertices + np.array([3, -2, 1]))))
    assert np.array(other.levels) / unit == pytest.approx(np.array(found.levels), rel=1e-6)
    assert other.uneven == pytest.approx(found.uneven, rel=1e-6)


def test_nothing_moves_on_a_plane():
    found = colour_of(shapes.grid(20, 20, dimension=3))
    assert found.levels == pytest.approx([0] * 5, abs=1e-12)
    assert not found.is_coloured(1.0)


def folded(height, waves):
    """A sphere with waves all over, three times as high on one side."""
    sphere = shapes.icosphere(5)
    x, y, z = sphere.vertices.T
    wave = (1.5 + z) * np.sin(waves * x) * np.sin(waves * y)
    return sphere.with_vertices(sphere.vertices * (1 + height * wave)[:, None])


def smoothed(mesh, rows, cut):
    return mesh.with_vertices(along_normals(mesh, low_passed(rows, mesh.vertices, Linear(cut))))


class TestBeside:
    def measured(self, truth, noise, cut=0.3, core=None):
        """Return the levels, of the noise alone, before and beside, in mean edges."""
        mesh, edge = moved(truth, noise), float(truth.edge_lengths.mean())
        core = np.ones(len(noise), np.bool_) if core is None else core
        rows = Bench.of(mesh).rows
        first = colour_of(mesh)
        way = partial(smoothed, rows=rows, cut=cut)
        found = colour_beside(first, rows, mesh, way(mesh), way, core)
        assert found.uneven == (1.0,) * 5
        assert found.kurtosis == first.kurtosis
        return np.array(first.levels) / edge, np.array(found.levels) / edge

    def test_what_is_left_of_the_noise_is_no_shape(self):
        found = [self.measured(TORUS, white(TORUS, 0.2, seed), 0.4)[1] for seed in range(4)]
        assert np.mean(found, axis=0) == pytest.approx([0.2] * 5, rel=0.05)

    @pytest.mark.parametrize("seed", [0, 2])
    def test_shape_that_is_all_over_is_told(self, seed):
        truth = folded(0.03, 20)
        before, found = self.measured(truth, white(truth, 0.2, seed))
        assert before[0] > 0.26
        assert found == pytest.approx([0.2] * 5, rel=0.1)

    def test_the_core_counts(self):
        noise = white(TORUS, 0.2) * np.where(TORUS.vertices[:, 0] > 0, 1, 4)
        _, found = self.measured(TORUS, noise, core=TORUS.vertices[:, 0] > 0.3)
        assert found[2:] == pytest.approx([0.2] * 3, rel=0.1)

    def test_where_nothing_is_noise_the_colour_stays(self):
        plane = shapes.grid(20, 20, dimension=3)
        first, rows = colour_of(moved(TORUS, white(TORUS, 0.2))), Bench.of(plane).rows
        core = np.ones(plane.n_vertices, np.bool_)
        assert colour_beside(first, rows, plane, plane, lambda other: other, core) is first

    def test_a_filter_that_leaves_all_noise_says_little(self):
        """All that is put on the first result would be shape: levels are doubled, and no more."""
        mesh = moved(TORUS, white(TORUS, 0.2))
        rows, core = Bench.of(mesh).rows, np.ones(mesh.n_vertices, np.bool_)
        first, clean = colour_of(mesh), smoothed(mesh, rows, 0.02)
        found = colour_beside(first, rows, mesh, clean, lambda other: other, core)
        edge = float(TORUS.edge_lengths.mean())
        assert np.array(found.levels) / edge == pytest.approx([0.4] * 5, rel=0.1)

    @pytest.mark.parametrize("unit", [1e-9, 1e9])
    def test_the_unit_does_not_matter(self, unit):
        noise = averaged(BLOB, 0.3, own=1 / 7)
        _, found = self.measured(BLOB, noise)
        _, other = self.measured(BLOB.with_vertices(unit * BLOB.vertices), noise)
        assert other == pytest.approx(found, rel=1e-6)

    def test_lines(self):
        random = np.random.default_rng(0)
        x = random.exponential(size=4000)
        y = (1 + 2 * x) * random.gamma(8, 1 / 8, 4000)
        assert start_of_line(x, y) == pytest.approx(1, rel=0.05)
        w = np.ones_like(y)
        for _ in range(50):
            a, b = np.linalg.lstsq(np.stack([w, w * x], axis=1), w * y)[0]
            w = 1 / (a + b * x)
        assert start_of_line(x, y) == pytest.approx(a, rel=1e-6)
        assert start_of_line(x, 3 + 0 * x) == pytest.approx(3)
        assert start_of_line(0 * x, y) == pytest.approx(y.mean())
        assert start_of_line(x, 5 - x) == pytest.approx(np.mean(5 - x))  # no line falls
        two = np.repeat([1.0, 2.0], 50)
        assert 1 < start_of_line(two, 5 * two) < 2  # or is as steep as that
        assert start_of_line(x, 2 * x) == pytest.approx(0, abs=1e-9)
        assert start_of_line(x, 0 * x) == 0


class TestChance:
    """What noise of a colour adds to the difference of two risks."""

    def test_the_deviation_is_that_of_many(self):
        wheel = np.exp(2j * np.pi * np.arange(30) / 30)
        flat = np.concatenate([[0], wheel, 2 * wheel])
        i, j = np.arange(30), (np.arange(30) + 1) % 30
        faces = [(0 * i, 1 + i, 1 + j), (1 + i, 31 + i, 31 + j), (1 + i, 31 + j, 1 + j)]
        fan = Mesh(np.stack([flat.real, flat.imag, 0 * flat.real], axis=1),
                   np.concatenate([np.stack(three, axis=1) for three in faces]))  # fmt: skip
        rows, degrees = Bench.of(fan).rows, np.diff(fan.topology.adjacency.indptr)
        assert degrees[0] == 30
        colour = NoiseColour((2.0, 1.5, 1.0, 0.8, 0.7), (1.0,) * 5, 3.0)
        random = np.random.default_rng(0)
        noise = colour.noise(rows, random.standard_normal((fan.n_vertices, 6000)))
        for f in (degrees == 30, np.abs(flat) > 1, random.normal(size=len(degrees))):
            found = colour.deviation(rows, degrees, np.float64(f))
            assert found == pytest.approx((f @ noise).std(), rel=0.06)

    def test_white_noise_is_a_colour_too(self):
        mesh = shapes.icosphere(3)
        rows, n = Bench.of(mesh).rows, mesh.n_vertices
        core = np.arange(n) % 3 > 0
        x = mesh.vertices + 0.01 * white(mesh, 1)[:, None] * mesh.vertex_normals
        even = NoiseColour((0.1,) * 5, (1.0,) * 5, 3.0)
        trial = _Trial(mesh, core, [], 1.0, 1.0, mesh.vertex_normals, None, rows)
        found = trial.chance(x, mesh.vertices, 0.3)
        apart = np.linalg.norm((x - mesh.vertices)[core])
        assert found == pytest.approx(2 * 0.3 * apart / core.sum())
        # its lowest frequencies are guessed, and no power fits those of white noise
        other = replace(trial, colour=even).chance(x, mesh.vertices, 0.3)
        assert other == pytest.approx(found, rel=0.1)

    def test_what_is_smooth_is_more_by_chance(self):
        mesh = shapes.icosphere(3)
        rows, core = Bench.of(mesh).rows, np.ones(mesh.n_vertices, np.bool_)
        low = NoiseColour((2.0, 1.5, 1.0, 0.8, 0.7), (1.0,) * 5, 3.0)
        trial = _Trial(mesh, core, [], 1.0, 1.0, mesh.vertex_normals, low, rows)
        smooth, rough = 1.01 * mesh.vertices, moved(mesh, white(mesh, 0.05)).vertices
        for x, least, most in ((smooth, 2, 9), (rough, 0.9, 1.1)):
            plain = replace(trial, colour=None).chance(x, mesh.vertices, 0.3)
            assert least * plain < trial.chance(x, mesh.vertices, 0.3) < most * plain

    @pytest.mark.parametrize("sure", [4.0, 8.0])
    def test_a_part_of_the_way(self, sure):
        """From the best of the simple ones to that of all, the shorter the more may be chance."""
        mesh = moved(ALL[2], averaged(ALL[2], 0.3, own=1 / 7))
        bench, colour, n = Bench.of(mesh), colour_of(mesh), mesh.n_vertices
        filters = (Linear(0.3), Linear(0.1), Linear(0.2, True, 0.3), Linear(0.07, True, 0.3))
        probe = 0.01 * colour.noise(bench.rows, white(mesh, 1)[:, None]) * bench.normals
        other = mesh.with_vertices(mesh.vertices + probe)
        here, there = filtered(mesh, bench, filters), filtered(other, bench.moved(other), filters)
        everywhere, square = np.ones(n, np.bool_), float((probe**2).sum()) / n
        trial = _Trial(mesh, everywhere, [probe], square, 1.0, bench.normals, colour, bench.rows)
        sigma = colour.level(bench.rows)
        (all_of_it, least), (simple, most), (found, _) = (
            trial.mixture(here, [there], sigma, 2, value) for value in (0.0, 1e9, sure)
        )
        assert (simple[2:] == 0).all()
        assert all_of_it[2:].sum() > 0.1
        x, y = (np.tensordot(weights, here, 1) for weights in (all_of_it, simple))
        share = sure_share(most - least, sure * trial.chance(x, y, sigma))
        assert 0 < share < 1
        assert found == pytest.approx(share * all_of_it + (1 - share) * simple)

    def test_shares(self):
        assert sure_share(-1.0, 1.0) == sure_share(0.0, 0.0) == sure_share(0.5, 1.0) == 0
        assert sure_share(1.0, 0.0) == 1
        assert sure_share(1.0, 1.0) == pytest.approx(0.75)


class TestDenoise:
    @pytest.mark.parametrize("truth", [BLOB, TORUS], ids=["blob", "torus"])
    def test_it_is_said_and_near_the_best_linear_filter(self, truth):
        mesh = moved(truth, averaged(truth, 0.3, own=1 / 7))
        found = denoise(mesh)
        assert any("not white" in text for text in found.warnings)
        assert found.noise.sigma == pytest.approx(rms(mesh, truth), rel=0.25)
        bench = Bench.of(mesh)
        best = min(rms(mesh.with_vertices(x), truth) for x in filtered(mesh, bench, LINEAR))
        assert rms(found.mesh, truth) < 1.15 * best
        # for white noise of the same level low passes alone, as here, would smooth far too little
        level = noise_level(mesh.topology.adjacency, mesh.vertices, directions=bench.normals)
        plain = denoise(mesh, "linear", noise=level.sigma)
        assert rms(plain.mesh, truth) > 1.1 * rms(found.mesh, truth)

    def test_the_level_is_that_of_all_frequencies(self):
        mesh = moved(TORUS, averaged(TORUS, 0.3, own=0.5))
        bench = Bench.of(mesh)
        before = noise_level(mesh.topology.adjacency, mesh.vertices, 1.0, bench.normals)
        after = with_colour(before, colour_of(mesh), bench.rows)
        assert before.sigma < 0.75 * rms(mesh, TORUS)
        assert after.sigma == after.spread == pytest.approx(rms(mesh, TORUS), rel=0.15)
        assert len(after.warnings) == len(before.warnings) + 1

    def test_a_look_tells_its_colour_and_the_normals(self):
        truth = TORUS
        mesh = moved(truth, averaged(truth, 0.3, own=1 / 7))
        seen = Seen.of(mesh, None, 40_000, linear=False)
        first = with_colour(seen.measured, colour_of(mesh), equal_rows(mesh))
        assert seen.looks == 0
        assert seen.colour.uneven == (1.0,) * 5
        level = rms(mesh, truth)
        assert abs(seen.found.sigma / level - 1) < abs(first.sigma / level - 1)

        def off(normals):
            return 1 - np.einsum("ij,ij->i", normals, truth.vertex_normals).mean()

        assert off(seen.normals) < 0.5 * off(Bench.of(mesh).normals)

    def test_a_level_that_is_said_is_looked_with(self):
        mesh = moved(BLOB, averaged(BLOB, 0.3, own=1 / 7))
        edge = mesh.edge_lengths.mean()
        little, much = (Seen.of(mesh, s * edge, 40_000, linear=False) for s in (0.01, 0.3))
        own = mesh.vertex_normals

        def turned(normals):
            return 1 - np.einsum("ij,ij->i", normals, own).mean()

        assert turned(little.normals) < 0.1 * turned(much.normals)
        assert np.array_equal(denoise(mesh, noise=0).mesh.vertices, mesh.vertices)
