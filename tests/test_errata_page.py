"""The page of the errata is true and complete: every number on it is computed again."""

import doctest
import re
from functools import cache
from pathlib import Path

import pytest

PAGE = (Path(__file__).parents[1] / "docs" / "errata.md").read_text(encoding="utf-8")
ALL = [f"E{k}" for k in range(1, 96)]
FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE

# Entries without a number, and why.
WITHOUT_NUMBER = {"E95": "slips of writing and numbering, which nothing can compute"}


def parts_of(text: str) -> list[tuple[str, str]]:
    """Cut a page at its headings; what is not an entry has no name."""
    cut = re.split(r"^(###? .*)$", text, flags=re.MULTILINE)
    found = [("", cut[0])]
    for heading, body in zip(cut[1::2], cut[2::2], strict=True):
        name = re.match(r"### (E\d+)\. \S", heading)
        found.append((name[1] if name else "", body))
    return found


PARTS = parts_of(PAGE)
ENTRIES = [(name, text) for name, text in PARTS if name]


def failures(name: str, text: str, scope: dict[str, object]) -> str:
    """Run the python blocks of a text; what doctest has to say, or nothing."""
    blocks = re.findall(r"^```python\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
    test = doctest.DocTestParser().get_doctest("\n\n".join(blocks), {}, name, None, 0)
    test.globs = scope
    said: list[str] = []
    doctest.DocTestRunner(optionflags=FLAGS).run(test, out=said.append, clear_globs=False)
    return "".join(said)


@cache
def head() -> dict[str, object]:
    """Run the blocks that stand before or between the entries: the meshes of the page."""
    scope: dict[str, object] = {}
    for name, text in PARTS:
        assert name or not (said := failures("head", text, scope)), said
    return scope


@pytest.mark.parametrize(("name", "text"), ENTRIES, ids=[name for name, _ in ENTRIES])
def test_the_numbers_of_an_entry_are_what_a_run_gives(name, text):
    said = failures(name, text, dict(head()))  # a copy: an entry needs the head, and no other entry
    assert not said, said


@pytest.mark.parametrize(("name", "text"), ENTRIES, ids=[name for name, _ in ENTRIES])
def test_an_entry_says_what_is_printed_what_is_true_and_why_and_shows_it(name, text):
    words = re.findall(r"^\*\*(Printed|True|Because)\*\*", text, re.MULTILINE)
    assert words == ["Printed", "True", "Because"]
    assert (">>> " in text) != (name in WITHOUT_NUMBER)
    fences = re.findall(r"^```.*$", text, re.MULTILINE)
    assert fences == ["```python", "```"] * (len(fences) // 2)


def test_all_95_slips_are_listed_once_and_in_order():
    assert [name for name, _ in ENTRIES] == ALL


def test_a_wrong_number_on_the_page_would_be_found():
    name, text = next(entry for entry in ENTRIES if entry[0] == "E16")
    wrong = text.replace("printed 10.0", "printed 10.5")
    assert wrong != text
    assert "Got:\n    printed 10.0" in failures(name, wrong, dict(head()))


def test_every_heading_of_an_entry_is_recognized():
    assert len(re.findall(r"^### ", PAGE, re.MULTILINE)) == len(ENTRIES)
