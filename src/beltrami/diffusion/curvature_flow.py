"""Mean curvature flow: heat on the surface as it becomes (Desbrun 1999, Kazhdan 2012)."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Booleans, Floats
from beltrami._progress import Progress, stages
from beltrami.diffusion.heat import heat
from beltrami.errors import BeltramiError, MeshError, SingularMatrixError
from beltrami.mesh.mesh import Mesh
from beltrami.operators.laplacian import laplacian
from beltrami.operators.pair import Laplacian


def curvature_flow(
    mesh: Mesh,
    weights: str | None,
    mass: str | None,
    time: float,
    steps: int,
    held: Booleans,
    progress: Progress | None = None,
    *,
    conformal: bool = False,
) -> Floats:
    r"""Move by :math:`\partial x/\partial t = -B_t^{-1} L_t x`, the pair made anew each step.

    :math:`-B^{-1}Lx` is twice the mean curvature normal, so the area falls as fast as it can
    (Desbrun, Meyer, Schröder and Barr 1999). Each step of length δ = time / steps is implicit:
    :math:`(B_k + \delta L_k)x_{k+1} = B_k x_k`.

    With ``conformal`` the stiffness stays that of the start, and the mass alone is made anew: the
    flow of Kazhdan, Solomon and Ben-Chen (2012), which does not pinch thin parts off, and turns a
    surface of genus 0 into a sphere. So that it can go on, the surface is scaled about its
    centroid to the area of the start after each step, unless vertices are held.

    Raises
    ------
    BeltramiError
        If the surface degenerates on the way: ``steps`` done are told, with the cause.

    Notes
    -----
    A sphere of radius r has the radius :math:`\sqrt{r^2 - 4t}` at the time t.
    Cost: a factorisation for each step.

    Examples
    --------
    >>> import numpy as np
    >>> from beltrami.mesh.shapes import icosphere
    >>> mesh = icosphere(3)
    >>> free = np.zeros(mesh.n_vertices, bool)
    >>> x = curvature_flow(mesh, None, None, 0.09, 30, free)
    >>> float(np.linalg.norm(x, axis=1).mean().round(2))  # the root of 1 - 4 * 0.09
    0.8
    """
    state, start = mesh, laplacian(mesh, weights, mass)
    for done, _ in enumerate(stages(steps, progress)):
        try:
            pair = laplacian(state, weights, mass) if done else start
            if conformal:
                pair = _with_stiffness_of(start, pair)
            moved = heat(pair, state.vertices, time / steps, steps=1, hold=held)
        except (MeshError, SingularMatrixError) as cause:
            if not done:
                raise
            raise BeltramiError(
                f"the surface degenerates after {done} of {steps} steps ({cause}). Stop earlier"
                + ("" if conformal else ', or use "conformal_flow"')
            ) from cause
        state = state.with_vertices(moved)
        if conformal and not held.any():
            state = _scaled_to(mesh.area, state)
    return state.vertices


def _scaled_to(area: float, mesh: Mesh) -> Mesh:
    centre = mesh.face_areas @ mesh.vertices[mesh.faces].mean(axis=1) / mesh.area
    return mesh.with_vertices((mesh.vertices - centre) * np.sqrt(area / mesh.area) + centre)


def _with_stiffness_of(start: Laplacian, now: Laplacian) -> Laplacian:
    """Join the stiffness of the start and the mass of now; the domain serves the ordering."""
    return Laplacian(
        start.stiffness,
        now.mass,
        start.edges,
        start.edge_weight,
        start.weight_kind,
        now.mass_kind,
        start.domain,
    )
