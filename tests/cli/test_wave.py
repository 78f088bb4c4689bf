from itertools import pairwise

import numpy as np
import pytest
from PIL import Image

from beltrami.diffusion.bumps import gaussian_bumps
from beltrami.diffusion.wave import wave
from beltrami.io.registry import read_mesh, write_mesh
from beltrami.mesh.shapes import grid
from beltrami.operators.laplacian import laplacian

SMALL = ("--size", 60, 50)


def frames(*arguments, **options):
    return np.array([frame for _, frame in wave(*arguments, **options)])


def test_an_array_of_frames(beltrami, sphere, tmp_path):
    output = tmp_path / "w.npy"
    arguments = ("--time", 2, "--frames", 5, "--bump", 3, "--hollow", 40, "--width", 0.3)
    done = beltrami("wave", sphere, *arguments, "-o", output)
    assert done.exit_code == 0, done.stderr
    assert "5 frames" in done.stdout
    mesh = read_mesh(sphere)
    f = gaussian_bumps(mesh, [3, 40], 0.3, [1, -1])
    expected = frames(laplacian(mesh), f, None, np.linspace(0, 2, 5))
    np.testing.assert_array_equal(np.load(output), expected)


def test_data_velocity_and_options(beltrami, tmp_path):
    mesh = grid(6, 5)
    write_mesh(tmp_path / "g.obj", mesh)
    f, g = mesh.vertices[:, :2].T ** 2
    np.save(tmp_path / "f.npy", f)
    np.savetxt(tmp_path / "g.txt", g)
    arguments = ("--data", tmp_path / "f.npy", "--velocity", tmp_path / "g.txt", "--time", 1)
    output = tmp_path / "w.npy"
    options = ("--frames", 3, "--method", "implicit", "--step", 0.1, "--hold-boundary")
    done = beltrami("wave", tmp_path / "g.obj", *arguments, *options, "-o", output)
    assert done.exit_code == 0, done.stderr
    pair, times = laplacian(mesh), np.linspace(0, 1, 3)
    held = mesh.topology.boundary_edges.ravel()
    expected = frames(pair, f, g, times, "implicit", step=0.1, hold=held)
    np.testing.assert_allclose(np.load(output), expected, atol=1e-12)
    done = beltrami(
        "wave", tmp_path / "g.obj", *arguments, "--frames", 3, "-o", output,
        "--method", "spectral", "--modes", 42, "--mass", "consistent",
    )  # fmt: skip
    assert done.exit_code == 0, done.stderr
    exact = frames(laplacian(mesh, mass="consistent"), f, g, times, "spectral")
    np.testing.assert_allclose(np.load(output), exact, atol=1e-9)


@pytest.mark.chapter("F3.6")
@pytest.mark.parametrize("suffix", [".gif", ".webp"])
def test_an_animation(beltrami, sphere, tmp_path, suffix):
    output = tmp_path / f"w{suffix}"
    arguments = ("--time", 2, "--frames", 4, "--bump", 3, "--width", 0.4, "--rate", 10)
    done = beltrami("wave", sphere, *arguments, *SMALL, "-o", output)
    assert done.exit_code == 0, done.stderr
    with Image.open(output) as picture:
        assert picture.n_frames == 4
        assert picture.size[0] == 60
        looks = []
        for k in range(4):
            picture.seek(k)
            looks.append(np.asarray(picture.convert("RGB"), dtype=int))
        assert picture.info["duration"] == 100
    assert all(np.abs(b - a).max() > 30 for a, b in pairwise(looks))


def test_a_folder_of_pictures(beltrami, sphere, tmp_path):
    output = tmp_path / "frames"
    arguments = ("--time", 1, "--frames", 3, "--bump", 3, *SMALL, "-o", output)
    for _ in range(2):  # the second time it is there already
        done = beltrami("wave", sphere, *arguments)
        assert done.exit_code == 0, done.stderr
        names = sorted(path.name for path in output.iterdir())
        assert names == ["frame-0000.png", "frame-0001.png", "frame-0002.png"]
    with Image.open(output / names[0]) as first:
        red, _, blue = np.asarray(first.convert("RGB"), dtype=int).transpose(2, 0, 1)
    assert (red - blue).max() > 60


def test_several_columns_go_to_an_array_only(beltrami, sphere, tmp_path):
    np.save(tmp_path / "f.npy", read_mesh(sphere).vertices)
    arguments = ("wave", sphere, "--data", tmp_path / "f.npy", "--time", 1, "--frames", 2)
    assert beltrami(*arguments, "-o", tmp_path / "w.npy").exit_code == 0
    assert np.load(tmp_path / "w.npy").shape == (2, 162, 3)
    done = beltrami(*arguments, "-o", tmp_path / "w.gif")
    assert done.exit_code == 2
    assert "one function" in done.stderr


@pytest.mark.parametrize(
    ("arguments", "code", "text"),
    [
        ((), 2, "--data, or --bump"),
        (("--bump", 1, "--data", "f.npy"), 2, "either"),
        (("--data", "f.npy", "--width", 1), 2, "--width"),
        (("--bump", 1, "--modes", 5), 2, "--method spectral"),
        (("--bump", 999), 1, "999"),
        (("--bump", 1, "--step", 9), 1, "the longest allowed is"),
        (("--bump", 1, "--method", "leap"), 1, "Did you mean 'leapfrog'?"),
    ],
)
def test_options_that_do_not_fit(beltrami, sphere, tmp_path, arguments, code, text):
    done = beltrami("wave", sphere, "--time", 1, "-o", tmp_path / "w.npy", *arguments)
    assert done.exit_code == code
    assert text in done.stderr
    assert not (tmp_path / "w.npy").exists()


def test_a_mistake_leaves_no_folder(beltrami, sphere, tmp_path):
    done = beltrami("wave", sphere, "--time", -1, "--bump", 1, "-o", tmp_path / "w")
    assert done.exit_code == 1
    assert "times must be" in done.stderr
    assert not (tmp_path / "w").exists()
    done = beltrami("wave", sphere, "--time", 1, "--bump", 1, "-o", tmp_path / "w.mp4")
    assert done.exit_code == 1
    assert "'.gif'" in done.stderr


def test_a_velocity_of_several_functions(beltrami, tmp_path):
    mesh = grid(6, 5)
    f, g = mesh.vertices[:, :2].T ** 2
    write_mesh(tmp_path / "g.ply", mesh.with_data(f=f, g=g))
    arguments = ("--bump", 3, "--velocity", tmp_path / "g.ply", "--time", 1)
    done = beltrami("wave", tmp_path / "g.ply", *arguments, "-o", tmp_path / "w.npy")
    assert done.exit_code == 1
    assert "has several functions ('f', 'g'): a file with one is needed" in done.stderr
