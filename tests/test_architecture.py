"""The rooms: imports go one way, and importing the package is cheap."""

import ast
import re
import subprocess
import sys
import tomllib
from fnmatch import fnmatch
from pathlib import Path

import pytest

import beltrami

ROOT = Path(__file__).parents[1]
SOURCE = ROOT / "src" / "beltrami"


def test_import_contracts_hold():
    linter = Path(sys.executable).with_name("lint-imports")
    done = subprocess.run(
        [linter, "--no-cache"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("path", sorted(SOURCE.rglob("*.py")), ids=lambda p: p.name)
def test_no_room_imports_the_package_root(path):
    if path == SOURCE / "__init__.py":
        return
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            assert all(alias.name != "beltrami" for alias in node.names)
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0, "imports are absolute"
            assert node.module != "beltrami"


def test_the_root_loads_neither_numba_nor_the_sparse_solvers():
    code = (
        "import sys, beltrami; "
        "print([m for m in ('numba', 'scipy', 'numpy', 'rich') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_every_public_name_loads():
    for name in beltrami.__all__:
        assert getattr(beltrami, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'laplacien'"):
        _ = beltrami.laplacien


@pytest.mark.parametrize("path", sorted(SOURCE.rglob("*.py")), ids=lambda p: p.name)
def test_files_are_short(path):
    assert len(path.read_text(encoding="utf-8").splitlines()) <= 300


def test_the_source_archive_has_what_the_tests_read():
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    kept = settings["tool"]["hatch"]["build"]["targets"]["sdist"]["include"]
    read = {
        name
        for path in (ROOT / "tests").rglob("*.py")
        for name in re.findall(r'parents\[\d\] / "([\w.]+)', path.read_text(encoding="utf-8"))
        if (ROOT / name).exists()
    }
    assert {"docs", "examples", "Makefile"} <= read
    assert not {name for name in read if not any(fnmatch(name, one) for one in kept)}
