"""The command as a shell sees it: exit codes, one line of error, quick help."""

import subprocess
import sys
from importlib.metadata import version

import pytest

COMMAND = (sys.executable, "-c", "from beltrami.cli import main; main()")


def shell(*arguments):
    return subprocess.run(
        [*COMMAND, *map(str, arguments)],
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
        timeout=120,
    )


def test_bad_input_is_one_line_and_exit_code_1(tmp_path):
    done = shell("info", tmp_path / "missing.obj")
    assert done.returncode == 1
    assert done.stdout == ""
    assert done.stderr == f"beltrami: {tmp_path / 'missing.obj'}: No such file or directory\n"


def test_a_remedy_is_a_command(stray, tmp_path):
    done = shell("smooth", stray, "-o", tmp_path / "out.off")
    assert done.returncode == 1
    assert len(done.stderr.splitlines()) == 1
    assert "`beltrami repair --remove-" in done.stderr
    assert "repair(mesh" not in done.stderr


def test_python_runs_the_package_as_a_command():
    version = subprocess.run(
        [sys.executable, "-m", "beltrami", "--version"], capture_output=True, text=True, check=False
    )
    assert (version.returncode, version.stderr) == (0, "")
    assert version.stdout == shell("--version").stdout
    usage = [sys.executable, "-m", "beltrami", "smoothe"]
    assert subprocess.run(usage, capture_output=True, check=False).returncode == 2


def test_success_writes_nothing_on_stderr(sphere, tmp_path):
    done = shell("smooth", sphere, "-o", tmp_path / "out.ply")
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize("arguments", [("infoo",), ("info",), ("info", "a.obj", "--jsn"), ()])
def test_bad_usage_is_exit_code_2(beltrami, arguments):
    assert beltrami(*arguments).exit_code == 2


def test_version(beltrami):
    assert beltrami("--version").stdout == f"beltrami {version('beltrami')}\n"


@pytest.mark.parametrize("arguments", [["--help"], ["smooth", "-h"], ["--version"]])
def test_help_loads_no_kernels(arguments):
    code = (
        "import sys, beltrami.cli\n"
        f"sys.argv[1:] = {arguments}\n"
        "try: beltrami.cli.main()\n"
        "except SystemExit as end: assert not end.code\n"
        "heavy = {'numba', 'scipy.sparse', 'PIL', 'beltrami.mesh.mesh'}\n"
        "assert not heavy & set(sys.modules), heavy & set(sys.modules)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("verb", ["info", "repair", "smooth", "heat", "render", "tour"])
def test_each_verb_explains_itself(beltrami, verb):
    done = beltrami(verb, "--help")
    assert done.exit_code == 0
    assert f"{verb} [OPTIONS]" in done.stdout
    assert f" {verb} " in beltrami("--help").stdout
