import numpy as np
import pytest

from beltrami.cli.functions import read_data, write_values
from beltrami.errors import DimensionError
from beltrami.io.registry import read_mesh
from beltrami.mesh.shapes import icosphere

MESH = icosphere(1)
VALUES = np.random.default_rng(440_913_277).normal(size=MESH.n_vertices)


@pytest.mark.parametrize("suffix", [".npy", ".txt", ".csv", ".ply", ".NPY"])
@pytest.mark.parametrize("values", [VALUES, MESH.vertices], ids=["n", "n3"])
def test_written_values_read_back(tmp_path, suffix, values):
    path = tmp_path / f"f{suffix}"
    write_values(path, MESH, "f", values)
    np.testing.assert_array_equal(read_data(path, MESH), values)


def test_ply_has_the_mesh_too(tmp_path):
    write_values(tmp_path / "f.ply", MESH, "warmth", VALUES)
    back = read_mesh(tmp_path / "f.ply")
    np.testing.assert_array_equal(back.vertices, MESH.vertices)
    assert list(back.vertex_data) == ["warmth"]


def test_data_are_checked_against_the_mesh(tmp_path):
    path = tmp_path / "f.npy"
    np.save(path, VALUES[1:])
    with pytest.raises(DimensionError, match=r"f\.npy has the shape \(41,\)"):
        read_data(path, MESH)


def test_which_of_several(tmp_path):
    mesh = MESH.with_data(a=VALUES, b=-VALUES)
    write_values(tmp_path / "f.ply", mesh, "c", VALUES + 1)
    np.testing.assert_array_equal(read_data(tmp_path / "f.ply", MESH, "b"), -VALUES)
