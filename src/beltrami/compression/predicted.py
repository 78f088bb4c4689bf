"""Functions through the predictor of positions: integers and floats exactly, or within a bound."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, Integers
from beltrami.compression.exact import (
    BITS,
    LOWEST,
    decode_beside,
    encode_beside,
    exponent_for,
    floats_at,
    moved,
    places_of,
    steps_of,
)
from beltrami.compression.functions import read_label, write_label
from beltrami.compression.grid import grid_for
from beltrami.compression.neighbourhood import Neighbourhood
from beltrami.compression.numbers import EFFORTS, decode_numbers, encode_numbers, reader_is_done
from beltrami.compression.varint import Reader, to_varints

WHOLE, EXACT, BOUNDED = range(3)
_LARGEST = 1 << 30
_MOST_COLUMNS = 256


def encode_exactly(
    name: str, values: NDArray[Any], near: Neighbourhood, effort: str
) -> bytes | None:
    """Write an array (n,) or (n, d) exactly; None where that cannot be done in this way."""
    ordered = values.astype(values.dtype.newbyteorder("<"), order="C")
    flat = ordered.reshape(len(ordered), math.prod(ordered.shape[1:]))
    if flat.size == 0 or flat.shape[1] > _MOST_COLUMNS:
        return None
    head = write_label(name, ordered) + to_varints([EFFORTS.index(effort)])
    if flat.dtype.kind in "iub":
        if (np.maximum(flat, 0) > _LARGEST).any() or (np.minimum(flat, 0) < -_LARGEST).any():
            return None
        return head + to_varints([WHOLE]) + encode_numbers(flat.astype(np.int64), near, effort)
    if not np.isfinite(flat).all():
        return None
    narrow = _narrowed(flat)
    exponent = exponent_for(narrow)
    steps = steps_of(narrow, exponent)
    beside = places_of(narrow) - places_of(_at_steps(steps, exponent, narrow.dtype.str))
    kind = list(BITS).index(narrow.dtype.str)
    numbers = encode_numbers(steps, near, effort)
    return (
        head + to_varints([EXACT, kind, exponent - LOWEST]) + numbers + encode_beside(beside, steps)
    )


def _narrowed(flat: NDArray[Any]) -> NDArray[Any]:
    """Return doubles in single precision, where that loses nothing."""
    with np.errstate(over="ignore", under="ignore"):
        single = flat.astype("<f4") if flat.dtype.itemsize == 8 else flat
    same = single.astype(flat.dtype).tobytes() == flat.tobytes()
    return np.ascontiguousarray(single if same else flat)


def _at_steps(steps: Integers, exponent: int, kind: str) -> NDArray[Any]:
    """Return the floats at whole numbers of steps."""
    with np.errstate(over="ignore", under="ignore"):
        return np.ldexp(steps.astype(np.float64), exponent).astype(kind)


def encode_within(
    name: str, values: NDArray[Any], max_error: float, near: Neighbourhood, effort: str
) -> tuple[bytes, NDArray[Any]]:
    """Return (bytes, what they become) of floats, each row within ``max_error`` of itself."""
    flat = values.reshape(len(values), math.prod(values.shape[1:])).astype(np.float64)
    rounding = float(np.finfo(values.dtype).eps) * float(abs(flat).max(initial=0.0))
    rounding *= math.sqrt(flat.shape[1]) if values.dtype.itemsize < 8 else 0.0
    grid = grid_for(flat, max(max_error - rounding, 0.0), None)
    numbers = grid.round(flat)
    ordered = values.astype(values.dtype.newbyteorder("<"), order="C")
    head = write_label(name, ordered) + to_varints([EFFORTS.index(effort), BOUNDED])
    head += np.append(grid.origin, grid.step).astype("<f8").tobytes()
    found = grid.points(numbers).astype(values.dtype).reshape(values.shape)
    return head + encode_numbers(numbers, near, effort), found


def decode_predicted(reader: Reader, n: int, near: Neighbourhood) -> tuple[str, NDArray[Any]]:
    """Read (name, array of n rows)."""
    name, kind, tail = read_label(reader)
    columns = math.prod(tail)
    if not 0 < columns <= _MOST_COLUMNS:
        raise reader.fault(f"expected 1 to {_MOST_COLUMNS} columns, found {columns}")
    effort = EFFORTS[reader.varint(len(EFFORTS) - 1, "effort")]
    way = reader.varint(BOUNDED, "a way to write functions")
    if (way == WHOLE) == (np.dtype(kind).kind == "f"):
        raise reader.fault(f"functions of the type {kind!r} are not written in this way")
    read = (_read_whole, _read_exact, _read_within)[way]
    values = read(reader, (n, columns), kind, near, effort)
    return name, values.reshape(n, *tail)


def _read_whole(
    reader: Reader, shape: tuple[int, int], kind: str, near: Neighbourhood, effort: str
) -> NDArray[Any]:
    numbers = decode_numbers(reader, shape, near, effort)
    reader_is_done(reader)
    limits = (0, 1) if kind == "|b1" else (np.iinfo(kind).min, np.iinfo(kind).max)
    if numbers.size and not limits[0] <= int(numbers.min()) <= int(numbers.max()) <= limits[1]:
        raise reader.fault(f"a number that is not of the type {kind!r}")
    return numbers.astype(kind)


def _read_exact(
    reader: Reader, shape: tuple[int, int], kind: str, near: Neighbourhood, effort: str
) -> NDArray[Any]:
    narrow = list(BITS)[reader.varint(len(BITS) - 1, "precision")]
    exponent = reader.varint(-2 * LOWEST, "exponent") + LOWEST
    steps = decode_numbers(reader, shape, near, effort)
    if steps.size and abs(steps).max() > _LARGEST:
        raise reader.fault("a number of steps beyond 2^30")
    places = places_of(_at_steps(steps, exponent, narrow))
    beside = decode_beside(reader, steps)
    found = moved(places, beside, narrow)
    if found is None or np.dtype(narrow).itemsize > np.dtype(kind).itemsize:
        raise reader.fault(f"a value that is not of the type {kind!r}")
    return floats_at(found, narrow).astype(kind)


def _read_within(
    reader: Reader, shape: tuple[int, int], kind: str, near: Neighbourhood, effort: str
) -> NDArray[Any]:
    numbers: Floats = np.frombuffer(reader.take(8 * (shape[1] + 1)), "<f8")
    origin, step = numbers[:-1], numbers[-1]
    steps = decode_numbers(reader, shape, near, effort)
    reader_is_done(reader)
    with np.errstate(over="ignore", invalid="ignore"):
        values = (steps * step + origin).astype(kind)
    if not np.isfinite(values).all():
        raise reader.fault("values that are not finite")
    return values
