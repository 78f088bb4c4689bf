"""Compression: the mesh in fewer and fewer bits, and what becomes of it."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Integers
from beltrami.cli.chapters.chapter import Chapter, Stage, number
from beltrami.compression.compress import compress, vertex_order
from beltrami.compression.contents import describe
from beltrami.compression.decompress import decompress
from beltrami.mesh.mesh import Mesh

BITS = (6, 8, 10, 12, 14)
COARSE = 6
HEAD = ("bits of the grid", "bytes", "bits per vertex", "mean error", "moved to likely places")


def compression(stage: Stage) -> Chapter:
    """Compress on finer and finer grids; draw the coarsest, and the likeliest surface in it."""
    mesh = Mesh(stage.mesh.vertices, stage.mesh.topology)  # without functions, which take bytes too
    order = vertex_order(mesh)
    rows: list[tuple[str, ...]] = []
    shown: list[Mesh] = []
    for bits in BITS:
        plain = compress(mesh, bits=bits, effort="fast", verify=False)
        smooth = compress(mesh, bits=bits, effort="fast", verify=False, mode="smooth")
        found = decompress(plain), decompress(smooth)
        if bits == COARSE:
            shown = [_numbered_back(each, order) for each in found]
        size = 8 * len(plain) / mesh.n_vertices
        errors = [_error(mesh, each, order) for each in found]
        rows.append((str(bits), str(len(plain)), f"{size:.2f}", *map(number, errors)))
    data = compress(mesh, stage.folder / "mesh.btm", max_error=_tolerance(mesh))
    sections = dict(describe(data).sections)
    return Chapter(
        "Compression",
        "3.3.6",
        (
            "First the faces, which are walked over, at the cost of little more than how many "
            "there are around each vertex; they give the order, and the systems of Laplacians "
            "that guess each position from those before it. What is left is rounded to a grid and "
            "coded bit by bit, with probabilities that many models mix.",
            f"Within a ten-thousandth of the diagonal: {len(data)} bytes, "
            f"{sections['connectivity']} of them for the faces.",
        ),
        (HEAD, *rows),
        (
            stage.draw(
                "compressed.png",
                f"The mesh; on the grid of {COARSE} bits; moved within the cells of that grid.",
                [stage.mesh, *shown],
            ),
        ),
        (("mesh.btm", "the mesh within a ten-thousandth of its diagonal"),),
        (
            f"beltrami compress {stage.name} --max-error 1e-4 --relative -o mesh.btm",
            "beltrami info mesh.btm",
            "beltrami decompress mesh.btm -o decompressed.ply",
        ),
    )


def _tolerance(mesh: Mesh) -> float:
    """Return a ten-thousandth of the diagonal of the bounding box."""
    return 1e-4 * float(np.linalg.norm(np.ptp(mesh.vertices, axis=0)))


def _numbered_back(found: Mesh, order: Integers) -> Mesh:
    """Give the vertices their old numbers again."""
    x = np.empty_like(found.vertices)
    x[order] = found.vertices
    return Mesh(x, order[found.faces])


def _error(mesh: Mesh, found: Mesh, order: Integers) -> float:
    """Return the root mean square distance of the vertices, over the diagonal."""
    distances = np.linalg.norm(found.vertices - mesh.vertices[order], axis=1)
    return float(np.sqrt((distances**2).mean()) / (1e4 * _tolerance(mesh)))
