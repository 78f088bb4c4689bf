"""The most common lines of OBJ and OFF files, plain vertices and triangles, at full speed."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import part_of_kernels
from beltrami.io.digits import eight
from beltrami.io.numbers import read_number

_SPACE, _NEWLINE, _RETURN, _V = 32, 10, 13, 118


@part_of_kernels
def plain_vertices(b: Any, p: int, end: int, x: Any, n: int) -> Any:
    r"""Read lines ``v x y z`` with single blanks as long as there are such: (position, n).

    The first line that is anything else, wrong ones too, is left to the caller.

    Examples
    --------
    >>> import numpy as np
    >>> from beltrami._jit import kernel
    >>> b, x = np.frombuffer(b"v 1 2 .5\nv 1 2 3 4\n", np.uint8), np.empty((9, 3))
    >>> kernel(plain_vertices)(b, 0, len(b), x, 0)
    (9, 1)
    """
    while n < x.shape[0] and p + 1 < end and b[p] == _V and b[p + 1] == _SPACE:
        start, total = p + 2, 0.0
        for c in range(3):
            value, q = read_number(b, start, end)
            if q == start or q >= end:
                return p, n
            if b[q] != (_NEWLINE if c == 2 else _SPACE):
                if c < 2 or b[q] != _RETURN or q + 1 >= end or b[q + 1] != _NEWLINE:
                    return p, n
                q += 1
            x[n, c] = value
            total += value
            start = q + 1
        if total - total != 0.0:  # NaN or infinite, or a sum that overflows
            break
        n += 1
        p = start
    return p, n


@part_of_kernels
def plain_faces(b: Any, p: int, tag: int, base: int, limit: int, faces: Any, m: int) -> Any:
    r"""Read lines of a tag and i j k, from base to limit, with single blanks: (position, m).

    The tag is ``f`` in OBJ and ``3`` in OFF.

    Examples
    --------
    >>> import numpy as np
    >>> from beltrami._jit import kernel
    >>> b, faces = np.frombuffer(b"f 1 2 3\nf 1 2 3 4\n", np.uint8), np.empty((9, 3), int)
    >>> kernel(plain_faces)(b, 0, ord("f"), 1, 4, faces, 0)
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
        if q >= end:
            break
        if b[q] != _NEWLINE:
            if b[q] != _RETURN or q + 1 >= end or b[q + 1] != _NEWLINE:
                break
            q += 1
        faces[m, 0] = i
        faces[m, 1] = j
        faces[m, 2] = k
        m += 1
        p = q + 1
    return p, m


@part_of_kernels
def _index(b: Any, p: int, end: int, base: int, limit: int) -> Any:
    """Read an index of base..limit: (index from 0, position), or ``end`` where there is none."""
    if p + 8 > end:  # the last bytes of the file
        return 0, end
    value, count = eight(b, p)
    index = np.int64(value)
    if count == np.uint64(0) or index < base or index > limit:
        return 0, end
    return index - base, p + np.int64(count)
