"""One triangle: the four numbers from which every weight and area of a face follows."""

from __future__ import annotations

import math
from typing import Any

from beltrami._jit import part_of_kernels

BARYCENTRIC, VORONOI, CIRCUMCENTRIC = 0, 1, 2


@part_of_kernels
def measure(x: Any, i: int, j: int, k: int) -> Any:
    """Return the dot products of the sides at the corners i, j, k, and twice the area.

    The cotangent at a corner is its dot product over twice the area; the square of a side is the
    sum of the dot products at its two ends. Both keep their digits in needles, where formulas in
    the lengths lose them.
    """
    ix, iy, iz = x[i, 0], x[i, 1], x[i, 2]
    jx, jy, jz = x[j, 0], x[j, 1], x[j, 2]
    kx, ky, kz = x[k, 0], x[k, 1], x[k, 2]
    ux, uy, uz = jx - ix, jy - iy, jz - iz
    vx, vy, vz = kx - jx, ky - jy, kz - jz
    wx, wy, wz = ix - kx, iy - ky, iz - kz
    at_i = -(ux * wx + uy * wy + uz * wz)
    at_j = -(ux * vx + uy * vy + uz * vz)
    at_k = -(vx * wx + vy * wy + vz * wz)
    cx, cy, cz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    return at_i, at_j, at_k, math.sqrt(cx * cx + cy * cy + cz * cz)


@part_of_kernels
def is_flat(at_i: float, at_j: float, at_k: float, double: float) -> bool:
    """Whether area <= 1e-12 (longest side)², the bound of ``degenerate_faces``; true for NaN."""
    on_ij, on_jk, on_ki = at_i + at_j, at_j + at_k, at_k + at_i
    longest = on_ij if on_ij > on_jk else on_jk
    longest = longest if longest > on_ki else on_ki
    return not (double > 2e-12 * longest)


@part_of_kernels
def shares(at_i: float, at_j: float, at_k: float, double: float, kind: int) -> Any:
    """Return the parts of the area of a triangle that belong to its corners; they add to it.

    ``BARYCENTRIC`` a third each. ``CIRCUMCENTRIC`` the signed Voronoi cells of theorem 3 with
    its constant corrected (E22): (|e_ij|² cot k + |e_ik|² cot j) / 8. ``VORONOI`` the same in
    triangles without an obtuse angle, otherwise half the area at that angle and a quarter at the
    others (Meyer et al. 2003): never negative.
    """
    if kind == 0:
        return double / 6, double / 6, double / 6
    if kind == 1:
        if at_i < 0:
            return double / 4, double / 8, double / 8
        if at_j < 0:
            return double / 8, double / 4, double / 8
        if at_k < 0:
            return double / 8, double / 8, double / 4
    on_i = (at_j + at_k) * at_i  # |e_jk|² cot i, times twice the area
    on_j = (at_k + at_i) * at_j
    on_k = (at_i + at_j) * at_k
    eighth = 8 * double
    return (on_j + on_k) / eighth, (on_k + on_i) / eighth, (on_i + on_j) / eighth
