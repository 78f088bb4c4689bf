"""The collector rests while modules and kernels are loaded, and is as it was afterwards."""

import gc
import os
import subprocess
import sys
import weakref

import numba
import pytest

from beltrami._collector import resting_collector
from beltrami._jit import kernel


@pytest.fixture(params=[True, False], ids=["awake", "asleep"])
def awake(request):
    """Whether the collector was at work before."""
    before = gc.isenabled()
    (gc.enable if request.param else gc.disable)()
    yield request.param
    (gc.enable if before else gc.disable)()


def test_it_rests_until_the_last_one_leaves(awake):
    with resting_collector:
        with resting_collector:
            assert not gc.isenabled()
        assert not gc.isenabled()
    assert gc.isenabled() is awake


def test_an_error_wakes_it_too(awake):
    with pytest.raises(KeyError), resting_collector:
        raise KeyError
    assert gc.isenabled() is awake


def test_what_was_made_meanwhile_is_old_and_still_collected():
    class Thing:
        pass

    gc.collect()
    with resting_collector:
        cycle = Thing()
        cycle.itself = cycle
        gone = weakref.ref(cycle)
        del cycle
    assert gc.get_freeze_count() == 0
    gc.collect(0)
    assert gone() is not None  # not among the young ones, which are looked at often
    gc.collect()
    assert gone() is None


def test_objects_that_somebody_froze_stay_frozen():
    """A server freezes what its children are to share; nothing of that is undone."""
    code = """
import gc, beltrami
gc.freeze()
frozen = gc.get_freeze_count()
beltrami.Mesh
print(frozen > 0, gc.get_freeze_count() > 0.9 * frozen, gc.isenabled())
"""
    assert _printed(code) == ["True", "True", "True"]


def test_it_rests_while_numba_compiles(monkeypatch, awake):
    seen = []
    monkeypatch.setattr(
        resting_collector.__class__, "__exit__", _watched(resting_collector, seen), raising=True
    )
    assert kernel(_one_more)(1) == 2
    assert seen
    assert not any(seen)
    assert gc.isenabled() is awake


def test_an_error_of_numba_wakes_it_too(awake):
    with pytest.raises(numba.errors.NumbaError):
        kernel(_one_more)(None)
    assert gc.isenabled() is awake


def test_it_rests_while_a_public_name_is_loaded():
    """A module is asked at its import; it is a fresh process, in which nothing is loaded yet."""
    code = """
import gc, sys, beltrami
class Asks:
    def find_spec(self, name, path=None, target=None):
        if name == "beltrami.mesh.mesh":
            print(gc.isenabled())
sys.meta_path.insert(0, Asks())
beltrami.Mesh
print(gc.isenabled())
"""
    assert _printed(code) == ["False", "True"]


def _printed(code):
    done = subprocess.run(
        [sys.executable, "-c", code], env=dict(os.environ), capture_output=True, text=True
    )
    assert not done.returncode, done.stderr
    return done.stdout.split()


def _one_more(x):
    return x + 1


def _watched(rest, seen):
    honest = rest.__class__.__exit__

    def leave(self, *raised):
        seen.append(gc.isenabled())
        honest(self, *raised)

    return leave
