import zipfile

import pytest

from beltrami.batch.sources import find_sources
from beltrami.errors import BeltramiError


@pytest.fixture
def folder(tmp_path):
    for name in ("a.ply", "b.OBJ", "sub/c.off.gz", "sub/d.txt", "sub/x[1].stl", "out/e.ply"):
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(b"")
    return tmp_path


def names(found, folder):
    return [source.name.removeprefix(f"{folder}/") for source in found.sources]


def test_a_folder_stands_for_its_meshes(folder):
    found = find_sources(folder, str(folder / "out"))
    assert names(found, folder) == ["a.ply", "b.OBJ", "sub/c.off.gz", "sub/x[1].stl"]
    assert found.left_out == 2  # no mesh, and a result


def test_patterns_names_and_repetitions(folder, monkeypatch):
    monkeypatch.chdir(folder)
    given = ["**/*.ply", "./a.ply", folder / "a.ply", "sub/x[1].stl", "sub/d.txt"]
    found = find_sources(given)
    assert len(found.sources) == 4
    assert {source.place.removeprefix(f"{folder}/") for source in found.sources} == {
        "a.ply",
        "out/e.ply",
        "sub/x[1].stl",
        "sub/d.txt",  # named by itself: it fails when it is read
    }


def test_the_order_is_that_of_the_names(folder):
    forth = find_sources([folder / "a.ply", folder / "b.OBJ"])
    back = find_sources([folder / "b.OBJ", folder / "a.ply"])
    assert forth == back


def test_urls(folder):
    http = "https://example.org/a.ply?x=[1]*"
    assert [s.place for s in find_sources([http]).sources] == [http]
    with zipfile.ZipFile(folder / "meshes.zip", "w") as archive:
        for name in ("x/a.ply", "x/b.obj", "x/notes.txt", "../evil.ply"):
            archive.writestr(name, b"")
    url = f"zip://x/*::{folder / 'meshes.zip'}"
    found = find_sources(url)
    assert [s.place.partition("::")[0] for s in found.sources] == ["zip://x/a.ply", "zip://x/b.obj"]
    assert found.left_out == 1


@pytest.mark.parametrize("wanted", ["missing.ply", "*.nothing", "sub/*.txt", "sub/no*"])
def test_nothing_there_is_an_error_before_the_work(folder, monkeypatch, wanted):
    monkeypatch.chdir(folder)
    with pytest.raises(FileNotFoundError) as caught:
        find_sources(["a.ply", wanted])
    assert caught.value.filename == wanted


@pytest.mark.parametrize("wanted", [[], [3], [None], 3, b"a.ply"])
def test_what_is_no_source(wanted):
    with pytest.raises(BeltramiError):
        find_sources(wanted)


def test_a_url_of_nothing_known():
    with pytest.raises(BeltramiError, match="cannot be searched: Protocol not known: nothing"):
        find_sources("nothing://x/*.ply")
