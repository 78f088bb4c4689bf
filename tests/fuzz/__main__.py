"""Search for inputs that a reader does not bear, led by the branches that they reach.

``PYTHONPATH=tests python -m fuzz FORMAT [seconds]`` gives the corpus of a format to Atheris
(libFuzzer), which changes inputs and keeps each that takes a new way in ``.fuzz/FORMAT``, from
where the next search goes on. One that breaks a reader, or takes more memory or time than is
allowed, is written to the current folder: it belongs into the corpus once that is mended.

Functions are instrumented one by one after everything is loaded and compiled: numba compiles
from the code of a function, and would meet that of the instrument. So the ways are those
through Python; inside kernels the indices are checked (``NUMBA_BOUNDSCHECK=1``).
"""

from __future__ import annotations

import sys
import tempfile
import types
from pathlib import Path

import atheris

from fuzz import readers

FINDS = Path(".fuzz")
LONGEST = 700  # bytes
LONGER = {"gii": 2500, "vtu": 2500, "vtp": 2500}  # XML says little in 700
MEMORY = 4096  # megabytes of the process, libraries included
PATIENCE = 120  # seconds for an input, which may be the first to need a kernel
_WATCHED = ("beltrami.io", "beltrami.compression", "beltrami.spectrum")


def functions_of(space, met):
    """Yield the plain functions of a module or of a class of ours, each once."""
    for value in list(vars(space).values()):
        value = getattr(value, "__func__", getattr(value, "fget", value))
        ours = str(getattr(value, "__module__", "")).startswith(_WATCHED)
        if not ours or id(value) in met:
            continue
        if isinstance(value, types.FunctionType):
            met.add(id(value))
            yield value
        elif isinstance(value, type):
            met.add(id(value))
            yield from functions_of(value, met)


def instrument():
    """Have the functions tell where they go, and return how many do."""
    met: set[int] = set()
    modules = [module for name, module in sys.modules.items() if name.startswith(_WATCHED)]
    found = [function for module in modules for function in functions_of(module, met)]
    for function in found:
        atheris.instrument_func(function)
    return len(found)


def dictionary(words):
    """The words in libFuzzer's way of writing them."""
    return "".join('"' + "".join(f"\\x{byte:02x}" for byte in word) + '"\n' for word in words)


def main():
    name, seconds = sys.argv[1], float((sys.argv[2:] or ["60"])[0])
    for data in readers.corpus(name):  # loads all that is read with, and compiles it
        readers.outcome(name, data)
    print(f"{name}: {instrument()} functions are watched")  # noqa: T201
    (FINDS / name).mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile("w", suffix=".dict") as words:
        words.write(dictionary(readers.WORDS))
        words.flush()
        options = {
            "dict": words.name,
            "max_len": LONGER.get(name, LONGEST),
            "max_total_time": round(seconds),
            "rss_limit_mb": MEMORY,
            "timeout": PATIENCE,
            "artifact_prefix": f"broken-{name}-",
            "print_final_stats": 1,
        }
        given = [f"-{option}={value}" for option, value in options.items()]
        atheris.Setup(
            [sys.argv[0], *given, str(FINDS / name), str(readers.CORPUS / name)],
            lambda data: readers.outcome(name, data),
        )
        atheris.Fuzz()


if __name__ == "__main__":
    main()
