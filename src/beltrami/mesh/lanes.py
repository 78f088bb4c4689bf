"""Instructions that numba has no words for: eight comparisons at once, memory asked for early."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic

LANES = 8
_WORD, _INDEX = ir.IntType(64), ir.IntType(32)
_BYTE = ir.IntType(8)
_EIGHT = ir.VectorType(_WORD, LANES)
_TO_WRITE, _KEEP, _DATA = 1, 3, 1  # what prefetch is to do


@intrinsic  # type: ignore[untyped-decorator]
def below(typing_context: Any, address: Any, bound: Any) -> Any:  # noqa: ARG001
    """Compare eight unsigned words from an address on with a bound: bit t if word t is less.

    All eight are read, without a branch that the processor could guess wrong.
    """

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:  # noqa: ARG001
        words = builder.load(builder.inttoptr(values[0], _EIGHT.as_pointer()))
        words.align = _WORD.width // 8
        nothing = ir.Constant(_EIGHT, ir.Undefined)
        first = builder.insert_element(nothing, values[1], ir.Constant(_INDEX, 0))
        everywhere = ir.Constant(ir.VectorType(_INDEX, LANES), [0] * LANES)
        bounds = builder.shuffle_vector(first, nothing, everywhere)
        less = builder.icmp_unsigned("<", words, bounds)
        return builder.zext(builder.bitcast(less, ir.IntType(LANES)), _WORD)

    return types.uint64(address, bound), generate


@intrinsic  # type: ignore[untyped-decorator]
def bits_in(typing_context: Any, mask: Any) -> Any:  # noqa: ARG001
    """Count the bits of a word that are 1."""

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:  # noqa: ARG001
        return builder.ctpop(values[0])

    return types.uint64(mask), generate


@intrinsic  # type: ignore[untyped-decorator]
def first_bit(typing_context: Any, mask: Any) -> Any:  # noqa: ARG001
    """Return the number of the lowest bit that is 1; there must be one."""

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:  # noqa: ARG001
        return builder.cttz(values[0], ir.Constant(ir.IntType(1), 1))

    return types.uint64(mask), generate


@intrinsic  # type: ignore[untyped-decorator]
def will_write(typing_context: Any, address: Any) -> Any:  # noqa: ARG001
    """Ask for the memory at an address, which is written soon; an invalid one does no harm."""

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:  # noqa: ARG001
        pointer = _BYTE.as_pointer()
        kind = ir.FunctionType(ir.VoidType(), [pointer, _INDEX, _INDEX, _INDEX])
        prefetch = builder.module.declare_intrinsic("llvm.prefetch", (pointer,), kind)
        how = [ir.Constant(_INDEX, choice) for choice in (_TO_WRITE, _KEEP, _DATA)]
        builder.call(prefetch, [builder.inttoptr(values[0], pointer), *how])
        return context.get_dummy_value()

    return types.void(address), generate
