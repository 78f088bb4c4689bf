"""A real scheduler and real workers, and what happens when they die.

A source that is a named pipe blocks its worker until the test writes into it: so the test knows
that a worker is in the middle of a mesh, without a clock.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from contextlib import suppress

import pytest

from beltrami.batch.run_batch import run_batch
from beltrami.io.registry import write_mesh
from beltrami.mesh.shapes import torus

pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")

STEPS = "repair, spectrum k=4, write"
LONG = 60  # seconds after which a test that hangs is given up


@pytest.fixture(scope="module")
def cluster():
    """Start a scheduler and two workers, as separate processes."""
    dask = pytest.importorskip("dask")
    distributed = pytest.importorskip("distributed")
    settings = {
        "distributed.scheduler.allowed-failures": 1,
        "distributed.worker.memory.spill": False,
        "distributed.worker.memory.target": False,
        "distributed.worker.memory.pause": False,
    }
    with (
        dask.config.set(settings),
        distributed.LocalCluster(
            n_workers=2,
            threads_per_worker=1,
            dashboard_address="127.0.0.1:0",
            memory_limit="1GB",
            silence_logs=60,
        ) as started,
    ):
        yield started


@pytest.fixture
def pipe(tmp_path):
    """Make a mesh that is a named pipe."""
    path = tmp_path / "z.ply"
    os.mkfifo(path)
    return path


@pytest.fixture
def good(tmp_path):
    """Write four meshes; return their names."""
    names = [tmp_path / f"{i}.ply" for i in range(4)]
    for i, name in enumerate(names):
        write_mesh(name, torus(12, 7 + i))
    return names


def kill_busy(cluster, but=None):
    """Kill the worker that has a job, if it is not this one; return its process when it is gone."""
    from distributed import Client

    with Client(cluster.scheduler_address) as client:
        for _ in range(20 * LONG):
            pids = client.run(os.getpid)
            busy = [pids.get(worker) for worker, jobs in client.processing().items() if jobs]
            if len(busy) == 1 and busy[0] not in (None, but):
                break
            time.sleep(0.05)
    os.kill(busy[0], signal.SIGKILL)
    with suppress(ProcessLookupError):
        for _ in range(20 * LONG):
            os.kill(busy[0], 0)
            time.sleep(0.05)
    return busy[0]


class _Counting(threading.Event):
    """An event that is set when so many meshes have ended."""

    def __init__(self, wanted):
        super().__init__()
        self.wanted = wanted

    def __call__(self, state):
        if state.ended == self.wanted:
            self.set()


def in_thread(function):
    """Start a function in a thread; return its results, in a list, and the thread."""
    results = []
    thread = threading.Thread(target=lambda: results.append(function()), daemon=True)
    thread.start()
    return results, thread


def test_the_mesh_of_a_killed_worker_is_done_again_and_none_twice(
    cluster, good, pipe, tmp_path, table
):
    out, ended = tmp_path / "out", _Counting(4)
    address = cluster.scheduler_address
    results, thread = in_thread(
        lambda: run_batch([*good, pipe], STEPS, out, scheduler=address, watch=ended)
    )
    write_mesh(tmp_path / "whole.ply", torus(9, 9))
    content = (tmp_path / "whole.ply").read_bytes()
    with pipe.open("wb", buffering=0) as file:  # waits for a worker to read
        assert ended.wait(LONG)
        kill_busy(cluster)
        try:
            file.write(content)  # the next worker reads already
        except BrokenPipeError:
            with pipe.open("wb") as again:  # waits for it
                again.write(content)
    thread.join(LONG)
    assert [(r.state.done, r.state.failed) for r in results] == [(5, 0)]
    rows = table(out)
    assert sorted(rows) == ["0.ply", "1.ply", "2.ply", "3.ply", "z.ply"]
    assert rows["z.ply"]["repair.n_vertices"] == 81
    assert len(list((out / "work").rglob("*.json"))) == 5
    assert list((out / "incoming").iterdir()) == []


def test_a_mesh_that_kills_every_worker_fails_and_stops_nobody(
    cluster, good, pipe, tmp_path, table
):
    out, ended = tmp_path / "out", _Counting(4)
    address = cluster.scheduler_address
    results, thread = in_thread(
        lambda: run_batch([*good, pipe], STEPS, out, scheduler=address, watch=ended)
    )
    with pipe.open("wb"):
        assert ended.wait(LONG)
        kill_busy(cluster, but=kill_busy(cluster))
    thread.join(LONG)
    assert [(r.state.done, r.state.failed) for r in results] == [(4, 1)]
    row = table(out)["z.ply"]
    assert (row["error_kind"], row["key"]) == ("KilledWorker", None)
    assert "the worker died" in row["error"]
    assert "2 times" in row["error"]


def pids(cluster):
    from distributed import Client

    with Client(cluster.scheduler_address) as client:
        client.wait_for_workers(2)
        return set(client.run(os.getpid).values())


def test_a_mesh_that_hangs_fails_at_its_limit_and_ends_one_worker_once(
    cluster, good, pipe, tmp_path, table
):
    """Nobody writes into the pipe; the others are known from before."""
    out, address = tmp_path / "out", cluster.scheduler_address
    run_batch(good, STEPS, out, workers=0)
    before = pids(cluster)
    done = run_batch([*good, pipe], STEPS, out, scheduler=address, time_limit="3s")
    after = pids(cluster)
    assert (done.state.done, done.state.failed) == (4, 1)
    row = table(out)["z.ply"]
    assert (row["error_kind"], row["error_step"]) == ("TimeLimitError", "reading")
    assert (row["outcome"], row["key"]) == ("failed", None)
    assert list((out / "incoming").iterdir()) == []
    assert len(before & after) == 1  # it was not tried a second time
    write_mesh(tmp_path / "whole.ply", torus(9, 9))
    content = (tmp_path / "whole.ply").read_bytes()
    _, thread = in_thread(lambda: pipe.write_bytes(content))
    again = run_batch([*good, pipe], STEPS, out, scheduler=address)
    thread.join(LONG)
    assert (again.state.done, again.state.reused) == (5, 4)


def test_nobody_else_can_talk_to_the_workers_of_this_machine(good, tmp_path):
    import distributed

    from beltrami.batch.cluster import local_workers, on_workers
    from beltrami.batch.pipeline import as_pipeline
    from beltrami.batch.store import Store
    from beltrami.batch.work import Job

    store = Store(tmp_path / "out")
    job = Job("a", str(good[0]), as_pipeline(STEPS), store.root, 10**9)
    with store.claimed(), local_workers(1, 10**9) as workers:
        assert [outcome.outcome for outcome in on_workers(workers, iter([job]))] == ["done"]
        address = workers.client.scheduler_info()["address"]
        # a worker whose compiled code keeps it silent for minutes is not given up
        ttl = workers.client.run_on_scheduler(lambda dask_scheduler: dask_scheduler.worker_ttl)
        assert ttl is None
        assert address.startswith("tls://127.0.0.1:")
        for stranger in (address, address.replace("tls", "tcp")):
            security = distributed.Security.temporary() if stranger == address else None
            with pytest.raises(OSError, match=r"."):
                distributed.Client(stranger, timeout="1s", security=security)


CLIENT = """
import sys
from beltrami.batch.run_batch import run_batch
if __name__ == "__main__":
    run_batch(sys.argv[2:], sys.argv[1], "out", workers=1, memory="2GB")
"""


def client(tmp_path, names, *, group=False):
    """Start a batch with a worker in a process of its own."""
    script = tmp_path / "client.py"
    script.write_text(CLIENT)
    command = [sys.executable, script, STEPS, *map(str, names)]
    return subprocess.Popen(
        command, cwd=tmp_path, stderr=subprocess.PIPE, text=True, start_new_session=group
    )


def write_for_ever(file):
    while True:
        os.write(file.fileno(), b" ")


@pytest.mark.parametrize("how", ["SIGKILL", "SIGINT"])
def test_a_client_that_is_killed_or_interrupted_goes_on_later(good, pipe, tmp_path, table, how):
    running = client(tmp_path, [*good, pipe], group=True)
    with pipe.open("wb") as file:
        if how == "SIGKILL":
            running.kill()
        else:
            os.killpg(running.pid, signal.SIGINT)  # as a terminal does
        _, errors = running.communicate(timeout=LONG)
        with pytest.raises(BrokenPipeError):  # its worker ends too
            write_for_ever(file)
    if how == "SIGINT":
        assert {"0.ply", "1.ply", "2.ply"} <= set(table(tmp_path / "out"))
        assert errors.rstrip().endswith("KeyboardInterrupt")
        assert errors.count("Traceback") == 1
    results, thread = in_thread(
        lambda: run_batch([*good, pipe], STEPS, tmp_path / "out", workers=0)
    )
    write_mesh(tmp_path / "whole.ply", torus(9, 9))
    with pipe.open("wb") as file:
        file.write((tmp_path / "whole.ply").read_bytes())
    thread.join(LONG)
    assert [(r.state.done, r.state.reused) for r in results] == [(5, 4)]
    assert len(table(tmp_path / "out")) == 5
    assert list((tmp_path / "out" / "incoming").iterdir()) == []
