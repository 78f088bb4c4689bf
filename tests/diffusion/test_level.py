"""The level of the noise beside a first result: at creases, on folded shapes, of strong noise."""

import numpy as np
import pytest

from beltrami.diffusion.level import _levels, clipped_level, level_beside, without_shape
from beltrami.diffusion.linear_filters import Linear, equal_rows, low_passed
from beltrami.diffusion.noise import noise_level
from beltrami.mesh import shapes


def noisy(truth, sigma, seed=0):
    noise = np.random.default_rng(seed).normal(0, sigma, truth.n_vertices)
    return truth.with_vertices(truth.vertices + noise[:, None] * truth.vertex_normals)


def told(truth):
    """The truth itself as the first result."""
    return lambda mesh: truth


def not_filtered(mesh):
    return mesh


def dense_levels(mesh, clean):
    """Those of the two orders by their definitions."""
    n, normals = mesh.n_vertices, clean.vertex_normals
    W = np.zeros((n, n))
    for i, j in mesh.edges:
        length = np.linalg.norm(clean.vertices[i] - clean.vertices[j])
        apart = ((normals[i] - normals[j]) ** 2).sum()
        W[i, j] = W[j, i] = np.exp(-apart / (2 * 0.5**2)) / length
    K = np.eye(n) - W / W.sum(axis=1)[:, None]
    for order in (3, 6):
        R = np.linalg.matrix_power(K, order)
        rough = ((R @ mesh.vertices) * normals).sum(axis=1)
        yield clipped_level(rough / np.sqrt((R**2 * (normals @ normals.T) ** 2).sum(axis=1)))


def test_against_the_definition():
    truth = shapes.cube(5)
    mesh = noisy(truth, 0.01)
    expected = without_shape(*dense_levels(mesh, truth), mesh.n_vertices)
    # beside the truth nothing is too low, so the noise that is added has nothing to mend
    assert level_beside(mesh, truth, told(truth)) == pytest.approx(expected, rel=1e-9)


@pytest.mark.chapter("P42")
def test_creases_leave_nothing():
    """Five differences in six are near a crease here; plain ones are all of the crease."""
    truth = shapes.cube(8)
    sigma = 0.03 * truth.edge_lengths.mean()
    levels, plain = [], []
    for seed in range(6):
        mesh = noisy(truth, sigma, seed)
        levels.append(level_beside(mesh, truth, told(truth)) / sigma)
        A, normals = mesh.topology.adjacency, truth.vertex_normals
        plain.append(noise_level(A, mesh.vertices, None, normals).sigma / sigma)
    assert np.mean(levels) == pytest.approx(1, abs=0.1)
    assert np.mean(plain) > 1.5


def test_what_is_as_rough_as_the_noise_is_told_by_its_orders():
    """A texture that has less of itself in the higher order."""
    sphere = shapes.icosphere(4)
    edge, white = sphere.edge_lengths.mean(), np.random.default_rng(2).normal(size=2562)
    texture = low_passed(equal_rows(sphere), white[:, None], Linear(1.1))
    truth = sphere.with_vertices(sphere.vertices * (1 + 0.15 * edge * texture))
    sigma = 0.05 * edge
    for seed in (3, 4):
        mesh = noisy(truth, sigma, seed)
        low, high = _levels(mesh, truth) / sigma
        assert low > 1.15
        assert low > high + 0.05
        assert abs(level_beside(mesh, truth, told(truth)) / sigma - 1) < 0.7 * (low - 1)


def test_where_normals_are_wrong_noise_of_the_same_level_says_how_much():
    """The mesh as its own first result: its normals follow its noise."""
    truth = shapes.icosphere(4)
    sigma = 0.35 * truth.edge_lengths.mean()
    for seed in range(2):
        mesh = noisy(truth, sigma, seed)
        alone = _levels(mesh, mesh)[0] / sigma
        assert alone < 0.9
        assert abs(level_beside(mesh, mesh, not_filtered) / sigma - 1) < 0.9 * (1 - alone)


def test_the_unit_does_not_matter():
    truth = shapes.cube(6)
    mesh = noisy(truth, 0.02)
    level = level_beside(mesh, truth, told(truth))
    large, same = (one.with_vertices(1e9 * one.vertices) for one in (mesh, truth))
    assert level_beside(large, same, told(same)) == pytest.approx(1e9 * level, rel=1e-9)


class TestClippedLevel:
    def test_it_errs_less_by_chance_than_a_median(self):
        values = np.random.default_rng(0).normal(0, 3, (400, 500))
        clipped = [clipped_level(row) for row in values]
        median = np.median(np.abs(values), axis=1) / 0.6744897501960817
        assert np.mean(clipped) == pytest.approx(3, rel=0.01)
        assert np.std(clipped) < 0.85 * np.std(median)

    def test_a_third_of_the_values_may_be_anything(self):
        values = np.random.default_rng(1).normal(size=3000)
        values[::3] = 1e12
        assert clipped_level(values) < 10


class TestWithoutShape:
    def test_what_may_be_chance_counts_for_nothing(self):
        assert without_shape(1.0, np.sqrt(1 - 0.019), 2500) == 1
        assert without_shape(1.0, np.sqrt(1 - 0.04), 2500) == pytest.approx(np.sqrt(0.92))

    def test_it_never_takes_more_than_half(self):
        assert without_shape(1.0, 0.0, 10**6) == pytest.approx(np.sqrt(0.5))
