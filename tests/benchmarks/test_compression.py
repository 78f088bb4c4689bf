"""The table of sizes: it measures what comes back, and refuses what does not."""

import numpy as np
import pytest
from benchmarks.compression import bytes_at, geometric_mean, main, measure, same_faces

import beltrami as bt
from benchmarks import compression


@pytest.fixture
def without_draco(monkeypatch):
    monkeypatch.setattr(compression, "draco", lambda mesh, bits: 1000 * bits)
    monkeypatch.setattr(compression, "draco_connectivity", lambda mesh: 500)


def test_a_mesh_is_measured(without_draco):
    mesh = bt.shapes.icosphere(2)
    one = measure("sphere", mesh, 9, "fast")
    assert one.ours == len(bt.compress(mesh, bits=9, effort="fast"))
    assert one.ratio == one.ours / 9000
    step = np.ptp(mesh.vertices, axis=0).max() / 511
    assert one.error == pytest.approx(step / 2, rel=0.15)  # a uniform error in three dimensions


def test_a_mesh_that_does_not_come_back_has_no_ratio(without_draco, monkeypatch):
    mesh = bt.shapes.icosphere(1)
    honest = bt.decompress
    monkeypatch.setattr(
        bt, "decompress", lambda data: honest(data).with_vertices(honest(data).vertices[::-1])
    )
    with pytest.raises(RuntimeError, match="does not come back"):
        measure("sphere", mesh, 9, "fast")


def test_faces_are_the_same_up_to_order_and_first_corner():
    faces = np.array([[0, 1, 2], [2, 1, 3]])
    assert same_faces(faces, np.array([[3, 2, 1], [1, 2, 0]]))
    assert not same_faces(faces, np.array([[3, 1, 2], [1, 2, 0]]))


def test_means_and_lines_are_of_logarithms():
    assert geometric_mean([2, 8]) == pytest.approx(4)
    assert bytes_at(0.1, [(1.0, 100), (0.01, 10_000)]) == pytest.approx(1000)


def test_the_table_is_printed(without_draco, tmp_path, capsys):
    bt.write_mesh(tmp_path / "a.ply", bt.shapes.icosphere(1))
    assert main([str(tmp_path / "a.ply"), "--bits", "5", "7", "--effort", "fast"]) == 0
    printed = capsys.readouterr().out
    assert "| mesh | vertices | 5 bits | 7 bits |" in printed
    assert "(goal 0.65)" in printed
    assert "(goal 0.5)" in printed
