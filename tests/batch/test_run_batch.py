import errno
import json
import os
import resource
import sys
import threading
import weakref

import numpy as np
import pytest

import beltrami as bt
from beltrami.batch import results
from beltrami.batch.failures import PipelineError, StoreError, StrictError
from beltrami.batch.memory import BASE
from beltrami.batch.run_batch import run_batch
from beltrami.batch.store import Store, is_name
from beltrami.errors import BeltramiError, MissingExtraError, UnknownNameError
from beltrami.io.npz import read_arrays

STEPS = "repair, spectrum k=5, descriptors count=4"


def run(meshes, out, steps=STEPS, **options):
    return run_batch(meshes, steps, out, **{"workers": 0} | options)


def test_one_row_for_each_mesh_good_or_corrupt(meshes, tmp_path, table, manifest):
    out = tmp_path / "out"
    found = run(meshes, out)
    assert (found.state.done, found.state.failed, found.left_out) == (3, 1, 1)
    rows = table(out)
    assert sorted(rows) == ["0.ply", "1.ply", "2.ply", "bad.ply"]
    assert [rows[name]["outcome"] for name in sorted(rows)] == ["done"] * 3 + ["failed"]
    bad = rows["bad.ply"]
    assert (bad["error_kind"], bad["error_step"]) == ("FileFormatError", "reading")
    assert "end_header" in bad["error"]
    assert bad["spectrum.eigenvalues"] is None
    basis = bt.fourier_basis(bt.laplacian(bt.read_mesh(meshes / "1.ply")), 5)
    assert rows["1.ply"]["spectrum.eigenvalues"] == basis.eigenvalues.tolist()
    assert len(rows["1.ply"]["descriptors.hks_mean"]) == 4
    head, lines = manifest(out)
    assert (head["meshes"], head["done"], head["failed"], head["complete"]) == (4, 3, 1, True)
    assert head["pipeline"][1]["k"] == 5
    assert head["versions"]["beltrami"] == lines["0.ply"]["versions"]["beltrami"]
    assert sorted(lines) == sorted(rows)
    assert lines["bad.ply"]["error"]["message"] == bad["error"]
    assert list(lines["0.ply"]["seconds"]) == ["reading", "repair", "spectrum", "descriptors"]
    assert found.failures[0].source.endswith("bad.ply")
    assert "spectrum" in lines["0.ply"]["files"]


@pytest.mark.skipif(sys.platform != "linux", reason="names of other systems are Unicode")
def test_names_that_are_no_unicode_lose_nothing(meshes, tmp_path, table, manifest):
    good, bad = (os.fsdecode(os.fsencode(meshes) + name) for name in (b"/\xff.ply", b"/\xfe.ply"))
    os.rename(meshes / "0.ply", good)
    os.rename(meshes / "bad.ply", bad)
    for sources in (meshes, [good, bad]):
        run(sources, tmp_path / "out")
        rows = table(tmp_path / "out")
        assert (rows["\\udcff.ply"]["outcome"], rows["\\udcfe.ply"]["outcome"]) == (
            "done",
            "failed",
        )
        assert manifest(tmp_path / "out")[1].keys() == rows.keys()


def test_files_are_there_under_the_names_of_their_contents(meshes, tmp_path, table):
    out = tmp_path / "out"
    run(meshes, out, "write format=off, laplacian, spectrum k=5, compress")
    row = table(out)["2.ply"]
    mesh = bt.read_mesh(meshes / "2.ply")
    for step in ("write", "laplacian", "spectrum", "compress"):
        assert is_name(row[f"{step}.file"])
    assert np.array_equal(bt.read_mesh(out / row["write.file"]).vertices, mesh.vertices)
    assert bt.decompress(out / row["compress.file"]).n_faces == mesh.n_faces
    assert bt.load_basis(out / row["spectrum.file"]).k == 5
    arrays = read_arrays(out / row["laplacian.file"], "arrays of a batch", 1)
    assert np.array_equal(arrays["stiffness_data"], bt.laplacian(mesh).stiffness.data)


def test_a_second_run_does_only_what_is_missing_or_changed(meshes, tmp_path, table):
    out = tmp_path / "out"
    run(meshes, out)
    before = {name: row["key"] for name, row in table(out).items()}
    assert run(meshes, out).state.reused == 4
    bt.write_mesh(meshes / "1.ply", bt.shapes.torus(9, 9))
    bt.write_mesh(meshes / "new.ply", bt.shapes.torus(9, 8))
    again = run(meshes, out)
    assert (again.state.done, again.state.reused) == (4, 3)
    after = {name: row["key"] for name, row in table(out).items()}
    assert {name for name in after if after[name] != before.get(name)} == {"1.ply", "new.ply"}
    assert run(meshes, out, STEPS.replace("5", "6")).state.reused == 0
    assert len(table(out)["0.ply"]["spectrum.eigenvalues"]) == 6
    assert run(meshes, out).state.reused == 5  # the first work is still there


def test_the_same_bytes_are_worked_on_once(meshes, tmp_path, table):
    (meshes / "copy.ply").write_bytes((meshes / "0.ply").read_bytes())
    out = tmp_path / "out"
    assert run(meshes, out).state.reused == 1
    rows = table(out)
    assert rows["copy.ply"]["key"] == rows["0.ply"]["key"]
    assert rows["copy.ply"]["spectrum.eigenvalues"] == rows["0.ply"]["spectrum.eigenvalues"]


def test_work_of_which_something_is_lost_is_done_again(meshes, tmp_path, table):
    out = tmp_path / "out"
    run(meshes, out)
    rows = table(out)
    key = rows["0.ply"]["key"]
    (out / rows["1.ply"]["spectrum.file"]).unlink()
    (out / rows["2.ply"]["spectrum.file"]).write_bytes(b"cut off")
    (out / "work" / key[:2] / f"{key}.json").write_bytes(b'{"format": 1')
    assert run(meshes, out).state.reused == 1  # the failure
    again = table(out)
    for name, row in rows.items():
        for column in row.keys() - {"seconds"}:
            assert again[name][column] == row[column], (name, column)
    assert run(meshes, out).state.reused == 4


def test_a_record_with_paths_out_of_the_folder_is_not_believed(meshes, tmp_path, table):
    out = tmp_path / "out"
    run(meshes, out)
    row = table(out)["0.ply"]
    path = out / "work" / row["key"][:2] / f"{row['key']}.json"
    record = json.loads(path.read_bytes())
    record["files"]["spectrum"]["name"] = "../../in/0.ply"
    path.write_text(json.dumps(record))
    assert run(meshes, out).state.reused == 3
    assert table(out)["0.ply"]["spectrum.file"] == row["spectrum.file"]


def test_redo(meshes, tmp_path):
    out = tmp_path / "out"
    run(meshes, out)
    assert run(meshes, out, redo="failed").state.reused == 3
    assert run(meshes, out, redo="all").state.reused == 0
    with pytest.raises(UnknownNameError):
        run(meshes, out, redo="some")


def test_strict_stops_at_the_first_failure(meshes, tmp_path, manifest):
    out = tmp_path / "out"
    (meshes / "0.ply").write_bytes(b"ply\n")
    with pytest.raises(StrictError, match=r"0\.ply: reading: ") as caught:
        run(meshes, out, strict=True)
    assert caught.value.source.endswith("0.ply")
    head, lines = manifest(out)
    assert (head["complete"], list(lines)) == (False, ["0.ply"])


def test_nothing_runs_if_the_pipeline_cannot(meshes, tmp_path):
    with pytest.raises(PipelineError):
        run(meshes, tmp_path / "out", "repair, spectrum k=0")
    assert not (tmp_path / "out").exists()


def test_a_failing_step_keeps_what_the_steps_before_it_found(meshes, tmp_path, table):
    out = tmp_path / "out"
    found = run(meshes / "0.ply", out, "diagnose, spectrum k=5000, descriptors")
    row = table(out)["0.ply"]
    assert (row["outcome"], row["error_step"]) == ("failed", "spectrum")
    assert "k must be from 1 to 84" in row["error"]
    assert row["diagnose.n_vertices"] == 84
    assert str(found.failures[0].error).startswith("spectrum: k must be")


def test_an_error_of_ours_stops_one_mesh_only(meshes, tmp_path, monkeypatch):
    def broken(mesh, **options):
        raise ZeroDivisionError("a mistake")

    monkeypatch.setattr("beltrami.batch.verbs_of_meshes.repair", broken)
    found = run(meshes, tmp_path / "out")
    assert found.state.failed == 4
    assert {one.error.kind for one in found.failures} == {"ZeroDivisionError", "FileFormatError"}


@pytest.mark.parametrize(
    "error", [OSError(errno.EIO, "no"), MissingExtraError("x", "batch", "it"), MemoryError()]
)
def test_what_circumstances_cause_is_tried_again(meshes, tmp_path, table, monkeypatch, error):
    def broken(mesh, **options):
        raise error

    out = tmp_path / "out"
    with monkeypatch.context() as patch:
        patch.setattr("beltrami.batch.verbs_of_meshes.repair", broken)
        run(meshes / "0.ply", out)
    row = table(out)["0.ply"]
    assert (row["outcome"], row["error_step"], row["key"]) == ("failed", "repair", None)
    assert run(meshes / "0.ply", out).state.done == 1


def test_ctrl_c_leaves_what_is_done_and_a_later_run_goes_on(meshes, tmp_path, table, manifest):
    out = tmp_path / "out"

    def interrupt(state):
        if state.ended == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(meshes, out, watch=interrupt)
    assert sorted(table(out)) == ["0.ply", "1.ply"]
    assert manifest(out)[0]["complete"] is False
    states = []
    assert run(meshes, out, watch=states.append).state.reused == 2
    assert [state.ended for state in states] == [1, 2, 3, 4]
    assert [state.last is not None for state in states] == [False, False, False, True]
    assert states[-1].rate > 0
    assert manifest(out)[0]["complete"] is True


@pytest.mark.skipif(sys.platform != "linux", reason="limits of Linux")
def test_a_full_disk_stops_the_run_and_loses_nothing(meshes, tmp_path, table):
    out = tmp_path / "out"
    run(meshes / "0.ply", out)
    before = (out / "results.parquet").read_bytes()
    _, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (2000, hard))  # no file may be longer
    try:
        with pytest.raises(StoreError, match="results cannot be written: File too large"):
            run(meshes, out)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (hard, hard))
    assert (out / "results.parquet").read_bytes() == before
    assert list((out / "incoming").iterdir()) == []
    again = run(meshes, out)
    assert (again.state.done, again.state.failed, again.state.reused) == (3, 1, 1)
    assert len(table(out)) == 4


def test_no_space_left_stops_the_run(meshes, tmp_path, monkeypatch):
    written = []

    def fsync(descriptor):
        written.append(descriptor)
        if len(written) > 6:
            raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("beltrami.batch.store.os.fsync", fsync)
    with pytest.raises(StoreError, match="No space left on device"):
        run(meshes, tmp_path / "out")
    monkeypatch.undo()
    found = run(meshes, tmp_path / "out")
    assert (found.state.done, found.state.failed) == (3, 1)
    assert found.state.reused > 0


def test_a_mesh_that_would_not_fit_fails_before_its_work(meshes, tmp_path, table, manifest):
    out = tmp_path / "out"
    steps = "diagnose, spectrum k=5, descriptors count=2000000"
    found = run(meshes / "0.ply", out, steps, memory="2GB")
    row = table(out)["0.ply"]
    assert row["error_kind"] == "TooLargeError"
    assert "is estimated to need 8.41 GB" in row["error"]
    assert "2.00 GB are allowed" in row["error"]
    assert row["diagnose.n_vertices"] is None
    assert row["key"] is None  # more memory may be there next time
    assert found.state.failed == 1
    allowed = run(meshes / "0.ply", out, "diagnose", memory=BASE + 10**8)
    assert allowed.state.done == 1


@pytest.mark.skipif(sys.platform != "linux", reason="limits of Linux")
def test_out_of_memory_is_a_clear_reason(meshes, tmp_path, monkeypatch):
    from beltrami.batch import limits
    from beltrami.batch.pipeline import as_pipeline
    from beltrami.batch.work import Job, process

    with open("/proc/self/status") as status:
        used = next(int(line.split()[1]) * 1024 for line in status if line.startswith("VmData"))
    steps = as_pipeline("spectrum k=5, descriptors count=2000000")
    out = Store(tmp_path / "out")
    job = Job("a", str(meshes / "0.ply"), steps, out.root)
    with out.claimed(), limits.at_most(int((used + 3 * 10**8) / limits.SHARE)):
        outcome = process(job)
    assert (outcome.outcome, outcome.error.step) == ("failed", "descriptors")
    assert "out of memory" in outcome.error.message
    assert outcome.key == ""


def test_limits_are_taken_back():
    from beltrami.batch import limits

    before = resource.getrlimit(resource.RLIMIT_DATA)
    with pytest.raises(ZeroDivisionError), limits.at_most(10**12):
        raise ZeroDivisionError
    assert resource.getrlimit(resource.RLIMIT_DATA) == before


def test_results_elsewhere(meshes, tmp_path):
    place = f"memory://{tmp_path.name}/results"
    assert run(meshes, place).state.done == 3
    again = run(meshes, place)
    assert again.state.reused == 4
    store = Store(place)
    assert store.size("results.parquet") > 0
    assert len(store.read(["manifest.jsonl"])[0].splitlines()) == 5


def test_results_elsewhere_of_meshes_that_all_fail(tmp_path):
    place = f"memory://{tmp_path.name}/results"
    assert run(f"memory://{tmp_path.name}/gone.ply", place).state.failed == 1
    assert len(Store(place).read(["manifest.jsonl"])[0].splitlines()) == 2


def test_no_row_without_its_record(meshes, tmp_path, monkeypatch):
    monkeypatch.setattr("beltrami.batch.results.decoded", lambda *_: None)
    with pytest.raises(StoreError, match="its record is not in the results"):
        run(meshes, tmp_path / "out")
    assert not (tmp_path / "out" / "results.parquet").exists()


def test_what_goes_wrong_after_reading_is_not_put_down_to_it(meshes, tmp_path, table, monkeypatch):
    def broken(record):
        raise TypeError("a mistake")

    monkeypatch.setattr("beltrami.batch.record.Record.encoded", broken)
    run(meshes / "0.ply", tmp_path / "out")
    row = table(tmp_path / "out")["0.ply"]
    assert (row["outcome"], row["error_kind"], row["error_step"]) == ("failed", "TypeError", None)


def test_a_store_that_cannot_be_read_stops_the_run(meshes, tmp_path):
    out = tmp_path / "out"
    run(meshes, out)
    record = next((out / "work").rglob("*.json"))
    record.unlink()
    record.mkdir()
    with pytest.raises(StoreError, match="results cannot be read: Is a directory"):
        run(meshes, out)


@pytest.mark.parametrize("place", ["nothing://x", "memory://results[1]"])
def test_a_place_that_can_have_no_results(meshes, place):
    with pytest.raises(StoreError):
        run(meshes, place)


def test_a_worker_that_cannot_reach_the_results_stops_the_run(meshes):
    from beltrami.batch.pipeline import as_pipeline
    from beltrami.batch.work import Job, process

    job = Job("a", str(meshes / "0.ply"), as_pipeline("diagnose"), "nothing://x")
    outcome = process(job)
    assert (outcome.outcome, outcome.error.kind) == ("stopped", "StoreError")


def test_results_among_the_sources_are_no_sources(meshes):
    out = meshes / "out"
    run(meshes, out, "write")
    assert run(meshes, out, "write").state.total == 4


def test_eight_threads_may_run_batches(meshes, tmp_path):
    states = {}

    def one(i):
        states[i] = run(meshes, tmp_path / str(i), "diagnose").state

    threads = [threading.Thread(target=one, args=(i,)) for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [states[i].done for i in range(8)] == [3] * 8


@pytest.mark.parametrize(
    "options", [{"workers": -1}, {"workers": 1.5}, {"memory": "much"}, {"workers": 2, "memory": 9}]
)
def test_options_that_cannot_be(meshes, tmp_path, options):
    with pytest.raises(BeltramiError):
        run(meshes, tmp_path / "out", **options)


def test_a_scheduler_that_is_not_there(meshes, tmp_path):
    with pytest.raises(PipelineError, match="a scheduler has its own workers"):
        run(meshes, tmp_path / "out", scheduler="tcp://127.0.0.1:1", workers=1)
    with pytest.raises(BeltramiError, match="no scheduler answers at nothing://"):
        run(meshes, tmp_path / "out", scheduler="nothing://x", workers=None)


@pytest.mark.parametrize("package", ["fsspec", "pyarrow.parquet", "distributed"])
def test_what_is_not_installed_is_named_before_the_work(meshes, tmp_path, monkeypatch, package):
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(MissingExtraError, match=r"beltrami\[batch\]"):
        run(meshes, tmp_path / "out", workers=1)


def test_the_table_does_not_depend_on_the_size_of_its_pieces(meshes, tmp_path, table, monkeypatch):
    run(meshes, tmp_path / "out")
    at_once = table(tmp_path / "out")
    monkeypatch.setattr("beltrami.batch.results._ROWS", 2)
    run(meshes, tmp_path / "out")
    assert table(tmp_path / "out") == at_once


def test_the_lines_of_the_manifest_are_not_all_in_memory(meshes, tmp_path, manifest, monkeypatch):
    class Text(str):
        __slots__ = ("__weakref__",)

    made, alive = [], []

    def line(outcome, record, real=results._line):
        alive.append(sum(one() is not None for one in made))
        text = Text(real(outcome, record))
        made.append(weakref.ref(text))
        return text

    monkeypatch.setattr(results, "_ROWS", 1)
    monkeypatch.setattr(results, "_line", line)
    run(meshes, tmp_path / "out")
    assert len(made) == len(manifest(tmp_path / "out")[1]) == 4
    assert max(alive) <= 1


def test_a_table_of_failures_alone_has_every_column(meshes, tmp_path):
    import pyarrow.parquet

    run(meshes / "bad.ply", tmp_path / "out")
    found = pyarrow.parquet.read_schema(tmp_path / "out" / "results.parquet")
    assert str(found.field("spectrum.eigenvalues").type) == "list<element: double>"
    assert str(found.field("repair.n_faces").type) == "int64"
    assert "descriptors.file" in found.names
