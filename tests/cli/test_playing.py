"""Chapters in several processes: the same as one after another, and none waits for another."""

import os
import signal
from dataclasses import replace
from multiprocessing import active_children

import pytest

from beltrami.cli import playing
from beltrami.cli.chapters.chapter import Stage
from beltrami.errors import BeltramiError
from beltrami.mesh.shapes import grid, icosphere


def stage(folder, mesh=None):
    folder.mkdir()
    return Stage("mesh.ply", mesh or icosphere(2), folder, "y", None)


def timeless(played):
    return [(replace(chapter, seconds=None), possible) for chapter, possible in played]


def test_two_processes_play_what_one_plays(tmp_path, monkeypatch):
    monkeypatch.setattr(playing, "_cores", lambda: 2)
    few = ("geodesics", "files", "surface")
    monkeypatch.setattr(playing, "CHAPTERS", few)
    steps = []
    one = playing.play(stage(tmp_path / "one"), lambda done, total: steps.append((done, total)))
    assert steps == [(0, 3), (1, 3), (2, 3)]
    monkeypatch.setattr(playing, "LARGE", 0)
    two = playing.play(stage(tmp_path / "two"), lambda done, total: steps.append((done, total)))
    assert steps[3:] == [(1, 3), (2, 3), (3, 3)]
    assert timeless(two) == timeless(one)
    assert all(chapter.seconds > 0 for chapter, _ in two)
    for path in (tmp_path / "one").iterdir():
        assert (tmp_path / "two" / path.name).read_bytes() == path.read_bytes()


def test_each_chapter_has_files_of_its_own(tmp_path):
    owners = {}
    for name in playing.CHAPTERS:
        _, possible = playing.play_one(stage(tmp_path / name), name)
        assert possible
        for path in (tmp_path / name).iterdir():
            assert owners.setdefault(path.name, name) == name


def test_a_chapter_that_cannot_be_played_says_why(tmp_path, monkeypatch):
    import beltrami.cli.chapters.files as module

    def refused(_):
        raise BeltramiError("the disk is full")

    monkeypatch.setattr(module, "files", refused)
    chapter, possible = playing.play_one(stage(tmp_path / "a", grid(3, 3)), "files")
    assert not possible
    assert (chapter.title, chapter.text) == ("Files", ("Not on this mesh: the disk is full",))


def test_processes_have_one_thread_and_what_was_set_stays(monkeypatch):
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "3")
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    with playing._one_thread_each():
        assert (os.environ["OMP_NUM_THREADS"], os.environ["OPENBLAS_NUM_THREADS"]) == ("1", "3")
    assert "OMP_NUM_THREADS" not in os.environ
    assert os.environ["OPENBLAS_NUM_THREADS"] == "3"


def test_a_process_that_was_asked_to_leave_plays_no_other_chapter(tmp_path):
    before = signal.getsignal(signal.SIGINT)
    here = stage(tmp_path / "a")
    try:
        playing._leave_when_asked()
        assert playing._play_in_process(here, "files")[1]
        with pytest.raises(SystemExit, match="130"):
            signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)  # again, while it tidies up
        with pytest.raises(SystemExit, match="130"):
            playing._play_in_process(here, "files")
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("error", [KeyboardInterrupt, BeltramiError])
def test_no_process_is_left_behind(tmp_path, monkeypatch, error):
    monkeypatch.setattr(playing, "_cores", lambda: 2)
    monkeypatch.setattr(playing, "CHAPTERS", ("geodesics", "files", "surface"))
    monkeypatch.setattr(playing, "LARGE", 0)

    def fail(done, total):
        raise error

    with pytest.raises(error):
        playing.play(stage(tmp_path / "a"), fail)
    assert not active_children()


@pytest.mark.parametrize("name", playing.CHAPTERS)
def test_the_chapters_are_there(name):
    module = __import__(f"beltrami.cli.chapters.{name}", fromlist=[name])
    assert callable(getattr(module, name))


def test_the_longest_are_chapters():
    assert set(playing._LONGEST) < set(playing.CHAPTERS)
