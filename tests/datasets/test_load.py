"""Data sets come from a folder or from a server, with the digest of the registry, or not at all."""

import hashlib
import sys
import threading
from dataclasses import replace
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer

import pytest
from typer.testing import CliRunner

import beltrami as bt
from beltrami.cli.app import app
from beltrami.datasets.registry import DATASETS, Dataset
from beltrami.errors import DatasetError, MissingExtraError, UnknownNameError

CONTENT = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
SHA256 = hashlib.sha256(CONTENT).hexdigest()


class Quiet(SimpleHTTPRequestHandler):
    asked: list[str] = []  # noqa: RUF012 - one server at a time

    def do_GET(self):
        self.asked.append(self.path)
        super().do_GET()

    def log_message(self, *args):
        pass


@pytest.fixture
def server(tmp_path, monkeypatch):
    """Serve a folder on this machine, and return the folder and the requests."""
    folder = tmp_path / "served"
    folder.mkdir()
    (folder / "triangle.obj").write_bytes(CONTENT)
    Quiet.asked.clear()
    serving = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(folder)))
    thread = threading.Thread(target=serving.serve_forever, args=(0.01,))
    thread.start()
    monkeypatch.setenv("NO_PROXY", "127.0.0.1")
    one = Dataset(
        "triangle", "triangle.obj", "", f"http://127.0.0.1:{serving.server_port}/triangle.obj",
        SHA256, len(CONTENT), "CC0", "nobody", 3, 1, 0, 1,
    )  # fmt: skip
    monkeypatch.setitem(DATASETS, "triangle", one)
    yield folder
    serving.shutdown()
    thread.join()
    serving.server_close()


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """An empty cache of the user, and no local folder."""
    pooch = pytest.importorskip("pooch")
    monkeypatch.delenv("BELTRAMI_DATA", raising=False)
    monkeypatch.setattr(pooch, "os_cache", lambda name: tmp_path / "cache" / name)
    return tmp_path / "cache" / "beltrami"


def test_names_that_do_not_exist():
    with pytest.raises(UnknownNameError) as caught:
        bt.datasets.load("spott")
    assert caught.value.choices == bt.datasets.names()


def test_fetched_once(server, cache):
    mesh = bt.datasets.load("triangle")
    assert (mesh.n_vertices, mesh.n_faces) == (3, 1)
    assert bt.datasets.fetch("triangle") == cache / "triangle.obj"
    assert Quiet.asked == ["/triangle.obj"]


def test_a_changed_file_in_the_cache_is_fetched_again(server, cache):
    bt.datasets.fetch("triangle").write_bytes(CONTENT[:-6])
    assert bt.datasets.fetch("triangle").read_bytes() == CONTENT
    assert len(Quiet.asked) == 2


def test_another_file_than_promised_is_not_kept(server, cache):
    (server / "triangle.obj").write_bytes(CONTENT + b"#")
    with pytest.raises(DatasetError, match="BELTRAMI_DATA") as caught:
        bt.datasets.load("triangle")
    assert caught.value.path == str(cache / "triangle.obj")
    assert not [path for path in cache.rglob("*") if path.is_file()]


@pytest.mark.parametrize("why", ["no page", "no server"])
def test_offline_says_which_file_and_where_to_put_it(server, cache, monkeypatch, why):
    url = DATASETS["triangle"].url
    gone = url + "x" if why == "no page" else "http://127.0.0.1:9/triangle.obj"
    monkeypatch.setitem(DATASETS, "triangle", replace(DATASETS["triangle"], url=gone))
    with pytest.raises(DatasetError) as caught:
        bt.datasets.load("triangle")
    place = cache / "triangle.obj"
    assert f"Put {gone} there by hand, as {place}" in str(caught.value)
    place.parent.mkdir(parents=True, exist_ok=True)
    place.write_bytes(CONTENT)  # as it says
    assert bt.datasets.load("triangle").n_faces == 1


def test_a_cache_that_cannot_be_made_is_told(server, cache):
    cache.parent.write_bytes(b"")
    with pytest.raises(DatasetError, match="cannot fetch"):
        bt.datasets.load("triangle")


def test_without_pooch_the_extra_is_named(monkeypatch):
    monkeypatch.delenv("BELTRAMI_DATA", raising=False)
    monkeypatch.setitem(sys.modules, "pooch", None)
    with pytest.raises(MissingExtraError, match=r"spot_triangulated.obj.*beltrami\[data\]"):
        bt.datasets.load("spot")


@pytest.fixture
def local(tmp_path, monkeypatch):
    """A local folder with the triangle; nothing may be fetched."""
    monkeypatch.setenv("BELTRAMI_DATA", str(tmp_path))
    monkeypatch.setitem(sys.modules, "pooch", None)
    one = replace(DATASETS["spot"], name="triangle", file="triangle.obj", sha256=SHA256)
    monkeypatch.setitem(DATASETS, "triangle", one)
    (tmp_path / "triangle.obj").write_bytes(CONTENT)
    return tmp_path


def test_a_local_folder_needs_no_network(local):
    assert bt.datasets.fetch("triangle") == local / "triangle.obj"
    assert bt.datasets.load("triangle").n_vertices == 3


def test_what_a_local_folder_lacks_is_told(local):
    (local / "triangle.obj").unlink()
    with pytest.raises(DatasetError, match="not in the folder of BELTRAMI_DATA") as caught:
        bt.datasets.load("triangle")
    assert caught.value.path == str(local / "triangle.obj")


def test_another_file_in_a_local_folder_is_told(local):
    (local / "triangle.obj").write_bytes(CONTENT + b"#")
    with pytest.raises(DatasetError, match="SHA-256"):
        bt.datasets.load("triangle")


def test_the_command_takes_data_sets(local):
    done = CliRunner().invoke(app, ["info", "dataset:triangle"])
    assert done.exit_code == 0
    assert "3 vertices" in done.output
    (local / "triangle.obj").unlink()
    for name in ("triangle", "spott"):
        done = CliRunner().invoke(app, ["info", f"dataset:{name}"])
        assert done.exit_code == 1
        assert done.output.startswith("beltrami: ")
        assert len(done.output.splitlines()) == 1
