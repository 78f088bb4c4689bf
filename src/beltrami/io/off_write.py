"""Writing OFF: vertices and triangles, with normals and colours where there are some."""

from __future__ import annotations

from typing import IO

import numpy as np

from beltrami._arrays import Floats
from beltrami.io.text import write_rows
from beltrami.mesh.mesh import Mesh


def write_off(file: IO[bytes], mesh: Mesh, vertices: Floats) -> None:
    """Write an OFF file with numbers that read back bit for bit.

    The vertex data "normal" (n, 3) make it a NOFF, "color" (n, 3) or (n, 4) a COFF file, both a
    CNOFF file; other vertex data are left out.

    Examples
    --------
    >>> import io
    >>> from beltrami.mesh.mesh import Mesh
    >>> mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> file = io.BytesIO()
    >>> write_off(file, mesh, mesh.vertices)
    >>> file.getvalue().splitlines()[:2]
    [b'OFF', b'3 1 0']
    """
    keyword, form, columns = "OFF", "%r %r %r", [vertices]
    for letter, name, widths in (("N", "normal", (3,)), ("C", "color", (3, 4))):
        array = mesh.vertex_data.get(name)
        if array is None or array.ndim != 2 or array.shape[1] not in widths:
            continue
        if array.dtype.kind not in "uif" or not np.isfinite(array).all():
            continue
        keyword = letter + keyword
        form += (" %d" if array.dtype.kind in "ui" else " %r") * array.shape[1]
        columns.append(array.astype(np.float64))
    file.write(f"{keyword}\n{mesh.n_vertices} {mesh.n_faces} 0\n".encode("ascii"))
    write_rows(file, form, np.hstack(columns))
    write_rows(file, "3 %d %d %d", mesh.faces)
