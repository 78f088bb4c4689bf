"""The suite of maps: disks are disks, and no map is called valid that is not."""

import numpy as np
import pytest
from benchmarks.disks import less_one, suite, tube
from benchmarks.mapping_suite import Outcome, judged, main, report

import beltrami as bt
from benchmarks import mapping_suite


@pytest.fixture(autouse=True)
def bundled_shapes_alone(monkeypatch):
    monkeypatch.delenv("BELTRAMI_MESHES", raising=False)


def test_disks_are_disks():
    groups = set()
    for group, _, mesh in suite(2000, ("bump", "cube", "torus", "icosphere", "30 rings")):
        groups.add(group)
        assert mesh.n_vertices <= 2000
        assert mesh.topology.is_manifold
        assert mesh.euler_characteristic == len(mesh.boundary_loops) == 1
    assert groups == set(mapping_suite.GROUPS)
    assert len(less_one(bt.shapes.icosphere(1)).boundary_loops[0]) == 3
    assert tube(30).n_vertices < tube(60).n_vertices


def test_maps_are_judged_by_the_certificate():
    mesh = bt.shapes.disk(4, dimension=3)
    x = mesh.vertices[:, :2]
    good, mirrored = judged(mesh, lambda: x), judged(mesh, lambda: x * [1, -1])
    for one in (good, mirrored):
        assert one.valid
        assert one.energy == pytest.approx(1)
    folded = x.copy()
    folded[0] = [5, 5]
    bad = judged(mesh, lambda: folded)
    assert not bad.valid
    assert "flipped" in bad.note
    assert not judged(mesh, lambda: x * np.nan).valid
    assert not judged(mesh, lambda: x[1:]).valid
    failed = judged(mesh, lambda: 1 / 0)
    assert not failed.valid
    assert failed.note == "ZeroDivisionError"


def test_invalid_maps_do_not_enter_the_median():
    good, better, bad = Outcome(True, 4.0, 1.0), Outcome(True, 2.0, 1.0), Outcome(False, 1.0, 1.0)
    names = ("beltrami auto", "beltrami free", "libigl slim(20)")
    found = {("cut", names[0]): [good, bad], ("cut", names[1]): [better, better]}
    found["cut", names[2]] = [better, better]
    text = "\n".join(report(found, "cut"))
    assert "| beltrami auto | 1 of 2 | 4 | 4 | 2.0 |" in text
    assert "MISSED" in text
    assert "1.000 median, 1.000 largest" in text


def test_the_command_prints_every_map_and_the_goals(monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["mapping_suite", "30 rings", "--details"])
    main()
    out = capsys.readouterr().out
    assert "tube, 30 rings, 386 vertices, beltrami free: valid" in out
    assert "goal, every map a certified bijection: met" in out
