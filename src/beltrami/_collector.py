"""Garbage is collected later: not while modules and kernels are loaded, which leave little."""

from __future__ import annotations

import gc
import threading


class _Rest:
    """A context in which the collector rests; it wakes up, if it was awake, after the last one.

    Each full collection looks at all objects, and the more are made, the more of them come. In
    the first call, which makes 100,000 objects that stay, they are a fifth of the time. What was
    made meanwhile then counts as old, as if it had been looked at.
    """

    def __init__(self) -> None:
        self._lock = threading.RLock()
        self._inside = 0
        self._was_awake = False

    def __enter__(self) -> None:
        with self._lock:
            if not self._inside:
                self._was_awake = gc.isenabled()
                gc.disable()
            self._inside += 1

    def __exit__(self, *raised: object) -> None:
        with self._lock:
            self._inside -= 1
            if not self._inside and self._was_awake:
                if not gc.get_freeze_count():  # else somebody keeps objects from the collector
                    gc.freeze()
                    gc.unfreeze()  # to the old ones, so that the next look at the new ones is short
                gc.enable()


resting_collector = _Rest()
