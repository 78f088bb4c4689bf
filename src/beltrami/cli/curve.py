"""beltrami compress --curve: how many bytes for which error, beside Draco where it is installed."""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import typer

from beltrami.cli.console import print_json, waiting
from beltrami.cli.outputs import check_picture_output

POINTS = {"grid": range(6, 15), "smooth": range(5, 13), "spectral": range(3, 10)}  # bits
DRACO = "draco"
_LEVELS = (5, 7, 8, 9, 10)
_HEAD = "mode      bits     bytes  bits/vertex  rms error  largest"


@dataclass(frozen=True)
class Point:
    """A file: its bytes, and its errors as parts of the diagonal of the bounding box."""

    mode: str
    bits: int
    bytes: int
    bits_per_vertex: float
    rms: float
    largest: float
    of_draco: float | None = None  # bytes, over those that Draco takes for this error


def tell_curve(path: Path, picture: Path | None, effort: str, json: bool) -> None:
    """Write a table of all modes: bytes and errors; draw it if a picture is named.

    The functions on the mesh are left out, as they are by Draco, whose bytes are those of its best
    level, and whose error is that of the same grid.
    """
    from beltrami.io.registry import read_mesh
    from beltrami.mesh.mesh import Mesh

    if picture is not None:
        check_picture_output(picture)
    with waiting(f"compressing {path.name}") as progress:
        read = read_mesh(path)
        mesh, points = Mesh(read.vertices, read.topology), []
        asked = [(mode, bits) for mode, grids in POINTS.items() for bits in grids]
        for done, (mode, bits) in enumerate(asked):
            progress(done, len(asked))
            points.append(_point(mesh, mode, bits, effort))
        draco = [one for one in (_draco(mesh, point) for point in points) if one]
    points = [_beside(point, draco) for point in points] + draco
    if picture is not None:
        _draw(points, picture)
    if json:
        print_json([asdict(point) for point in points])
        return
    typer.echo(_HEAD + ("  of Draco's bytes for that error" if draco else ""))
    for one in points:
        share = "" if one.of_draco is None else f"{one.of_draco:9.2f}"
        typer.echo(
            f"{one.mode:8} {one.bits:5} {one.bytes:9} {one.bits_per_vertex:12.2f} "
            f"{one.rms:10.2e} {one.largest:8.1e}{share}"
        )
    if picture is not None:
        typer.echo(f"wrote {picture}")


def _point(mesh: Any, mode: str, bits: int, effort: str) -> Point:
    """Compress in one mode, both ways."""
    from beltrami.compression.compress import compress, vertex_order
    from beltrami.compression.decompress import decompress

    data = compress(mesh, bits=bits, mode=mode, effort=effort, verify=False)
    diagonal = float(np.linalg.norm(np.ptp(mesh.vertices, axis=0))) or 1.0
    away = decompress(data).vertices - mesh.vertices[vertex_order(mesh)]
    distances = np.linalg.norm(away, axis=1) / diagonal
    rms, largest = float(np.sqrt((distances**2).mean())), float(distances.max())
    return Point(mode, bits, len(data), 8 * len(data) / mesh.n_vertices, rms, largest)


def _draco(mesh: Any, ours: Point) -> Point | None:
    """Return the fewest bytes of Draco over its levels, on the grid of a point of ours.

    None for other modes, without DracoPy, and outside of R³.
    """
    if ours.mode != "grid" or mesh.dimension != 3:
        return None
    try:
        encode = importlib.import_module("DracoPy").encode
    except ImportError:
        return None
    points, faces = mesh.vertices.astype(np.float32), mesh.faces.astype(np.uint32)
    size = min(
        len(encode(points, faces, quantization_bits=ours.bits, compression_level=level))
        for level in _LEVELS
    )
    return Point(DRACO, ours.bits, size, 8 * size / mesh.n_vertices, ours.rms, ours.largest)


def _beside(one: Point, draco: Sequence[Point]) -> Point:
    """Compare with Draco's bytes for the same error, between its grids by lines in logarithms."""
    errors, sizes = [other.rms for other in draco][::-1], [other.bytes for other in draco][::-1]
    if not errors or not errors[0] * (1 - 1e-9) <= one.rms <= errors[-1] * (1 + 1e-9):
        return one
    if errors[0] <= 0:
        return one
    theirs = float(np.exp(np.interp(np.log(one.rms), np.log(errors), np.log(sizes))))
    return Point(**{**asdict(one), "of_draco": one.bytes / theirs})


def _draw(points: Sequence[Point], picture: Path) -> None:
    """Draw the errors over the bits per vertex."""
    from beltrami.display.line_plot import plot_rates

    curves = {}
    for mode in dict.fromkeys(point.mode for point in points):
        own = [point for point in points if point.mode == mode]
        rates = np.array([point.bits_per_vertex for point in own])
        curves["Draco" if mode == DRACO else mode] = rates, np.array([point.rms for point in own])
    plot_rates(curves, picture)
