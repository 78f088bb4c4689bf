"""Search for inputs that a reader does not bear, led by the branches that they reach.

``PYTHONPATH=tests python -m fuzz FORMAT [seconds]`` changes inputs of the corpus at random, and
keeps each that takes a new way: another pair of lines in Python, or another kind of error or of
result, by which the branches of compiled kernels are told. One that breaks a reader is written to
the current folder. Memory and time are bounded.
"""

from __future__ import annotations

import hashlib
import re
import resource
import signal
import sys
import time
from pathlib import Path

import numpy as np

from fuzz import readers

LONGEST = 700  # bytes
LONGER = {"gii": 2500, "vtu": 2500}  # XML says little in 700
SPACE = 6 << 30  # bytes of addresses; the libraries themselves take more than one of them
PATIENCE = 120  # seconds for an input, which may be the first to need a kernel
_WATCHED = ("/beltrami/io/", "/beltrami/compression/", "/beltrami/spectrum/")


def way_of(name, data):
    """What an input reaches: pairs of lines, and the kind of the outcome."""
    way, last = set(), {}

    def inside(frame, event, _):
        if event == "line":
            key = (frame.f_code.co_filename, frame.f_code.co_name)
            way.add((*key, last.get(key), frame.f_lineno))
            last[key] = frame.f_lineno
        return inside

    def enter(frame, *_):
        return inside if any(part in frame.f_code.co_filename for part in _WATCHED) else None

    signal.alarm(PATIENCE)
    sys.settrace(enter)
    try:
        outcome = readers.outcome(name, data)
    finally:
        sys.settrace(None)
        signal.alarm(0)
    way.add(" ".join(re.findall(r"[a-z]+", outcome.split("found")[0])[:3]))
    return way


def shortest(name, inputs):
    """The inputs that are needed to go all the ways that these go, short ones first."""
    kept, seen = [], set()
    for data in sorted(inputs, key=lambda data: (len(data), data)):
        way = way_of(name, data)
        if not way <= seen:
            kept.append(data)
            seen |= way
    return kept, seen


def search(name, seconds, rng):
    """Change inputs for so long; the new ones are in the corpus."""
    folder = readers.CORPUS / name
    folder.mkdir(parents=True, exist_ok=True)
    (kept, seen), tried = shortest(name, readers.corpus(name)), 0
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        data = readers.mutated(rng, kept)[: LONGER.get(name, LONGEST)]
        tried += 1
        label = hashlib.sha256(data).hexdigest()[:16]
        try:
            way = way_of(name, data)
        except BaseException:
            Path(f"broken-{label}.{name}").write_bytes(data)
            raise
        if not way <= seen:
            seen |= way
            kept.append(data)
    kept, seen = shortest(name, kept)
    for path in folder.iterdir():
        path.unlink()
    for data in kept:
        (folder / hashlib.sha256(data).hexdigest()[:16]).write_bytes(data)
    print(f"{name}: {tried} inputs, {len(kept)} kept, {len(seen)} ways")  # noqa: T201


def main():
    name, seconds = sys.argv[1], float((sys.argv[2:] or ["60"])[0])
    resource.setrlimit(resource.RLIMIT_AS, (SPACE, SPACE))
    for data in readers.corpus(name):  # loads the kernels
        readers.outcome(name, data)
    search(name, seconds, np.random.default_rng())


if __name__ == "__main__":
    main()
