import json

import pytest

from beltrami.io.registry import write_mesh
from beltrami.mesh.shapes import icosphere


@pytest.fixture
def folder(tmp_path):
    meshes = tmp_path / "meshes"
    meshes.mkdir()
    for i in range(2):
        write_mesh(meshes / f"{i}.ply", icosphere(i))
    (meshes / "bad.off").write_text("OFF\n1")
    (meshes / "notes.txt").write_text("")
    return meshes


def test_a_folder_in_words(beltrami, folder, tmp_path):
    arguments = ["batch", folder, "--do", "repair, diagnose", "-o", tmp_path / "out"]
    done = beltrami(*arguments, "--workers", 0)
    assert done.exit_code == 0, done.output
    lines = done.stdout.splitlines()
    assert lines[0].startswith(f"failed {folder}/bad.off: reading: ")
    assert lines[1] == "left out 1 files that are no meshes"
    assert lines[2].startswith("2 of 3 meshes done, 1 failed, 0 known from before; ")
    assert lines[3] == f"wrote {tmp_path / 'out'}: results.parquet, manifest.jsonl"
    assert done.stderr == ""
    again = beltrami(*arguments, "--workers", 0)
    assert "3 known from before" in again.stdout


def test_for_machines(beltrami, folder, tmp_path):
    done = beltrami(
        "batch", folder / "*.ply", folder / "bad.off", "--do", "diagnose", "-o", tmp_path / "out",
        "--workers", 0, "--json",
    )  # fmt: skip
    found = json.loads(done.stdout)
    assert (found["meshes"], found["done"], found["failed"]) == (3, 2, 1)
    assert found["failures"][0]["kind"] == "FileFormatError"


@pytest.mark.parametrize(
    ("more", "line"),
    [
        (["--do", "repiar"], "step 1 of the pipeline: unknown verb 'repiar'"),
        (["--do", "missing.toml"], "missing.toml: No such file or directory"),
        (["--do", "diagnose", "--memory", "much"], "memory is a size such as 4GB"),
        (["--do", "diagnose", "--time-limit", "soon"], "a time limit is a time such as 10min"),
        (["--do", "diagnose", "--time-limit", "9s"], "a time limit stops the worker that is late"),
        (["--do", "diagnose", "--redo", "some"], "unknown redo 'some'"),
        (["--do", "diagnose", "--strict"], "bad.off: reading: "),
    ],
)
def test_what_cannot_be_is_one_line_and_exit_code_1(beltrami, folder, tmp_path, more, line):
    done = beltrami("batch", folder, "-o", tmp_path / "out", "--workers", 0, *more)
    assert done.exit_code == 1
    assert line in done.stderr
    assert len(done.stderr.splitlines()) == 1


def test_no_mesh_is_told(beltrami, tmp_path):
    done = beltrami("batch", tmp_path / "*.ply", "--do", "diagnose", "-o", tmp_path / "out")
    assert done.exit_code == 1
    assert "No mesh there" in done.stderr


def test_the_bar_tells_what_failed(monkeypatch):
    from io import StringIO

    from rich.console import Console
    from rich.progress import Progress

    from beltrami.batch.record import Problem
    from beltrami.batch.state import Failure, State
    from beltrami.cli.batch import _drawing

    written = StringIO()
    bar = Progress(console=Console(file=written, force_terminal=True, width=200))
    watch = _drawing(bar)
    failure = Failure("[a].ply", Problem("MeshError", "no [faces]", "spectrum"))
    watch(State(2, done=1, seconds=1.0))
    watch(State(2, done=1, failed=1, reused=1, seconds=2.0, last=failure))
    assert "failed [a].ply: spectrum: no [faces]" in written.getvalue()
    task = bar.tasks[0]
    assert (task.completed, task.total, task.fields["rate"], task.fields["failed"]) == (
        2,
        2,
        0.5,
        1,
    )
