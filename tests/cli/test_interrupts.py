"""Ctrl-C: one line, no traceback, old output whole, nothing half-written."""

import os
import signal
import subprocess
import sys
import threading
import time
import types

import pytest

from beltrami.cli.interrupts import hear_again
from beltrami.io.registry import write_mesh
from beltrami.mesh.shapes import icosphere

# The command, which tells on stdout when the verb calls this function for the first time.
TELLING = """
import importlib, sys
module = importlib.import_module({module!r})
real = getattr(module, {name!r})
def told(*args, **kwargs):
    print("started", flush=True)
    return real(*args, **kwargs)
setattr(module, {name!r}, told)
from beltrami.cli import main
main()
"""
VERBS = {
    "smooth": (("--steps", "100000000"), ("beltrami.diffusion.smoothing", "stages")),
    "heat": (
        ("--source", "1", "--time", "1", "--steps", "100000000"),
        ("beltrami.diffusion.heat_steps", "stages"),
    ),
    "write": (("--steps", "1"), ("beltrami.io.registry", "_write")),
}

pytestmark = pytest.mark.skipif(os.name == "nt", reason="no SIGINT to a single process on Windows")


def interrupt(code, arguments, folder, environment=None):
    """Run until it has started, send SIGINT; return the exit code and stderr."""
    process = subprocess.Popen(
        [sys.executable, "-c", code, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=folder,
        env=os.environ | (environment or {}),
    )
    try:
        assert process.stdout.readline() == "started\n", process.stderr.read()
        process.send_signal(signal.SIGINT)
        return process.communicate(timeout=60)[1], process.returncode
    finally:
        process.kill()


@pytest.mark.parametrize("case", VERBS)
def test_interrupted_verbs(case, tmp_path):
    options, (module, name) = VERBS[case]
    write_mesh(tmp_path / "in.ply", icosphere(3))
    (tmp_path / "out.ply").write_text("old")
    code = TELLING.format(module=module, name=name)
    if case == "write":  # stay in the middle of writing
        code = code.replace(
            "return real", "args[0].write(b'half'); import time; time.sleep(60)\n    return real"
        )
    verb = "smooth" if case == "write" else case
    errors, returncode = interrupt(code, (verb, "in.ply", "-o", "out.ply", *options), tmp_path)
    assert (returncode, errors) == (130, "beltrami: interrupted\n")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["in.ply", "out.ply"]
    assert (tmp_path / "out.ply").read_text() == "old"


def test_interrupted_tour(tmp_path):
    write_mesh(tmp_path / "in.ply", icosphere(3))
    code = TELLING.format(module="beltrami.cli.chapters.heat", name="laplacian")
    errors, returncode = interrupt(code, ("tour", "in.ply", "-o", "tour"), tmp_path)
    assert (returncode, errors) == (130, "beltrami: interrupted\n")
    names = {path.name for path in (tmp_path / "tour").iterdir()}
    assert "surface.png" in names  # earlier chapters are done
    assert "index.html" not in names
    assert not [name for name in names if name.startswith(".")]


def test_interrupted_tour_of_several_processes(tmp_path):
    write_mesh(tmp_path / "in.ply", icosphere(3))
    code = TELLING.format(module="beltrami.cli.playing", name="as_completed")
    setting = "import beltrami.cli.playing as p; p.LARGE, p._cores = 0, lambda: 2\n"
    errors, returncode = interrupt(setting + code, ("tour", "in.ply", "-o", "tour"), tmp_path)
    assert (returncode, errors) == (130, "beltrami: interrupted\n")
    names = {path.name for path in (tmp_path / "tour").iterdir()}
    assert "index.html" not in names
    assert not [name for name in names if name.startswith(".")]


# Found by Python as it starts: processes of a pool take long, and say a traceback if interrupted.
SLOW = """
import sys, time
if "--multiprocessing-fork" in sys.orig_argv:
    time.sleep(2)
"""


def test_interrupted_while_the_processes_of_a_tour_start(tmp_path):
    write_mesh(tmp_path / "in.ply", icosphere(3))
    (tmp_path / "slow").mkdir()
    (tmp_path / "slow" / "sitecustomize.py").write_text(SLOW)
    code = TELLING.format(module="beltrami.cli.playing", name="as_completed")
    setting = "import beltrami.cli.playing as p; p.LARGE, p._cores = 0, lambda: 2\n"
    path = os.pathsep.join([str(tmp_path / "slow"), *filter(None, [os.getenv("PYTHONPATH")])])
    start = time.monotonic()
    errors, returncode = interrupt(
        setting + code, ("tour", "in.ply", "-o", "tour"), tmp_path, {"PYTHONPATH": path}
    )
    assert (returncode, errors) == (130, "beltrami: interrupted\n")
    assert time.monotonic() - start > 2  # they were starting


def test_an_interrupt_that_python_loses_comes_again():
    lost = types.SimpleNamespace(exc_type=KeyboardInterrupt)
    hear_again(lost)
    with pytest.raises(KeyboardInterrupt):
        list(map(time.sleep, [0.01] * 500))


def test_other_lost_exceptions_are_shown_as_ever(monkeypatch):
    shown = []
    monkeypatch.setattr(sys, "__unraisablehook__", shown.append)
    lost = types.SimpleNamespace(exc_type=ValueError)
    before = threading.active_count()
    hear_again(lost)
    assert shown == [lost]
    assert threading.active_count() == before
