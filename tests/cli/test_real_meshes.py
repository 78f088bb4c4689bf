"""Real files, good and bad: a result or one clear line, never a traceback."""

import os
import resource
import subprocess
import sys
from pathlib import Path

import pytest

from beltrami.io import extras
from beltrami.io.registry import READERS

GIGABYTE = 1024**2  # in the kilobytes of ru_maxrss
FOLDER = os.environ.get("BELTRAMI_MESHES")
SUFFIXES = (*READERS, *extras.READERS)
FILES = sorted(
    path
    for path in (Path(FOLDER).rglob("*") if FOLDER else ())
    if path.name.lower().removesuffix(".gz").endswith(SUFFIXES)
)

pytestmark = [
    pytest.mark.meshes,
    pytest.mark.skipif(FOLDER is None, reason="BELTRAMI_MESHES names no folder of meshes"),
]


def shell(*arguments):
    code = "from beltrami.cli import main; main()"
    done = subprocess.run(
        [sys.executable, "-c", code, *map(str, arguments)],
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
        timeout=120,
    )
    assert resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss < GIGABYTE
    assert "Traceback" not in done.stderr
    if done.returncode == 0:
        assert done.stderr == ""
    else:
        assert done.returncode == 1
        assert done.stdout == ""
        assert len(done.stderr.splitlines()) == 1, done.stderr
        assert done.stderr.startswith("beltrami: ")
    return done


def test_there_are_files():
    assert FILES


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_each_file(path, tmp_path):
    told = shell("info", path)
    if told.returncode == 1:
        assert path.name in told.stderr
        return
    smoothed = shell("smooth", path, "-o", tmp_path / "out.ply")
    assert (smoothed.returncode == 0) == (tmp_path / "out.ply").exists()
    if smoothed.returncode == 1:  # then info has told the remedy
        remedy = smoothed.stderr.split("`")[1]
        assert remedy.startswith("beltrami repair --")
        assert remedy in told.stdout
    drawn = shell("render", path, "-o", tmp_path / "out.png", "--size", 200, 200)
    assert drawn.returncode == 0, drawn.stderr
