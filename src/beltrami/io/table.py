"""Columns of numbers in a text file."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats
from beltrami.errors import FileFormatError, check_name
from beltrami.io.source import Source, mark_length

_SEPARATORS = bytes.maketrans(b",;", b"  ")


def read_table(source: Source, name: str | None = None, missing: bool = False) -> Floats:
    r"""Read rows of numbers parted by blanks, commas or semicolons: (n,) or (n, c).

    Text after ``#`` and blank lines are skipped. A first line that is not all numbers names the
    columns; then ``name`` chooses one.
    NaN is a number where values may be ``missing``.

    Raises
    ------
    FileFormatError
        With the line, where a number is missing, is too many, or is not finite.
    UnknownNameError
        If no column has this name.

    Examples
    --------
    >>> import numpy as np
    >>> read_table(Source("f.csv", np.frombuffer(b"u,v\n1,2\n3,4\n", np.uint8)), "v").tolist()
    [2.0, 4.0]
    """
    rows: list[list[float]] = []
    names: list[str] = []
    text = source.data[mark_length(source.data) :].tobytes()
    for number, line in enumerate(text.split(b"\n"), 1):
        words = line.split(b"#")[0].translate(_SEPARATORS).split()
        if not words:
            continue
        try:
            row = [float(word) for word in words]
        except ValueError as cause:
            if rows or names:
                found = line[:40].decode("latin-1").strip()
                raise FileFormatError(
                    source.path, f"expected numbers, found {found!r}", line=number
                ) from cause
            names = [word.decode("latin-1").strip("\"'") for word in words]
            continue
        width = len(rows[0]) if rows else len(names) or len(row)
        if len(row) != width or not _valid(row, missing):
            raise FileFormatError(
                source.path,
                f"expected {width} finite numbers, as on the lines before, found {row[:5]}",
                line=number,
            )
        rows.append(row)
    if not rows:
        raise FileFormatError(source.path, "expected rows of numbers, found none")
    table = np.array(rows)
    if name is not None:
        return np.ascontiguousarray(table[:, names.index(check_name("column", name, names))])
    return table[:, 0] if table.shape[1] == 1 else table


def _valid(row: list[float], missing: bool) -> bool:
    values = np.array(row)
    return not np.isinf(values).any() if missing else bool(np.isfinite(values).all())
