"""What many tests share, made when one of them asks for it: to collect tests takes no time then.

Each process that runs tests collects all of them, and would make and compile all of it.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from types import FunctionType

from beltrami.mesh.shapes import blob

creature = functools.cache(blob)


class MadeOnce(Mapping):
    """Things by name; a function among them is called when its name is asked for, once."""

    def __init__(self, makers):
        self._makers = dict(makers)
        self._made = functools.cache(lambda name: self._makers[name]())

    def __getitem__(self, name):
        thing = self._makers[name]
        return self._made(name) if isinstance(thing, FunctionType) else thing

    def __iter__(self):
        return iter(self._makers)

    def __len__(self):
        return len(self._makers)
