"""Denoising: the level of the noise, the risk, and that the choice is a good one."""

import numpy as np
import pytest

from beltrami.diffusion.bends import unlike_noise
from beltrami.diffusion.candidates import EVENING, Bench, OfNormals, along_normals, filtered
from beltrami.diffusion.choice import apply, choose
from beltrami.diffusion.denoise import denoise
from beltrami.diffusion.level import level_beside
from beltrami.diffusion.linear_filters import (
    IN_PARTS,
    LINEAR,
    Linear,
    low_passed,
    rows_by_length,
    rows_by_normals,
)
from beltrami.diffusion.noise import noise_level
from beltrami.diffusion.patches import components_of, part_of, sample_of
from beltrami.diffusion.risk import best_mixture, mixture_risk
from beltrami.diffusion.smooth_mesh import smooth_mesh
from beltrami.errors import (
    BeltramiError,
    DimensionError,
    EmptyMeshError,
    MeshError,
    NonFiniteError,
    NotOrientableError,
    UnknownNameError,
)
from beltrami.mesh import shapes
from beltrami.mesh.mesh import Mesh
from made_once import creature
from strategies import moebius


def noisy(truth, level, seed=0):
    """White noise along the normals, its level in mean edge lengths."""
    sigma = level * truth.edge_lengths.mean()
    noise = np.random.default_rng(seed).normal(0, sigma, truth.n_vertices)
    return truth.with_vertices(truth.vertices + noise[:, None] * truth.vertex_normals), sigma


def rms(mesh, truth):
    return np.sqrt(((mesh.vertices - truth.vertices) ** 2).sum(axis=1).mean())


def angle(mesh, truth):
    cosine = np.einsum("ij,ij->i", mesh.face_normals, truth.face_normals)
    return np.degrees(np.arccos(np.clip(cosine, -1, 1))).mean()


def first_result(mesh, sigma, filters, *, known):
    """What low passes make of the mesh, and how."""
    bench, sample = Bench.of(mesh), sample_of(mesh, 10**6)
    first = choose(
        sample, sigma, bench.normals, filters, known=known, caution=1.15, evening=EVENING
    )

    def low_pass(other):
        return other.with_vertices(apply(other, Bench.of(other), first))

    return low_pass(mesh), low_pass


BLOB = creature(2500)
CUBE = shapes.cube(10)


@pytest.mark.chapter("P42")
@pytest.mark.parametrize("level", [0.1, 0.2, 0.35])
@pytest.mark.parametrize(
    "truth", [BLOB, shapes.cube(20), shapes.torus(60, 30)], ids=["blob", "cube", "torus"]
)
def test_the_level_of_white_noise(truth, level):
    mesh, sigma = noisy(truth, level)
    found = denoise(mesh, "linear").noise
    assert found.sigma == pytest.approx(sigma, rel=0.25)
    assert found.relative == pytest.approx(found.sigma / mesh.edge_lengths.mean())
    assert not found.warnings


def spiked(truth, white):
    """A tenth of the vertices off by a normal variable of one mean edge; also white noise."""
    random = np.random.default_rng(5)
    n = truth.n_vertices
    hit = random.random(n) < 0.1
    noise = truth.edge_lengths.mean() * (
        hit * random.normal(0, 1, n) + white * random.normal(0, 1, n)
    )
    return truth.with_vertices(truth.vertices + noise[:, None] * truth.vertex_normals), hit


def copies(one, count):
    """Return so many copies of a mesh, apart from each other."""
    shift = 3 * np.arange(count)[:, None, None] * [1, 0, 0]
    faces = one.faces + one.n_vertices * np.arange(count)[:, None, None]
    return Mesh((one.vertices + shift).reshape(-1, 3), faces.reshape(-1, 3))


class TestNoiseLevel:
    def level(self, values, mesh=BLOB):
        return noise_level(mesh.topology.adjacency, values)

    def test_against_the_definition(self):
        A = BLOB.topology.adjacency.toarray()
        f = np.random.default_rng(0).normal(size=len(A))
        K = np.eye(len(A)) - A / A.sum(axis=1)[:, None]
        R = np.eye(len(A))
        found = self.level(f)
        for order in range(3):
            R = R @ K
            rough = R @ f / np.linalg.norm(R, axis=1)
            expected = np.median(np.abs(rough)) / 0.6744897501960817
            assert found.by_order[order] == pytest.approx(expected, rel=1e-10)
            if order == 2:
                assert found.sigma == pytest.approx(expected, rel=1e-10)
            if order == 1:
                assert found.spread == pytest.approx(np.sqrt(np.mean(rough**2)), rel=1e-10)
                assert found.kurtosis == pytest.approx(np.mean(rough**4) / np.mean(rough**2) ** 2)

    def test_white_noise_is_white(self):
        for seed in range(5):
            f = 3 * np.random.default_rng(seed).normal(size=BLOB.n_vertices)
            found = self.level(f)
            assert found.sigma == pytest.approx(3, rel=0.06)
            assert not found.warnings
            assert abs(found.correlation) < 0.03
            uniform = np.random.default_rng(seed).uniform(-1, 1, BLOB.n_vertices)
            assert not self.level(uniform).warnings

    def test_spikes_and_smoothed_noise_are_told(self):
        rng = np.random.default_rng(4)
        f = rng.normal(size=BLOB.n_vertices)
        spikes = f * (rng.random(len(f)) < 0.15)
        assert any("outliers" in text for text in self.level(spikes).warnings)
        assert self.level(spikes).spread == pytest.approx(np.sqrt(0.15), rel=0.2)
        assert self.level(spikes).sigma < 0.8 * self.level(spikes).spread
        A = BLOB.topology.adjacency
        smooth = (A @ f) / A.sum(axis=1)
        assert any("not white" in text for text in self.level(smooth).warnings)

    def test_smooth_functions_hardly_count(self):
        f = np.random.default_rng(1).normal(size=BLOB.n_vertices)
        wave = 10 * np.sin(2 * BLOB.vertices[:, 0])
        assert self.level(0.1 * f + wave).sigma == pytest.approx(0.1, rel=0.1)


class TestRisk:
    def test_it_is_unbiased(self):
        """The mean over 1000 noises of the estimate is the mean of the true error."""
        rng = np.random.default_rng(0)
        n, sigma = 60, 0.7
        x = np.linalg.qr(rng.normal(size=(n, n)))[0]
        truth = 3 * x[:, 0] + 2 * x[:, 1]
        filters = [np.eye(n), x[:, :5] @ x[:, :5].T, x[:, :20] @ x[:, :20].T * 0.8]
        weights = np.array([0.2, 0.5, 0.3])
        divergence = np.array([np.trace(H) / n for H in filters])
        risks, errors = [], []
        for _ in range(1000):
            y = truth + rng.normal(0, sigma, n)
            moves = np.stack([H @ y - y for H in filters])
            risks.append(mixture_risk(weights, moves @ moves.T / n, divergence, sigma))
            errors.append(np.mean((y + weights @ moves - truth) ** 2))
        off = np.subtract(risks, errors)
        assert abs(off.mean()) < 3 * off.std() / np.sqrt(1000)
        assert off.std() / np.sqrt(1000) < 0.04 * np.mean(errors)

    @pytest.mark.parametrize("seed", range(5))
    def test_no_other_mixture_is_better(self, seed):
        rng = np.random.default_rng(seed)
        moves = rng.normal(size=(6, 40)) * rng.uniform(0.1, 3, (6, 1))
        gram, divergence = moves @ moves.T / 40, rng.uniform(0, 1, 6)
        best = best_mixture(gram, divergence, 0.8)
        assert best.min() >= 0
        assert best.sum() == pytest.approx(1)

        def cost(w):
            return mixture_risk(w, gram, divergence, 0.8)

        for other in rng.dirichlet(np.full(6, 0.3), 500):
            assert cost(other) >= cost(best) - 1e-6

    def test_candidates_that_do_nothing(self):
        weights = best_mixture(np.zeros((3, 3)), np.ones(3), 1.0)
        assert weights == pytest.approx([1 / 3] * 3)


class TestCandidates:
    def test_a_linear_one_against_the_matrix(self):
        mesh, _ = noisy(shapes.icosphere(2), 0.2)
        A = mesh.topology.adjacency.toarray()
        k, U = np.linalg.eig(np.eye(len(A)) - A / A.sum(axis=1)[:, None])
        bench = Bench.of(mesh)
        for one in (LINEAR[0], LINEAR[4], LINEAR[7], Linear(0.3)):
            gain = 1 / (1 + (k.real.clip(0) / one.cut) ** 10)
            moved = ((U * gain) @ np.linalg.solve(U, mesh.vertices)).real
            expected = along_normals(mesh, moved)
            found = filtered(mesh, bench, [one])[0]
            assert np.allclose(found, expected, atol=3e-3)

    def test_weights_by_length_against_the_matrix(self):
        mesh, _ = noisy(shapes.torus(20, 12), 0.2)
        lengths = mesh.edge_lengths
        W = np.zeros((mesh.n_vertices, mesh.n_vertices))
        W[tuple(mesh.edges.T)] = 1 / lengths
        W += W.T
        k, U = np.linalg.eig(np.eye(len(W)) - W / W.sum(axis=1)[:, None])
        rows = rows_by_length(mesh)
        for cut in (0.5, 0.1):
            gain = 1 / (1 + (k.real.clip(0) / cut) ** 4)
            expected = ((U * gain) @ np.linalg.solve(U, mesh.vertices)).real
            found = low_passed(rows, mesh.vertices, Linear(cut, True))
            assert np.allclose(found, expected, atol=3e-3 * np.ptp(expected))
        flat = Mesh(np.zeros((3, 3)), [[0, 1, 2]])  # no lengths: equal weights
        assert rows_by_length(flat).data.tolist() == [0.5] * 6

    def test_weights_by_normals_against_the_matrix(self):
        mesh, _ = noisy(shapes.cube(4), 0.1)
        normals, lengths = mesh.vertex_normals, mesh.edge_lengths
        i, j = mesh.edges.T
        W = np.zeros((mesh.n_vertices, mesh.n_vertices))
        apart = np.linalg.norm(normals[i] - normals[j], axis=1)
        W[i, j] = np.exp(-(apart**2) / (2 * 0.3**2)) / lengths
        W += W.T
        k, U = np.linalg.eig(np.eye(len(W)) - W / W.sum(axis=1)[:, None])
        gain = 1 / (1 + (k.real.clip(0) / 0.4) ** 6)
        expected = ((U * gain) @ np.linalg.solve(U, mesh.vertices)).real
        one = Linear(0.4, True, 0.3)
        found = low_passed(rows_by_normals(mesh, 0.3), mesh.vertices, one)
        assert np.allclose(found, expected, atol=3e-3 * np.ptp(expected))
        assert not np.allclose(
            low_passed(rows_by_length(mesh), mesh.vertices, one), expected, atol=0.02
        )
        evened = mesh.with_vertices(low_passed(Bench.of(mesh).rows, mesh.vertices, Linear(0.5)))
        moved = low_passed(rows_by_normals(evened, 0.3), mesh.vertices, one)
        assert np.allclose(
            filtered(mesh, Bench.of(mesh), [one])[0], along_normals(mesh, moved), atol=1e-12
        )

    def test_the_weights_are_those_of_the_mesh_that_is_filtered(self):
        """Else the divergence, which changed copies tell, would lack what the noise does there."""
        mesh, sigma = noisy(BLOB, 0.3)
        other = mesh.with_vertices(noisy(mesh, 0.3, seed=1)[0].vertices)
        moved, afresh = Bench.of(mesh, Linear(0.2)).moved(other), Bench.of(other, Linear(0.2))
        one = Linear(0.1, True)
        found, expected = (filtered(other, b, [one])[0] for b in (moved, afresh))
        assert np.array_equal(found, expected)
        assert np.array_equal(moved.normals, afresh.normals)
        anew = Bench.of(mesh, Linear(0.7)).moved(other, Linear(0.2))
        assert anew.evening == Linear(0.2)
        assert np.array_equal(filtered(other, anew, [one])[0], expected)
        kept = filtered(other, Bench.of(mesh, Linear(0.2)), [one])[0]
        assert np.abs(kept - expected).max() > 0.01 * sigma

    def test_those_of_normals_are_the_methods_of_smooth_mesh(self):
        mesh, _ = noisy(CUBE, 0.2)
        bench = Bench.of(mesh)
        wanted = [OfNormals(True, 0.3, 6), OfNormals(False, 0.4, 3), OfNormals(True, 0.3, 3)]
        found = filtered(mesh, bench, wanted)
        for one, x in zip(wanted, found, strict=True):
            method = "guided_normals" if one.guided else "bilateral_normals"
            options = {"contrast": one.contrast, "steps": one.rounds}
            assert np.array_equal(x, smooth_mesh(mesh, method, **options).vertices)

    def test_displacements_along_normals(self):
        sphere = shapes.icosphere(3)
        rng = np.random.default_rng(0)
        moved = sphere.vertices * 1.1 + rng.normal(0, 0.02, sphere.vertices.shape)
        kept = along_normals(sphere, moved)
        normals = sphere.with_vertices(moved).vertex_normals
        way = kept - sphere.vertices
        assert np.allclose(np.cross(way, normals), 0, atol=1e-14)
        assert np.allclose(((moved - kept) * normals).sum(axis=1), 0, atol=1e-14)


def test_samples_are_patches_of_the_mesh():
    sample = sample_of(BLOB, 1600)
    assert 0.6 * 1600 < sample.mesh.n_faces <= 1600
    assert np.array_equal(sample.mesh.vertices, BLOB.vertices[sample.vertices])
    whole = {tuple(face) for face in BLOB.faces.tolist()}
    assert {tuple(face) for face in sample.vertices[sample.mesh.faces].tolist()} <= whole
    assert sample.mesh.topology.n_components <= 8
    sample = sample_of(shapes.icosphere(5), 8000)  # its core has no border of the sample
    assert 0.7 < sample.core.mean() < 0.9
    assert not sample.core[np.unique(sample.mesh.topology.boundary_edges)].any()
    whole = sample_of(BLOB, 10**6)
    assert whole.mesh is BLOB
    assert np.array_equal(whole.vertices, np.arange(BLOB.n_vertices))
    assert whole.core.all()


def test_components_and_their_meshes():
    one, two = shapes.icosphere(2), shapes.icosphere(1)
    n = two.n_vertices
    mesh = Mesh(  # small, large, a stray vertex, and small again
        np.concatenate([two.vertices, one.vertices + 5, [[9, 9, 9]], two.vertices - 5]),
        np.concatenate([two.faces, one.faces + n, two.faces + n + one.n_vertices + 1]),
    )
    large, rest = components_of(mesh, 100, 8)
    assert np.array_equal(large, np.arange(n, n + one.n_vertices))
    assert np.array_equal(np.sort(np.concatenate([large, rest])), np.arange(mesh.n_vertices))
    part = part_of(mesh, large)
    assert np.array_equal(part.faces, one.faces)
    assert np.array_equal(part.vertices, one.vertices + 5)
    assert [len(part) for part in components_of(mesh, 10, 2)] == [one.n_vertices, n, n + 1]
    assert [len(part) for part in components_of(mesh, 1000, 8)] == [mesh.n_vertices]


@pytest.mark.parametrize("level", [0.1, 0.3])
def test_where_the_shape_is_smooth_the_level_is_found_better(level):
    """Sharp low passes leave the same residual for many cuts, and this tells the level."""
    truth = shapes.torus(60, 30)
    meshes = [noisy(truth, level, seed)[0] for seed in range(6)]
    found = [(denoise(mesh, "linear"), rms(mesh, truth)) for mesh in meshes]
    better = np.array([one.sigma / sigma - 1 for one, sigma in found])
    first = np.array([one.noise.sigma / sigma - 1 for one, sigma in found])
    assert np.abs(better).max() < 0.015
    assert np.sqrt(np.mean(better**2)) < 0.75 * np.sqrt(np.mean(first**2))
    assert denoise(meshes[0], "linear", noise=1e-3).sigma == 1e-3
    mesh = noisy(CUBE, level)[0]
    detailed = denoise(mesh, "linear")
    clean, low_pass = first_result(mesh, detailed.noise.sigma, LINEAR, known=False)
    beside = level_beside(mesh, clean, low_pass)
    unlike = unlike_noise(mesh, clean, lambda white: beside * white)
    if level == 0.1:  # which may be shape in part
        assert beside / max(unlike, 1) < detailed.sigma < beside
    else:
        assert detailed.sigma == beside
    assert detailed.sigma == pytest.approx(rms(mesh, CUBE), rel=0.1)


@pytest.mark.chapter("P43")
@pytest.mark.parametrize("level", [0.1, 0.3])
def test_the_blind_choice_is_near_the_best_of_linear_filters_and_of_sweeps(level):
    mesh, _ = noisy(BLOB, level, seed=3)
    found = denoise(mesh)
    bench = Bench.of(mesh)
    best = min(rms(mesh.with_vertices(x), BLOB) for x in filtered(mesh, bench, LINEAR))
    assert rms(found.mesh, BLOB) < 1.1 * best
    taubin = [smooth_mesh(mesh, "taubin", steps=k) for k in (1, 2, 4, 8, 16, 32, 64)]
    assert rms(found.mesh, BLOB) < 0.95 * min(rms(one, BLOB) for one in taubin)
    assert found.predicted_error == pytest.approx(rms(found.mesh, BLOB), rel=0.3)
    assert not found.warnings
    assert found.volume_change == pytest.approx(found.mesh.volume / mesh.volume - 1, abs=1e-15)


def test_normals_of_smooth_shapes_are_as_even_as_by_the_best_averaging():
    """Averages even out the normals and shrink; here nothing shrinks, and the normals are as good.

    With mixtures chosen for σ as it is, or a second one for less than its chance, the angle is
    two to four times as large.
    """
    sphere = shapes.icosphere(4)
    truth = sphere.with_vertices(sphere.vertices * [1, 1.7, 0.6])
    mesh, _ = noisy(truth, 0.2, seed=2)
    found = denoise(mesh)
    swept = [smooth_mesh(mesh, steps=k) for k in (5, 10, 20, 40, 80)]
    assert angle(found.mesh, truth) < 1.1 * min(angle(one, truth) for one in swept)
    assert rms(found.mesh, truth) < 0.25 * min(rms(one, truth) for one in swept)
    assert all("linear" in name for name, _ in found.mixture)
    assert {name for name, _ in found.second} <= {"as it is", "along normals"}


@pytest.mark.chapter("P45")
def test_creases_are_kept_where_linear_filters_round_them():
    mesh, _ = noisy(CUBE, 0.25, seed=1)
    found, linear = denoise(mesh), denoise(mesh, "linear")
    assert angle(found.mesh, CUBE) < 0.5 * angle(linear.mesh, CUBE)
    assert rms(found.mesh, CUBE) < 0.7 * rms(linear.mesh, CUBE)
    assert any("normals" in name for name, _ in found.mixture)
    assert all(name.startswith("linear") for name, _ in linear.mixture)


@pytest.mark.chapter("P15")
def test_the_same_mesh_gives_the_same_bits_and_the_unit_does_not_matter():
    mesh, sigma = noisy(shapes.blob(500), 0.2)
    found, again = denoise(mesh), denoise(mesh)
    assert np.array_equal(found.mesh.vertices, again.mesh.vertices)
    for unit in (1e-6, 1e6):
        scaled = denoise(mesh.with_vertices(unit * mesh.vertices))
        assert np.allclose(scaled.mesh.vertices / unit, found.mesh.vertices, atol=1e-3 * sigma)
        assert scaled.sigma == pytest.approx(unit * found.sigma)


def test_ridges_are_kept_by_low_passes_that_look_at_normals():
    mesh, _ = noisy(BLOB, 0.1)
    bench = Bench.of(mesh)
    alike, in_parts = (
        min(rms(mesh.with_vertices(x), BLOB) for x in filtered(mesh, bench, filters))
        for filters in (LINEAR, IN_PARTS)
    )
    assert in_parts < 0.93 * alike
    found = denoise(mesh)
    assert rms(found.mesh, BLOB) < in_parts
    assert sum(weight for name, weight in found.mixture if "by normals" in name) > 0.2


class TestNoiseOfOtherKinds:
    def test_noise_that_is_strong_beside_long_thin_faces(self):
        """It folds them, so that no filter of normals knows the shape: low passes do."""
        flat = shapes.grid(100, 20, dimension=3)
        x, y, _ = flat.vertices.T
        truth = flat.with_vertices(np.stack([x, 2 * y, np.sin(3 * x) / 3], axis=1))
        mesh, _ = noisy(truth, 0.3)
        found = denoise(mesh)
        assert any("strong beside the faces" in text for text in found.warnings)
        assert angle(found.mesh, truth) < 7
        assert rms(found.mesh, truth) < 0.3 * rms(mesh, truth)
        mesh, _ = noisy(truth, 0.1)
        assert not denoise(mesh).warnings

    def test_its_level_is_measured_beside_creases_too(self):
        """Plain differences are off by a twelfth here: thin faces and folds spoil the normals."""
        flat = shapes.grid(100, 20, dimension=3)
        x, y, _ = flat.vertices.T
        folds = 0.1 * np.abs((8 * x) % 2 - 1)
        truth = flat.with_vertices(np.stack([x, 2.5 * y, folds], axis=1))
        mesh, sigma = noisy(truth, 0.3)
        found = denoise(mesh)
        assert any("strong beside the faces" in text for text in found.warnings)
        assert found.sigma == pytest.approx(sigma, rel=0.04)

    @pytest.mark.parametrize("white", [0.0, 0.15])
    def test_spikes_are_missing_data(self, white):
        """They leave half of what the best linear filter leaves, and less."""
        mesh, hit = spiked(BLOB, white)
        found = denoise(mesh)
        assert any("outliers" in text for text in found.warnings)
        assert any(text.startswith(f"{len(found.spikes)} vertices were") for text in found.warnings)
        assert hit[found.spikes].mean() > 0.85
        bench = Bench.of(mesh)
        best = min(rms(mesh.with_vertices(x), BLOB) for x in filtered(mesh, bench, LINEAR))
        assert rms(found.mesh, BLOB) < (0.4 if white == 0 else 0.75) * best
        assert found.predicted_error == pytest.approx(rms(found.mesh, BLOB), rel=0.6)
        if white:
            sigma = white * BLOB.edge_lengths.mean()
            assert found.sigma == pytest.approx(sigma, rel=0.2)

    @pytest.mark.parametrize("white", [0.15, 0.2])
    def test_spikes_come_down_in_their_place_and_not_beside(self, white):
        """Along normals with noise they are off by a fifth of their height."""
        truth = shapes.icosphere(4)
        mesh, _ = spiked(truth, white)
        found = denoise(mesh)
        x, n = found.mesh.vertices, truth.vertices
        beside = np.linalg.norm(x - np.einsum("ij,ij->i", x, n)[:, None] * n, axis=1)
        assert np.sqrt((beside[found.spikes] ** 2).mean()) < 0.06 * truth.edge_lengths.mean()

    def test_spikes_that_cannot_be_told_are_filtered_safely(self):
        """In ``"linear"``, or if a level is told, none are looked for."""
        mesh, _ = spiked(BLOB, 0.0)
        found = denoise(mesh, "linear")
        assert not len(found.spikes)
        assert any("outliers" in text for text in found.warnings)
        clean, _ = first_result(mesh, found.noise.spread, LINEAR, known=True)
        A = mesh.topology.adjacency
        assert found.sigma == noise_level(A, mesh.vertices, None, clean.vertex_normals).spread
        bench = Bench.of(mesh)
        best = min(rms(mesh.with_vertices(x), BLOB) for x in filtered(mesh, bench, LINEAR))
        assert rms(found.mesh, BLOB) < 1.1 * best
        # with the level of the median it would smooth far too little
        told = denoise(mesh, "linear", noise=found.noise.sigma)
        assert rms(told.mesh, BLOB) > 1.15 * best
        assert not len(denoise(mesh, noise=found.sigma).spikes)

    def test_spikes_have_the_numbers_of_the_whole_mesh(self):
        truth = shapes.icosphere(4)
        n = truth.n_vertices
        white, (rough, hit) = noisy(truth, 0.1)[0], spiked(truth, 0.0)
        found = denoise(
            Mesh(
                np.concatenate([white.vertices, rough.vertices + 9]),
                np.concatenate([truth.faces, truth.faces + n]),
            )
        )
        assert [len(part.spikes) > 0 for part in found.parts] == [False, True]
        assert np.array_equal(found.spikes, found.parts[1].spikes)
        assert hit[found.spikes - n].all()
        assert len(found.spikes) > 0.9 * hit.sum()
        part = Mesh(found.mesh.vertices[n:] - 9, truth.faces)
        assert rms(part, truth) < 0.02 * truth.edge_lengths.mean()

    @pytest.mark.parametrize("truth", [CUBE, shapes.cube(24), BLOB], ids=["cube", "finer", "blob"])
    def test_where_there_are_none_nothing_changes(self, truth, monkeypatch):
        for mesh in (truth, noisy(truth, 0.1)[0]):
            found = denoise(mesh)
            assert not len(found.spikes)
            assert not any("taken for spikes" in text for text in found.warnings)
            monkeypatch.setattr("beltrami.diffusion.blind.find_spikes", lambda mesh: None)
            assert np.array_equal(found.mesh.vertices, denoise(mesh).mesh.vertices)

    def test_strong_noise_is_said(self):
        mesh, _ = noisy(BLOB, 0.7)
        found = denoise(mesh)
        assert any("very strong" in text for text in found.warnings)
        assert rms(found.mesh, BLOB) < 0.5 * rms(mesh, BLOB)

    def test_strong_noise_on_a_smooth_shape_is_almost_as_by_the_best_linear_filter(self):
        """Without the greater caution it is more than twice as far."""
        truth = shapes.icosphere(4)
        mesh, _ = noisy(truth.with_vertices(truth.vertices * [1, 1.7, 0.6]), 0.7)
        truth = truth.with_vertices(truth.vertices * [1, 1.7, 0.6])
        found = denoise(mesh)
        bench = Bench.of(mesh)
        best = min(rms(mesh.with_vertices(x), truth) for x in filtered(mesh, bench, LINEAR))
        assert rms(found.mesh, truth) < 1.2 * best

    def test_strong_noise_on_a_sphere_leaves_less_than_the_best_linear_filter(self):
        truth = shapes.icosphere(5)
        mesh, _ = noisy(truth, 0.7)
        bench = Bench.of(mesh)
        best = min(rms(mesh.with_vertices(x), truth) for x in filtered(mesh, bench, LINEAR[8:16]))
        assert rms(denoise(mesh).mesh, truth) < best

    @pytest.mark.parametrize("level", [0.3, 0.7])
    def test_the_estimate_is_along_the_normals_of_what_low_passes_leave(self, level):
        """Along those of the evened mesh it is up to twice as far as the best, and 1.5 times."""
        truth = shapes.torus(60, 30)
        for seed in range(3):
            mesh, _ = noisy(truth, level, seed)
            bench = Bench.of(mesh)
            best = min(rms(mesh.with_vertices(x), truth) for x in filtered(mesh, bench, LINEAR))
            assert rms(denoise(mesh).mesh, truth) < 1.2 * best

    def test_a_known_level_is_taken(self):
        mesh, sigma = noisy(BLOB, 0.2)
        assert denoise(mesh, "linear", noise=sigma).sigma == sigma
        more = denoise(mesh, "linear", noise=2 * sigma)
        assert rms(more.mesh, mesh) > rms(denoise(mesh, "linear").mesh, mesh)

    def test_no_noise_is_no_change(self):
        plane = shapes.grid(8, 8)
        x = np.column_stack([plane.vertices[:, :2], np.zeros(plane.n_vertices)])
        found = denoise(Mesh(x, plane.faces))
        assert np.allclose(found.mesh.vertices, x, atol=1e-12)
        assert np.isnan(found.volume_change)  # of an open mesh, also where nothing is done
        assert denoise(found.mesh, noise=0.0).mesh is found.mesh
        assert denoise(BLOB, "linear", noise=0.0).mesh.vertices == pytest.approx(
            BLOB.vertices, abs=1e-9
        )


class TestScans:
    def test_open_meshes_keep_their_boundary_in_place(self):
        plane = shapes.grid(40, 40)
        x, y = plane.vertices[:, :2].T
        truth = Mesh(np.stack([x, y, 0.2 * np.sin(5 * x) * y], axis=1), plane.faces)
        mesh, _ = noisy(truth, 0.25)
        found = denoise(mesh)
        assert np.isnan(found.volume_change)
        assert rms(found.mesh, truth) < 0.45 * rms(mesh, truth)
        rim = np.unique(truth.topology.boundary_edges)
        drift = found.mesh.vertices[rim] - truth.vertices[rim]
        assert np.abs(drift.mean(axis=0)).max() < 0.05 * truth.edge_lengths.mean()
        plain = smooth_mesh(mesh, steps=5).vertices[rim] - truth.vertices[rim]
        assert np.linalg.norm(drift, axis=1).mean() < 0.3 * np.linalg.norm(plain, axis=1).mean()

    def test_each_component_has_its_own_noise(self):
        truth = shapes.icosphere(4)
        rough, sigma = noisy(truth, 0.3)
        fine, small = noisy(truth, 0.05, seed=1)
        n = truth.n_vertices
        two = Mesh(
            np.concatenate([fine.vertices, rough.vertices + 9]),
            np.concatenate([truth.faces, truth.faces + n]),
        )
        found = denoise(two, "linear")
        assert [part.sigma for part in found.parts] == pytest.approx([small, sigma], rel=0.1)
        for part, one, shift in zip(found.parts, (fine, rough), (0, 9), strict=True):
            alone = denoise(one, "linear")
            moved = found.mesh.vertices[part.vertices] - shift
            assert np.allclose(moved, alone.mesh.vertices, atol=1e-9)
            assert [name for name, _ in part.mixture] == [name for name, _ in alone.mixture]
            assert part.predicted_error == pytest.approx(alone.predicted_error, rel=1e-6)
        square = np.mean([part.predicted_error**2 for part in found.parts])
        assert found.predicted_error == pytest.approx(np.sqrt(square))

    def test_warnings_name_the_component(self):
        truth = shapes.icosphere(4)
        n = truth.n_vertices
        white, strong = noisy(truth, 0.2)[0], noisy(truth, 0.7)[0]
        found = denoise(
            Mesh(
                np.concatenate([white.vertices, strong.vertices + 9]),
                np.concatenate([truth.faces, truth.faces + n]),
            ),
            "linear",
        )
        assert len(found.warnings) == 1
        assert found.warnings[0].startswith(f"part 1, {n} vertices: the noise is very strong")

    def test_small_components_strays_and_several_faces_on_an_edge(self):
        truth = shapes.icosphere(3)
        one, _ = noisy(truth, 0.2)
        n = one.n_vertices
        two = Mesh(  # and a leaf, and a vertex of no face
            np.concatenate([one.vertices, one.vertices + 9, [[50.0, 0, 0]], [[0, 0, 7.0]]]),
            np.concatenate([one.faces, one.faces + n, [[*one.edges[7], 2 * n + 1]]]),
        )
        found = denoise(two)
        assert len(found.parts) == 1
        assert np.array_equal(found.mesh.vertices[2 * n], two.vertices[2 * n])
        for part in (found.mesh.vertices[:n], found.mesh.vertices[n : 2 * n] - 9):
            assert rms(truth.with_vertices(part), truth) < 0.6 * rms(one, truth)

    @pytest.mark.parametrize("rings", [0, 1, 2])
    @pytest.mark.parametrize("count", [1, 5, 60])
    def test_many_small_shapes_do_not_shrink(self, rings, count):
        one = shapes.icosphere(rings)
        mesh = copies(one, count)
        found = denoise(mesh)
        assert found.volume_change == pytest.approx(0, abs=0.005)
        assert rms(found.mesh, mesh) < 0.02
        assert not any("white" in text for text in found.warnings)  # shapes are not its colour

    def test_shapes_of_few_vertices_are_left_as_they_are_and_it_says_so(self):
        sphere, cube = noisy(shapes.icosphere(3), 0.2)[0], shapes.cube()
        n = sphere.n_vertices
        mesh = Mesh(
            np.concatenate([cube.vertices + 9, sphere.vertices, cube.vertices - 9]),
            np.concatenate([cube.faces, sphere.faces + 8, cube.faces + 8 + n]),
        )
        found = denoise(mesh)
        large, tiny = found.parts
        assert large.vertices.tolist() == list(range(8, 8 + n))
        assert (tiny.sigma, tiny.mixture, tiny.second) == (0, (), ())
        assert np.array_equal(found.mesh.vertices[tiny.vertices], mesh.vertices[tiny.vertices])
        assert rms(found.mesh, mesh) > 0.001
        assert found.warnings[0].startswith("part 1, 16 vertices: components of less than 40")
        assert denoise(cube).mesh is cube
        assert denoise(cube, noise=0.05).sigma == 0.05  # who knows the noise is believed

    @pytest.mark.parametrize("faces", [1, 4])
    def test_few_faces(self, faces):
        mesh = Mesh(np.eye(4, 3) + 1, [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]][:faces])
        assert np.isfinite(denoise(mesh).mesh.vertices).all()

    def test_a_closed_mesh_without_a_volume(self):
        for x in (np.eye(3), np.eye(3) * [1, 1, 0]):
            assert np.isnan(denoise(Mesh(x, [[0, 1, 2], [0, 2, 1]])).volume_change)

    def test_what_is_refused(self):
        with pytest.raises(UnknownNameError):
            denoise(BLOB, "best")
        for noise in (-1.0, np.nan, np.inf):
            with pytest.raises(BeltramiError, match="noise must be"):
                denoise(BLOB, noise=noise)
        with pytest.raises(EmptyMeshError):
            denoise(Mesh(np.zeros((3, 3)), np.zeros((0, 3), int)))
        with pytest.raises(DimensionError):
            denoise(Mesh(np.eye(3, 2), [[0, 1, 2]]))
        x = BLOB.vertices.copy()
        x[3] = np.inf
        with pytest.raises(NonFiniteError):
            denoise(BLOB.with_vertices(x))
        faces = BLOB.faces.copy()
        faces[5] = faces[5, ::-1]
        with pytest.raises(MeshError, match=r"orient=True"):
            denoise(Mesh(BLOB.vertices, faces))


def test_progress_is_told():
    told = []
    denoise(noisy(shapes.icosphere(2), 0.2)[0], progress=lambda done, total: told.append(done))
    assert told == [1, 2]


@pytest.mark.parametrize("noise", [1e3, 1e12, 1e100])
def test_noise_that_is_larger_than_the_mesh_is_a_number_too(noise):
    found = denoise(shapes.icosphere(1), noise=noise)
    assert np.isfinite(found.mesh.vertices).all()
    weights = best_mixture(np.diag([0.0, 1e-24]), np.array([1.0, 0.5]), noise)
    assert weights == pytest.approx([0, 1])  # the one that keeps less of the noise


def test_a_surface_with_one_side_is_told_what_will_do():
    """No repair turns its faces; averages need no normals."""
    strip = Mesh(*moebius(np.random.default_rng(5), 9))
    with pytest.raises(NotOrientableError, match=r"one side.*\"averaging\"") as caught:
        denoise(strip)
    assert "repair(" not in str(caught.value)
    smooth_mesh(strip, "averaging")
