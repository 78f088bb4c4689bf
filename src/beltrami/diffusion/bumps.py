"""Gaussian bumps: what waves begin with in figure 3.6."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, Integers, as_indices, rectangular, require_finite
from beltrami._kinds import checked
from beltrami.errors import BeltramiError, DimensionError, check_name
from beltrami.geodesics.distance import geodesic_distance
from beltrami.geodesics.heat_method import HeatMethod
from beltrami.mesh.door import require_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.operators.domain import require_laplacian
from beltrami.operators.pair import Laplacian
from beltrami.operators.soundness import require_sound

BUMP_DISTANCES = ("heat", "exact", "edges", "euclidean")


@checked
def gaussian_bumps(
    mesh: Mesh,
    vertices: ArrayLike,
    width: float,
    heights: ArrayLike = 1.0,
    *,
    distance: str = "heat",
    balance: Laplacian | None = None,
) -> Floats:
    r"""Superpose Gaussian bumps :math:`\sum_j h_j e^{-d(x, x_j)^2 / (2\sigma^2)}` (l. 460).

    Chapter items: P48.

    Parameters
    ----------
    mesh
        A sound mesh.
    vertices
        The centres x_j: h indices, or a mask.
    width
        σ > 0, in the unit of length. Below about two edges the mesh does not carry the bump.
    heights
        One number, or (h,): negative ones are hollows.
    distance
        Along the surface, by ``"heat"``, ``"exact"`` or along ``"edges"`` (see
        ``geodesic_distance``), or through space, ``"euclidean"``.
    balance
        A pair of this mesh, whose mean is subtracted.

    Returns
    -------
    (n,)

    Raises
    ------
    DimensionError, NonFiniteError, UnknownNameError, BeltramiError
        If the heights, the width or the name are not valid.
    MeshError
        If there are no such vertices, or the mesh is not sound.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> sphere = icosphere(3)
    >>> f = gaussian_bumps(sphere, [0, 5], 0.3, [1, -1], distance="exact")
    >>> f[[0, 5]].round(2).tolist()
    [1.0, -1.0]
    """
    check_name("distance of bumps", distance, BUMP_DISTANCES)
    centres = as_indices(vertices, require_mesh(mesh, "bumps").n_vertices, "centres")
    if balance is not None:
        require_laplacian(balance, "the balance of bumps")
    given = np.asarray(rectangular(heights), np.float64)
    if given.ndim == 0:
        given = np.full(len(centres), float(given))
    if given.shape != centres.shape:
        raise DimensionError(f"{len(centres)} bumps have heights of the shape {given.shape}")
    require_finite(given, "the heights")
    if not (math.isfinite(width) and width > 0):
        raise BeltramiError(f"the width of bumps must be positive and finite, not {width}")
    if not len(centres):
        raise BeltramiError("bumps need a centre")
    distances = _distances(mesh, centres, distance)
    with np.errstate(over="ignore"):  # so far away that the bump is 0
        bumps = given @ np.exp(-0.5 * (distances / width) ** 2)
    return np.asarray(bumps if balance is None else bumps - balance.mean(bumps))


def _distances(mesh: Mesh, centres: Integers, kind: str) -> Floats:
    """Return one row for each centre; infinite where it does not reach."""
    if kind == "euclidean":
        require_sound(mesh)
        x = mesh.vertices
        return np.stack([np.linalg.norm(x - x[centre], axis=1) for centre in centres])
    if kind == "heat":
        method = HeatMethod(mesh)
        return np.stack([method.distance(centre) for centre in centres])
    return np.stack([geodesic_distance(mesh, centre, method=kind) for centre in centres])
