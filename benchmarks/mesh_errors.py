"""How far a mesh is from another one of the same faces: four measures, and curves of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Errors:
    """Distances as parts of the diagonal of the bounding box, and an angle in degrees.

    Parameters
    ----------
    rms, largest
        Of the distances of vertices.
    angle
        Between the normals of faces, in the mean over the area.
    visual
        Of Karni and Gotsman: the mean of ``rms`` and of the root mean square difference of
        Laplacians x - Σ x_j / |x - x_j| / Σ 1 / |x - x_j|.
    """

    rms: float
    largest: float
    angle: float
    visual: float


def measure_errors(mesh: Any, found: NDArray[Any]) -> Errors:
    """Compare positions ``found`` with those of the mesh."""
    x = mesh.vertices
    diagonal = float(np.linalg.norm(np.ptp(x, axis=0))) or 1.0
    off = np.linalg.norm(found - x, axis=1) / diagonal
    rms = float(np.sqrt((off**2).mean()))
    i, j = mesh.edges.T
    weights = 1 / np.maximum(np.linalg.norm(x[i] - x[j], axis=1), 1e-12 * diagonal)
    difference = (found - x) / diagonal
    total, sums = np.zeros(len(x)), np.zeros_like(x)
    for a, b in ((i, j), (j, i)):
        np.add.at(total, a, weights)
        np.add.at(sums, a, weights[:, None] * difference[b])
    laplacian = difference - sums / np.maximum(total, 1e-300)[:, None]
    rough = float(np.sqrt((laplacian**2).sum(axis=1).mean()))
    return Errors(rms, float(off.max()), _mean_angle(mesh, found), (rms + rough) / 2)


def _mean_angle(mesh: Any, found: NDArray[Any]) -> float:
    def normals(y: NDArray[Any]) -> NDArray[Any]:
        a, b, c = y[mesh.faces].transpose(1, 0, 2)
        return np.cross(b - a, c - a)

    p, q = normals(mesh.vertices), normals(found)
    areas = np.linalg.norm(p, axis=1)
    lengths = areas * np.linalg.norm(q, axis=1)
    cosines = np.where(lengths > 0, (p * q).sum(axis=1) / np.maximum(lengths, 1e-300), 0.0)
    return float(np.average(np.degrees(np.arccos(np.clip(cosines, -1, 1))), weights=areas))


def bytes_at(error: float, curve: Sequence[tuple[float, int]]) -> float:
    """Return the bytes that this error takes, by lines in logarithms; no fewer than the fewest.

    Where the error is smaller than all of the curve, infinitely many.
    """
    logs = np.log(sorted(curve))
    if np.log(error) < logs[0, 0]:
        return float("inf")
    return float(np.exp(np.interp(np.log(error), logs[:, 0], logs[:, 1])))
