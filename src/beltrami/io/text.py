"""Rows of numbers as text, each number as short as reads back the same."""

from __future__ import annotations

from typing import IO, Any

from numpy.typing import NDArray

_BLOCK = 4096  # rows formatted at a time


def write_rows(file: IO[bytes], form: str, rows: NDArray[Any]) -> None:
    r"""Write each row of an (n, c) array by a form with c places, such as ``"v %r %r %r"``.

    ``%r`` writes the shortest decimal number that reads back bit for bit.

    Examples
    --------
    >>> import io, numpy as np
    >>> file = io.BytesIO()
    >>> write_rows(file, "v %r %r", np.array([[0.1, 2.0], [1e-300, 3.0]]))
    >>> file.getvalue()
    b'v 0.1 2.0\nv 1e-300 3.0\n'
    """
    line = form + "\n"
    for start in range(0, len(rows), _BLOCK):
        block = rows[start : start + _BLOCK]
        file.write(((line * len(block)) % tuple(block.ravel().tolist())).encode("ascii"))
