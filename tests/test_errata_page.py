"""The page of the errata is true and complete: every number on it is computed again."""

import doctest
import re
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[1] / "docs"
WHOLE = DOCS / "errata.md"
PAGES = [WHOLE] if WHOLE.is_file() else sorted(DOCS.glob("errata-part-*.md"))
ALL = [f"E{k}" for k in range(1, 96)]
FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE

# Entries without a number, and why.
WITHOUT_NUMBER = {"E95": "slips of writing and numbering, which nothing can compute"}


def code_of(text: str) -> str:
    """Blank all lines outside of the python blocks, so that the numbers of the lines stay true."""
    inside, lines = False, []
    for line in text.splitlines():
        fence = line.startswith("```")
        lines.append(line if inside and not fence else "")
        inside = (line == "```python") if fence else inside
    return "\n".join(lines) + "\n"


def entries_of(text: str) -> list[tuple[str, str]]:
    """Return the name and the text of each entry, in order."""
    parts = re.split(r"^(?:### (E\d+)\. .*|## .*)$", text, flags=re.MULTILINE)
    return [(name, body) for name, body in zip(parts[1::2], parts[2::2], strict=True) if name]


ENTRIES = [entry for page in PAGES for entry in entries_of(page.read_text(encoding="utf-8"))]


def test_every_number_of_the_page_is_what_runs_give():
    scope: dict[str, object] = {}
    said: list[str] = []
    tried = 0
    for page in PAGES:
        code = code_of(page.read_text(encoding="utf-8"))
        test = doctest.DocTestParser().get_doctest(code, {}, page.name, str(page), 0)
        test.globs = scope  # one namespace: the second half uses the meshes of the first
        runner = doctest.DocTestRunner(optionflags=FLAGS)
        runner.run(test, out=said.append, clear_globs=False)
        tried += runner.tries
    assert not said, "".join(said)
    assert tried > len(ENTRIES)


def test_no_slip_is_listed_twice_and_all_are_in_order():
    names = [name for name, _ in ENTRIES]
    assert names == sorted(set(names), key=ALL.index)


@pytest.mark.skipif(not WHOLE.is_file(), reason="the page is still in parts")
def test_all_95_slips_are_listed():
    assert [name for name, _ in ENTRIES] == ALL


@pytest.mark.parametrize(("name", "text"), ENTRIES, ids=[name for name, _ in ENTRIES])
def test_an_entry_says_what_is_printed_what_is_true_and_why_and_runs(name, text):
    words = re.findall(r"\*\*(Printed|True|Because)\*\*", text)
    assert words == ["Printed", "True", "Because"]
    assert (">>> " in text) != (name in WITHOUT_NUMBER)


def test_a_wrong_number_on_the_page_would_be_found():
    page = PAGES[0].read_text(encoding="utf-8")
    assert page.count("300 596 312 0") == 1
    code = code_of(page.replace("300 596 312 0", "300 596 313 0"))
    head = code[: code.index(">>> irregular") + 400]
    test = doctest.DocTestParser().get_doctest(head, {}, "head", None, 0)
    assert doctest.DocTestRunner(optionflags=FLAGS).run(test, out=lambda _: None).failed == 1
