"""A few rows of many right-hand sides in registers: the innermost loop of substitution.

Compilers do not keep a tile of numbers in vector registers by themselves, so its instructions are
written here one by one, for vectors of up to 64 bytes; narrower machines split them.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic

LINE = 64  # bytes of a line of the cache, and of the largest vector
PIECE = 16  # bytes of the smallest
BELOW, FORWARD, BACKWARD = range(3)  # what a tile stands for
_WORD = ir.IntType(64)
_FUSED = ("contract",)  # a product and a sum may be one instruction
_POINTER = 8  # bytes


@intrinsic(prefer_literal=True)  # type: ignore[untyped-decorator]
def subtract(
    typing_context: Any,  # noqa: ARG001
    like: Any,
    x: Any,
    offsets: Any,
    target: Any,
    low: Any,
    high: Any,
    panel: Any,
    step: Any,
    lines: Any,
    rows: Any,
    kind: Any,
) -> Any:
    """Subtract multiples of rows low to high from some rows, target to target + ``rows``.

    Row t starts ``offsets[t]`` bytes after x, and only ``lines`` of it are treated there: a tuple
    of vectors, each told by a tuple of as many zeros as it has pieces of 16 bytes.
    The multiples are L[target + i, k] of a panel with a column each ``step`` bytes, or
    L[k, target + i] if ``kind`` is BACKWARD. If it is not BELOW, the triangle of L of these rows
    is then solved with. ``x``, ``offsets`` and ``panel`` are addresses, ``like`` is any number of
    their type; ``rows`` and ``kind`` are constants.
    """
    arguments = (like, x, offsets, target, low, high, panel, step, lines, rows, kind)
    made = rows.literal_value, lines.count, PIECE * lines.dtype.count, kind.literal_value

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        number = context.get_value_type(signature.args[0])
        _Tile(builder, number, values[1:8], *made).generate()
        return context.get_dummy_value()

    return types.void(*arguments), generate


@intrinsic  # type: ignore[untyped-decorator]
def fetch(typing_context: Any, address: Any) -> Any:  # noqa: ARG001
    """Ask for the line of the cache at an address, which need not be one of ours."""

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:  # noqa: ARG001
        kind, word = ir.IntType(8).as_pointer(), ir.IntType(32)
        shape = ir.FunctionType(ir.VoidType(), [kind, word, word, word])
        ask = builder.module.declare_intrinsic("llvm.prefetch", [kind], shape)
        reading, near, data = (ir.Constant(word, i) for i in (0, 3, 1))
        builder.call(ask, [builder.inttoptr(values[0], kind), reading, near, data])
        return context.get_dummy_value()

    return types.void(types.int64), generate


class _Tile:
    """Writes the instructions of one tile."""

    def __init__(
        self,
        builder: Any,
        number: Any,
        values: Any,
        rows: int,
        lines: int,
        width: int,
        kind: int,
    ) -> None:
        self.builder, self.number, self.kind = builder, number, kind
        self.x, self.offsets, self.target, self.low, self.high, self.panel, self.step = values
        self.rows, self.lines, self.width = range(rows), range(lines), width
        self.size = 8 if isinstance(number, ir.DoubleType) else 4
        self.lanes = width // self.size
        self.vector = ir.VectorType(number, self.lanes)

    def generate(self) -> None:
        """Sum what is to be subtracted, load the rows, solve with the triangle, store.

        Sums that begin at zero are rounded less than those that begin at the rows: in single
        precision eigenpairs need fewer solves for it.
        """
        builder = self.builder
        places = [self._row(self._plus(self.target, i)) for i in self.rows]
        sums = [[cgutils.alloca_once(builder, self.vector) for _ in self.lines] for _ in self.rows]
        zero = ir.Constant(self.vector, [0.0] * self.lanes)
        for i in self.rows:
            for w in self.lines:
                builder.store(zero, sums[i][w])
        with cgutils.for_range_slice(builder, self.low, self.high, self._word(1), _WORD) as (k, _):
            source = self._row(k)
            others = [
                self._load(self._plus(source, self.width * w), self.vector) for w in self.lines
            ]
            for i in self.rows:
                factor = self._everywhere(self._entry(i, k))
                for w in self.lines:
                    builder.store(
                        self._less(builder.load(sums[i][w]), factor, others[w]), sums[i][w]
                    )
        result = [
            [
                builder.fadd(
                    self._load(self._plus(places[i], self.width * w), self.vector),
                    builder.load(sums[i][w]),
                )
                for w in self.lines
            ]
            for i in self.rows
        ]
        self._solve(result)
        for i in self.rows:
            for w in self.lines:
                self._store(result[i][w], self._plus(places[i], self.width * w))

    def _solve(self, y: Any) -> None:
        """Solve with the triangle of the rows themselves."""
        order = {BELOW: (), FORWARD: self.rows, BACKWARD: self.rows[::-1]}[self.kind]
        one = ir.Constant(self.number, 1.0)
        for j in order:
            column = self._plus(self.target, j)
            inverse = self._everywhere(self.builder.fdiv(one, self._entry(j, column)))
            y[j] = [self.builder.fmul(y[j][w], inverse) for w in self.lines]
            for i in self.rows[j + 1 :] if self.kind == FORWARD else self.rows[:j]:
                factor = self._everywhere(self._entry(i, column))
                y[i] = [self._less(y[i][w], factor, y[j][w]) for w in self.lines]

    def _less(self, a: Any, b: Any, c: Any) -> Any:
        return self.builder.fsub(a, self.builder.fmul(b, c, flags=_FUSED), flags=_FUSED)

    def _word(self, value: int) -> Any:
        return ir.Constant(_WORD, value)

    def _plus(self, a: Any, b: int) -> Any:
        return self.builder.add(a, self._word(b))

    def _row(self, t: Any) -> Any:
        """Return where row t stands."""
        at = self.builder.add(self.offsets, self.builder.mul(t, self._word(_POINTER)))
        return self.builder.add(self.x, self._load(at, _WORD, _POINTER))

    def _entry(self, i: int, k: Any) -> Any:
        """Return L[target + i, k], or L[k, target + i] if backward."""
        row, column = self._plus(self.target, i), k
        if self.kind == BACKWARD:
            row, column = column, row
        multiply, add = self.builder.mul, self.builder.add
        at = add(multiply(row, self._word(self.size)), multiply(column, self.step))
        return self._load(add(self.panel, at), self.number, self.size)

    def _load(self, at: Any, kind: Any, align: int = 0) -> Any:
        loaded = self.builder.load(self.builder.inttoptr(at, kind.as_pointer()))
        loaded.align = align or self.size
        return loaded

    def _store(self, value: Any, at: Any) -> None:
        stored = self.builder.store(value, self.builder.inttoptr(at, value.type.as_pointer()))
        stored.align = self.size

    def _everywhere(self, number: Any) -> Any:
        """Return the vector whose every lane is this number."""
        nothing, index = ir.Constant(self.vector, ir.Undefined), ir.IntType(32)
        first = self.builder.insert_element(nothing, number, ir.Constant(index, 0))
        lanes = ir.Constant(ir.VectorType(index, self.lanes), [0] * self.lanes)
        return self.builder.shuffle_vector(first, nothing, lanes)
