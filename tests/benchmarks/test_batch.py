"""The meshes of the benchmark have the defects that it says, and the tables are of what was run."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from benchmarks.batch import dirty, ply, report, run, write_meshes
from benchmarks.batch_memory import STEPS
from benchmarks.huge import write_sphere

import beltrami as bt
from benchmarks import batch

ROOT = Path(__file__).parents[2]


def test_every_defect_is_there(tmp_path):
    mesh = dirty(bt.shapes.icosphere(3), np.random.default_rng(3))
    found = bt.diagnose(mesh)
    assert len(found.unreferenced_vertices) == 5
    assert len(found.duplicate_faces) >= 3
    assert len(found.degenerate_faces) == 3
    assert len(found.inconsistent_edges) > 5
    assert len(found.boundary_edges) == 30
    fixed = bt.repair(
        mesh,
        merge_duplicate_vertices=True,
        remove_degenerate_faces=True,
        remove_duplicate_faces=True,
        split_non_manifold=True,
        orient=True,
        remove_unreferenced=True,
    ).mesh
    assert bt.diagnose(fixed).is_clean
    assert fixed.is_closed


def test_a_small_run_is_reported(tmp_path, monkeypatch):
    monkeypatch.setattr(batch, "SIZES", (500,))
    monkeypatch.setattr(batch, "CUT_OFF", 3)
    monkeypatch.setattr(batch, "STEPS", "repair, spectrum k=4")
    folder = tmp_path / "in"
    folder.mkdir()
    write_meshes(folder, 3, 7)
    before = {path: path.read_bytes() for path in folder.iterdir()}
    write_meshes(folder, 3, 7)
    assert {path: path.read_bytes() for path in folder.iterdir()} == before
    first = run(folder, tmp_path / "out", 0)
    again = run(folder, tmp_path / "out", 0)
    assert (first.done, first.failed) == (again.done, again.failed) == (2, 1)
    assert list(first.steps) == ["reading", "repair", "spectrum"]
    text = report([first], again)
    assert "| 1 | " in text
    assert "A million such meshes" in text


def test_the_file_is_what_a_reader_expects(tmp_path):
    mesh = bt.shapes.icosphere(1)
    (tmp_path / "a.ply").write_bytes(ply(mesh))
    assert np.array_equal(bt.read_mesh(tmp_path / "a.ply").faces, mesh.faces)


@pytest.mark.parametrize("faces", [8, 60, 3000])
def test_the_huge_sphere_is_clean(tmp_path, faces):
    write_sphere(tmp_path / "a.ply", faces)
    found = bt.diagnose(bt.read_mesh(tmp_path / "a.ply"))
    assert found.is_clean
    assert found.is_closed
    assert found.genus == 0
    assert found.volume > 0
    assert found.n_faces == pytest.approx(faces, rel=0.3)


@pytest.mark.heavy
@pytest.mark.skipif(sys.platform != "linux", reason="peaks are measured on Linux")
@pytest.mark.parametrize("step", STEPS)
def test_no_step_needs_more_memory_than_is_estimated(step):
    done = subprocess.run(
        [sys.executable, "-m", "benchmarks.batch_memory", "--vertices", "150000", step],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    *_, ratio = done.stdout.splitlines()[-1].strip("| ").split(" | ")
    assert 1 < float(ratio) < 3


@pytest.mark.heavy
def test_ten_million_faces_within_eight_gigabytes():
    done = subprocess.run(
        [sys.executable, "-m", "benchmarks.huge", "--faces", "10000000"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    rows = [line.strip("| ").split(" | ") for line in done.stdout.splitlines()]
    peaks = {row[0]: float(row[3]) for row in rows if len(row) == 5 and row[1][0].isdigit()}
    assert set(peaks) == {"read", "diagnose", "smooth", "render"}
    assert max(peaks.values()) < 8
