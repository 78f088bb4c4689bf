import numpy as np
import pytest

from beltrami.diffusion.regularize import regularize
from beltrami.io.registry import read_mesh
from beltrami.operators.laplacian import laplacian


@pytest.fixture
def noisy(sphere, tmp_path):
    path = tmp_path / "f.npy"
    np.save(path, np.random.default_rng(5).normal(size=162))
    return path


@pytest.mark.parametrize("form", ["mass", "identity", "normalized"])
def test_each_form(beltrami, sphere, noisy, tmp_path, form):
    output = tmp_path / "g.ply"
    done = beltrami(
        "regularize", sphere, "--data", noisy, "--time", 0.5, "--form", form, "-o", output
    )
    assert done.exit_code == 0, done.stderr
    expected = regularize(laplacian(read_mesh(sphere)), np.load(noisy), 0.5, form)
    np.testing.assert_array_equal(read_mesh(output).vertex_data["f"], expected)
    assert f"from {expected.min():.6g}" in done.stdout


def test_weights_of_the_values_and_no_end(beltrami, sphere, noisy, tmp_path):
    soft = np.arange(162) % 3.0
    np.savetxt(tmp_path / "w.txt", soft)
    arguments = ("regularize", sphere, "--data", noisy, "--measured", tmp_path / "w.txt")
    output = tmp_path / "g.npy"
    for time in (0.2, np.inf):
        done = beltrami(*arguments, "--time", time, "--mass", "consistent", "-o", output)
        assert done.exit_code == 0, done.stderr
        pair = laplacian(read_mesh(sphere), mass="consistent")
        expected = regularize(pair, np.load(noisy), time, weights=soft)
        np.testing.assert_array_equal(np.load(output), expected)


@pytest.mark.parametrize(
    ("arguments", "code", "text"),
    [
        (("--time", -1), 1, "t must be >= 0"),
        (("--time", 1, "--form", "masses"), 1, "Did you mean 'mass'?"),
        ((), 2, "--time"),
    ],
)
def test_options_that_do_not_fit(beltrami, sphere, noisy, tmp_path, arguments, code, text):
    done = beltrami("regularize", sphere, "--data", noisy, "-o", tmp_path / "g.npy", *arguments)
    assert done.exit_code == code
    assert text in done.stderr
