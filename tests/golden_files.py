"""The golden files: made once, from shapes of the package; ``python golden_files.py`` shows how.

They are never made again: a decoder of any later version must read them to the same bits.
"""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import numpy as np

import beltrami as bt
from beltrami.mesh.mesh import Mesh

FOLDER = Path(__file__).parent / "compression" / "golden"


def digest(mesh):
    """The SHA-256 of everything in a mesh, low bytes first."""
    arrays = [mesh.vertices, mesh.faces, *mesh.vertex_data.values()]
    if mesh.corner_uv is not None:
        arrays.append(mesh.corner_uv)
    data = b"".join(
        str(a.shape).encode() + a.astype(a.dtype.newbyteorder("<")).tobytes() for a in arrays
    )
    return hashlib.sha256(data).hexdigest()


def examples():
    """Meshes and options: symmetric and irregular, open and closed, damaged, in 2, 3 and 5-D."""
    sphere, cylinder = bt.shapes.icosphere(3), bt.shapes.cylinder(24, 9)
    rng = np.random.default_rng(2000)
    bumpy = sphere.with_vertices(sphere.vertices * (1 + 0.05 * rng.normal(size=(642, 1))))
    damaged = np.concatenate([cylinder.faces[:-5], cylinder.faces[:4], [[0, 0, 1], [1, 70, 140]]])
    functions = {"a": rng.normal(size=cylinder.n_vertices), "b": np.arange(cylinder.n_vertices)}
    uv = rng.random((len(damaged), 3, 2))
    disk = bt.shapes.disk(9)
    heights = disk.vertices[:, 0]
    smooth = {
        "red": heights > 0.2,
        "colours": np.rint(100 + 90 * disk.vertices).astype(np.uint8),
        "single": (heights**2).astype(np.float32),
        "double": np.sqrt(1 + heights**2),
        "near": heights.copy(),
        "noise": rng.normal(size=disk.n_vertices),
    }
    sheet = disk.vertices[disk.faces]
    sheet[:40] += 2.0  # a seam
    return {
        "icosphere": (sphere, {"bits": 12}),
        "torus": (bt.shapes.torus(24, 16), {"max_error": 1e-4, "effort": "fast"}),
        "cube": (bt.shapes.cube(6), {"bits": 8}),
        "bumpy": (bumpy, {"bits": 10, "keep_order": True}),
        "damaged": (Mesh(cylinder.vertices, damaged, functions, uv), {"max_error": 1e-3}),
        "disk": (disk, {"bits": 14}),
        "five": (Mesh(rng.normal(size=(disk.n_vertices, 5)), disk.faces), {"bits": 6}),
        "smooth": (bt.shapes.cylinder(20, 12), {"bits": 6, "mode": "smooth"}),
        "blob": (bt.shapes.blob(2000), {"bits": 11}),
        "free": (bt.shapes.blob(1200), {"bits": 6, "mode": "smooth"}),
        "spectral_blob": (bt.shapes.blob(1200), {"bits": 7, "mode": "spectral"}),
        "spectral_icosphere": (sphere, {"bits": 6, "mode": "spectral", "effort": "fast"}),
        "spectral_torus": (
            bt.shapes.torus(24, 16),
            {"max_error": 0.03, "mode": "spectral", "keep_order": True},
        ),
        "functions": (
            Mesh(disk.vertices, disk.faces, smooth, sheet),
            {"bits": 6, "function_errors": {"near": 1e-3}, "keep_order": True},
        ),
        "spectral_cube": (bt.shapes.cube(6), {"terms": 40, "bits": 9, "mode": "spectral"}),
    }


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    place = FOLDER / "digests.json"
    digests = json.loads(place.read_text()) if place.exists() else {}
    for name, (mesh, options) in examples().items():
        if name not in digests:
            data = bt.compress(mesh, FOLDER / f"{name}.btm", **options)
            digests[name] = digest(bt.decompress(data))
    place.write_text(json.dumps(digests, indent=1) + "\n")
