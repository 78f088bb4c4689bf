"""Corrections of denoised meshes: their terms, their weights, and that they bring something."""

import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from beltrami.diffusion import choice
from beltrami.diffusion.blind import blind_choice
from beltrami.diffusion.candidates import Bench, along_normals
from beltrami.diffusion.corrections import (
    NONE,
    TERMS,
    Corrections,
    _gain,
    _terms,
    best_corrections,
    shrunk_weights,
)
from beltrami.diffusion.denoise import denoise
from beltrami.diffusion.fairing import faired
from beltrami.diffusion.linear_filters import Linear, low_passed
from beltrami.io.registry import read_mesh
from beltrami.mesh import shapes
from beltrami.mesh.mesh import Mesh

FOLDER = os.environ.get("BELTRAMI_MESHES")
SPHERE = shapes.icosphere(4)
FILTER = Linear(0.3)


def rough(sphere=SPHERE):
    """A sphere that is rough on one side, and everywhere a little."""
    random = np.random.default_rng(0).normal(size=sphere.n_vertices)
    A = sphere.topology.adjacency
    for _ in range(2):
        random = A @ random / A.sum(axis=1)
    place = 0.3 + 1.7 * (sphere.vertices[:, 2] > 0)
    edge = sphere.edge_lengths.mean()
    return sphere.with_vertices(sphere.vertices * (1 + 1.5 * edge * place * random)[:, None])


def noisy(truth, level, seed=0):
    sigma = level * truth.edge_lengths.mean()
    noise = np.random.default_rng(50 + seed).normal(0, sigma, truth.n_vertices)
    return truth.with_vertices(truth.vertices + noise[:, None] * truth.vertex_normals), sigma


def smoothed(mesh):
    return along_normals(mesh, low_passed(Bench.of(mesh).rows, mesh.vertices, FILTER))


def trial(truth, level, seed=0, unit=1.0):
    """The noisy mesh, what a low pass makes of it, and of a changed copy, and σ."""
    mesh, sigma = noisy(truth, level, seed)
    mesh, sigma = mesh.with_vertices(unit * mesh.vertices), unit * sigma
    normals = mesh.with_vertices(smoothed(mesh)).vertex_normals
    random = np.random.default_rng(100 + seed).choice([-1.0, 1.0], (2, len(normals)))
    changes = [0.3 * sigma * along[:, None] * normals for along in random]
    changed = [(c, smoothed(mesh.with_vertices(mesh.vertices + c))) for c in changes]
    return mesh, smoothed(mesh), changed, sigma


def rms(x, truth):
    return np.sqrt(((x - truth.vertices) ** 2).sum(axis=1).mean())


ROUGH = rough()
EVERYWHERE = np.ones(SPHERE.n_vertices, np.bool_)


class TestTerms:
    def test_against_the_definition(self):
        """Dense matrices, on an open mesh with a stray vertex."""
        grid = shapes.grid(8, 9, dimension=3)
        random = np.random.default_rng(1)
        y = np.vstack([grid.vertices + random.normal(0, 0.1, grid.vertices.shape), [[9, 9, 9]]])
        mesh = Mesh(y, grid.faces)
        x = y + random.normal(0, 0.05, y.shape)
        A = mesh.topology.adjacency.toarray()
        A[-1, -1] = 1
        W = A / A.sum(axis=1, keepdims=True)
        n = mesh.with_vertices(x).vertex_normals
        r = ((y - x) * n).sum(axis=1)
        powers = [np.linalg.matrix_power(W, k) for k in range(7)]
        removed = [P @ r for P in powers]
        left = [((P @ x - x) * n).sum(axis=1) for P in powers]
        unit = 0.7
        lengths = np.where(A > 0, np.linalg.norm(x[:, None] - x[None], axis=2), 0)
        mean = lengths.sum(axis=1) / A.sum(axis=1)
        bend = W @ left[1] / unit
        places = [(mean / unit - 1) / 0.15, bend / 0.15, (abs(bend) - 0.1) / 0.1]
        expected = [*removed[2:], *left[1:]]
        for place in places:
            factor = place.clip(-3, 3)
            expected += [factor * removed[k] for k in (2, 4)]
            expected += [factor * left[k] for k in (1, 2, 4)]
        found = np.stack(list(_terms(mesh, x, n, unit)))
        assert found.shape == (TERMS, len(y))
        assert np.allclose(found, expected, atol=1e-13)
        weights = random.normal(size=TERMS)
        moved = Corrections(unit, weights, 1.0).of(mesh, x)
        assert np.allclose(moved, x + (weights @ np.stack(expected))[:, None] * n, atol=1e-12)

    def test_none_changes_nothing(self):
        x = ROUGH.vertices
        assert NONE.of(ROUGH, x) is x
        assert NONE.size == 0


class TestWeights:
    def test_without_errors_the_equations_are_solved(self):
        random = np.random.default_rng(2)
        f = random.normal(size=(5, 40)) * [[1], [10], [0.1], [1], [3]]
        c = random.normal(size=5)
        assert np.allclose(shrunk_weights(f @ f.T, c, 0.0), np.linalg.solve(f @ f.T, c))

    def test_chance_is_shrunk_away(self):
        """Where there is nothing but errors, hardly any are left; one direction stays as it is."""
        random = np.random.default_rng(3)
        f = random.normal(size=(20, 400))
        gram, root = f @ f.T / 400, np.linalg.cholesky(f @ f.T / 400)
        norms = np.sqrt(np.diag(gram))
        direction = np.linalg.eigh(gram / norms / norms[:, None])[1][:, -1] / norms
        plain = np.zeros((2, 200))
        shrunk = np.zeros((2, 200))
        for i in range(200):
            error = 0.05 * root @ random.normal(size=20)
            for strength in (0, 1):
                true = strength * direction
                c = gram @ true + error
                for weights, kept in (
                    (np.linalg.solve(gram, c), plain),
                    (shrunk_weights(gram, c, 0.05**2), shrunk),
                ):
                    kept[strength, i] = (weights - true) @ gram @ (weights - true)
        assert plain.mean(axis=1) == pytest.approx([20 * 0.05**2] * 2, rel=0.1)
        assert (shrunk.mean(axis=1) < 0.3 * plain.mean(axis=1)).all()

    def test_a_term_twice_and_a_term_that_is_nothing(self):
        gram = np.array([[1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 0.0]])
        a = shrunk_weights(gram, np.array([2.0, 2.0, 0.0]), 1e-6)
        assert np.allclose(a, [1, 1, 0], atol=1e-5)


class TestGain:
    def test_it_is_that_of_the_truth_up_to_chance(self):
        """c is <f n, truth - x>/n, with errors of the covariance σ² G/n; without σ² it is not."""
        mesh, x, changed, sigma = trial(ROUGH, 0.3)
        unit = float(mesh.edge_lengths.mean())
        normals = mesh.with_vertices(x).vertex_normals
        n = len(x)
        gram, agreement = _gain(mesh, EVERYWHERE, x, changed, sigma, unit)
        terms = np.stack(list(_terms(mesh, x, normals, unit)))
        assert np.allclose(gram, terms @ terms.T / n)
        true = terms @ ((ROUGH.vertices - x) * normals).sum(axis=1) / n
        chance = sigma * np.sqrt(np.diag(gram) / n)
        assert (np.abs(agreement - true) < 4.5 * chance).all()
        naive = _gain(mesh, EVERYWHERE, x, changed, 0.0, unit)[1]
        assert np.abs((naive - true) / chance).max() > 15

    def test_it_is_measured_on_the_core(self):
        mesh, x, changed, sigma = trial(ROUGH, 0.3)
        core = SPHERE.vertices[:, 0] > -0.6
        far = SPHERE.vertices[:, 0] < -0.97  # nothing of it reaches the core
        assert far.any()
        for one in (x, *(moved for _, moved in changed)):
            assert one.flags.writeable
        found = _gain(mesh, core, x, changed, sigma, 1.0)
        spoilt = [(c, np.where(far[:, None], 2 * moved, moved)) for c, moved in changed]
        again = _gain(mesh, core, np.where(far[:, None], 2 * x, x), spoilt, sigma, 1.0)
        everywhere = _gain(mesh, EVERYWHERE, x, changed, sigma, 1.0)
        for a, b, c in zip(found, again, everywhere, strict=True):
            assert np.array_equal(a, b)
            assert not np.allclose(a, c)


class TestBest:
    @pytest.mark.parametrize("seed", range(3))
    def test_the_result_is_nearer_the_truth(self, seed):
        mesh, x, changed, sigma = trial(ROUGH, 0.3, seed)
        found = best_corrections(mesh, EVERYWHERE, x, changed, sigma, sigma**2)
        corrected = found.of(mesh, x)
        assert rms(corrected, ROUGH) < 0.8 * rms(x, ROUGH)
        moved = np.sqrt(((corrected - x) ** 2).sum(axis=1).mean())
        assert found.size == pytest.approx(moved)

    def test_few_vertices_and_little_that_is_left_are_not_corrected(self):
        mesh, x, changed, sigma = trial(ROUGH, 0.9)
        bound = 26 * sigma**2 / (0.06 * mesh.n_vertices)
        found = best_corrections(mesh, EVERYWHERE, x, changed, sigma, 1.01 * bound)
        assert found.size > 0
        assert best_corrections(mesh, EVERYWHERE, x, changed, sigma, 0.99 * bound) is NONE
        core = np.arange(mesh.n_vertices) % 2 == 0
        assert best_corrections(mesh, core, x, changed, sigma, 1.01 * bound) is NONE

    def test_what_costs_more_has_to_be_surer(self):
        mesh, x, changed, sigma = trial(ROUGH, 0.1)
        cheap, dear = (
            best_corrections(
                mesh, EVERYWHERE, x, changed, sigma, 26 * sigma**2 / (cost * mesh.n_vertices)
            )
            for cost in (0.002, 0.01)
        )
        assert np.array_equal(cheap.weights, dear.weights)  # both below 1.5 %
        mesh, x, changed, sigma = trial(ROUGH, 0.9)
        cheap, dear = (
            best_corrections(
                mesh, EVERYWHERE, x, changed, sigma, 26 * sigma**2 / (cost * mesh.n_vertices)
            )
            for cost in (0.01, 0.05)
        )
        assert 0 < dear.size < cheap.size

    def test_gains_that_may_be_chance_are_none(self):
        """Were x the truth, whatever the noise, there would be nothing to correct."""
        for seed in range(4):
            mesh, _, changed, sigma = trial(ROUGH, 0.3, seed)
            x = ROUGH.vertices
            same = [(change, x) for change, _ in changed]
            assert best_corrections(mesh, EVERYWHERE, x, same, sigma, sigma**2) is NONE
            more = 1.5 * sigma  # what is left of the noise would be shape
            assert best_corrections(mesh, EVERYWHERE, x, same, 0.5 * sigma, more**2).size > 0

    def test_more_than_there_is_to_gain_is_none(self):
        """Where the error is said to be small, corrections that are larger cannot be right."""
        mesh, x, changed, sigma = trial(ROUGH, 0.1)  # little noise: fitting it costs little
        size = best_corrections(mesh, EVERYWHERE, x, changed, sigma, 9 * sigma**2).size
        enough = 1.01 * size**2
        assert best_corrections(mesh, EVERYWHERE, x, changed, sigma, enough).size == size
        assert best_corrections(mesh, EVERYWHERE, x, changed, sigma, 0.98 * enough) is NONE

    @pytest.mark.parametrize("unit", [2.0**-40, 2.0**40])
    def test_the_unit_does_not_matter(self, unit):
        mesh, x, changed, sigma = trial(ROUGH, 0.3)
        found = best_corrections(mesh, EVERYWHERE, x, changed, sigma, sigma**2)
        changed = [(unit * c, unit * moved) for c, moved in changed]
        scaled = mesh.with_vertices(unit * mesh.vertices)
        again = best_corrections(
            scaled, EVERYWHERE, unit * x, changed, unit * sigma, (unit * sigma) ** 2
        )
        assert np.array_equal(again.weights, found.weights)
        assert np.array_equal(again.of(scaled, unit * x), unit * found.of(mesh, x))

    def test_the_numbering_matters_up_to_rounding(self):
        mesh, x, changed, sigma = trial(ROUGH, 0.3)
        found = best_corrections(mesh, EVERYWHERE, x, changed, sigma, sigma**2)
        order = np.random.default_rng(5).permutation(len(x))
        place = np.argsort(order)
        other = Mesh(mesh.vertices[order] + 3, place[mesh.faces])
        changed = [(c[order], moved[order] + 3) for c, moved in changed]
        again = best_corrections(other, EVERYWHERE, x[order] + 3, changed, sigma, sigma**2)
        moved = again.of(other, x[order] + 3) - 3
        assert np.allclose(moved, found.of(mesh, x)[order], atol=1e-6 * sigma)


class TestDenoise:
    def test_what_is_mixed_is_corrected(self, monkeypatch):
        """The corrections are chosen for the end of the mixtures, there and on changed copies."""
        given = []
        weights = np.random.default_rng(0).normal(0, 0.1, TERMS)

        def best(mesh, core, x, changed, sigma, risk):
            given.append((mesh, core, x, changed, sigma, risk))
            return Corrections(0.5, weights, 0.125)

        monkeypatch.setattr(choice, "best_corrections", best)
        mesh, _ = noisy(shapes.blob(500), 0.2)
        blind = blind_choice(mesh, None, 40_000)
        found, chosen, bench = blind.noise, blind.choice, blind.bench
        ((same, core, x, changed, sigma, risk),) = given
        assert same is mesh
        assert core.all()
        assert (sigma, risk) == (chosen.sigma, chosen.risk)
        plain = replace(chosen, corrections=NONE)
        least = 0.02 * sigma  # filters of hardly any weight are left out where they are applied
        assert np.allclose(x, choice.apply(mesh, bench, plain), atol=least)
        for change, moved in changed:
            other = mesh.with_vertices(mesh.vertices + change)
            assert np.sqrt((change**2).sum(axis=1).mean()) == pytest.approx(0.3 * sigma, rel=0.05)
            assert np.allclose(moved, choice.apply(other, bench.moved(other), plain), atol=least)
            assert not np.allclose(moved, x, atol=4 * least)
        corrected = choice.apply(mesh, bench, chosen)
        before = choice.apply(mesh, bench, plain)
        assert np.array_equal(corrected, chosen.corrections.of(mesh, before))
        done = denoise(mesh)
        end = faired(mesh.with_vertices(corrected), chosen.risk**0.5)
        assert np.array_equal(done.mesh.vertices, end)
        assert done.corrected == done.parts[0].corrected == 0.125
        assert not found.warnings

    def test_what_was_made_even_beside_creases_is_not(self, monkeypatch):
        """They may be nearer the truth, but faces that were flat would be bent."""
        tried = []

        def best(mesh, *_):
            tried.append(mesh)
            return NONE

        monkeypatch.setattr(choice, "best_corrections", best)
        for truth, expected in ((shapes.cube(12), 0), (shapes.blob(500), 1)):
            denoise(noisy(truth, 0.2)[0])
            assert len(tried) == expected

    def test_smooth_shapes_are_not(self):
        mesh, _ = noisy(shapes.icosphere(3), 0.3)
        assert denoise(mesh).corrected == 0


@pytest.mark.heavy
@pytest.mark.meshes
def test_the_folds_of_a_cortex_are_nearer_the_truth():
    if not FOLDER:
        pytest.skip("BELTRAMI_MESHES names no folder of meshes")
    truth = read_mesh(Path(FOLDER) / "pial_left.gii.gz")
    mesh, _ = noisy(truth, 0.3)
    blind = blind_choice(mesh, None, 40_000)
    chosen, bench = blind.choice, blind.bench
    plain = choice.apply(mesh, bench, replace(chosen, corrections=NONE))
    corrected = choice.apply(mesh, bench, chosen)
    assert rms(corrected, truth) < 0.97 * rms(plain, truth)
