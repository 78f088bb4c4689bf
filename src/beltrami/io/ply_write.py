"""Writing PLY: binary, little endian, double coordinates, with the vertex data."""

from __future__ import annotations

from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats
from beltrami.io.ply_data import columns_of
from beltrami.io.ply_header import TYPES
from beltrami.mesh.mesh import Mesh

_NAMES = {kind: name for name, kind in reversed(TYPES.items())}  # "uchar", not "uint8"


def write_ply(file: IO[bytes], mesh: Mesh, vertices: Floats) -> None:
    """Write a binary little-endian PLY file; numbers are kept bit for bit.

    Texture coordinates go into a list texcoord of each face, in single precision where that holds
    them exactly: MeshLab reads no other.

    Examples
    --------
    >>> import io
    >>> from beltrami.mesh.mesh import Mesh
    >>> mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> file = io.BytesIO()
    >>> write_ply(file, mesh, mesh.vertices)
    >>> file.getvalue().splitlines()[1]
    b'format binary_little_endian 1.0'
    """
    columns: dict[str, NDArray[Any]] = {
        "x": vertices[:, 0],
        "y": vertices[:, 1],
        "z": vertices[:, 2],
    }
    columns.update(columns_of(mesh.vertex_data))
    kinds = {name: column.dtype.str[1:] for name, column in columns.items()}
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    header += [f"property {_NAMES[kind]} {name}" for name, kind in kinds.items()]
    header += [f"element face {mesh.n_faces}", "property list uchar int vertex_indices"]
    fields: list[Any] = [("count", "u1"), ("corners", "<i4", (3,))]
    uv = mesh.corner_uv
    if uv is not None:
        with np.errstate(over="ignore"):
            single = np.array_equal(uv.astype(np.float32), uv, equal_nan=True)
        kind = "f4" if single else "f8"
        header.append(f"property list uchar {_NAMES[kind]} texcoord")
        fields += [("turns", "u1"), ("uv", "<" + kind, (6,))]
    file.write("\n".join([*header, "end_header\n"]).encode("ascii"))
    rows = np.empty(len(vertices), [(f"p{i}", "<" + kind) for i, kind in enumerate(kinds.values())])
    for i, column in enumerate(columns.values()):
        rows[f"p{i}"] = column
    file.write(rows.tobytes())
    faces = np.empty(mesh.n_faces, fields)
    faces["count"] = 3
    if uv is not None:
        faces["turns"] = 6
        faces["uv"] = uv.reshape(-1, 6)
    faces["corners"] = mesh.faces
    file.write(faces.tobytes())
