"""The suite of maps: disks are disks, and no map is called valid that is not."""

import numpy as np
import pytest
from benchmarks.disks import cut, natural, one_triangle, suite
from benchmarks.mapping_suite import Outcome, judged, main, report, summary
from benchmarks.surfaces import blocks, closed, less_one, sponge, tube

import beltrami as bt
from benchmarks import mapping_suite


@pytest.fixture(autouse=True)
def bundled_shapes_alone(monkeypatch):
    monkeypatch.delenv("BELTRAMI_MESHES", raising=False)


def test_disks_are_disks():
    groups = set()
    names = ("bump", "cap", "torus", "plate", "frame", "sponge", "needle", "pill", "30 rings")
    for group, _, mesh in suite(2600, names):
        groups.add(group)
        assert mesh.n_vertices <= 2600
        assert mesh.topology.is_manifold
        assert mesh.euler_characteristic == len(mesh.boundary_loops) == 1
    assert groups == set(mapping_suite.GROUPS)
    assert len(less_one(bt.shapes.icosphere(1)).boundary_loops[0]) == 3
    assert tube(30).n_vertices < tube(60).n_vertices


def test_with_the_meshes_there_are_as_many_disks_as_in_the_table(monkeypatch):
    alone = [len(group()) for group in (natural, cut, one_triangle)]
    monkeypatch.setenv("BELTRAMI_MESHES", "anywhere")
    assert [len(group()) for group in (natural, cut, one_triangle)] == [13, 26, 24]
    assert alone == [5, 10, 12]


def test_blocks_have_the_genus_of_their_tunnels():
    one = blocks(np.ones((2, 1, 1), np.bool_))
    assert (one.is_closed, one.genus, one.volume) == (True, 0, pytest.approx(2))
    assert (sponge(1).genus, sponge(2).genus) == (5, 81)
    filled = closed(bt.shapes.cylinder(8, 3))
    assert (filled.is_closed, filled.genus) == (True, 0)


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
    found = {("cut", names[0]): {"a": good, "b": bad}}
    found["cut", names[1]] = {"a": better, "b": better}
    found["cut", names[2]] = {"a": better}  # a slow peer may not get all
    text = "\n".join(report(found, "cut"))
    assert "| beltrami auto | 1 of 2 | 4 | 4 | 2.0 |" in text
    assert "MISSED" in text
    assert "where that is valid on 1 disks: 1.000 median, 1.000 largest" in text
    assert "| beltrami auto | 1 of 2 | 4 |" in "\n".join(summary(found))


def test_the_command_prints_every_map_and_the_goals(monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["mapping_suite", "30 rings", "--details"])
    main()
    out = capsys.readouterr().out
    assert "tube, 30 rings, 386 vertices, beltrami free: valid" in out
    assert "goal, every map a certified bijection: met" in out
