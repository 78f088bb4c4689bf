"""A mesh that takes too long fails, wherever it hangs, and stops nobody."""

import contextlib
import os
import subprocess
import sys
from types import SimpleNamespace

import pytest

from beltrami.batch.cluster import Workers, _outcome_of
from beltrami.batch.failures import PipelineError, TimeLimitError
from beltrami.batch.pipeline import as_pipeline
from beltrami.batch.run_batch import run_batch
from beltrami.batch.store import Store
from beltrami.batch.time_limit import parse_time, process_in_time, told_late
from beltrami.batch.work import Job, process
from beltrami.errors import BeltramiError
from beltrami.io.registry import write_mesh
from beltrami.mesh.shapes import torus

STEPS = "repair, integrate"
# What never returns to Python, keeps its lock, and does not look at signals.
HANGING = """
import sys
from pathlib import Path
from beltrami.batch import time_limit
from beltrami.batch.pipeline import as_pipeline
from beltrami.batch.work import Job

def hang(job, tell):
    tell("repair")
    tell("spectrum")
    max(range(10**16))

time_limit.process = hang
job = Job("a", "a.ply", as_pipeline("repair"), sys.argv[1], None, "nothing", 0.2)
time_limit.process_in_time(job, "one")
"""


@pytest.fixture
def job(tmp_path):
    """Return a job with a limit of an hour."""
    write_mesh(tmp_path / "a.ply", torus(9, 9))
    store = Store(tmp_path / "out")
    with store.claimed():
        place = str(tmp_path / "a.ply")
        yield Job("a.ply", place, as_pipeline(STEPS), store.root, seconds=3600.0)


def incoming(job):
    return sorted(os.listdir(os.path.join(job.store, "incoming")))


def test_times():
    times = {"10min": 600, "2 h": 7200, "90": 90, "1.5s": 1.5, "1D": 86400, 7: 7, 0.25: 0.25}
    assert {text: parse_time(text) for text in times} == times
    for wrong in ("", "0s", "-1s", "1 year", "min", 0, -1, 1e300, True, None, float("nan"), [1]):
        with pytest.raises(PipelineError, match="time limit is a time such as 10min"):
            parse_time(wrong)


def test_code_that_does_not_return_to_python_is_ended(job):
    command = [sys.executable, "-c", HANGING, job.store]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert (done.returncode, done.stderr) == (1, "")
    assert incoming(job) == ["one.steps"]
    assert told_late(job, "other") is None
    outcome = process_in_time(job, "one")  # as the next worker does
    assert (outcome.outcome, outcome.key) == ("failed", "")
    assert (outcome.error.kind, outcome.error.step) == ("TimeLimitError", "spectrum")
    assert "more than the 3600 s" in outcome.error.message
    assert incoming(job) == []
    assert process_in_time(job, "one").outcome == "done"  # and in another run it is tried again


def test_a_mesh_in_time_leaves_no_mark(job):
    outcome = process_in_time(job, "one")
    assert outcome.outcome == "done"
    assert incoming(job) == []
    mark = os.path.join(job.store, "incoming", "two.steps")
    with open(mark, "w") as file:  # of a worker that was killed, but not because of the time
        file.write("reading\nrepair\n")
    assert told_late(job, "two") is None
    assert process_in_time(job, "two").reused
    assert incoming(job) == []


def test_what_is_longer_than_the_system_can_wait_is_no_error(job, monkeypatch):
    set_to = []
    monkeypatch.setattr("threading.TIMEOUT_MAX", 60.0)
    monkeypatch.setattr("faulthandler.dump_traceback_later", lambda at, **_: set_to.append(at))
    assert process_in_time(job, "one").outcome == "done"
    assert set_to == [60.0]


@pytest.mark.parametrize("ending", [None, KeyboardInterrupt])
def test_the_clock_is_stopped_however_the_work_ends(job, monkeypatch, ending):
    told = []
    later, cancel = "faulthandler.dump_traceback_later", "faulthandler.cancel_dump_traceback_later"
    monkeypatch.setattr(later, lambda *_, **__: told.append("set"))
    monkeypatch.setattr(cancel, lambda: told.append("stopped"))

    def work(*_):
        told.append("work")
        if ending is not None:
            raise ending

    monkeypatch.setattr("beltrami.batch.time_limit.process", work)
    with contextlib.nullcontext() if ending is None else pytest.raises(ending):
        process_in_time(job, "one")
    assert told == ["set", "work", "stopped"]
    assert incoming(job) == []


def test_steps_are_told_as_they_begin(job):
    told = []
    process(job, told.append)
    assert told == ["reading", "reading", "repair", "integrate"]


def test_marks_of_a_killed_run_are_cleared_away(job, tmp_path):
    other = Store(tmp_path / "other")
    for _ in range(2):
        with other.claimed():
            place = tmp_path / "other" / "incoming"
            assert list(place.iterdir()) == []
            (place / "x.steps").write_text("reading")
            (place / "x.txt").write_text("somebody else's")
            (place / "x.txt").unlink()


def test_a_mark_that_cannot_be_written_stops_the_run(job, tmp_path):
    (tmp_path / "full").write_text("no folder")
    nowhere = Job("a", job.place, job.pipeline, str(tmp_path / "full"), seconds=1.0)
    outcome = process_in_time(nowhere, "one")
    assert outcome.outcome == "stopped"
    assert outcome.error.message == "results cannot be written: Not a directory" or (
        "File exists" in outcome.error.message
    )


def test_a_scheduler_that_allows_no_second_try_is_understood(job):
    distributed = pytest.importorskip("distributed")
    worker = SimpleNamespace(address="tcp://127.0.0.1:1")

    class Lost:
        key = "one"

        def result(self):
            raise distributed.KilledWorker("one", worker, 0)

    workers = Workers(None)
    mark = os.path.join(job.store, "incoming", "one.steps")
    with open(mark, "w") as file:
        file.write("reading\nTimeout (1:00:00)!\nThread 0x")
    error = _outcome_of(Lost(), job, workers).error
    assert (error.kind, error.step) == ("TimeLimitError", "reading")
    error = _outcome_of(Lost(), job, workers).error
    assert error.kind == "KilledWorker"
    assert "late on several machines" in error.message


def test_what_cannot_be_stopped_is_refused(job, tmp_path):
    distributed = pytest.importorskip("distributed")
    with pytest.raises(PipelineError, match="workers=1"):
        run_batch(job.place, STEPS, tmp_path / "x", workers=0, time_limit="1s")
    for threads in (1, 2):  # no processes, so nobody who would start another one
        with distributed.LocalCluster(
            n_workers=1,
            threads_per_worker=threads,
            processes=False,
            dashboard_address="127.0.0.1:0",
        ) as cluster:
            at = {"scheduler": cluster.scheduler_address, "time_limit": "1s"}
            with pytest.raises(BeltramiError, match="one thread, and with a nanny"):
                run_batch(job.place, STEPS, tmp_path / "x", **at)


def test_the_error_says_what_to_do():
    error = TimeLimitError(600.0)
    assert str(error).startswith("more than the 600 s were needed")
    assert isinstance(error, TimeoutError)
