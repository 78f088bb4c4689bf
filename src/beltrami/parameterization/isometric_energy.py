"""The symmetric Dirichlet energy of maps: sums, gradient, and a Hessian without negative parts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from beltrami._arrays import Booleans, Floats
from beltrami._jit import kernel
from beltrami.mesh.mesh import Mesh
from beltrami.parameterization.block_pattern import BlockPattern
from beltrami.parameterization.distortion import slopes


@dataclass(frozen=True, eq=False)
class IsometricEnergy:
    r""":math:`\sum_f A_f (t^2 (\sigma_1^2 + \sigma_2^2) + t^{-2} (\sigma_1^{-2} + \sigma_2^{-2}))`.

    The energy of a map that is taken t times as large; infinite where a face is turned over or
    has no area. ``isometric_energy`` makes it.

    Attributes
    ----------
    mesh
        The surface.
    slopes : (m, 3, 2)
        The gradients of the hat functions; ``areas`` : (m,) of the faces, of the whole.
    """

    mesh: Mesh
    slopes: Floats
    areas: Floats

    def sums(self, x: Floats) -> tuple[float, float]:
        r"""Return the means of :math:`\sigma_1^2 + \sigma_2^2` and of its inverses' sum."""
        return _sums(self.mesh.faces, self.slopes, self.areas, x)

    def derivatives(self, x: Floats, t: float, pattern: BlockPattern) -> tuple[Floats, Floats]:
        """Return the gradient at the free vertices, (free, 2), and the entries of the Hessian.

        The Hessian of each face is projected to the semi-definite matrices by its eigenvectors,
        which are known (B. Smith, F. de Goes, T. Kim, Analytic eigensystems for isotropic
        distortion energies, 2019): of the four, only the one of turning can be negative.
        """
        gradient = np.zeros((pattern.size // 2, 2))
        entries = np.zeros(len(pattern.indices))
        _derivatives(
            self.mesh.faces, self.mesh.topology.face_edges, t * self.slopes, self.areas, x,
            pattern.number, pattern.widths, pattern.vertex_slots, pattern.edge_slots,
            gradient, entries,
        )  # fmt: skip
        return gradient, entries

    def gradient(self, x: Floats, t: float, pattern: BlockPattern) -> Floats:
        r"""Return the gradient at the free vertices, (free, 2), alone.

        With the determinant D and the sum of squares Q of the Jacobian J of a face it is
        :math:`2 A ((1 + D^{-2}) J - Q D^{-3} \operatorname{cof} J)` by J.
        """
        gradient = np.zeros((pattern.size // 2, 2))
        _gradient(self.mesh.faces, t * self.slopes, self.areas, x, pattern.number, gradient)
        return gradient


def isometric_energy(mesh: Mesh) -> IsometricEnergy:
    """Prepare the energy of maps of a mesh; O(m)."""
    return IsometricEnergy(mesh, slopes(mesh), mesh.face_areas / mesh.area)


def first_collapse(mesh: Mesh, x: Floats, direction: Floats) -> float:
    """Return the smallest s > 0 at which a face of x + s direction has no area; it may be inf."""
    return float(_first_collapse(mesh.faces, x, direction))


@kernel
def _jacobian(face: Any, g: Any, x: Any) -> Any:
    """Return the rows of J: differences come first, so that tiny images keep their digits."""
    i, j, k = face[0], face[1], face[2]
    ux, uy = x[j, 0] - x[i, 0], x[j, 1] - x[i, 1]
    vx, vy = x[k, 0] - x[i, 0], x[k, 1] - x[i, 1]
    return (
        ux * g[1, 0] + vx * g[2, 0], ux * g[1, 1] + vx * g[2, 1],
        uy * g[1, 0] + vy * g[2, 0], uy * g[1, 1] + vy * g[2, 1],
    )  # fmt: skip


@kernel
def _sums(faces: Any, g: Any, areas: Any, x: Any) -> Any:
    grown = shrunk = 0.0
    for f in range(faces.shape[0]):
        a, b, c, d = _jacobian(faces[f], g[f], x)
        determinant = a * d - b * c
        if not determinant > 0:
            return np.inf, np.inf
        squares = a * a + b * b + c * c + d * d
        grown += areas[f] * squares
        shrunk += areas[f] * (squares / determinant / determinant)
    return grown, shrunk


@kernel
def _gradient(faces: Any, g: Any, areas: Any, x: Any, number: Any, gradient: Any) -> None:
    for f in range(faces.shape[0]):
        a, b, c, d = _jacobian(faces[f], g[f], x)
        determinant = a * d - b * c
        inverse = 1 / determinant / determinant
        along = 2 * areas[f] * (1 + inverse)
        across = 2 * areas[f] * (a * a + b * b + c * c + d * d) * inverse / determinant
        for k in range(3):
            i = number[faces[f, k]]
            if i >= 0:
                p, q = g[f, k, 0], g[f, k, 1]
                gradient[i, 0] += along * (a * p + b * q) - across * (d * p - c * q)
                gradient[i, 1] += along * (c * p + d * q) - across * (a * q - b * p)


@kernel
def _frames(a: Any, b: Any, c: Any, d: Any) -> Any:
    """Return the singular values of [[a, b], [c, d]], and cosine and sine of both rotations."""
    e, f, g, h = (a + d) / 2, (a - d) / 2, (c + b) / 2, (c - b) / 2
    large = np.hypot(e, h) + np.hypot(f, g)
    turned, mirrored = np.arctan2(h, e), np.arctan2(g, f)
    left, right = (turned + mirrored) / 2, (turned - mirrored) / 2
    small = (a * d - b * c) / large
    return large, small, np.cos(left), np.sin(left), np.cos(right), np.sin(right)


@kernel
def _derivatives(
    faces: Any, face_edges: Any, g: Any, areas: Any, x: Any, number: Any, widths: Any,
    vertex_slots: Any, edge_slots: Any, gradient: Any, entries: Any,
) -> None:  # fmt: skip
    """Add up the faces.

    In the frames of the singular vectors the blocks of two corners are products of the slopes p,
    q along the two of them, times the curvatures: along both singular values, of turning (which
    is cut off at 0) and of shearing.
    """
    p, q = np.empty(3), np.empty(3)
    for f in range(faces.shape[0]):
        s, r, c, z, cv, zv = _frames(*_jacobian(faces[f], g[f], x))
        area = areas[f]
        pull, push = 2 * (s - s**-3.0), 2 * (r - r**-3.0)
        first, second = 2 + 6 * s**-4.0, 2 + 6 * r**-4.0
        product = s * r
        turning = max((pull + push) / (s + r), 0.0)
        shearing = 2 + 2 * (s * s + product + r * r) / product**3
        both, mixed = (shearing + turning) / 2, (shearing - turning) / 2
        for k in range(3):
            p[k] = g[f, k, 0] * cv - g[f, k, 1] * zv
            q[k] = g[f, k, 0] * zv + g[f, k, 1] * cv
        for k in range(3):
            i = number[faces[f, k]]
            if i < 0:
                continue
            along, across = area * pull * p[k], area * push * q[k]
            gradient[i, 0] += c * along - z * across
            gradient[i, 1] += z * along + c * across
            for n in range(3):
                j = number[faces[f, n]]
                if j < 0:
                    continue
                m00 = area * (first * p[k] * p[n] + both * q[k] * q[n])
                m11 = area * (second * q[k] * q[n] + both * p[k] * p[n])
                m01 = area * mixed * q[k] * p[n]
                m10 = area * mixed * p[k] * q[n]
                slot = vertex_slots[i]
                if n != k:
                    side = 0 if faces[f, k] < faces[f, n] else 1
                    slot = edge_slots[face_edges[f, 3 - k - n], side]
                # U M U', of which the column belongs to corner k, the row to corner n
                entries[slot] += c * c * m00 - c * z * (m01 + m10) + z * z * m11
                entries[slot + widths[i] + 1] += z * z * m00 + c * z * (m01 + m10) + c * c * m11
                entries[slot + widths[i]] += c * z * (m00 - m11) - z * z * m01 + c * c * m10
                entries[slot + 1] += c * z * (m00 - m11) + c * c * m01 - z * z * m10


def shrinking(mesh: Mesh, x: Floats, direction: Floats, share: float) -> Booleans:
    """Return (m,): whether x + direction leaves a face less than this share of its area."""
    found = np.empty(mesh.n_faces, np.bool_)
    _shrinking(mesh.faces, x, direction, share, found)
    return found


@kernel
def _shrinking(faces: Any, x: Any, d: Any, share: float, found: Any) -> None:
    for f in range(faces.shape[0]):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        ux, uy, vx, vy = x[j, 0] - x[i, 0], x[j, 1] - x[i, 1], x[k, 0] - x[i, 0], x[k, 1] - x[i, 1]
        px, py, qx, qy = d[j, 0] - d[i, 0], d[j, 1] - d[i, 1], d[k, 0] - d[i, 0], d[k, 1] - d[i, 1]
        after = (ux + px) * (vy + qy) - (uy + py) * (vx + qx)
        found[f] = not after >= share * (ux * vy - uy * vx)


@kernel
def _first_collapse(faces: Any, x: Any, d: Any) -> Any:
    """Solve for the roots of the areas, c + b s + a s² with c > 0."""
    first = np.inf
    for f in range(faces.shape[0]):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        ux, uy, vx, vy = x[j, 0] - x[i, 0], x[j, 1] - x[i, 1], x[k, 0] - x[i, 0], x[k, 1] - x[i, 1]
        px, py, qx, qy = d[j, 0] - d[i, 0], d[j, 1] - d[i, 1], d[k, 0] - d[i, 0], d[k, 1] - d[i, 1]
        a, c = px * qy - py * qx, ux * vy - uy * vx
        b = ux * qy - uy * qx + px * vy - py * vx
        inside = b * b - 4 * a * c
        if inside < 0:
            continue
        root = np.sqrt(inside)
        for bottom in (root - b, -root - b):  # 2 c over it: no cancellation where b < 0
            if bottom != 0.0 and 0.0 < 2 * c / bottom < first:
                first = 2 * c / bottom
    return first
