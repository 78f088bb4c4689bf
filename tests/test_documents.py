"""The documents are true: the README's code runs, its commands exist, the example draws."""

import re
import runpy
import shlex
from pathlib import Path

import pytest
from PIL import Image
from typer.testing import CliRunner

import beltrami as bt
from beltrami.cli.app import app
from beltrami.mesh import shapes

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def size_of(path: Path) -> tuple[int, int]:
    with Image.open(path) as picture:
        return picture.size


def test_the_code_of_the_readme_runs(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    scope: dict[str, object] = {}
    for block in re.findall(r"```python\n(.*?)```", README, re.DOTALL):
        exec(compile(block, "README.md", "exec"), scope)  # noqa: S102
    printed = capsys.readouterr().out
    assert "no defects" in printed
    assert "1 of 4 vertices belong to no face (vertices 3). Drop them with repair(" in printed
    assert "('removed 1 unreferenced vertex',) [ 0  1  2 -1]" in printed
    euler, curvature = (float(line) for line in printed.splitlines()[-4:-2])
    assert abs(euler - 2) < 1e-9
    assert abs(curvature - 1) < 1e-12
    assert scope["distance"][[0, 17]].min() == 0
    assert (tmp_path / "smoother.ply").is_file()
    assert size_of(tmp_path / "picture.png")[0] == 1600


def test_the_commands_of_the_readme_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    blob = shapes.blob(500)
    bt.write_mesh("scan.ply", bt.Mesh([*blob.vertices, [9, 9, 9]], blob.faces))
    commands = re.findall(r"^    beltrami (.*?)(?:  +#.*)?$", README, re.MULTILINE)
    commands = [c for c in commands if not c.startswith("tour -o")]
    assert len(commands) == 18
    for command in commands:
        done = CliRunner().invoke(app, shlex.split(command))
        assert done.exit_code == 0, (command, done.output)
    assert (tmp_path / "tour" / "index.html").is_file()


@pytest.mark.parametrize(
    "name",
    [
        "ARCHITECTURE",
        "CONTRIBUTING",
        "README",
        "docs/conventions",
        "docs/errata",
        "docs/format",
        "docs/chapter-map",
        "docs/scaling",
    ],
)
def test_links_lead_somewhere(name):
    path = ROOT / f"{name}.md"
    for target in re.findall(r"\]\(([^)#]+)\)", path.read_text(encoding="utf-8")):
        assert (path.parent / target).exists(), target


def test_the_rooms_are_those_of_the_plan():
    plan = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
    rooms = {p.name for p in (ROOT / "src/beltrami").iterdir() if p.is_dir()} - {"__pycache__"}
    assert {room for room in rooms if f"{room}/" in plan} == rooms


def test_the_picture_of_the_readme_is_made_by_the_example(tmp_path):
    example = runpy.run_path(str(ROOT / "examples/readme_picture.py"))
    nearer, sound = example["main"](str(tmp_path / "blob.png"), 1500)
    assert nearer > 1.5
    assert sound
    assert (ROOT / "docs/images/blob.png").stat().st_size < 300_000
    assert size_of(tmp_path / "blob.png") == size_of(ROOT / "docs/images/blob.png")


@pytest.mark.parametrize(
    "path", [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")], ids=lambda path: path.stem
)
def test_no_document_holds_two_versions_of_its_text(path):
    assert not re.search(r"^(<{7} |={7}$|>{7} )", path.read_text(encoding="utf-8"), re.MULTILINE)


@pytest.mark.parametrize(
    "path", [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")], ids=lambda path: path.stem
)
def test_what_the_documents_name_of_a_class_it_has(path):
    for name, of_it in re.findall(r"`(?:bt\.)?([A-Z]\w+)\.(\w+)", path.read_text(encoding="utf-8")):
        found = getattr(bt, name, None)
        fields = getattr(found, "__annotations__", {})
        assert found is None or hasattr(found, of_it) or of_it in fields, f"{name}.{of_it}"


@pytest.mark.parametrize("name", ["ARCHITECTURE", "CONTRIBUTING", "README", "benchmarks/README"])
def test_what_the_documents_name_is_there(name):
    text = (ROOT / f"{name}.md").read_text(encoding="utf-8")
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    targets = set(re.findall(r"^([a-z-]+):", makefile, re.MULTILINE))
    assert set(re.findall(r"(?:^ {4}|`)make ([a-z-]+)", text, re.MULTILINE)) <= targets
    for module in re.findall(r"python -m (benchmarks\.\w+)", text):
        assert (ROOT / f"{module.replace('.', '/')}.py").is_file(), module
    files = re.findall(r"`([\w./*<>-]+\.(?:py|js|md|toml|csv)|\w[\w/]*/)`", text)
    homes = [ROOT, ROOT / "src" / "beltrami", *(ROOT / name for name in ("tests", "benchmarks"))]
    homes += [place for home in homes[1:] for place in home.rglob("*") if place.is_dir()]
    for file in {file for file in files if "<" not in file}:
        assert any(True for home in homes for _ in home.glob(file)), file
