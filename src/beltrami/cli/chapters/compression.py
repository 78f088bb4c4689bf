"""Compression: the mesh in fewer and fewer bits, and what becomes of it."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Integers
from beltrami.cli.chapters.chapter import Chapter, Stage, number
from beltrami.compression.compress import compress, vertex_order
from beltrami.compression.contents import describe
from beltrami.compression.decompress import decompress
from beltrami.mesh.mesh import Mesh

BITS = (6, 10, 14)
COARSE = 6
TERMS = (4, 16, 64)
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
    coarse = [_few_terms(mesh, terms) for terms in TERMS]
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
            "The faces give eigenvectors too, so that a file can hold coefficients instead of "
            "positions: the fewest bytes for a coarse shape, and any beginning of it is a coarser "
            f"one. The first {', '.join(map(str, TERMS))} of each block of vertices: "
            f"{', '.join(str(len(each)) for each in coarse)} bytes.",
        ),
        (HEAD, *rows),
        (
            stage.draw(
                "compressed.png",
                f"The mesh; on the grid of {COARSE} bits; moved within the cells of that grid.",
                [stage.mesh, *shown],
            ),
            stage.draw(
                "terms.png",
                f"Of {', '.join(map(str, TERMS))} eigenvectors of each block of 250 vertices.",
                [_numbered_back(decompress(each), order) for each in coarse],
            ),
        ),
        (("mesh.btm", "the mesh within a ten-thousandth of its diagonal"),),
        (
            f"beltrami compress {stage.name} --max-error 1e-4 --relative -o mesh.btm",
            f"beltrami compress {stage.name} --mode spectral --terms {TERMS[-1]} -o coarse.btm",
            "beltrami info mesh.btm",
            "beltrami decompress mesh.btm -o decompressed.ply",
        ),
    )


def _few_terms(mesh: Mesh, terms: int) -> bytes:
    """Compress by so many coefficients, rounded as the grid of 10 bits is."""
    count = min(terms, mesh.n_vertices)
    return compress(mesh, bits=10, mode="spectral", terms=count, effort="fast", verify=False)


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
