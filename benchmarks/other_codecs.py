"""Other codecs of meshes, on the same grid: Draco, meshoptimizer with zstd, and plain xz."""

from __future__ import annotations

import lzma
import time
from typing import Any

import numpy as np

from benchmarks.packages import package

LEVELS = (5, 7, 8, 9, 10)


def _arrays(mesh: Any) -> tuple[Any, Any]:
    return mesh.vertices.astype(np.float32), mesh.faces.astype(np.uint32)


def draco(mesh: Any, bits: int) -> int:
    """Return the fewest bytes of Draco over its levels."""
    encode = package("DracoPy").encode
    V, F = _arrays(mesh)
    return min(len(encode(V, F, quantization_bits=bits, compression_level=q)) for q in LEVELS)


def draco_seconds(mesh: Any, bits: int) -> tuple[float, float]:
    """Return the seconds of Draco's best level, to and fro."""
    library = package("DracoPy")
    V, F = _arrays(mesh)
    start = time.process_time()
    data = library.encode(V, F, quantization_bits=bits, compression_level=10)
    middle = time.process_time()
    library.decode(data)
    return middle - start, time.process_time() - middle


def draco_connectivity(mesh: Any) -> int:
    """Return the fewest bytes where every position is rounded to the same point."""
    encode = package("DracoPy").encode
    V, F = _arrays(mesh)
    flat = {"quantization_bits": 1, "quantization_range": 1e8, "quantization_origin": [0, 0, 0]}
    return min(len(encode(V, F, compression_level=q, **flat)) for q in LEVELS)


def xz(mesh: Any) -> int:
    """Return the bytes of single precision and 32-bit indices after the best of xz."""
    raw = b"".join(array.tobytes() for array in _arrays(mesh))
    return len(lzma.compress(raw, preset=9 | lzma.PRESET_EXTREME))


def meshopt(mesh: Any, bits: int) -> int | None:
    """Return the bytes of meshoptimizer's two buffers after zstd 19; None without the libraries."""
    try:
        library, zstd = package("meshoptimizer"), package("zstandard")
    except ImportError:
        return None
    V, F = mesh.vertices, mesh.faces.astype(np.uint32).ravel()
    low = V.min(axis=0)
    scale = (2**bits - 1) / float((V.max(axis=0) - low).max())
    rounded = np.zeros((len(V), 4), np.uint16)
    rounded[:, :3] = np.floor((V - low) * scale + 0.5)
    cached, fetched = np.zeros_like(F), np.zeros_like(rounded)
    library.optimize_vertex_cache(cached, F, len(F), len(V))
    library.optimize_vertex_fetch(fetched, cached, rounded)
    encoded = library.encode_vertex_buffer(fetched, len(V), 8)
    encoded += library.encode_index_buffer(cached, len(F), len(V))
    return len(zstd.ZstdCompressor(level=19).compress(encoded))
