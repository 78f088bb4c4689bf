"""The most common lines of OBJ and OFF files, plain vertices and triangles, at full speed."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import kernel
from beltrami.io.digits import eight
from beltrami.io.numbers import read_number

_SPACE, _NEWLINE, _V = 32, 10, 118


@kernel
def plain_vertices(b: Any, p: int, end: int, x: Any, n: int) -> Any:
    r"""Read lines ``v x y z`` with single blanks as long as there are such: (position, n).

    The first line that is anything else, wrong ones too, is left to the caller.

    Examples
    --------
    >>> import numpy as np
    >>> b, x = np.frombuffer(b"v 1 2 .5\nv 1 2 3 4\n", np.uint8), np.empty((9, 3))
    >>> plain_vertices(b, 0, len(b), x, 0)
    (9, 1)
    """
    while n < x.shape[0] and p + 1 < end and b[p] == _V and b[p + 1] == _SPACE:
        x0, q = read_number(b, p + 2, end)
        if q == p + 2 or q >= end or b[q] != _SPACE:
            break
        x1, r = read_number(b, q + 1, end)
        if r == q + 1 or r >= end or b[r] != _SPACE:
            break
        x2, q = read_number(b, r + 1, end)
        if q == r + 1 or q >= end or b[q] != _NEWLINE:
            break
        total = x0 + x1 + x2
        if total - total != 0.0:  # NaN or infinite, or a sum that overflows
            break
        x[n, 0] = x0
        x[n, 1] = x1
        x[n, 2] = x2
        n += 1
        p = q + 1
    return p, n


@kernel
def plain_faces(b: Any, p: int, tag: int, base: int, limit: int, faces: Any, m: int) -> Any:
    r"""Read lines of a tag and i j k, from base to limit, with single blanks: (position, m).

    The tag is ``f`` in OBJ and ``3`` in OFF.

    Examples
    --------
    >>> import numpy as np
    >>> b, faces = np.frombuffer(b"f 1 2 3\nf 1 2 3 4\n", np.uint8), np.empty((9, 3), int)
    >>> plain_faces(b, 0, ord("f"), 1, 4, faces, 0)
    (8, 1)
    """
    end = b.size
    while m < faces.shape[0] and p + 1 < end and b[p] == tag and b[p + 1] == _SPACE:
        i, q = _index(b, p + 2, end, base, limit)
        if q >= end or b[q] != _SPACE:
            break
        j, q = _index(b, q + 1, end, base, limit)
        if q >= end or b[q] != _SPACE:
            break
        k, q = _index(b, q + 1, end, base, limit)
        if q >= end or b[q] != _NEWLINE:
            break
        faces[m, 0] = i
        faces[m, 1] = j
        faces[m, 2] = k
        m += 1
        p = q + 1
    return p, m


@kernel
def _index(b: Any, p: int, end: int, base: int, limit: int) -> Any:
    """Read an index of base..limit: (index from 0, position), or ``end`` where there is none."""
    if p + 8 > end:  # the last bytes of the file
        return 0, end
    value, count = eight(b, p)
    index = np.int64(value)
    if count == np.uint64(0) or index < base or index > limit:
        return 0, end
    return index - base, p + np.int64(count)
