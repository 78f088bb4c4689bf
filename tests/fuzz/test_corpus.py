"""The inputs that the search kept: read or refused, with little memory, in bounded time."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from fuzz import readers

TESTS = Path(__file__).parents[1]


@pytest.mark.parametrize("name", readers.TARGETS)
def test_every_kept_input_is_read_or_refused(name):
    outcomes = [readers.outcome(name, data) for data in readers.corpus(name)]
    assert "read" in outcomes
    assert len(set(outcomes)) > 1


@pytest.mark.parametrize("name", readers.TARGETS)
def test_the_corpus_is_small(name):
    sizes = [len(data) for data in readers.corpus(name)]
    assert max(sizes) <= 4000
    assert sum(sizes) < 100_000


def capped(rounds, seed, **environment):
    done = subprocess.run(
        [sys.executable, "-m", "fuzz.capped", str(rounds), str(seed)],
        cwd=TESTS,
        env=os.environ | environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=3000,
    )
    assert done.returncode == 0, done.stderr[-2000:]


def test_changed_inputs_in_little_memory():
    capped(150, 20_260_731)


@pytest.mark.heavy
def test_many_changed_inputs_with_bounds_checked(tmp_path):
    """Kernels are compiled anew to look at each index: a write outside is an IndexError."""
    seed = int.from_bytes(os.urandom(4))
    capped(5_000, seed, NUMBA_BOUNDSCHECK="1", NUMBA_CACHE_DIR=str(tmp_path))
