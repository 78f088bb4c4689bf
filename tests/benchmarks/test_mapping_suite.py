"""The suite of maps: disks are disks, and no map is called valid that is not."""

import numpy as np
import pytest
from benchmarks.disks import cut, natural, one_triangle, suite
from benchmarks.mapping_report import Large, Outcome, goals, summary, table
from benchmarks.mapping_suite import judged, keep, main, read_kept
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
    assert "| beltrami auto | 1 of 2 | 4 | 4 | 2.0 |" in table(found, "cut")
    assert "| beltrami auto | 1 of 2 | 4 |" in "\n".join(summary(found))
    rows = {what: rest for what, *rest in goals(found, [])}
    assert rows["beltrami auto: certified bijections"] == ["1", "2", "**missed**"]
    assert rows["beltrami free: certified bijections"] == ["2", "2", "met"]
    beside = rows["beltrami free / SLIM(20) where it is valid, cut, 1 disks: largest"]
    assert beside == ["1.000 (median 1.000)", "<= 1.1", "met"]


def test_goals_of_energy_and_time_are_missed_above_their_limits():
    found = {("natural", "beltrami auto"): {"a": Outcome(True, 1.81, 1.0)}}
    slow, wrong = Outcome(True, 2.0, 3.1), Outcome(False, 2.0, 0.1)
    large = [Large("cut", 50_000, 50_123, slow), Large("one triangle", 10**6, 10**6, wrong)]
    rows = {what: rest for what, *rest in goals(found, large)}
    assert rows["beltrami auto, natural: median"] == ["1.810", "<= 1.8", "**missed**"]
    assert rows["cut, 50123 vertices: seconds"] == ["3.1", "<= 3", "**missed**"]
    assert rows["one triangle, 1000000 vertices: seconds"][1:] == ["a bijection", "**missed**"]


def test_the_command_writes_every_map_and_the_goals(monkeypatch, capsys, tmp_path):
    out = tmp_path / "maps.md"
    given = ["30 rings", "--details", "--large", "--folder", str(tmp_path), "--output", str(out)]
    monkeypatch.setattr("sys.argv", ["mapping_suite", *given])
    monkeypatch.setattr("os.getloadavg", lambda: (1.0, 1.0, 1.0))
    main()
    assert "tube, 30 rings, 386 vertices, beltrami free: valid" in capsys.readouterr().out
    text = out.read_text()
    assert "| beltrami free: certified bijections | 1 | 1 | met |" in text
    assert "## Tube" in text
    assert "| libigl | " in text
    monkeypatch.setattr(mapping_suite, "judged", None)  # all is kept
    main()
    assert out.read_text() == text


def test_what_is_kept_comes_back(tmp_path):
    file, one = tmp_path / "new" / "maps.jsonl", Outcome(False, np.inf, 0.5, "3 flipped")
    assert read_kept(file) == {}
    keep(file, ("cut", "a", "libigl lscm"), one)
    keep(None, ("cut", "b", "libigl lscm"), one)
    assert read_kept(file) == {("cut", "a", "libigl lscm"): one}
