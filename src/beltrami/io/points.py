"""read_points: the points of a file without faces, or those of a mesh."""

from __future__ import annotations

import os
from collections.abc import Callable

from beltrami._arrays import Floats
from beltrami._kinds import checked
from beltrami.errors import FileFormatError
from beltrami.io.obj import obj_points
from beltrami.io.off import off_points
from beltrami.io.ply import ply_points
from beltrami.io.registry import suffix_of
from beltrami.io.source import Source, load
from beltrami.io.table import read_table


def _table_points(source: Source) -> Floats:
    """Read rows that begin with x y z."""
    rows = read_table(source)
    if rows.ndim != 2 or rows.shape[1] < 3:
        raise FileFormatError(source.path, "expected rows of three numbers or more, x y z")
    return rows[:, :3].copy()


READERS: dict[str, Callable[[Source], Floats]] = {
    ".ply": ply_points,
    ".obj": obj_points,
    ".off": off_points,
    ".xyz": _table_points,
    ".csv": _table_points,
    ".txt": _table_points,
}


@checked
def read_points(path: str | os.PathLike[str], *, max_bytes: int | None = None) -> Floats:
    r"""Read the points of a file, as a scanner writes them; faces, if there are any, are left out.

    ``PointCloud(read_points(path))`` has a Laplacian without any. OBJ, OFF and PLY are read
    byte by byte as in ``read_mesh``; XYZ, CSV and TXT are rows of numbers that begin with x y z,
    where a first row of names is skipped. Any of them may be compressed (``.gz``).

    Parameters
    ----------
    path
        The file.
    max_bytes
        What a compressed file may unpack to; see ``read_mesh``.

    Returns
    -------
    (n, 3) float64
        In the order of the file.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    UnknownNameError
        If the suffix is not known.
    FileFormatError
        If the file is not what its format promises, with the line or the byte; or has no points.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     place = pathlib.Path(folder, "scan.xyz")
    ...     _ = place.write_text("0 0 0\n1 0 0\n0 1 0.5\n")
    ...     read_points(place).tolist()
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.5]]
    """
    return READERS[suffix_of(path, None, tuple(READERS))](load(path, max_bytes))
