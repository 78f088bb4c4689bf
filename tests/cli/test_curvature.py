import json

import numpy as np
import pytest

from beltrami.io.registry import read_mesh
from beltrami.operators.curvature import curvature


@pytest.mark.parametrize("kind", ["gaussian", "mean", "principal"])
def test_values_are_those_of_the_function(beltrami, sphere, tmp_path, kind):
    output = tmp_path / "c.npy"
    done = beltrami("curvature", sphere, "--kind", kind, "-o", output)
    assert done.exit_code == 0, done.stderr
    expected = getattr(curvature(read_mesh(sphere)), kind)
    np.testing.assert_array_equal(np.load(output), expected)


def test_the_sum_is_that_of_gauss_and_bonnet(beltrami, sphere):
    done = beltrami("curvature", sphere)
    assert "add to 12.5663706 (2π times the Euler characteristic: 12.5663706)" in done.stdout
    facts = json.loads(beltrami("curvature", sphere, "--json").stdout)
    assert facts["gaussian"]["integral"] == pytest.approx(4 * np.pi)
    assert facts["total"] == pytest.approx(facts["gauss_bonnet"])
    assert facts["mean"]["median"] == pytest.approx(1, rel=0.02)


def test_a_misspelt_kind(beltrami, sphere):
    done = beltrami("curvature", sphere, "--kind", "gausian")
    assert done.exit_code == 1
    assert "Did you mean 'gaussian'?" in done.stderr


def test_a_stray_vertex_is_named(beltrami, stray):
    done = beltrami("curvature", stray)
    assert done.exit_code == 1
    assert len(done.stderr.splitlines()) == 1
    assert "`beltrami repair --remove-" in done.stderr
