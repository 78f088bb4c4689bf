"""Whole numbers at the door of the spectrum."""

from __future__ import annotations

import operator
from typing import Any

from beltrami.errors import BeltramiError


def whole(what: str, value: Any, least: int, most: int) -> int:
    """Return a whole number from ``least`` to ``most``; BeltramiError if it is another thing.

    Examples
    --------
    >>> whole("order", 7, 1, 10)
    7
    """
    try:
        number = operator.index(value)
    except TypeError:
        number = least - 1
    if not least <= number <= most:
        raise BeltramiError(f"{what} must be a whole number from {least} to {most}, not {value!r}")
    return number
