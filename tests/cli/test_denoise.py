import numpy as np
import pytest

from beltrami.diffusion.denoise import denoise
from beltrami.diffusion.denoise_function import denoise_function
from beltrami.io.registry import read_mesh, write_mesh
from beltrami.mesh.shapes import icosphere
from beltrami.operators.laplacian import laplacian


@pytest.fixture
def noisy(tmp_path):
    sphere = icosphere(3)
    noise = np.random.default_rng(0).normal(0, 0.02, sphere.n_vertices)
    path = tmp_path / "noisy.ply"
    write_mesh(path, sphere.with_vertices(sphere.vertices * (1 + noise)[:, None]))
    return path


@pytest.mark.parametrize("words", [(), ("--method", "linear"), ("--noise", 0.03)])
def test_it_writes_what_denoise_returns_and_reports(beltrami, noisy, tmp_path, words):
    done = beltrami("denoise", noisy, "-o", tmp_path / "clean.ply", *words)
    assert done.exit_code == 0, done.stderr
    options = dict(zip([word[2:] for word in map(str, words[::2])], words[1::2], strict=True))
    found = denoise(read_mesh(noisy), **options)
    np.testing.assert_array_equal(read_mesh(tmp_path / "clean.ply").vertices, found.mesh.vertices)
    assert f"noise: {found.sigma:.4g} along the normals" in done.stdout
    assert found.mixture[0][0] in done.stdout
    assert f"error expected: {found.predicted_error:.3g}" in done.stdout
    assert f"volume: {100 * found.volume_change:+.3f} %" in done.stdout


def test_a_function(beltrami, noisy, tmp_path):
    mesh = read_mesh(noisy)
    f = mesh.vertices[:, 0] + np.random.default_rng(1).normal(0, 0.2, mesh.n_vertices)
    np.save(tmp_path / "f.npy", f)
    words = ("--data", tmp_path / "f.npy", "--weights", "combinatorial", "-o", tmp_path / "g.npy")
    done = beltrami("denoise", noisy, *words)
    assert done.exit_code == 0, done.stderr
    found = denoise_function(laplacian(mesh, "combinatorial"), f)
    np.testing.assert_array_equal(np.load(tmp_path / "g.npy"), found.values)
    assert f"column 0: noise {found.sigma[0]:.4g}" in done.stdout


def test_warnings_go_to_the_error_stream(beltrami, noisy, tmp_path):
    mesh = read_mesh(noisy)
    rng = np.random.default_rng(2)
    spikes = 1 + 0.2 * (rng.random(mesh.n_vertices) < 0.1) * rng.normal(size=mesh.n_vertices)
    write_mesh(noisy, mesh.with_vertices(mesh.vertices * spikes[:, None]))
    done = beltrami("denoise", noisy, "-o", tmp_path / "clean.ply")
    assert done.exit_code == 0
    assert "warning: the rough part has outliers" in done.stderr


@pytest.mark.parametrize(
    ("words", "code", "text"),
    [
        (("--method", "beast"), 1, "method of denoising"),
        (("--noise", -1), 1, "noise must be"),
        (("--weights", "cotangent"), 2, "--data"),
        (("--data", "f.npy", "--method", "linear"), 2, "--method"),
    ],
)
def test_options_that_do_not_fit(beltrami, noisy, tmp_path, words, code, text):
    done = beltrami("denoise", noisy, "-o", tmp_path / "clean.ply", *words)
    assert done.exit_code == code
    assert text in done.stderr
