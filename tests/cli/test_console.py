import io
import json
import time

import numpy as np
import pytest
from rich.console import Console

from beltrami.cli import console


@pytest.fixture
def screen(monkeypatch):
    """Put a screen in the place of stderr: a terminal or a file."""

    def put(terminal):
        text = io.StringIO()
        monkeypatch.setattr(
            console, "Console", lambda **_: Console(file=text, force_terminal=terminal, width=80)
        )
        return text

    return put


def wait(seconds):
    with console.waiting("working hard") as progress:
        progress(3, 8)
        time.sleep(seconds)


def test_a_bar_after_the_patience_on_a_terminal(screen, monkeypatch):
    monkeypatch.setattr(console, "_PATIENCE", 0.05)
    text = screen(True)
    wait(0.5)
    assert "working hard" in text.getvalue()
    assert "3/8" in text.getvalue()


def test_no_bar_for_short_work(screen):
    assert console._PATIENCE == 1
    text = screen(True)
    wait(0)
    assert text.getvalue() == ""


def test_no_bar_where_nobody_looks(screen, monkeypatch):
    monkeypatch.setattr(console, "_PATIENCE", 0.05)
    text = screen(False)
    wait(0.3)
    assert text.getvalue() == ""


def test_the_bar_goes_when_the_work_fails(screen, monkeypatch):
    monkeypatch.setattr(console, "_PATIENCE", 0.05)
    text = screen(True)

    def fail():
        with console.waiting("working hard"):
            time.sleep(0.3)
            raise RuntimeError

    with pytest.raises(RuntimeError):
        fail()
    assert text.getvalue().endswith("\x1b[2K")  # the line is wiped


def test_json_knows_no_nan(capsys):
    value = {"a": np.array([1.5, np.nan, -np.inf]), "b": (float("inf"), np.int64(3)), "c": None}
    console.print_json(value)
    assert json.loads(capsys.readouterr().out) == {
        "a": [1.5, None, None],
        "b": [None, 3],
        "c": None,
    }
