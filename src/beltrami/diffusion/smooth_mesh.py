"""Smoothing of meshes: the coordinates are three functions (example 2, figure 3.3)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats
from beltrami._kinds import checked
from beltrami._progress import Progress
from beltrami.diffusion.held import held_vertices, require_free
from beltrami.diffusion.smoothing_methods import SMOOTHING_METHODS
from beltrami.errors import BeltramiError, NotClosedError, check_name
from beltrami.mesh.door import require_mesh
from beltrami.mesh.mesh import Mesh

KEPT = ("volume", "centroid")


@checked
def smooth_mesh(
    mesh: Mesh,
    method: str = "averaging",
    *,
    steps: int | None = None,
    step: float | None = None,
    pass_band: float | None = None,
    time: float | None = None,
    weights: str | None = None,
    mass: str | None = None,
    features: float | None = None,
    contrast: float | None = None,
    fidelity: float | None = None,
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
        Polynomials of the averaging W̃ = D⁻¹ W, which take ``steps`` and ``weights``:
        ``"averaging"``: rounds (default 10) of (1 - δ) x + δ W̃ x with δ = ``step`` (default 1).
        ``"taubin"``: pairs of rounds (default 10), one with δ = ``step`` (default 0.5) and one
        that grows back, so that frequencies below ``pass_band`` (default 0.1) stay: it hardly
        shrinks.
        ``"windowed_sinc"``: the same aim by the best polynomial of degree ``steps`` (default 20).

        Flows for a ``time``, in ``steps`` steps, which take ``weights`` and ``mass``:
        ``"implicit"`` (10 steps), ``"explicit"``: heat, ∂x/∂t = -B⁻¹ L x.
        ``"bilaplacian"`` (1 step): ∂x/∂t = -(B⁻¹ L)² x; the time has the unit length⁴.
        ``"curvature_flow"`` (10 steps): implicit fairing by the mean curvature normal, the pair
        made anew from the surface at each step.
        ``"conformal_flow"`` (10 steps): the same with the stiffness of the start, which does not
        pinch thin parts off.

        Filters of the normals of the faces, which keep creases; then positions that fit them:
        ``"bilateral_normals"`` (20 ``steps``), ``"guided_normals"`` (10): means over near faces
        whose normals differ by less than about ``contrast`` (default 0.35).
        ``"tv_normals"`` (200 ``steps``): normals of small total variation, near the old ones by
        ``fidelity`` (default 1; more is nearer).
    contrast, fidelity
        See there; without a unit.
    time
        No default, because it says how much is smoothed: features below about sqrt(4 time) go, by
        the bi-Laplacian those below 2 pi time^(1/4).
    weights
        Default: "combinatorial" for polynomials, which need them non-negative; "cotangent" for
        flows.
    mass
        Of the flows; see ``laplacian``.
    features
        Of the polynomials: an angle in degrees. Edges where the surface bends more, and those of
        the boundary, are smoothed along themselves, and corners stay.
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
        If ``time`` is missing, an option is given that the method has not, ``keep`` would move
        what is held, all vertices are held, or the surface degenerates on the way.
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
    >>> round(smooth_mesh(sphere, "taubin", steps=50).volume / sphere.volume, 2)
    1.04
    """
    require_mesh(mesh, "smooth_mesh")
    given = {
        "steps": steps,
        "step": step,
        "pass_band": pass_band,
        "time": time,
        "weights": weights,
        "mass": mass,
        "features": features,
        "contrast": contrast,
        "fidelity": fidelity,
    }
    chosen = SMOOTHING_METHODS[check_name("smoothing method", method, tuple(SMOOTHING_METHODS))]
    options = {name: value for name, value in given.items() if value is not None}
    for name in options:
        if name not in chosen.options:
            raise BeltramiError(
                f"the method {method!r} has no {name}; it has {', '.join(chosen.options)}"
            )
    held = held_vertices(hold, mesh.n_vertices)
    if hold_boundary:
        held |= mesh.topology.on_boundary
        require_free(held)
    if keep is not None:
        check_name("quantity to keep", keep, KEPT)
        if held.any():
            raise BeltramiError(f"keeping the {keep} would move the vertices that are held")
    if keep == "volume" and not mesh.is_closed:
        raise NotClosedError(
            "the surface has a boundary, so there is no volume to keep",
            edges=mesh.topology.boundary_edges,
            remedy='Take keep="centroid", or hold_boundary=True, which leaves the border in place.',
        )
    before = mesh.volume if keep == "volume" else None
    moved = mesh.with_vertices(chosen.run(mesh, held, progress, **options))
    if keep is None:
        return moved
    factor = 1.0 if before is None else _regrowth(before, moved)
    if not moved.area > 0:
        raise BeltramiError(f"the surface has shrunk to a point, so its {keep} cannot be kept")
    centred = (moved.vertices - _centroid(moved)) * factor
    return moved.with_vertices(centred + _centroid(mesh))


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
