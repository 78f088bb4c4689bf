import json

import numpy as np
import pytest

from beltrami.io.registry import read_mesh, write_mesh
from beltrami.operators.integrals import integrate


def test_without_data_it_is_the_area(beltrami, sphere):
    facts = json.loads(beltrami("integrate", sphere, "--json").stdout)
    assert facts["integral"] == pytest.approx(read_mesh(sphere).area)
    assert facts["mean"] == pytest.approx(1)


@pytest.mark.parametrize(("how", "areas"), [("vertex", "voronoi"), ("edge", "incenter")])
def test_each_column_of_a_function(beltrami, sphere, tmp_path, how, areas):
    mesh = read_mesh(sphere)
    values = np.exp(3 * mesh.vertices[:, :2])
    np.save(tmp_path / "f.npy", values)
    words = ("--data", tmp_path / "f.npy", "--how", how, "--areas", areas)
    done = beltrami("integrate", sphere, *words)
    assert done.exit_code == 0, done.stderr
    found = [float(x) for x in done.stdout.splitlines()[0].removeprefix("integral ").split(",")]
    expected = integrate(mesh, values, how, areas)
    assert found == pytest.approx(expected, rel=1e-11)
    assert found == pytest.approx([4 * np.pi * np.sinh(3) / 3] * 2, rel=0.06)
    assert found != pytest.approx(integrate(mesh, values), rel=1e-6)  # the options are heard


def test_a_wrong_name(beltrami, sphere):
    done = beltrami("integrate", sphere, "--how", "edges")
    assert done.exit_code == 1
    assert "Did you mean 'edge'?" in done.stderr


def test_a_file_with_several_functions(beltrami, sphere, tmp_path):
    mesh = read_mesh(sphere)
    f = mesh.vertices[:, 0]
    write_mesh(tmp_path / "two.ply", mesh.with_data(f=f, g=f))
    words = ("integrate", sphere, "--data", tmp_path / "two.ply")
    done = beltrami(*words)
    assert done.exit_code == 1
    assert "has several functions ('f', 'g'): choose one with --data-name" in done.stderr
    assert beltrami(*words, "--data-name", "g").exit_code == 0
