"""Real files, good and bad: a result or one clear line, never a traceback."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from beltrami.io import extras
from beltrami.io.registry import READERS

GIGABYTE = 1024**2  # in kilobytes
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


# Several commands in one process, which is started for each file.
COMMANDS = """
import contextlib, io, json, sys
from beltrami.cli import main
from pathlib import Path
for words in json.loads(sys.argv[1]):
    out, err, code = io.StringIO(), io.StringIO(), 0
    sys.argv[1:] = words
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            main()
        except SystemExit as end:
            code = end.code or 0
    print(json.dumps([code, out.getvalue(), err.getvalue()]))
status = Path("/proc/self/status")  # what the process before had does not count here
lines = status.read_text().splitlines() if status.exists() else ["VmHWM: 0"]
print(*(line.split()[1] for line in lines if line.startswith("VmHWM")))
"""


def shell(*commands):
    """Run the commands; return (exit code, stdout, stderr) of each, checked."""
    words = json.dumps([list(map(str, command)) for command in commands])
    done = subprocess.run(
        [sys.executable, "-c", COMMANDS, words],
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
        timeout=120,
    )
    assert (done.returncode, done.stderr) == (0, "")
    *lines, kilobytes = done.stdout.splitlines()
    assert int(kilobytes) < GIGABYTE
    told = [json.loads(line) for line in lines]
    for code, out, err in told:
        if code == 0:
            assert err == ""
            continue
        assert code == 1
        assert out == ""
        assert len(err.splitlines()) == 1, err
        assert err.startswith("beltrami: ")
    assert len(told) == len(commands)
    return told


def test_there_are_files():
    assert FILES


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_each_file(path, tmp_path):
    told, smoothed, drawn = shell(
        ("info", path),
        ("smooth", path, "-o", tmp_path / "out.ply"),
        ("render", path, "-o", tmp_path / "out.png", "--size", 200, 200),
    )
    if told[0] == 1:  # no mesh: all verbs say the same
        assert path.name in told[2]
        assert told == smoothed == drawn
        return
    assert (smoothed[0] == 0) == (tmp_path / "out.ply").exists()
    if smoothed[0] == 1:  # then info has told the remedy
        remedy = smoothed[2].split("`")[1]
        assert remedy.startswith("beltrami repair --")
        assert remedy in told[1]
    assert drawn[0] == 0, drawn[2]
