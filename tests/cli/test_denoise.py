import numpy as np
import pytest

from beltrami.diffusion.denoise import denoise
from beltrami.diffusion.denoise_function import denoise_function
from beltrami.io.registry import read_mesh, write_mesh
from beltrami.mesh.mesh import Mesh
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


def test_the_report_compares_the_angles_of_faces(beltrami, tmp_path):
    """Two thirds of the edges of a triangulated cube bend by 90 degrees."""
    cube = Mesh(
        [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)],
        [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
         [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]],
    )  # fmt: skip
    write_mesh(tmp_path / "cube.ply", cube)
    words = ("--noise", 0, "-o", tmp_path / "same.ply")
    done = beltrami("denoise", tmp_path / "cube.ply", *words)
    assert done.exit_code == 0, done.stderr
    assert "mean angle of neighbouring faces: 60.0° before, 60.0° now" in done.stdout
    assert np.array_equal(read_mesh(tmp_path / "same.ply").vertices, cube.vertices)


def test_parts_are_told(beltrami, tmp_path):
    sphere = icosphere(4)
    noise = np.random.default_rng(0).normal(0, 0.01, sphere.n_vertices)
    one = sphere.vertices * (1 + noise)[:, None]
    both = Mesh(
        np.concatenate([one, one + 3]),
        np.concatenate([sphere.faces, sphere.faces + sphere.n_vertices]),
    )
    write_mesh(tmp_path / "two.ply", both)
    words = ("--method", "linear", "-o", tmp_path / "clean.ply")
    done = beltrami("denoise", tmp_path / "two.ply", *words)
    assert done.exit_code == 0, done.stderr
    assert "part 0, 2562 vertices:" in done.stdout
    assert "part 1, 2562 vertices:" in done.stdout
    assert done.stdout.count("noise: 0.0") == 2


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
    found = denoise(read_mesh(noisy))
    assert len(found.spikes)
    done = beltrami("denoise", noisy, "-o", tmp_path / "clean.ply")
    assert done.exit_code == 0
    assert "warning: the rough part has outliers" in done.stderr
    assert f"warning: {len(found.spikes)} vertices were taken for spikes" in done.stderr
    assert f"spikes: {len(found.spikes)} vertices" in done.stdout


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
