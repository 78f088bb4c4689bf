"""Vertex data as PLY properties: columns with names, and back."""

from __future__ import annotations

import re
from collections.abc import Mapping
from urllib.parse import quote, unquote

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import read_only
from beltrami.io.ply_texture import PAIRS

_COLOUR = ("red", "green", "blue", "alpha")
_NORMAL = ("nx", "ny", "nz")
_RESERVED = frozenset(("x", "y", "z", *_COLOUR, *_NORMAL))
_PRINTABLE = "!\"#$&'()*+,/:;<=>?@[\\]^`{|}"  # all of ASCII that is no blank, but not "%"
_KEPT = ("i1", "u1", "i2", "u2", "i4", "u4", "f4", "f8")


def grouped(columns: Mapping[str, NDArray[np.generic]]) -> dict[str, NDArray[np.generic]]:
    """Join columns that belong together, and undo :func:`columns_of`.

    Columns of different types stay apart.

    Examples
    --------
    >>> import numpy as np
    >>> column = np.zeros(4, np.uint8)
    >>> found = grouped({"red": column, "green": column, "blue": column, "uv_0": column})
    >>> {name: array.shape for name, array in found.items()}
    {'color': (4, 3), 'uv': (4, 1)}
    """
    result: dict[str, NDArray[np.generic]] = {}
    used: set[str] = set()
    for name in columns:
        if name in used:
            continue
        group, members = _group(name, columns)
        array = columns[name] if not members else np.stack([columns[m] for m in members], axis=1)
        used.update(members)
        native = array.astype(array.dtype.newbyteorder("="))
        result[unquote(group, errors="replace")] = read_only(np.ascontiguousarray(native))
    return result


def _group(name: str, columns: Mapping[str, NDArray[np.generic]]) -> tuple[str, tuple[str, ...]]:
    """Return the name and the members of the group that this column begins."""
    numbered = re.fullmatch(r"(.+)_0", name)
    members: tuple[str, ...] = ()
    group = name
    if name == "red":
        members = _COLOUR if "alpha" in columns else _COLOUR[:3]
        group = "color"
    elif name == "nx":
        members, group = _NORMAL, "normal"
    elif numbered:
        group = numbered[1]
        count = 1
        while f"{group}_{count}" in columns:
            count += 1
        members = tuple(f"{group}_{c}" for c in range(count))
    together = all(m in columns and columns[m].dtype == columns[name].dtype for m in members)
    if not members or not together or (group in columns):
        return name, ()
    return group, members


def columns_of(data: Mapping[str, NDArray[np.generic]]) -> dict[str, NDArray[np.generic]]:
    """Part arrays (n,) and (n, c) into columns of PLY types, with names without blanks.

    Integers that a PLY integer holds are written as such, others as doubles; truth values as
    bytes. What is no number is left out. Blanks, letters beyond ASCII, and names that would be
    joined by mistake are written as ``%`` and two digits.

    Examples
    --------
    >>> import numpy as np
    >>> list(columns_of({"color": np.zeros((2, 3)), "my f": np.zeros(2), "g": np.zeros((2, 2))}))
    ['red', 'green', 'blue', 'my%20f', 'g_0', 'g_1']
    """
    result: dict[str, NDArray[np.generic]] = {}
    for name, array in data.items():
        if array.dtype.kind not in "biuf" or array.ndim not in (1, 2):
            continue
        kept = _as_ply_type(array)
        if array.ndim == 1:
            result[_escaped(name, data)] = kept
            continue
        width = kept.shape[1]
        if name == "color" and width in (3, 4):
            names = _COLOUR[:width]
        elif name == "normal" and width == 3:
            names = _NORMAL
        else:
            names = tuple(f"{quote(name, safe=_PRINTABLE)}_{c}" for c in range(width))
        result.update({n: kept[:, c] for c, n in enumerate(names)})
    return result


def _escaped(name: str, data: Mapping[str, object]) -> str:
    """Write the name of a single column so that reading does not join it to others.

    Nor takes two functions u and v for texture coordinates.
    """
    safe = quote(name, safe=_PRINTABLE)
    paired = any(name == first and second in data for first, second in PAIRS)
    if safe in _RESERVED or paired or not safe:
        return "".join(f"%{ord(letter):02X}" for letter in safe[:1]) + safe[1:] if safe else "%20"
    return re.sub(r"_(?=\d+$)", "%5F", safe)


def _as_ply_type(array: NDArray[np.generic]) -> NDArray[np.generic]:
    if array.dtype.str[1:] in _KEPT:
        return array
    if array.dtype.kind == "b":
        return array.astype(np.uint8)
    if array.dtype.kind in "iu":
        low, high = (int(array.min()), int(array.max())) if array.size else (0, 0)
        for kind in (np.int32, np.uint32):
            info = np.iinfo(kind)
            if info.min <= low and high <= info.max:
                return array.astype(kind)
    return array.astype(np.float32 if array.dtype.itemsize == 2 else np.float64)
