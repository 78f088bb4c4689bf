import errno
import os
import subprocess
import sys

import pytest

from beltrami.batch.failures import StoreError
from beltrami.batch.store import Store, is_name, work_name
from beltrami.errors import MeshError


def names_in(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())


@pytest.fixture(params=["local", "memory"])
def store(request, tmp_path):
    place = tmp_path / "out" if request.param == "local" else f"memory://{tmp_path.name}/out"
    made = Store(place)
    with made.claimed():
        yield made


def test_a_file_has_the_name_of_its_content(store):
    kept = store.keep(".npz", lambda path: path.write_bytes(b"abc"))
    digest = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    assert (kept.name, kept.sha256, kept.bytes) == (f"files/ba/{digest}.npz", digest, 3)
    assert is_name(kept.name)
    assert store.size(kept.name) == 3
    assert store.keep(".npz", lambda path: path.write_bytes(b"abc")) == kept
    assert store.read([kept.name, "files/none"]) == [b"abc", None]
    assert store.size("files/none") is None


def test_trouble_elsewhere_is_not_taken_for_a_file_that_is_not_there(tmp_path, monkeypatch):
    store = Store(f"memory://{tmp_path.name}/out")
    failing = {f"/{tmp_path.name}/out/files/x": TimeoutError("no answer")}
    monkeypatch.setattr(store._files, "cat", lambda *_, **__: failing)
    assert store.read([]) == []
    with pytest.raises(StoreError, match="results cannot be read: TimeoutError: no answer"):
        store.read(["files/x"])


def test_a_record_is_replaced_as_a_whole(store):
    name = work_name("ab" * 32)
    store.replace(name, lambda path: path.write_bytes(b"one"))
    store.replace(name, lambda path: path.write_bytes(b"three"))
    assert store.read([name]) == [b"three"]


@pytest.mark.parametrize(
    ("error", "raised"),
    [
        (OSError(errno.ENOSPC, "No space left on device"), StoreError),
        (MeshError("no"), MeshError),
        (MemoryError(), MemoryError),
        (KeyboardInterrupt(), KeyboardInterrupt),
    ],
)
def test_whatever_happens_while_writing_nothing_is_left(tmp_path, error, raised):
    store = Store(tmp_path)

    def half(path):
        path.write_bytes(b"half")
        raise error

    with store.claimed(), pytest.raises(raised) as caught:
        store.keep(".npz", half)
    assert names_in(tmp_path) == [".lock"]
    if raised is StoreError:
        assert "No space left on device" in str(caught.value)
        assert caught.value.errno == errno.ENOSPC


def test_what_a_killed_run_left_is_cleared_away(tmp_path):
    left = tmp_path / "incoming" / "part-x"
    left.mkdir(parents=True)
    (left / "whole.npz").write_bytes(b"half")
    with Store(tmp_path).claimed():
        assert names_in(tmp_path) == [".lock"]


def test_two_runs_do_not_write_to_one_place(tmp_path):
    code = (
        "import sys; from beltrami.batch.store import Store\n"
        "with Store(sys.argv[1]).claimed(): print('mine')"
    )
    command = [sys.executable, "-c", code, str(tmp_path)]
    with Store(tmp_path).claimed():
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert "another batch is writing its results" in done.stderr
    assert subprocess.run(command, capture_output=True, check=True).stdout == b"mine\n"


@pytest.mark.parametrize("name", ["files", "work", "incoming"])
def test_a_link_out_of_the_folder_is_not_followed(tmp_path, name):
    out, other = tmp_path / "out", tmp_path / "other"
    out.mkdir()
    other.mkdir()
    (out / name).symlink_to(other, target_is_directory=True)

    def attempt():
        store = Store(out)
        with store.claimed():
            store.keep(".npz", lambda path: path.write_bytes(b"abc"))
            store.replace(work_name("ab" * 32), lambda path: path.write_bytes(b"abc"))

    with pytest.raises(StoreError, match="leads out of the results"):
        attempt()
    assert list(other.iterdir()) == []  # no folder either


@pytest.mark.parametrize(
    "name",
    [
        "files/../../evil.npz",
        "/etc/passwd",
        "files/ab/" + "ab" * 32 + ".npz/../../x",
        "files/cd/" + "ab" * 32 + ".npz",
        "files/ab/" + "ab" * 31 + ".npz",
        "files/ab/" + "ab" * 32 + ".npz\n",
        "FILES/ab/" + "ab" * 32 + ".npz",
        3,
    ],
)
def test_names_that_a_store_does_not_make(name):
    assert not is_name(name)


@pytest.mark.parametrize("key", ["", "../x", "ab" * 33, "AB" * 32, "ab" * 31 + "/."])
def test_keys_that_are_none(key):
    with pytest.raises(StoreError):
        work_name(key)


def test_a_place_that_cannot_be_written(tmp_path):
    (tmp_path / "file").write_text("x")
    with pytest.raises(StoreError, match="cannot be written"), Store(tmp_path / "file").claimed():
        pass
    assert os.path.isfile(tmp_path / "file")
