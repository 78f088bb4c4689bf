"""What a user's map returned, split into the functions it stands for."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami.errors import DimensionError
from beltrami.surfaces.jets import Jet, unstack


def entries(result: Any, depth: int, shape: tuple[int, int], what: str) -> Any:
    """Return lists, nested ``depth`` deep, of functions: arrays or jets of this shape.

    Sequences are split by their items. An array or a stack of jets is split along its first
    axes, (k, ...), or along its last ones, (..., k), whichever leaves the shape of the
    parameters. That is (n, 1) always, so that no array fits both.

    Raises
    ------
    DimensionError
        If the result has another shape, or complex values.

    Examples
    --------
    >>> first = entries([np.zeros((5, 1)), 1.0], 1, (5, 1), "φ")
    >>> last = entries(np.zeros((5, 1, 2)), 1, (5, 1), "φ")
    >>> [x.shape for x in first], [x.shape for x in last]
    ([(5, 1), (5, 1)], [(5, 1), (5, 1)])
    """
    if depth == 0:
        return _function(result, shape, what)
    if isinstance(result, Jet) or (isinstance(result, np.ndarray) and result.dtype != object):
        size = result.shape
        if len(size) != depth + 2 or shape not in (size[depth:], size[:2]):
            raise _wrong(what, size)
        _require_real(result, what)
        pieces = unstack(result, 0 if size[depth:] == shape else -depth)
    else:
        try:
            pieces = list(result)
        except TypeError:
            raise _wrong(what, _shape_of(result)) from None
    if not pieces:
        raise _wrong(what, (0,))
    return [entries(piece, depth - 1, shape, what) for piece in pieces]


def _function(result: Any, shape: tuple[int, int], what: str) -> Any:
    """Return a jet or an array of this shape; constants are spread."""
    if isinstance(result, np.ndarray) and result.dtype == object and result.ndim == 0:
        result = result.item()
    if isinstance(result, Jet):
        if result.shape != shape:
            raise _wrong(what, result.shape)
        return result
    try:
        given = np.asarray(result)
    except ValueError:
        raise _wrong(what, _shape_of(result)) from None
    _require_real(given, what)
    try:
        return np.broadcast_to(given.astype(np.float64), shape)
    except (TypeError, ValueError):
        raise _wrong(what, given.shape) from None


def _require_real(result: Any, what: str) -> None:
    if isinstance(result, np.ndarray) and result.dtype.kind == "c":
        raise DimensionError(f"{what} has complex values where real ones are needed")


def _shape_of(result: Any) -> tuple[int, ...]:
    """Return the shape, or the length of what is ragged."""
    try:
        return np.shape(result)
    except ValueError:
        return (len(result),)


def _wrong(what: str, shape: tuple[int, ...]) -> DimensionError:
    return DimensionError(
        f"{what} returned the shape {shape} for u and v of the shape (n, 1)",
        remedy="Return a sequence with one array like u for each coordinate, or one array with "
        "the coordinates along its last axis.",
    )
