"""Faults that take long to provoke, or need rights: a worker out of memory, a full disk."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from contextlib import suppress

import pytest

from beltrami.batch.cluster import local_workers, on_workers
from beltrami.batch.failures import StoreError
from beltrami.batch.pipeline import as_pipeline
from beltrami.batch.run_batch import run_batch
from beltrami.batch.store import Store
from beltrami.batch.work import Job
from beltrami.io.registry import write_mesh
from beltrami.mesh.shapes import torus

pytestmark = pytest.mark.heavy

STEPS = "repair, spectrum k=4, laplacian"


@pytest.mark.skipif(sys.platform != "linux", reason="named pipes and limits of Linux")
def test_a_worker_out_of_memory_is_stopped_and_that_is_the_reason(tmp_path):
    pipe, good = tmp_path / "z.ply", tmp_path / "a.ply"
    os.mkfifo(pipe)
    write_mesh(good, torus(9, 9))
    store = Store(tmp_path / "out")
    steps = as_pipeline(STEPS)
    # without a limit of its own, so that it is the process that watches over it that stops it
    jobs = [Job(path.name, str(path), steps, store.root) for path in (pipe, good)]

    def fill():
        for _ in range(2):
            with suppress(BrokenPipeError), pipe.open("wb", buffering=0) as file:
                while True:
                    file.write(bytes(1 << 20))

    threading.Thread(target=fill, daemon=True).start()
    with store.claimed(), local_workers(1, 600_000_000) as workers:
        outcomes = {outcome.name: outcome for outcome in on_workers(workers, iter(jobs))}
    assert outcomes["a.ply"].outcome == "done"
    error = outcomes["z.ply"].error
    assert error.kind == "KilledWorker"
    assert error.message.startswith("out of memory: the worker went beyond its limit")
    assert outcomes["z.ply"].key == ""


@pytest.fixture
def small_disk(tmp_path):
    """Mount a file system of two megabytes."""
    place = tmp_path / "disk"
    place.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=2m", "tmpfs", str(place)]
    done = subprocess.run(mount, capture_output=True, text=True, check=False)
    if done.returncode:
        pytest.skip(f"a small file system cannot be mounted here: {done.stderr.strip()}")
    yield place
    subprocess.run(["umount", "-l", str(place)], check=True)


@pytest.mark.parametrize("workers", [0, 2])
def test_a_full_disk(small_disk, tmp_path, table, workers):
    names = [tmp_path / f"{i}.ply" for i in range(12)]
    for i, name in enumerate(names):
        write_mesh(name, torus(40, 30 + i))
    out = small_disk / "out"
    with pytest.raises(StoreError, match="results cannot be written: No space left on device"):
        run_batch(names, STEPS, out, workers=workers)
    kept = len(list((out / "work").rglob("*.json")))
    assert 0 < kept < 12
    assert list((out / "incoming").iterdir()) == []
    subprocess.run(["mount", "-o", "remount,size=50m", str(small_disk)], check=True)
    again = run_batch(names, STEPS, out, workers=workers)
    assert (again.state.done, again.state.failed, again.state.reused) == (12, 0, kept)
    assert len(table(out)) == 12


def test_a_scheduler_that_is_lost_is_told(tmp_path):
    """The scheduler is a process of its own, which is killed while a worker works."""
    from beltrami.errors import BeltramiError

    pipe = tmp_path / "z.ply"
    os.mkfifo(pipe)
    code = (
        "import distributed, time\n"
        "if __name__ == '__main__':\n"
        "    c = distributed.LocalCluster(n_workers=1, threads_per_worker=1,\n"
        "        dashboard_address='127.0.0.1:0')\n"
        "    print(c.scheduler_address, flush=True)\n"
        "    time.sleep(600)\n"
    )
    (tmp_path / "scheduler.py").write_text(code)
    command = [sys.executable, str(tmp_path / "scheduler.py")]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as running:
        address = running.stdout.readline().strip()
        errors = []

        def attempt():
            try:
                run_batch(pipe, STEPS, tmp_path / "out", scheduler=address)
            except BeltramiError as error:
                errors.append(error)

        thread = threading.Thread(target=attempt, daemon=True)
        thread.start()
        with pipe.open("wb"):
            running.kill()
            thread.join(120)
    assert len(errors) == 1
    assert "the scheduler was lost" in str(errors[0])
