"""beltrami compress --curve: how many bytes for which error, beside Draco where it is installed."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

import numpy as np
import typer

from beltrami.cli.console import print_json, waiting

BITS = range(6, 15)
COLUMNS = (
    "bits",
    "bytes",
    "bits_per_vertex",
    "rms",
    "largest",
    "draco_bytes",
    "bytes_smooth",
    "rms_smooth",
)
_HEAD = "bits     bytes  bits/vertex  rms error  largest   smooth: bytes, rms error  Draco's bytes"


def tell_curve(path: Path, effort: str, json: bool) -> None:
    """Write a table of grids: bytes, and errors as parts of the diagonal of the bounding box.

    The functions on the mesh are left out, as they are by Draco's bytes: its best level, the same
    grid.
    """
    from beltrami.io.registry import read_mesh
    from beltrami.mesh.mesh import Mesh

    with waiting(f"compressing {path.name}") as progress:
        read = read_mesh(path)
        mesh = Mesh(read.vertices, read.topology)
        rows = []
        for done, bits in enumerate(BITS):
            progress(done, len(BITS))
            rows.append(_row(mesh, bits, effort))
    if json:
        print_json([dict(zip(COLUMNS, row, strict=True)) for row in rows])
        return
    typer.echo(_HEAD)
    for bits, size, rate, rms, largest, draco, small, smooth in rows:
        other = "-" if draco is None else f"{draco} ({size / draco:.2f} of them)"
        typer.echo(
            f"{bits:4} {size:9} {rate:12.2f} {rms:10.2e} {largest:8.1e} "
            f"{small:15} {smooth:11.2e}  {other}"
        )


def _row(mesh: Any, bits: int, effort: str) -> tuple[Any, ...]:
    """Compress on one grid, both ways; return a row of the table."""
    from beltrami.compression.compress import compress, vertex_order
    from beltrami.compression.decompress import decompress

    order = vertex_order(mesh)
    diagonal = float(np.linalg.norm(np.ptp(mesh.vertices, axis=0))) or 1.0
    sizes, errors = [], []
    for mode in ("grid", "smooth"):
        data = compress(mesh, bits=bits, mode=mode, effort=effort, verify=False)
        away = np.linalg.norm(decompress(data).vertices - mesh.vertices[order], axis=1) / diagonal
        sizes.append(len(data))
        errors.append((float(np.sqrt((away**2).mean())), float(away.max())))
    rate = 8 * sizes[0] / mesh.n_vertices
    (rms, largest), (smooth, _) = errors
    return bits, sizes[0], rate, rms, largest, _draco(mesh, bits), sizes[1], smooth


def _draco(mesh: Any, bits: int) -> int | None:
    """Return the fewest bytes of Draco over its levels; None without DracoPy, or outside of R³."""
    try:
        encode = importlib.import_module("DracoPy").encode
    except ImportError:
        return None
    if mesh.dimension != 3:
        return None
    points, faces = mesh.vertices.astype(np.float32), mesh.faces.astype(np.uint32)
    return min(
        len(encode(points, faces, quantization_bits=bits, compression_level=level))
        for level in (5, 7, 8, 9, 10)
    )
