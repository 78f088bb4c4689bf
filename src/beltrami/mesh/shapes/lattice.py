"""Faces of a lattice of rows and columns, each direction open or closed to a ring."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Integers


def lattice_faces(
    rows: int, columns: int, *, ring: tuple[bool, bool] = (False, False), alternating: bool = False
) -> Integers:
    """Cut the squares of a lattice in two, counter-clockwise where columns go right and rows up.

    Vertex (r, c) has the number r * (vertices in a row) + c. The diagonals go from (r, c) to
    (r + 1, c + 1), or, if ``alternating``, so where r + c is even and the other way where odd.

    Parameters
    ----------
    rows, columns
        The numbers of squares.
    ring
        Whether the rows, and the columns, close to a ring, the last next to the first.

    Returns
    -------
    (2 * rows * columns, 3) int

    Examples
    --------
    >>> lattice_faces(1, 1).tolist()
    [[0, 1, 3], [0, 3, 2]]
    """
    row_count = rows if ring[0] else rows + 1
    column_count = columns if ring[1] else columns + 1
    r, c = np.divmod(np.arange(rows * columns), columns)
    above, right = (r + 1) % row_count, (c + 1) % column_count
    p, q = r * column_count + c, r * column_count + right
    s, t = above * column_count + right, above * column_count + c
    faces = np.stack([p, q, s, p, s, t], axis=1)
    if alternating:
        odd = (r + c) % 2 == 1
        faces[odd] = np.stack([q, s, t, q, t, p], axis=1)[odd]
    return faces.reshape(-1, 3)
