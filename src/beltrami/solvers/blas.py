"""BLAS and LAPACK inside compiled kernels: scipy's own, called by address.

A kernel that knew an address when it was compiled could not be kept on disk, because the next
process finds the library elsewhere. So the addresses are data: each kernel gets a ``Blas``, which
names the routines, and the letters, scalars and sizes that Fortran wants by reference.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import get_cython_function_address, intrinsic
from numpy.typing import DTypeLike, NDArray

from beltrami._jit import kernel

_LETTERS = b"LNTRU"
L, N, T, R, U = range(5)  # places of the letters: lower or left, no, transposed, right, unit


class Blas(NamedTuple):
    """What kernels need to call BLAS; one for each call of a kernel, for it holds workspace."""

    gemm: int
    syrk: int
    trsm: int
    potrf: int
    letters: NDArray[np.uint8]
    scalars: NDArray[Any]  # 1, -1, 0 in the precision of the routines
    sizes: NDArray[np.int32]  # what the routines read, and the answer of potrf


def blas(dtype: DTypeLike) -> Blas:
    """Return the routines for float64 or float32, with a workspace of their own."""
    kind = np.dtype(dtype)
    prefix = {"float64": "d", "float32": "s"}[kind.name]
    return Blas(
        _address("cython_blas", prefix + "gemm"),
        _address("cython_blas", prefix + "syrk"),
        _address("cython_blas", prefix + "trsm"),
        _address("cython_lapack", prefix + "potrf"),
        np.frombuffer(_LETTERS, np.uint8).copy(),
        np.array([1, -1, 0], kind),
        np.zeros(8, np.int32),
    )


@cache
def _address(library: str, routine: str) -> int:
    return int(get_cython_function_address(f"scipy.linalg.{library}", routine))


def _generate_call(typing_context: Any, address: Any, arguments: Any) -> Any:  # noqa: ARG001
    """Write the code of a call of the C function at an address, with a tuple of pointers."""
    signature = types.void(address, arguments)

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:  # noqa: ARG001
        pointers = cgutils.unpack_tuple(builder, values[1])
        shape = ir.FunctionType(ir.VoidType(), [pointer.type for pointer in pointers])
        builder.call(builder.inttoptr(values[0], shape.as_pointer()), pointers)
        return context.get_dummy_value()

    return signature, generate


call: Callable[[int, tuple[int, ...]], None] = intrinsic(_generate_call)  # in kernels only


@kernel
def multiply(
    b: Any,
    turn_a: int,
    turn_b: int,
    m: int,
    n: int,
    k: int,
    alpha: int,
    beta: int,
    A: int,
    lda: int,
    B: int,
    ldb: int,
    C: int,
    ldc: int,
) -> None:
    """C <- α op(A) op(B) + β C, column-major; letters and scalars by their places."""
    b.sizes[0], b.sizes[1], b.sizes[2] = m, n, k
    b.sizes[3], b.sizes[4], b.sizes[5] = lda, ldb, ldc
    size, letter = b.sizes.ctypes.data, b.letters.ctypes.data
    scalar, width = b.scalars.ctypes.data, b.scalars.itemsize
    call(b.gemm, (
        letter + turn_a, letter + turn_b, size, size + 4, size + 8, scalar + width * alpha,
        A, size + 12, B, size + 16, scalar + width * beta, C, size + 20,
    ))  # fmt: skip


@kernel
def subtract_square(b: Any, n: int, k: int, A: int, lda: int, C: int, ldc: int) -> None:
    """C <- C - A A', the lower triangle; A is (n, k)."""
    b.sizes[0], b.sizes[1], b.sizes[2] = n, k, lda
    b.sizes[3] = ldc
    size, letter = b.sizes.ctypes.data, b.letters.ctypes.data
    scalar, width = b.scalars.ctypes.data, b.scalars.itemsize
    call(b.syrk, (
        letter + L, letter + N, size, size + 4, scalar + width, A, size + 8, scalar, C, size + 12,
    ))  # fmt: skip


@kernel
def divide_right(
    b: Any, turn: int, unit: int, m: int, n: int, A: int, lda: int, B: int, ldb: int
) -> None:
    """B <- B op(A)⁻¹ for a lower triangle A; B is (m, n). ``unit``: N, or U for a diagonal of 1."""
    b.sizes[0], b.sizes[1], b.sizes[2] = m, n, lda
    b.sizes[3] = ldb
    size, letter, scalar = b.sizes.ctypes.data, b.letters.ctypes.data, b.scalars.ctypes.data
    call(b.trsm, (
        letter + R, letter + L, letter + turn, letter + unit, size, size + 4, scalar,
        A, size + 8, B, size + 12,
    ))  # fmt: skip


@kernel
def cholesky_in_place(b: Any, n: int, A: int, lda: int) -> int:
    """Overwrite A by its lower Cholesky factor; return 0, or the first column (from 1) without."""
    b.sizes[0], b.sizes[1], b.sizes[2] = n, lda, 0
    size, letter = b.sizes.ctypes.data, b.letters.ctypes.data
    call(b.potrf, (letter + L, size, A, size + 4, size + 8))
    return int(b.sizes[2])
