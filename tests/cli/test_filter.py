import numpy as np
import pytest

import beltrami as bt
from beltrami.io.registry import read_mesh
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.filtering import filter as filter_function
from beltrami.spectrum.kernels import BandPass, Heat, HighPass, LowPass, Tikhonov, Wave


@pytest.fixture
def data(sphere, tmp_path):
    path = tmp_path / "f.npy"
    np.save(path, np.random.default_rng(0).normal(size=read_mesh(sphere).n_vertices))
    return path


@pytest.mark.parametrize(
    ("options", "kernel"),
    [
        (("heat", "--time", 0.1), Heat(0.1)),
        (("wave", "--time", 0.1), Wave(0.1)),
        (("tikhonov", "--time", 0.1), Tikhonov(0.1)),
        (("lowpass", "--cutoff", 20), LowPass(20, 10)),
        (("lowpass", "--cutoff", 20, "--width", 5), LowPass(20, 5)),
        (("highpass", "--cutoff", 20), HighPass(20, 10)),
        (("bandpass", "--band", 5, 20), BandPass(5, 20, 7.5)),
    ],
)
def test_each_kernel(beltrami, sphere, data, tmp_path, options, kernel):
    output = tmp_path / "g.npy"
    done = beltrami("filter", sphere, "--data", data, "--kernel", *options, "-o", output)
    assert done.exit_code == 0, done.stderr
    expected = filter_function(laplacian(read_mesh(sphere)), np.load(data), kernel)
    np.testing.assert_array_equal(np.load(output), expected)
    assert repr(kernel)[:12] in done.stdout
    assert "eigenvalues between 0 and" in done.stdout


def test_an_ideal_filter_names_its_remedies_and_lanczos_does_it(beltrami, sphere, data, tmp_path):
    output = tmp_path / "g.ply"
    ideal = ("--kernel", "lowpass", "--cutoff", 15, "--width", 0, "--weights", "combinatorial")
    arguments = ("filter", sphere, "--data", data, *ideal, "--mass", "voronoi", "-o", output)
    done = beltrami(*arguments)
    assert done.exit_code == 1
    assert "jumps at λ = 15" in done.stderr
    assert "--method exact" in done.stderr
    for method in ("lanczos", "exact"):
        assert beltrami(*arguments, "--method", method).exit_code == 0
        pair = laplacian(read_mesh(sphere), "combinatorial", "voronoi")
        exact = bt.fourier_basis(pair, pair.n).filter(np.load(data), LowPass(15.0))
        np.testing.assert_allclose(read_mesh(output).vertex_data["f"], exact, atol=1e-5)


def test_without_data_the_mesh_is_filtered(beltrami, sphere, tmp_path):
    output = tmp_path / "smooth.ply"
    done = beltrami("filter", sphere, "--kernel", "heat", "--time", 0.05, "-o", output)
    assert done.exit_code == 0, done.stderr
    mesh = read_mesh(sphere)
    expected = filter_function(laplacian(mesh), mesh.vertices, Heat(0.05))
    np.testing.assert_allclose(read_mesh(output).vertices, expected, atol=1e-6)
    assert np.linalg.norm(read_mesh(output).vertices, axis=1).max() < 0.95  # it shrinks


@pytest.mark.parametrize(
    ("options", "code", "text"),
    [
        (("heat",), 2, "needs --time"),
        (("lowpass", "--time", 1), 2, "needs --cutoff"),
        (("bandpass", "--cutoff", 1), 2, "needs --band"),
        (("heat", "--time", 1, "--cutoff", 3), 2, "no use for --cutoff"),
        (("heat", "--time", 1, "--width", 3), 2, "no use for --width"),
        (("bandpass", "--band", 3, 1), 1, "low < high"),
        (("het", "--time", 1), 1, "Did you mean 'heat'?"),
        (("heat", "--time", -1), 1, "time of heat"),
        (("heat", "--time", 1, "--tolerance", 0), 1, "tolerance"),
        (("heat", "--time", 1, "--method", "lanzcos"), 1, "Did you mean 'lanczos'?"),
    ],
)
def test_options_that_do_not_fit(beltrami, sphere, data, tmp_path, options, code, text):
    done = beltrami(
        "filter", sphere, "--data", data, "-o", tmp_path / "g.npy", "--kernel", *options
    )
    assert done.exit_code == code
    assert text in done.stderr
    assert not (tmp_path / "g.npy").exists()


def test_a_bad_output_is_told_before_the_work(beltrami, sphere, data, tmp_path):
    arguments = ("filter", sphere, "--kernel", "heat", "--time", 1)
    done = beltrami(*arguments, "--data", data, "-o", tmp_path / "g.obj")
    assert done.exit_code == 1
    assert "format for values" in done.stderr


def test_by_modes_of_a_file(beltrami, sphere, data, tmp_path):
    """A polynomial cannot cut low on a fine mesh, whose largest eigenvalues are far away."""
    modes, output = tmp_path / "modes.npz", tmp_path / "g.npy"
    assert beltrami("spectrum", sphere, "-k", 60, "-o", modes).exit_code == 0
    cut = ("filter", sphere, "--data", data, "--kernel", "lowpass", "-o", output, "--basis", modes)
    done = beltrami(*cut, "--cutoff", 20)
    assert done.exit_code == 0, done.stderr
    pair = laplacian(read_mesh(sphere))
    every = bt.fourier_basis(pair, pair.n)
    exact = every.filter(np.load(data), LowPass(20, 10))
    np.testing.assert_allclose(np.load(output), exact, atol=1e-5)
    output.unlink()
    beyond = beltrami(*cut, "--cutoff", 60)
    assert beyond.exit_code == 1
    assert "of the 60 modes" in beyond.stderr
    assert "Take more modes" in beyond.stderr
    assert beltrami(*cut, "--cutoff", 20, "--method", "lanczos").exit_code == 2
    beltrami("spectrum", sphere, "-k", 9, "--near", 12, "-o", modes)
    elsewhere = beltrami(*cut, "--cutoff", 20)
    assert elsewhere.exit_code == 1
    assert "a filter needs all from 0" in elsewhere.stderr
    assert not output.exists()


def test_all_modes_of_a_file_will_do_for_any_kernel(beltrami, sphere, data, tmp_path):
    modes, output = tmp_path / "modes.npz", tmp_path / "g.npy"
    pair = laplacian(read_mesh(sphere))
    bt.fourier_basis(pair, pair.n).save(modes)
    options = ("--kernel", "highpass", "--cutoff", 20, "--basis", modes)
    done = beltrami("filter", sphere, "--data", data, *options, "-o", output)
    assert done.exit_code == 0, done.stderr
    expected = filter_function(pair, np.load(data), HighPass(20, 10), "exact")
    np.testing.assert_allclose(np.load(output), expected, atol=1e-6)
