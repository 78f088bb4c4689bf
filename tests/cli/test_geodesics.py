import numpy as np
import pytest

from beltrami.geodesics.distance import geodesic_distance
from beltrami.io.registry import read_mesh, write_mesh
from beltrami.mesh.mesh import Mesh


@pytest.mark.parametrize(
    ("words", "options"),
    [
        ((), {}),
        (("--method", "exact"), {"method": "exact"}),
        (("--no-intrinsic", "--time", 0.1), {"intrinsic": False, "time": 0.1}),
    ],
)
def test_distances_are_those_of_the_function(beltrami, sphere, tmp_path, words, options):
    output = tmp_path / "d.ply"
    done = beltrami("geodesics", sphere, "--source", 3, "--source", 70, "-o", output, *words)
    assert done.exit_code == 0, done.stderr
    expected = geodesic_distance(read_mesh(sphere), [3, 70], **options)
    np.testing.assert_array_equal(read_mesh(output).vertex_data["distance"], expected)
    assert f"farthest is vertex {expected.argmax()} at" in done.stdout


def test_what_is_not_reached_is_said(beltrami, sphere, tmp_path):
    one = read_mesh(sphere)
    n = one.n_vertices
    two = Mesh(
        np.concatenate([one.vertices, one.vertices + 5]), np.concatenate([one.faces, one.faces + n])
    )
    write_mesh(tmp_path / "two.ply", two)
    done = beltrami("geodesics", tmp_path / "two.ply", "--source", 3, "-o", tmp_path / "d.npy")
    assert f"{n} vertices are not reached (inf)" in done.stdout
    assert np.isinf(np.load(tmp_path / "d.npy")).sum() == n


@pytest.mark.parametrize(
    ("words", "code", "text"),
    [
        ((), 2, "--source"),
        (("--source", 999), 1, "999"),
        (("--source", 1, "--method", "exakt"), 1, "Did you mean 'exact'?"),
        (("--source", 1, "--method", "edges", "--time", 1), 1, "belong to the heat method"),
    ],
)
def test_options_that_do_not_fit(beltrami, sphere, tmp_path, words, code, text):
    done = beltrami("geodesics", sphere, "-o", tmp_path / "d.npy", *words)
    assert done.exit_code == code
    assert text in done.stderr


def test_long_work_is_announced(beltrami, sphere, tmp_path, monkeypatch):
    monkeypatch.setattr("beltrami.cli.geodesics._MANY", 10)
    words = ("geodesics", sphere, "--source", 3, "-o", tmp_path / "d.npy")
    assert "may take minutes" in beltrami(*words, "--method", "exact").stderr
    assert "minutes" not in beltrami(*words).stderr
