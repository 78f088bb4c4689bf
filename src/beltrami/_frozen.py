"""Frozen objects whose derived quantities are computed once, when they are asked for."""

from __future__ import annotations

from typing import NoReturn


class Frozen:
    """Nothing can be set or deleted; ``functools.cached_property`` writes past this.

    Subclasses fill ``self.__dict__`` in their constructor.
    """

    def __setattr__(self, name: str, value: object) -> NoReturn:
        raise AttributeError(f"a {type(self).__name__} is frozen: {name!r} cannot be set")

    def __delattr__(self, name: str) -> NoReturn:
        raise AttributeError(f"a {type(self).__name__} is frozen: {name!r} cannot be deleted")
