"""The multifrontal factorisation L S L' of a symmetric indefinite matrix; S is a diagonal of signs.

It is L D L' with the roots of abs(D) put into L, so that substitution is that of Cholesky, with
the signs between. Rows are not exchanged: the order is that of the dissection.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import kernel
from beltrami.solvers.blas import N, T, divide_right, multiply
from beltrami.solvers.elimination import stride
from beltrami.solvers.fronts import assemble, put_away

_ONE, _MINUS = 0, 1  # places of the scalars
_WIDTH = 32  # columns that are factorised without BLAS
_STRIP = 64  # columns of an update at a time: what is above the diagonal is not needed


@kernel
def factorize_signed_fronts(
    indptr: Any,
    indices: Any,
    data: Any,
    scale: Any,
    order: Any,
    place: Any,
    starts: Any,
    children: Any,
    siblings: Any,
    row_starts: Any,
    rows: Any,
    panels: Any,
    b: Any,
    values: Any,
    stack: Any,
    stack_at: Any,
    local: Any,
    target: Any,
    signs: Any,
    work: Any,
    smallest: float,
) -> Any:
    """Fill ``values`` (zero before) and ``signs`` (n,); see ``factorize_fronts`` for the rest.

    Returns -1, or the column whose pivot is below ``smallest``. Workspace besides: ``work``
    (32 (widest + tallest),).
    """  # fmt: skip
    top = 0
    for i in range(starts.size - 1):
        first, columns = starts[i], starts[i + 1] - starts[i]
        below = row_starts[i + 1] - row_starts[i]
        panel = values[panels[i] : panels[i + 1]]
        update = stack[top : top + below * stride(below)]
        base = assemble(
            indptr, indices, data, scale, order, place, starts, children, siblings, row_starts,
            rows, stack, stack_at, local, target, i, panel, update, top,
        )  # fmt: skip
        failed = _panel(
            panel, columns, below, signs[first : first + columns], update, b, work, smallest
        )
        if failed >= 0:
            return first + failed
        top = put_away(stack, stack_at, i, update, below, base, top)
    return -1


@kernel
def _panel(
    panel: Any,
    columns: int,
    below: int,
    signs: Any,
    update: Any,
    b: Any,
    work: Any,
    smallest: float,
) -> Any:
    """Factorise a panel some columns at a time; return -1, or the column without a pivot."""
    height, width = columns + below, panel.itemsize
    start = panel.ctypes.data
    for k in range(0, columns, _WIDTH):
        last = min(k + _WIDTH, columns)
        failed = _triangle(panel, height, k, last, signs, smallest)
        if failed >= 0:
            return failed
        rest = height - last
        if rest == 0:
            continue
        corner = start + width * (k + k * height)
        under = start + width * (last + k * height)
        divide_right(b, T, N, rest, last - k, corner, height, under, height)
        for c in range(k, last):  # what stands there is L S: keep it, and make L of it
            for r in range(rest):
                entry = panel[last + r + c * height]
                work[(c - k) * rest + r] = entry
                panel[last + r + c * height] = entry * signs[c]
        there, right = work.ctypes.data, columns - last
        if right:
            multiply(
                b, N, T, rest, right, last - k, _MINUS, _ONE, under, height, there, rest,
                start + width * (last + last * height), height,
            )  # fmt: skip
        for c in range(0, below, _STRIP):
            count = min(_STRIP, below - c)
            multiply(
                b, N, T, below - c, count, last - k, _MINUS, _ONE,
                under + width * (right + c), height, there + width * (right + c), rest,
                update.ctypes.data + width * (c + c * stride(below)), stride(below),
            )  # fmt: skip
    return -1


@kernel
def _triangle(panel: Any, height: int, low: int, high: int, signs: Any, smallest: float) -> Any:
    """Factorise the square of columns low to high; return -1, or the column without a pivot."""
    for k in range(low, high):
        pivot = panel[k + k * height]
        if not abs(pivot) >= smallest:
            return k
        sign = 1.0 if pivot > 0 else -1.0
        root = np.sqrt(abs(pivot))
        signs[k] = sign
        panel[k + k * height] = root
        for r in range(k + 1, high):
            panel[r + k * height] *= sign / root
        for c in range(k + 1, high):
            factor = panel[c + k * height] * sign
            for r in range(c, high):
                panel[r + c * height] -= panel[r + k * height] * factor
    return -1
