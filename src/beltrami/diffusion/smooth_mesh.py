"""Smoothing of meshes: the coordinates are three functions (example 2, figure 3.3)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Booleans, Floats, as_indices
from beltrami._progress import Progress
from beltrami.diffusion.heat import heat
from beltrami.diffusion.smoothing import smooth
from beltrami.errors import BeltramiError, check_name
from beltrami.mesh.door import require_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.operators.laplacian import laplacian

SMOOTHING_METHODS = ("averaging", "implicit", "explicit")
KEPT = ("volume", "centroid")


def smooth_mesh(
    mesh: Mesh,
    method: str = "averaging",
    *,
    steps: int | None = None,
    step: float | None = None,
    time: float | None = None,
    weights: str | None = None,
    mass: str | None = None,
    hold_boundary: bool = False,
    hold: ArrayLike = (),
    keep: str | None = None,
    progress: Progress | None = None,
) -> Mesh:
    r"""Smooth the positions of a mesh; all else stays, but for data named "normal".

    Chapter items: X2, X6, P20.

    Parameters
    ----------
    mesh
        Any sound mesh.
    method
        ``"averaging"``: ``steps`` rounds (default 10) of (1 - δ) x + δ D⁻¹ W x with δ = ``step``
        (default 1).
        ``"implicit"``, ``"explicit"``: the heat equation for ``time``, in ``steps`` steps.
    time
        Diffusion time of the heat methods, in length² with area masses; no default, because it
        says how much is smoothed: features below about sqrt(4 time) go.
    weights
        Default: "combinatorial" for averaging, which needs them non-negative; "cotangent" for
        heat.
    mass
        Of the heat methods; see ``laplacian``.
    hold_boundary, hold
        Keep the boundary, or these vertices, where they are.
    keep
        ``"volume"``: scale the result about its centroid to the volume that there was (closed
        meshes), and put the centroid back; ``"centroid"``: only that. The centroid is that of
        the surface.

    Raises
    ------
    NotClosedError
        If the volume is to be kept of a mesh with boundary.
    BeltramiError
        If ``time`` is missing, an option is given that the method has not, or ``keep`` would
        move what is held.
    NegativeWeightError, StepTooLongError, MeshError
        As ``smooth`` and ``heat``.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> sphere = icosphere(3)
    >>> smoothed = smooth_mesh(sphere, steps=50)
    >>> round(smoothed.volume / sphere.volume, 3)  # averaging shrinks
    0.182
    >>> kept = smooth_mesh(sphere, steps=50, keep="volume")
    >>> round(kept.volume / sphere.volume, 12)
    1.0
    """
    check_name("smoothing method", method, SMOOTHING_METHODS)
    require_mesh(mesh, "smooth_mesh")
    foreign = {"time": time, "mass": mass} if method == "averaging" else {"step": step}
    for name, value in foreign.items():
        if value is not None:
            raise BeltramiError(f"the method {method!r} has no {name}")
    held = np.zeros(mesh.n_vertices, np.bool_)
    held[as_indices(hold, mesh.n_vertices, "held vertices")] = True
    if hold_boundary:
        held |= mesh.topology.on_boundary
    if keep is not None:
        check_name("quantity to keep", keep, KEPT)
        if held.any():
            raise BeltramiError(f"keeping the {keep} would move the vertices that are held")
    before = mesh.volume if keep == "volume" else None
    moved = mesh.with_vertices(
        _averaged(mesh, weights, steps, step, held, progress)
        if method == "averaging"
        else _diffused(mesh, method, weights, mass, time, steps, held, progress)
    )
    if keep is None:
        return moved
    factor = 1.0 if before is None else _regrowth(before, moved)
    if not moved.area > 0:
        raise BeltramiError(f"the surface has shrunk to a point, so its {keep} cannot be kept")
    centred = (moved.vertices - _centroid(moved)) * factor
    return moved.with_vertices(centred + _centroid(mesh))


def _averaged(
    mesh: Mesh,
    weights: str | None,
    steps: int | None,
    step: float | None,
    held: Booleans,
    progress: Progress | None,
) -> Floats:
    pair = laplacian(mesh, "combinatorial" if weights is None else weights, "degree")
    count = 10 if steps is None else steps
    delta = 1.0 if step is None else step
    return smooth(pair, mesh.vertices, count, delta, hold=held, progress=progress)


def _diffused(
    mesh: Mesh,
    method: str,
    weights: str | None,
    mass: str | None,
    time: float | None,
    steps: int | None,
    held: Booleans,
    progress: Progress | None,
) -> Floats:
    if time is None:
        raise BeltramiError(
            f"the method {method!r} needs a time: about the square of the size of the details "
            "that are to go, over 4"
        )
    pair = laplacian(mesh, weights, mass)
    return heat(pair, mesh.vertices, time, method, steps, hold=held, progress=progress)


def _regrowth(before: float, moved: Mesh) -> float:
    """Return the scale that gives the volume back."""
    now = moved.volume
    if not now * before > 0 or abs(now) < 1e-12 * moved.area**1.5:
        raise BeltramiError("the surface has collapsed, so its volume cannot be kept: smooth less")
    return float(np.cbrt(before / now))


def _centroid(mesh: Mesh) -> Floats:
    """Return the centroid of the surface: the mean of its points."""
    middle = mesh.vertices[mesh.faces].mean(axis=1)
    return np.asarray(mesh.face_areas @ middle / mesh.area)
