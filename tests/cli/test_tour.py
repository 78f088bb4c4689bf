import re
import shlex
import shutil

import pytest
from typer.testing import CliRunner

from beltrami.cli.app import app
from beltrami.io.registry import read_mesh, write_mesh
from beltrami.mesh.shapes import icosphere


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("made once")
    write_mesh(place / "a sphere é.ply", icosphere(2))
    words = ["tour", str(place / "a sphere é.ply"), "-o", str(place / "a tour")]
    done = CliRunner(env={"COLUMNS": "200"}).invoke(app, words)
    assert done.exit_code == 0, done.stderr
    assert done.stderr == ""
    return place / "a tour"


def test_everything_the_page_names_is_there(folder):
    page = (folder / "index.html").read_text(encoding="utf-8")
    named = re.findall(r'(?:src|href)="([^"#][^"]*)"', page)
    assert len(named) >= 10
    assert all((folder / name).stat().st_size > 0 for name in named)
    assert {path.name for path in folder.iterdir()} == {*named, "index.html"}
    assert "Not on this mesh" not in page
    assert "None" not in page


def test_its_commands_run_in_its_folder(folder, beltrami, monkeypatch, tmp_path):
    folder = shutil.copytree(folder, tmp_path / "a tour")
    monkeypatch.chdir(folder)
    blocks = re.findall(r"<pre>(.*?)</pre>", (folder / "index.html").read_text("utf-8"), re.S)
    smoothed = read_mesh("smoothed.ply").vertices.copy()
    interactive = (folder / "page.html").read_bytes()
    for command in "\n".join(blocks).splitlines():
        done = beltrami(*shlex.split(command)[1:])
        assert done.exit_code == 0, done.stderr
    assert (read_mesh("smoothed.ply").vertices == smoothed).all()
    assert (folder / "page.html").read_bytes() == interactive


def test_a_mesh_with_defects_is_repaired_on_a_copy(beltrami, stray, tmp_path):
    done = beltrami("tour", stray, "-o", tmp_path / "tour")
    assert done.exit_code == 0, done.stderr
    assert "removed 1 degenerate face" in done.stdout
    assert "removed 1 degenerate face" in (tmp_path / "tour" / "index.html").read_text("utf-8")
    assert read_mesh(tmp_path / "tour" / "mesh.ply").n_faces == 1


def test_nothing_to_show(beltrami, tmp_path):
    path = tmp_path / "line.off"
    path.write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n")
    done = beltrami("tour", path, "-o", tmp_path / "tour")
    assert done.exit_code == 1
    assert "no face has an area" in done.stderr
    assert not (tmp_path / "tour").exists()


def test_a_wrong_axis_is_told_before_the_work(beltrami, sphere, tmp_path):
    done = beltrami("tour", sphere, "-o", tmp_path / "tour", "--up", "q")
    assert done.exit_code == 1
    assert not (tmp_path / "tour").exists()


def test_what_a_chapter_warns_of_is_on_the_page(beltrami, sphere, tmp_path, monkeypatch):
    import warnings

    import beltrami.cli.chapters.files as module

    real = module.files

    def warning(stage):
        for _ in range(2):
            warnings.warn("the disk is <slow>", stacklevel=1)
        return real(stage)

    monkeypatch.setattr(module, "files", warning)
    done = beltrami("tour", sphere, "-o", tmp_path / "tour")
    assert done.exit_code == 0, done.stderr
    page = (tmp_path / "tour" / "index.html").read_text("utf-8")
    assert page.count("Warning: the disk is &lt;slow&gt;") == 1
    assert re.search(r"\d+ chapters in \d+ seconds", page)
    assert len(re.findall(r"· \d+\.\d s</p>", page)) >= 8
