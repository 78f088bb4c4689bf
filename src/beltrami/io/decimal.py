"""The double nearest to a decimal number of any length: Python's own, called by compiled code."""

from __future__ import annotations

import math
from typing import Any

from numba.core import types

from beltrami._jit import part_of_kernels

# Of the C interface of Python, which numba has linked to kernels already. Called by name, so
# that a kernel that does can be kept on disk.
_HOLD: Any = types.ExternalFunction("PyGILState_Ensure", types.int32())
_LET_GO: Any = types.ExternalFunction("PyGILState_Release", types.void(types.int32))
_TO_DOUBLE: Any = types.ExternalFunction(
    "PyOS_string_to_double", types.float64(types.uintp, types.uintp, types.uintp)
)
_TAKE: Any = types.ExternalFunction("PyMem_RawCalloc", types.uintp(types.uintp, types.uintp))
_GIVE_BACK: Any = types.ExternalFunction("PyMem_RawFree", types.void(types.uintp))
_COPY: Any = types.ExternalFunction("memcpy", types.uintp(types.uintp, types.uintp, types.uintp))
_LONGEST = 10**9 - 1  # bytes; with more digits Python raises an error, which nothing here would see


@part_of_kernels
def nearest(b: Any, start: int, stop: int) -> float:
    """Return the double nearest to the number b[start:stop], ties to even; infinite beyond range.

    Only what neither one multiplication nor 128 bits decide comes here: numbers below the normal
    range, and ties. Python's global lock is taken for it.

    Examples
    --------
    >>> import numpy as np
    >>> from beltrami._jit import kernel
    >>> digits = np.frombuffer(b"9007199254740993", np.uint8)  # 2**53 + 1: a tie
    >>> kernel(nearest)(digits, 0, len(digits))
    9007199254740992.0
    """
    size = stop - start
    if size > _LONGEST:
        return math.nan
    text = _TAKE(size + 1, 1)
    if text == 0:
        return math.nan
    _COPY(text, b.ctypes.data + start, size)
    lock = _HOLD()
    value = _TO_DOUBLE(text, 0, 0)
    _LET_GO(lock)
    _GIVE_BACK(text)
    return value
