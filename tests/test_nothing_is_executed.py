"""No code comes out of data: no pickle, no eval, no shell, and no archive is unpacked."""

import ast
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[1] / "src" / "beltrami"
MODULES = {
    "pickle", "cPickle", "dill", "cloudpickle", "joblib", "marshal", "shelve", "subprocess", "pty",
    "code", "codeop", "runpy", "tarfile", "ctypes.util", "xmlrpc", "telnetlib",
}  # fmt: skip
CALLS = {"eval", "exec", "compile", "__import__", "input", "breakpoint"}
METHODS = {
    "system", "popen", "execv", "execve", "execvp", "spawnv", "spawnl", "posix_spawn", "fork",
    "startfile", "extract", "extractall", "unpack_archive", "mktemp", "read_pickle", "to_pickle",
}  # fmt: skip
PICKLING = {"load", "save", "savez", "savez_compressed"}  # of numpy, unless told not to


def offences(text):
    """What a file does that it should not, with the lines."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
            yield from ((node.lineno, name) for name in names if name.split(".")[0] in MODULES)
        elif isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] in MODULES:
            yield node.lineno, node.module
        elif isinstance(node, ast.Call):
            yield from of_call(node)


def of_call(node):
    function, options = node.func, {word.arg: word.value for word in node.keywords}
    shell = options.get("shell")
    if shell is not None and not (isinstance(shell, ast.Constant) and shell.value is False):
        yield node.lineno, "shell"
    if isinstance(function, ast.Name) and function.id in CALLS:
        yield node.lineno, function.id
    if not isinstance(function, ast.Attribute):
        return
    if function.attr in METHODS:
        yield node.lineno, function.attr
    of_numpy = isinstance(function.value, ast.Name) and function.value.id in ("np", "numpy")
    if of_numpy and function.attr in PICKLING:
        allowed = options.get("allow_pickle")
        if not (isinstance(allowed, ast.Constant) and allowed.value is False):
            yield node.lineno, f"numpy.{function.attr} with pickle"
    of_torch = isinstance(function.value, ast.Name) and function.value.id == "torch"
    if of_torch and function.attr in ("load", "save"):
        yield node.lineno, f"torch.{function.attr}"


@pytest.mark.parametrize("path", sorted(SOURCE.rglob("*.py")), ids=lambda path: path.name)
def test_source(path):
    assert list(offences(path.read_text(encoding="utf-8"))) == []


@pytest.mark.parametrize(
    "line",
    [
        "import pickle",
        "from pickle import loads",
        "import os, subprocess",
        "eval(text)",
        "os.system(text)",
        "run(text, shell=True)",
        "np.load(path)",
        "np.load(path, allow_pickle=True)",
        "np.savez(path, a=a)",
        "archive.extractall(folder)",
        "torch.load(path)",
    ],
)
def test_the_check_sees_it(line):
    assert len(list(offences(line))) == 1


def test_what_is_allowed():
    assert not list(offences("np.load(path, allow_pickle=False)\nfield.load(1)\nimport json"))
