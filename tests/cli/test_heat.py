import numpy as np
import pytest

from beltrami.diffusion.heat import heat
from beltrami.io.registry import read_mesh, write_mesh
from beltrami.operators.laplacian import laplacian


def test_a_unit_of_heat_at_a_source(beltrami, sphere, tmp_path):
    output = tmp_path / "h.ply"
    done = beltrami("heat", sphere, "--source", 5, "--time", 0.1, "-o", output)
    assert done.exit_code == 0, done.stderr
    pair = laplacian(read_mesh(sphere))
    unit = np.zeros(pair.n)
    unit[5] = 1 / pair.masses[5]
    found = read_mesh(output).vertex_data["heat"]
    np.testing.assert_array_equal(found, heat(pair, unit, 0.1))
    assert pair.masses @ found == pytest.approx(1)


def test_one_of_several_functions_of_a_file(beltrami, sphere, tmp_path):
    mesh = read_mesh(sphere)
    x, y, _ = mesh.vertices.T
    write_mesh(tmp_path / "xy.ply", mesh.with_data(x=x, y=y))
    arguments = ("heat", sphere, "--data", tmp_path / "xy.ply", "--time", 0.1)
    output = tmp_path / "h.txt"
    assert beltrami(*arguments, "-o", output).exit_code == 1
    assert beltrami(*arguments, "--data-name", "y", "-o", output).exit_code == 0
    np.testing.assert_array_equal(np.loadtxt(output), heat(laplacian(mesh), y, 0.1))


@pytest.mark.parametrize(
    ("arguments", "code", "text"),
    [
        ((), 2, "--data or --source"),
        (("--source", 999), 1, "999"),
        (("--source", 1, "--mass", "vornoi"), 1, "Did you mean 'voronoi'?"),
        (("--source", 1, "--method", "explicit", "--steps", 1), 1, "the longest allowed is"),
    ],
)
def test_options_that_do_not_fit(beltrami, sphere, tmp_path, arguments, code, text):
    done = beltrami("heat", sphere, "--time", 5, "-o", tmp_path / "h.npy", *arguments)
    assert done.exit_code == code
    assert text in done.stderr


def test_data_of_the_wrong_length(beltrami, sphere, tmp_path):
    (tmp_path / "f.txt").write_text("1\n2\n3\n")
    done = beltrami(
        "heat", sphere, "--time", 1, "--data", tmp_path / "f.txt", "-o", tmp_path / "h.npy"
    )
    assert done.exit_code == 1
    assert "(3,)" in done.stderr
    assert "(162,)" in done.stderr


@pytest.mark.parametrize(
    ("arguments", "options"),
    [
        (("--method", "exact"), {"method": "exact"}),
        (("--method", "spectral"), {"method": "spectral"}),
        (
            ("--method", "crank_nicolson", "--steps", 7, "--damped-steps", 2),
            {"method": "crank_nicolson", "steps": 7, "damped_steps": 2},
        ),
    ],
)
def test_methods(beltrami, sphere, tmp_path, arguments, options):
    np.save(tmp_path / "f.npy", read_mesh(sphere).vertices[:, 1])
    output = tmp_path / "h.npy"
    arguments = ("--data", tmp_path / "f.npy", "--time", 0.1, *arguments, "-o", output)
    done = beltrami("heat", sphere, *arguments)
    assert done.exit_code == 0, done.stderr
    pair = laplacian(read_mesh(sphere))
    np.testing.assert_array_equal(
        np.load(output), heat(pair, np.load(arguments[1]), 0.1, **options)
    )


def test_modes(beltrami, sphere, tmp_path):
    output = tmp_path / "h.npy"
    arguments = ("heat", sphere, "--source", 3, "--modes", 20, "-o", output, "--time")
    done = beltrami(*arguments, 0.8, "--method", "spectral")
    assert done.exit_code == 0, done.stderr
    pair = laplacian(read_mesh(sphere))
    unit = np.zeros(pair.n)
    unit[3] = 1 / pair.masses[3]
    np.testing.assert_allclose(np.load(output), heat(pair, unit, 0.8, "exact"), atol=1e-6)
    done = beltrami(*arguments, 0.01, "--method", "spectral")
    assert done.exit_code == 1
    assert "20 modes" in done.stderr
    done = beltrami(*arguments, 0.01)
    assert done.exit_code == 2
    assert "--method spectral" in done.stderr
