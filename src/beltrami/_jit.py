"""Compiled kernels: numba, cached on disk where a folder can be written."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba
from numba.core import event, types
from numba.core.typing.templates import infer_global
from numpy.typing import NDArray

from beltrami._collector import resting_collector

Function = TypeVar("Function", bound=Callable[..., Any])


class _Compiling(event.Listener):  # type: ignore[misc]
    """Lets the collector of garbage rest while numba compiles, or loads what it had compiled."""

    def on_start(self, event: Any) -> None:  # noqa: ARG002
        resting_collector.__enter__()

    def on_end(self, event: Any) -> None:  # noqa: ARG002
        resting_collector.__exit__()


event.register("numba:compiler_lock", _Compiling())
_PARTS: dict[Any, Any] = {}  # what is compiled without an entry for Python


def kernel(function: Function) -> Function:
    """Compile a function on first use; nothing breaks where the cache cannot be written.

    The GIL is released, floating-point arithmetic is not reordered: the same input gives the
    same bits. A part of kernels can be one as well; what is on disk has no entry for Python then.
    """
    try:
        return cast(Function, numba.njit(cache=function not in _PARTS, nogil=True)(function))
    except RuntimeError:  # "cannot cache function": no folder to write into
        return cast(Function, numba.njit(nogil=True)(function))


def plain_kernel(function: Function) -> Function:
    """Compile like ``kernel`` what makes no arrays, and returns none; it may take and view them.

    Nothing counts who holds an array then. Counting is atomic, and takes longer than all else in
    a small kernel that is called with many arrays. Such a kernel that makes an array does not
    compile.
    """
    options: dict[str, Any] = {"nogil": True, "_nrt": False}
    try:
        return cast(Function, numba.njit(cache=True, **options)(function))
    except RuntimeError:
        return cast(Function, numba.njit(**options)(function))
    except KeyError:  # an option of numba that may go away
        return kernel(function)


def part_of_kernels(function: Function) -> Function:
    """Let kernels call a function; for Python it stays as it is written.

    It is compiled once for all kernels that call it, and kept on disk, without what makes it
    ready for Python, which takes as long as a small function itself. Each constant that it is
    called with is another type, for which it is compiled anew.
    """
    options: dict[str, Any] = {"nogil": True, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    try:
        part = numba.njit(cache=True, **options)(function)
    except RuntimeError:
        part = numba.njit(**options)(function)
    _PARTS[function] = part  # types hold what they are of weakly
    infer_global(function, types.Dispatcher(part))  # Python itself would crash if it called it
    return function


def unsigned(indices: NDArray[Any]) -> NDArray[Any]:
    """View non-negative integers as unsigned ones, for a kernel to index with.

    With a signed index numba tests for a negative one at each access, and counts it from the
    end; in loops that do little else this costs up to half of the time.
    """
    return indices.view(indices.dtype.str.replace("i", "u"))


def summing_kernel(function: Function) -> Function:
    """Compile like ``kernel``, and let sums be formed in lanes, as the processor likes them.

    The order of a sum is chosen when the kernel is compiled: the same input gives the same bits
    on one machine, but not on another kind of processor.
    """
    lanes = {"reassoc", "contract", "nsz"}
    try:
        return cast(Function, numba.njit(cache=True, nogil=True, fastmath=lanes)(function))
    except RuntimeError:
        return cast(Function, numba.njit(nogil=True, fastmath=lanes)(function))
