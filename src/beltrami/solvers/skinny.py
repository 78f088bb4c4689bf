"""Products of tall panels with a few columns: C += P'Z and W += P C.

BLAS first copies P into an order that it likes, which takes longer than such a product. Here eight
rows of the result stay in vector registers, and P is read as it is.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic
from numpy.typing import NDArray

from beltrami._jit import kernel

_TALL = 256  # rows of P at a time: they stay in the cache while its columns are gone through
_SMALLEST = 16  # bytes of a vector
_WORD = ir.IntType(64)
_FUSED = ("contract",)  # a product and a sum may be one instruction


def padded(Z: NDArray[Any]) -> NDArray[Any]:
    """Return Z with columns of zeros added, until its rows are whole vectors."""
    missing = -Z.shape[1] % (_SMALLEST // Z.itemsize)
    return np.ascontiguousarray(np.pad(Z, ((0, 0), (0, missing))) if missing else Z)


@intrinsic(prefer_literal=True)  # type: ignore[untyped-decorator]
def _tile(
    typing_context: Any,  # noqa: ARG001
    like: Any,
    target: Any,
    across: Any,
    factors: Any,
    factor_step: Any,
    step: Any,
    vectors: Any,
    count: Any,
    rows: Any,
    width: Any,
    lines: Any,
) -> Any:
    """Add ``count`` multiples of vectors to each of some rows of a target.

    Row i of the target is at ``target + i across``, its k-th factor at ``factors + i factor_step +
    k step``, and the k-th vector at ``vectors + k across``: all in bytes. A row has ``lines``
    vectors of ``width`` bytes, of numbers that have the type of ``like``.
    """
    arguments = (
        like, target, across, factors, factor_step, step, vectors, count, rows, width, lines,
    )  # fmt: skip
    shape = rows.literal_value, width.literal_value, lines.literal_value

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        number = context.get_value_type(signature.args[0])
        _write(builder, number, values[1:8], *shape)
        return context.get_dummy_value()

    return types.void(*arguments), generate


def _write(builder: Any, number: Any, values: Any, rows: int, width: int, lines: int) -> None:
    """Write the instructions of a tile."""
    target, across, factors, factor_step, step, vectors, count = values
    size = 8 if isinstance(number, ir.DoubleType) else 4
    vector = ir.VectorType(number, width // size)

    def at(base: Any, stride: Any, i: Any, more: int = 0) -> Any:
        moved = builder.add(base, builder.mul(stride, i))
        return builder.add(moved, ir.Constant(_WORD, more))

    def load(address: Any, kind: Any) -> Any:
        loaded = builder.load(builder.inttoptr(address, kind.as_pointer()))
        loaded.align = size
        return loaded

    row = [ir.Constant(_WORD, i) for i in range(rows)]
    tile = [(i, w) for i in range(rows) for w in range(lines)]
    places = {(i, w): at(target, across, row[i], w * width) for i, w in tile}
    sums = {one: cgutils.alloca_once(builder, vector) for one in tile}
    for one in tile:
        builder.store(load(places[one], vector), sums[one])
    zero, next_one = ir.Constant(_WORD, 0), ir.Constant(_WORD, 1)
    with cgutils.for_range_slice(builder, zero, count, next_one, _WORD) as (k, _):
        others = [load(at(vectors, across, k, w * width), vector) for w in range(lines)]
        column = at(factors, step, k)
        for i in range(rows):
            factor = _everywhere(builder, load(at(column, factor_step, row[i]), number), vector)
            for w in range(lines):
                product = builder.fmul(factor, others[w], flags=_FUSED)
                total = builder.fadd(builder.load(sums[i, w]), product, flags=_FUSED)
                builder.store(total, sums[i, w])
    for one in tile:
        to = builder.inttoptr(places[one], vector.as_pointer())
        builder.store(builder.load(sums[one]), to).align = size


def _everywhere(builder: Any, number: Any, vector: Any) -> Any:
    """Return the vector whose every lane is this number."""
    nothing, index = ir.Constant(vector, ir.Undefined), ir.IntType(32)
    first = builder.insert_element(nothing, number, ir.Constant(index, 0))
    lanes = ir.Constant(ir.VectorType(index, vector.count), [0] * vector.count)
    return builder.shuffle_vector(first, nothing, lanes)


@kernel
def _eight(
    like: Any, target: int, across: int, factors: int, factor_step: int, step: int, vectors: int,
    count: int,
) -> None:  # fmt: skip
    """Add multiples of the vectors, rows of ``across`` bytes, to eight rows of the target."""
    done = 0
    while done + 128 <= across:
        _tile(like, target + done, across, factors, factor_step, step, vectors + done, count,
              8, 64, 2)  # fmt: skip
        done += 128
    while done + 64 <= across:
        _tile(like, target + done, across, factors, factor_step, step, vectors + done, count,
              8, 64, 1)  # fmt: skip
        done += 64
    while done + 32 <= across:
        _tile(like, target + done, across, factors, factor_step, step, vectors + done, count,
              8, 32, 1)  # fmt: skip
        done += 32
    while done < across:
        _tile(like, target + done, across, factors, factor_step, step, vectors + done, count,
              8, 16, 1)  # fmt: skip
        done += 16


@kernel
def _one(
    like: Any, target: int, across: int, factors: int, factor_step: int, step: int, vectors: int,
    count: int,
) -> None:  # fmt: skip
    """Likewise to one row."""
    done = 0
    while done < across:
        _tile(like, target + done, across, factors, factor_step, step, vectors + done, count,
              1, 16, 1)  # fmt: skip
        done += 16


@kernel
def add_transposed_products(
    panels: Any, widths: Any, first: int, rows: int, Z: Any, C: Any, part: Any
) -> None:
    """C += [P Q ...]'Z, from column ``first`` of P on, as many as C (m, c) has rows.

    ``panels`` are addresses of (n, width) arrays; ``part`` is room like C. Sums are formed over
    ``rows`` rows at a time, so that rounding does not grow with n.
    """
    n, m, size, zero = Z.shape[0], C.shape[0], Z.itemsize, Z[0, 0]
    across, base, vectors = size * C.shape[1], part.ctypes.data, Z.ctypes.data
    for begin in range(0, n, rows):
        part[:] = 0
        for start in range(begin, min(begin + rows, n), _TALL):
            count = min(_TALL, min(begin + rows, n) - start)
            z, done, skipped = vectors + start * across, 0, first
            for p in range(panels.size):
                width = min(widths[p] - skipped, m - done)
                row = size * widths[p]
                factors = panels[p] + start * row + skipped * size
                for i in range(0, width - 7, 8):
                    to = base + (done + i) * across
                    _eight(zero, to, across, factors + i * size, size, row, z, count)
                for i in range(width - width % 8, width):
                    to = base + (done + i) * across
                    _one(zero, to, across, factors + i * size, size, row, z, count)
                done, skipped = done + width, 0
        C += part


@kernel
def add_products(W: Any, panels: Any, widths: Any, first: int, C: Any) -> None:
    """W += [P Q ...] C, from column ``first`` of P on, as many as C (m, c) has rows."""
    n, m, size, zero = W.shape[0], C.shape[0], W.itemsize, W[0, 0]
    across, target = size * C.shape[1], W.ctypes.data
    for start in range(0, n, _TALL):
        stop, done, skipped = min(start + _TALL, n), 0, first
        for p in range(panels.size):
            width = min(widths[p] - skipped, m - done)
            row, vectors = size * widths[p], C.ctypes.data + done * across
            factors = panels[p] + skipped * size
            for i in range(start, stop - 7, 8):
                to = target + i * across
                _eight(zero, to, across, factors + i * row, row, size, vectors, width)
            for i in range(stop - (stop - start) % 8, stop):
                to = target + i * across
                _one(zero, to, across, factors + i * row, row, size, vectors, width)
            done, skipped = done + width, 0
