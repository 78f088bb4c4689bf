"""Outliers of the rough part: those of sharp features are the shape's, those of noise are said."""

import numpy as np
import pytest

from beltrami.diffusion.denoise import denoise
from beltrami.diffusion.level import clipped_level
from beltrami.diffusion.noise import noise_level
from beltrami.diffusion.outliers import among_short_edges, are_of_shape, rough_part
from beltrami.diffusion.spikes import find_spikes
from beltrami.mesh import shapes
from made_once import MadeOnce, creature

SHARP = MadeOnce(
    {
        "cube": lambda: shapes.cube(16),
        "fine cube": lambda: shapes.cube(24),
        "can": lambda: shapes.cylinder(60, 30, caps=True),
        "box": lambda: scaled(shapes.cube(14), [1, 1.3, 0.7]),
    }
)
SMOOTH = MadeOnce({"blob": lambda: creature(1000), "torus": lambda: shapes.torus(60, 30)})


def scaled(mesh, factors):
    return mesh.with_vertices(mesh.vertices * factors)


def moved(truth, noise):
    """Along the normals, noise in mean edges."""
    way = truth.edge_lengths.mean() * noise
    return truth.with_vertices(truth.vertices + way[:, None] * truth.vertex_normals)


def white(truth, level, seed=0):
    return moved(truth, level * np.random.default_rng(seed).normal(size=truth.n_vertices))


def level_of(mesh):
    A, edge = mesh.topology.adjacency, mesh.edge_lengths.mean()
    return noise_level(A, mesh.vertices, edge, mesh.vertex_normals)


def rms(mesh, truth):
    """In mean edges."""
    square = ((mesh.vertices - truth.vertices) ** 2).sum(axis=1).mean()
    return float(np.sqrt(square) / truth.edge_lengths.mean())


class TestRoughPart:
    def test_against_the_definition(self):
        clean = shapes.cube(4)
        mesh, normals = white(clean, 0.05), clean.vertex_normals
        W = np.zeros((clean.n_vertices, clean.n_vertices))
        for i, j in mesh.edges:
            length = np.linalg.norm(clean.vertices[i] - clean.vertices[j])
            apart = ((normals[i] - normals[j]) ** 2).sum()
            W[i, j] = W[j, i] = np.exp(-apart / (2 * 0.5**2)) / length
        R = np.linalg.matrix_power(np.eye(len(W)) - W / W.sum(axis=1)[:, None], 3)
        rough = ((R @ mesh.vertices) * normals).sum(axis=1)
        rough /= np.sqrt((R**2 * (normals @ normals.T) ** 2).sum(axis=1))
        found = rough_part(mesh, clean)
        assert found.spread == pytest.approx(np.sqrt((rough**2).mean()), rel=1e-9)
        assert found.level == pytest.approx(clipped_level(rough), rel=1e-9)

    @pytest.mark.parametrize("name", ["cube", "can", "box"])
    def test_beside_the_truth_creases_leave_no_outliers(self, name):
        truth = SHARP[name]
        mesh = white(truth, 0.03)
        found, edge = rough_part(mesh, truth), truth.edge_lengths.mean()
        assert found.level / edge == pytest.approx(0.03, rel=0.15)
        assert found.spread < 1.2 * found.level
        assert level_of(mesh).spread > 1.5 * found.spread

    def test_spikes_stay(self):
        torus = SMOOTH["torus"]
        heights = np.random.default_rng(1).random(torus.n_vertices) < 0.05
        found = rough_part(moved(torus, heights), torus)
        assert found.spread > 2.5 * found.level


@pytest.mark.parametrize(("name", "level"), [("cube", 0.02), ("can", 0.03), ("box", 0.05)])
def test_little_noise_beside_creases_is_measured_and_taken_off(name, level):
    """The creases make the root mean square two times as large, or more."""
    truth = SHARP[name]
    mesh = white(truth, level)
    before = level_of(mesh)
    found = denoise(mesh)
    assert before.spread > 1.3 * level * truth.edge_lengths.mean()
    assert found.warnings == ()
    assert found.sigma / truth.edge_lengths.mean() == pytest.approx(level, rel=0.15)
    assert rms(found.mesh, truth) < 0.35 * rms(mesh, truth)


def test_a_clean_shape_with_creases_stays_as_it_is():
    """The more of its vertices are far from creases, the more exactly."""
    for name, largest in (("fine cube", 0.0), ("box", 0.004)):
        truth = SHARP[name]
        assert level_of(truth).has_outliers
        assert level_of(truth).spread > 0.05 * truth.edge_lengths.mean()
        found = denoise(truth)
        assert found.warnings == ()
        assert found.sigma <= largest * truth.edge_lengths.mean()
        assert rms(found.mesh, truth) <= largest


def test_a_level_that_is_said_is_taken_beside_creases_too():
    truth = SHARP["cube"]
    mesh = white(truth, 0.05)
    found = denoise(mesh, noise=0.05 * truth.edge_lengths.mean())
    assert found.warnings == ()
    assert rms(found.mesh, truth) < 0.35 * rms(mesh, truth)


@pytest.mark.parametrize("name", SMOOTH)
@pytest.mark.parametrize("kind", ["heavy tails", "two levels"])
def test_noise_that_is_not_gaussian_is_said(name, kind):
    truth = SMOOTH[name]
    random = np.random.default_rng(5)
    n = truth.n_vertices
    noise = {
        "heavy tails": lambda: random.standard_t(3, n) / 3**0.5,
        "two levels": lambda: np.where(random.random(n) < 0.15, 2.0, 0.5) * random.normal(size=n),
    }[kind]()
    mesh = moved(truth, 0.2 * noise)
    found = denoise(mesh)
    assert found.noise.has_outliers
    assert "has outliers" in found.warnings[0]
    if kind == "heavy tails":  # of two levels, the louder ones are spikes
        assert not len(found.spikes)
        assert found.sigma == pytest.approx(rms(mesh, truth) * truth.edge_lengths.mean(), rel=0.1)
    assert rms(found.mesh, truth) < 0.65 * rms(mesh, truth)


def test_what_is_known_of_outliers():
    torus = SMOOTH["torus"]
    found = level_of(moved(torus, np.random.default_rng(0).random(torus.n_vertices) < 0.05))
    assert found.has_outliers
    told = found.explained()
    assert not told.has_outliers
    assert (told.kurtosis, told.spread, told.warnings) == (found.kurtosis, found.spread, ())
    assert told.explained() == told


class TestOverlooked:
    """A spike that planes beyond a bend hold by chance is held as a crease is."""

    @staticmethod
    def spiked(truth, seed):
        random = np.random.default_rng([seed, 9])
        n = truth.n_vertices
        return (random.random(n) < 0.1) * random.normal(size=n)

    @pytest.mark.parametrize("seed", [1, 2])
    def test_they_are_found_once_the_others_are_down(self, seed):
        torus = shapes.torus(48, 24)
        heights = self.spiked(torus, seed)
        mesh = moved(torus, heights)
        found = find_spikes(mesh)
        assert (np.abs(heights[~found.found]) < 0.2).all()
        assert found.error < 0.005 * torus.edge_lengths.mean()
        assert rms(denoise(mesh).mesh, torus) < 0.06 * rms(mesh, torus)

    @pytest.mark.parametrize("name", ["cube", "can", "box"])
    def test_corners_and_creases_are_none(self, name):
        truth = SHARP[name]
        heights = self.spiked(truth, 4)
        found = find_spikes(moved(truth, heights))
        false = found.found & (heights == 0)
        assert false.sum() <= 0.01 * truth.n_vertices
        assert not false[np.bincount(truth.faces.ravel(), minlength=len(false)) == 3].any()


class TestLongEdges:
    """A sheet whose edges grow from its middle, with four folds where they are of medium length."""

    @staticmethod
    def sheet():
        square = shapes.grid(40, 40, dimension=3)
        t = 2 * square.vertices[:, :2] - 1
        x, y = (np.sign(t) * np.abs(t) ** 5).T
        return square.with_vertices(np.column_stack([x, y, 2 * np.abs(np.abs(x) - 0.5**5)]))

    def test_a_third_of_the_vertices_are_among_long_edges(self):
        sheet = self.sheet()
        short = among_short_edges(sheet)
        far = np.abs(sheet.vertices[:, :2]).max(axis=1)
        assert far[~short].min() > np.median(far[short])
        assert 0.3 < 1 - short.mean() < 0.45
        torus = shapes.torus(40, 20)
        assert among_short_edges(torus).all()

    @pytest.mark.parametrize("among", ["short", "long"])
    def test_outliers_there_may_be_of_the_shape(self, among):
        sheet = self.sheet()
        where = among_short_edges(sheet)
        if among == "long":  # and none of their neighbours is among short ones
            where = sheet.topology.adjacency @ where == 0
        hit = where & (np.random.default_rng(0).random(sheet.n_vertices) < 0.05)
        way = 0.5 * sheet.edge_lengths.mean() * hit[:, None] * sheet.vertex_normals
        mesh = sheet.with_vertices(sheet.vertices + way)
        everywhere = rough_part(mesh, sheet)
        assert everywhere.spread > 40 * everywhere.level  # as spikes everywhere, if all count
        assert are_of_shape(mesh, sheet.vertex_normals, sheet) == (among == "long")


class TestFewVertices:
    """Less than 200, on which nobody looks for spikes."""

    def test_a_clean_crease_is_no_noise(self):
        ball = shapes.icosphere(2)
        x, y, z = ball.vertices.T
        dent = ball.with_vertices(np.column_stack([x, y, np.where(z > 0.2, 0.4 - z, z)]))
        found = denoise(dent)
        assert rms(found.mesh, dent) < 0.0015
        assert found.noise.has_outliers

    @pytest.mark.parametrize("seed", [0, 1])
    def test_spikes_are_said_and_not_spread(self, seed):
        cube, random = shapes.cube(5), np.random.default_rng(seed)
        hit = random.random(cube.n_vertices) < 0.05
        mesh = moved(cube, 0.6 * hit * random.choice([-1, 1], cube.n_vertices))
        found = denoise(mesh)
        assert found.noise.has_outliers
        assert not len(found.spikes)
        assert rms(found.mesh, cube) <= rms(mesh, cube)


@pytest.mark.parametrize("share", [0.01, 0.1])
def test_the_colour_that_spikes_had_hidden_is_seen_without_them(share):
    torus, random = shapes.torus(80, 40), np.random.default_rng(0)
    near = torus.topology.adjacency
    noise = random.standard_normal(torus.n_vertices)
    noise = (noise + near @ noise) / (1 + near.sum(axis=1))
    noise *= 0.2 / noise.std()
    hit = random.random(torus.n_vertices) < share
    found = denoise(moved(torus, noise + hit * random.standard_normal(torus.n_vertices)))
    assert len(found.spikes)
    assert hit[found.spikes].mean() > 0.9
    assert any("not white" in text for text in found.warnings)
    assert rms(found.mesh, torus) < 0.08


class TestBounds:
    def test_crests_with_noise_are_not_said(self):
        """More than a twentieth of their outliers is left beside a first result."""
        assert not denoise(white(creature(1600), 0.1, seed=1)).warnings

    def test_spikes_on_a_shape_that_bends_unlike_noise_are_found(self):
        """A clean cube does, and half of what they leave goes with the creases."""
        cube = SHARP["fine cube"]
        random = np.random.default_rng(1)
        hit = random.random(cube.n_vertices) < 0.01
        mesh = moved(cube, hit * random.choice([-1, 1], cube.n_vertices))
        found = denoise(mesh)
        assert set(found.spikes.tolist()) >= set(np.flatnonzero(hit).tolist())
        assert rms(found.mesh, cube) < 0.1 * rms(mesh, cube)
