"""The pages of the site are true: their code and commands run, and print what stands below them."""

import re
import runpy
import shlex
from pathlib import Path

import pytest
from typer.testing import CliRunner

import beltrami as bt
from beltrami.cli.app import app

DOCS = Path(__file__).parents[1] / "docs"
PAGES = ("index", "start", *sorted(f"howto/{p.stem}" for p in (DOCS / "howto").glob("*.md")))
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?")


def blocks(page):
    """The fenced blocks of a page: (kind, text)."""
    text = (DOCS / f"{page}.md").read_text(encoding="utf-8")
    return re.findall(r"^```(\w+)\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)


def words(text):
    """What is said, with # for each number, and the numbers."""
    return " ".join(NUMBER.sub("#", text).split()), [float(x) for x in NUMBER.findall(text)]


def agree(said, shown):
    """Whether a run says what a page shows; numbers may differ by 2 %, or be both nearly zero."""
    (one, x), (other, y) = words(said), words(shown)
    near = [abs(a - b) <= max(0.02 * max(abs(a), abs(b)), 1e-8) for a, b in zip(x, y, strict=False)]
    return one == other and len(x) == len(y) and all(near)


@pytest.mark.parametrize("page", PAGES)
def test_a_page_runs_and_prints_what_it_shows(page, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    scope, said = {}, ""
    for kind, text in blocks(page):
        if kind == "python":
            assert not said.strip(), f"{page} does not show that it prints {said}"
            exec(compile(text, f"{page}.md", "exec"), scope)  # noqa: S102
            said = capsys.readouterr().out
        elif kind == "text":
            assert agree(said, text), f"{page} shows\n{text}\nand a run says\n{said}"
            said = ""
        elif kind == "console" and "beltrami tour" not in text:  # tests of its own
            for command in re.findall(r"^\$ beltrami (.*)$", text, re.MULTILINE):
                done = CliRunner().invoke(app, shlex.split(command))
                assert done.exit_code == 0, (command, done.output)
    assert not said.strip()


def test_the_comparison_sees_what_is_wrong():
    assert agree("a 1.000 b -3", "a 1.001  b -3")
    assert agree("1.0e-12", "3.1e-13")
    assert not agree("a 1.00", "a 1.05")
    assert not agree("a 1.00", "b 1.00")
    assert not agree("[1 2]", "[1 2 3]")
    assert not agree("True", "False")


@pytest.mark.parametrize("page", sorted(str(p.relative_to(DOCS)) for p in DOCS.rglob("*.md")))
def test_links_of_the_site_lead_somewhere(page):
    place = DOCS / page
    made = ("api/index.rst", "commands.md", "gallery.md")  # when the site is built
    for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", place.read_text(encoding="utf-8")):
        path = (place.parent / target).resolve()
        assert path.exists() or str(path.relative_to(DOCS.resolve())) in made, target


def test_the_api_has_a_place_for_every_public_name():
    rooms = runpy.run_path(str(DOCS / "extensions" / "rooms.py"))
    listed = {name for room in rooms["ROOMS"] for name in rooms["names_of"](room)}
    missing = {f"beltrami.{name}" for name in bt._HOME} - listed
    assert not missing
    assert all(rooms["resolve"](name).__doc__ for name in listed)


def test_prose_is_escaped_and_code_is_not():
    escape = runpy.run_path(str(DOCS / "extensions" / "rooms.py"))["escape"]
    assert escape("|e|² and ``a|b`` and :math:`|x|`") == r"\|e\|² and ``a|b`` and :math:`|x|`"
    assert escape("the f_ of it, x_i") == r"the f\_ of it, x_i"
