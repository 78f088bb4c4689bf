"""docs/chapter-map.md is what the markers say, and no item of the chapter is forgotten."""

import importlib.util
import re
from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
_SPEC = importlib.util.spec_from_file_location("chapter_map", ROOT / "docs" / "chapter_map.py")
chapter_map = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(chapter_map)
Item, Mark = chapter_map.Item, chapter_map.Mark

DOCSTRING = '''
"""A file.

Chapter items: X1.
"""


class Pair:
    """A pair.

    Chapter items: D14, Q3.5.
    """

    def apply(self):
        """Apply it.

        Chapter items: D7.
        """
'''
MARKED = """
pytestmark = [pytest.mark.heavy, pytest.mark.chapter("P1")]

@pytest.mark.parametrize("name", ["a"])
@pytest.mark.chapter("D1", "D2")
def test_both(name):
    pytest.mark.chapter("D9")

@pytest.mark.chapter("D3")
class TestRings:
    @pytest.mark.chapter("D4")
    def test_faces(self):
        pass
"""


@pytest.fixture(scope="module")
def items():
    return chapter_map.read_items()


@pytest.fixture(scope="module")
def marks():
    return chapter_map.collect()


def test_the_committed_page_is_the_generated_one(items, marks):
    committed = chapter_map.PAGE.read_text(encoding="utf-8")
    assert committed == chapter_map.page(items, *marks), "run `make docs-map` and commit the page"


def test_every_item_has_a_function_and_a_test_or_is_owed(items, marks):
    assert chapter_map.complaints(items, *marks) == []


def test_the_table_has_the_189_items_of_the_chapter(items):
    kinds = Counter(item.id[0] for item in items)
    assert kinds == {"D": 21, "T": 20, "Q": 10, "U": 40, "R": 5, "X": 6, "F": 11, "P": 76}
    assert len({item.id for item in items}) == 189
    expected = {
        f"{k}{i}" for k, n in (("U", 40), ("P", 76), ("R", 5), ("X", 6)) for i in range(1, n + 1)
    }
    expected |= {f"D{i}" for i in range(1, 22)} | {f"T{i}" for i in range(3, 23)}
    expected |= {f"Q3.{i}" for i in range(1, 11)} | {f"F3.{i}" for i in range(1, 12)}
    assert {item.id for item in items} == expected


def test_every_row_says_where_it_stands(items):
    words = {"D": "Definition", "T": "Theorem", "Q": "Equation", "R": "Remark", "X": "Example"}
    words |= {"F": "Figure", "U": "formula", "P": "text"}
    errata = set()
    for item in items:
        number = "" if item.id[0] in "UP" else f" {item.id[1:]}"
        assert item.place == words[item.id[0]] + number
        assert item.section in chapter_map.SECTIONS
        assert 0 < len(item.title.split()) <= 10
        errata |= set(item.errata.split())
    assert errata == {f"E{i}" for i in range(1, 95)}  # E95 is about names alone


def test_links_lead_to_files_that_define_the_name(marks):
    for mark in [*marks[0], *marks[1]]:
        code = (ROOT / mark.path).read_text(encoding="utf-8")
        assert not mark.name or re.search(rf"(def|class) {mark.name.split('.')[-1]}\b", code)


def test_docstrings_of_modules_classes_and_methods_are_read():
    found = list(chapter_map.offered("a.py", DOCSTRING))
    assert [(m.item, m.name) for m in found] == [
        ("X1", ""), ("D14", "Pair"), ("Q3.5", "Pair"), ("D7", "Pair.apply"),
    ]  # fmt: skip


@pytest.mark.parametrize("line", ["D1 and D2.", "D1, D2", "D1,D2.", "d1.", "", "D1. See also E4."])
def test_a_line_that_is_no_list_is_an_error(line):
    with pytest.raises(ValueError, match="is no list"):
        list(chapter_map.offered("a.py", f'"""A file.\n\nChapter items: {line}\n"""'))


def test_marks_of_files_classes_and_functions_are_read():
    found = list(chapter_map.checked("test_a.py", MARKED))
    assert [(m.item, m.name) for m in found] == [
        ("P1", ""), ("D1", "test_both"), ("D2", "test_both"), ("D3", "TestRings"),
        ("D4", "TestRings.test_faces"),
    ]  # fmt: skip


def test_what_is_wrong_is_told():
    row = Item("D1", "3.1.1", "Definition 1", "A surface", "", "")
    offer, check, odd = Mark("D1", "a.py", "f"), Mark("D1", "t.py", "t"), Mark("D99", "t.py", "t")
    assert chapter_map.complaints([row], [offer], [check]) == []
    assert chapter_map.complaints([row], [offer], [check, odd]) == ["t.py: t: no item D99"]
    assert chapter_map.complaints([row], [], []) == ["D1 (A surface) has no function and no test"]
    assert chapter_map.complaints([row], [offer], []) == ["D1 (A surface) has no test"]
    assert chapter_map.complaints([row], [], [check]) == ["D1 (A surface) has no function"]
    owed = row._replace(owed="later")
    assert chapter_map.complaints([owed], [offer], []) == []
    assert "owes no 'later'" in chapter_map.complaints([owed], [offer], [check])[0]


def test_the_page_of_one_item():
    row = Item("D1", "3.1.1", "Definition 1", "A surface", "E1 E2", "later")
    text = chapter_map.page([row], [Mark("D1", "src/a.py", "f")], [Mark("D1", "tests/t.py", "")])
    line = next(line for line in text.splitlines() if line.startswith("| D1 "))
    assert line == (
        "| D1 | Definition 1 | A surface | [`f`](../src/a.py)<br>owed: later "
        "| [`t`](../tests/t.py) | [E1](errata.md#e1-flat-surfaces-and-the-first-fundamental-form), "
        "[E2](errata.md#e2-what-a-parameterization-must-be) |"
    )
    assert "1 items: 0 done, 1 owed." in text


def test_each_slip_has_an_anchor():
    assert list(chapter_map.errata_anchors()) == [f"E{k}" for k in range(1, 96)]
