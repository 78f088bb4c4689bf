"""Memory: how much a step will need, told before it begins, and how much it may have.

The numbers are peaks measured on closed surfaces (n vertices, 2n faces), rounded up; see
``benchmarks/batch_memory.py``.
"""

from __future__ import annotations

import math
import re
from numbers import Real
from typing import Final

from beltrami.batch.failures import PipelineError
from beltrami.batch.verb import Estimate, Options, Size
from beltrami.errors import shown

BASE: Final = 350_000_000  # a worker with everything loaded
READ: Final = 4.0  # bytes at the peak of reading, for each byte of the file
READ_PACKED: Final = 30.0  # the same for a compressed mesh
_SIZE = re.compile(r"(\d+(?:\.\d*)?)\s*([kmgt]?i?)b?", re.IGNORECASE)
_UNITS = {"": 1, "k": 10**3, "m": 10**6, "g": 10**9, "t": 10**12}


def parse_size(text: object) -> int:
    """Return bytes: ``4GB`` are 4·10⁹, ``4GiB`` 4·2³⁰; a number is a number of bytes.

    Raises
    ------
    PipelineError
        If it is no size above zero.

    Examples
    --------
    >>> parse_size("4GB"), parse_size("1.5 GiB"), parse_size("800M"), parse_size(1e9)
    (4000000000, 1610612736, 800000000, 1000000000)
    """
    size = 0.0
    if isinstance(text, str):
        if found := _SIZE.fullmatch(text.strip()):
            unit = found.group(2).lower()
            binary = 1024 ** (1 + "kmgt".index(unit[0])) if len(unit) == 2 else 0
            size = float(found.group(1)) * (binary or _UNITS.get(unit, 0))
    elif isinstance(text, Real) and not isinstance(text, bool):
        size = float(text) if text < 2**62 else 0.0
    if not 1 <= size < 2**62:
        raise PipelineError(0, f"memory is a size such as 4GB, not {shown(text)}")
    return int(size)


def of_mesh(size: Size) -> int:
    """Return the bytes that a mesh with its topology holds."""
    return 60 * size.n_vertices + 120 * size.n_faces


def linear(per_vertex: int, per_face: int, held: int = 0) -> Estimate:
    """Return an estimate that grows with the mesh; ``held`` bytes per vertex stay.

    Examples
    --------
    >>> linear(100, 10, held=24)({}, Size(2, 3))
    (230, 48)
    """

    def estimate(_options: Options, size: Size) -> tuple[int, int]:
        n, m = size.n_vertices, size.n_faces
        return per_vertex * n + per_face * m, held * n

    return estimate


of_diagnosis: Final = linear(100, 150)
of_writing: Final = linear(50, 25)
of_repair: Final = linear(130, 250, held=300)  # the new mesh beside the old one
of_denoising: Final = linear(1_400, 500, held=24)
of_compression: Final = linear(700, 420)
of_integrals: Final = linear(100, 150)
of_curvature: Final = linear(220, 150)
of_parameterization: Final = linear(2_000, 500)


def _factor(n: int) -> int:
    """Return the bytes of a factor and of what it takes to make it: O(n log n) on a surface."""
    return int(90 * n * math.log2(n + 2))


def of_smoothing(options: Options, size: Size) -> tuple[int, int]:
    """Estimate smoothing: rows of weights, normals of faces, or a factor."""
    n = size.n_vertices
    if "time" in options and options.get("method") != "explicit":
        return _factor(n) + 100 * size.n_faces, 24 * n
    if options.get("method", "").endswith("_normals"):
        return linear(500, 420, held=24)(options, size)
    return linear(130, 100, held=24)(options, size)


def of_pair(options: Options, size: Size) -> tuple[int, int]:
    """Estimate a stiffness and a mass."""
    intrinsic = options.get("weights") in ("intrinsic_delaunay", "tufted")
    return linear(170, 400 if intrinsic else 150, held=180)(options, size)


def of_spectrum(options: Options, size: Size) -> tuple[int, int]:
    """Estimate eigenpairs: a factor, vectors to search with, and those that stay."""
    n, k = size.n_vertices, options["k"]
    pair, held = of_pair(options, size)
    dense = 40 * n * n if n <= 500 else 0
    return max(pair, _factor(n) + 30 * n * k + dense), held + 8 * n * k


def of_descriptors(options: Options, size: Size) -> tuple[int, int]:
    """Estimate signatures: count numbers for each vertex, as many while they are made."""
    count = max(len(options.get("times", ())), options["count"])
    kinds = {"all": 2, "shape-dna": 0}.get(options["kind"], 1)
    return 8 * (2 * kinds + 2) * size.n_vertices * count, 0
