"""The pages of the site are true: their code and commands run, and print what stands below them."""

import ast
import re
import runpy
from pathlib import Path

import pytest

import beltrami as bt

DOCS = Path(__file__).parents[1] / "docs"
OUTPUTS = runpy.run_path(str(DOCS / "outputs.py"))
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?")


def words(text):
    """What is said, with # for each number, and the numbers."""
    return " ".join(NUMBER.sub("#", text).split()), [float(x) for x in NUMBER.findall(text)]


def agree(said, shown):
    """Whether a run says what a page shows; numbers may differ by 5 %, or be both nearly zero."""
    (one, x), (other, y) = words(said), words(shown)
    near = [abs(a - b) <= max(0.05 * max(abs(a), abs(b)), 1e-8) for a, b in zip(x, y, strict=False)]
    return one == other and len(x) == len(y) and all(near)


@pytest.mark.parametrize("page", OUTPUTS["PAGES"])
def test_a_page_runs_and_prints_what_it_shows(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shown = (DOCS / f"{page}.md").read_text(encoding="utf-8")
    said = OUTPUTS["refreshed"](page, shown)
    pairs = [[block for kind, block in OUTPUTS["BLOCK"].findall(text) if kind == "text"]
             for text in (said, shown)]  # fmt: skip
    assert len(pairs[0]) == len(pairs[1]), "make docs-outputs"
    for run, page_says in zip(*pairs, strict=True):
        assert agree(run, page_says), f"the page shows\n{page_says}\nand a run says\n{run}"


def test_what_a_page_prints_is_put_below_its_code(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    page = "a\n\n```python\nprint(1 + 1)\n```\n\nb\n\n```text\nkept\n```\n"
    fresh = OUTPUTS["refreshed"]("p", page.replace("b\n\n", ""))
    assert fresh == "a\n\n```python\nprint(1 + 1)\n```\n\n```text\n2\n```\n"
    assert OUTPUTS["refreshed"]("p", fresh) == fresh
    bare = OUTPUTS["refreshed"]("p", "```python\nprint(3)\n```\n\nend\n")
    assert bare == "```python\nprint(3)\n```\n\n```text\n3\n```\n\nend\n"


def test_the_comparison_sees_what_is_wrong():
    assert agree("a 1.000 b -3", "a 1.001  b -3")
    assert agree("1.0e-12", "3.1e-13")
    assert not agree("a 1.00", "a 1.08")
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
    listed = {name for room in rooms["rooms"]() for name in rooms["names_of"](room)}
    missing = {f"beltrami.{name}" for name in bt._HOME} - listed
    assert not missing
    assert all(rooms["resolve"](name).__doc__ for name in listed)


def test_every_page_is_in_a_table_of_contents():
    named = {"index"}
    for place in DOCS.rglob("*.md"):
        for block in re.findall(r"```\{toctree\}\n(.*?)```", place.read_text("utf-8"), re.DOTALL):
            named |= {str((place.parent / line).resolve()) for line in block.split()}
    made = {"gallery", "commands", "viewer-note", "card"}  # when the site is built
    pages = {p for p in DOCS.rglob("*.md") if p.stem not in made and "api" not in p.parts}
    lost = {p.name for p in pages if str(p.with_suffix("").resolve()) not in named} - {"index.md"}
    assert not lost, "name it in the toctree of docs/reference.md, or of another page"


@pytest.mark.parametrize("path", sorted((DOCS.parent / "examples").glob("*.py")), ids=str)
def test_every_example_is_in_the_gallery(path):
    """The gallery runs an example as its docstring says: with a folder, or with a picture."""
    text = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8")))
    found = re.search(rf"^python examples/{path.name} (FOLDER|\S+\.(?:png|webp|gif))$", text, re.M)
    assert found, f"say 'python examples/{path.name} FOLDER' in a line of the docstring"


def test_prose_is_escaped_and_code_is_not():
    escape = runpy.run_path(str(DOCS / "extensions" / "rooms.py"))["escape"]
    assert escape("|e|² and ``a|b`` and :math:`|x|`") == r"\|e\|² and ``a|b`` and :math:`|x|`"
    assert escape(r"\|f\|") == r"\|f\|"  # done by hand
    assert escape("the f_ of it, x_i") == r"the f\_ of it, x_i"
