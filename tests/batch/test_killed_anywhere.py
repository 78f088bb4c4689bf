"""A run may end at any moment: before or after every change of the folder of results."""

import os
import shutil

import pytest

from beltrami.batch import run_batch as room
from beltrami.batch.run_batch import run_batch
from beltrami.io.registry import write_mesh
from beltrami.mesh.shapes import torus

STEPS = "repair, spectrum k=3, write"


class _Killed(BaseException):
    """Like a kill: nothing that is to be cleaned up is cleaned up."""


def rows_of(table, out):
    return {
        name: {column: value for column, value in row.items() if column != "seconds"}
        for name, row in table(out).items()
    }


@pytest.fixture
def whole(tmp_path, table):
    """Run without being killed; return the meshes, the rows and the files."""
    meshes = tmp_path / "in"
    meshes.mkdir()
    for i in range(2):
        write_mesh(meshes / f"{i}.off", torus(9, 7 + i))
    (meshes / "2.off").write_text("OFF\n")
    out = tmp_path / "whole"
    run_batch(meshes, STEPS, out, workers=0)
    return meshes, rows_of(table, out), files_of(out)


def files_of(out):
    return {str(path.relative_to(out)) for path in out.rglob("*") if path.is_file()}


@pytest.mark.parametrize("after", [False, True])
def test_a_later_run_makes_what_a_run_without_a_kill_makes(
    whole, tmp_path, table, monkeypatch, after
):
    meshes, rows, files = whole
    replace, tell, killed_at = os.replace, room.write_results, 0
    while True:
        killed_at += 1
        out, calls = tmp_path / f"out-{killed_at}", []

        def replace_or_die(source, target, calls=calls, last=killed_at):
            calls.append(target)
            if len(calls) == last and not after:
                raise _Killed
            replace(source, target)
            if len(calls) == last:
                raise _Killed

        with monkeypatch.context() as patch:
            patch.setattr(os, "replace", replace_or_die)
            patch.setattr(os, "unlink", lambda *_, **__: None)
            patch.setattr(shutil, "rmtree", lambda *_, **__: None)

            def tell_if_alive(*given, calls=calls, last=killed_at):
                if len(calls) < last:
                    tell(*given)

            patch.setattr(room, "write_results", tell_if_alive)
            try:
                run_batch(meshes, STEPS, out, workers=0)
                break  # it was not killed any more
            except _Killed:
                pass
        run_batch(meshes, STEPS, out, workers=0)
        assert rows_of(table, out) == rows, killed_at
        assert files_of(out) == files, killed_at
        assert run_batch(meshes, STEPS, out, workers=0).state.reused == 3
    assert killed_at > 10
