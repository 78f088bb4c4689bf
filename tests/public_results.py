"""All numbers in a result, whatever it is: fields, and everything that it derives when asked."""

from __future__ import annotations

import functools
import hashlib
import inspect
import types
from collections.abc import Iterator, Mapping

import numpy as np
from scipy.sparse import issparse

from beltrami.errors import BeltramiError

_LEAVES = (str, type(None), types.FunctionType, types.BuiltinFunctionType, type)


def arrays_of(result, seen=None):
    """Every array of numbers, with its path: dataclasses and frozen objects by all attributes.

    A derived attribute that is refused with a ``BeltramiError`` is left out.
    """
    yield from _walk("", result, set())


def _walk(path, value, seen):
    if isinstance(value, np.ndarray | np.generic | int | float | complex):
        yield path, np.asarray(value)
    elif isinstance(value, bytes):
        yield path, np.frombuffer(value, np.uint8)
    elif issparse(value):
        yield path, value.data
    elif isinstance(value, _LEAVES) or id(value) in seen:
        return
    else:
        seen.add(id(value))
        for name, part in _parts(value):
            yield from _walk(f"{path}.{name}", part, seen)


def _parts(value):
    if isinstance(value, Mapping):
        yield from value.items()
    elif isinstance(value, list | tuple | Iterator):
        yield from enumerate(value)
    elif type(value).__module__.startswith("beltrami"):
        for name in dir(value):
            static = inspect.getattr_static(value, name)
            derived = isinstance(static, property | functools.cached_property)
            if name.startswith("_") or (callable(static) and not derived):
                continue
            try:
                yield name, getattr(value, name)
            except BeltramiError:
                continue


def digest(result, leave_out=("seconds", "path")):
    """A digest of all bits of a result, but for what tells the time or where a file was.

    Floats are taken as float64, since functions on a mesh keep their type.
    """
    sha = hashlib.sha256()
    for path, array in arrays_of(result):
        if not any(word in path for word in leave_out):
            array = array.astype(np.float64) if array.dtype.kind == "f" else array
            sha.update(f"{path} {array.dtype} {array.shape};".encode())
            sha.update(np.ascontiguousarray(array).tobytes())
    return sha.hexdigest()
