"""The methods of smooth_mesh: their options, with defaults, and what they do to the positions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from beltrami._arrays import Booleans, Floats
from beltrami._progress import Progress, stages
from beltrami.diffusion.averaging_series import filter_rows
from beltrami.diffusion.bilaplacian import bilaplacian_flow
from beltrami.diffusion.curvature_flow import curvature_flow
from beltrami.diffusion.face_rings import face_rings
from beltrami.diffusion.features import feature_edges, weights_along
from beltrami.diffusion.heat import heat
from beltrami.diffusion.normal_filters import filtered_normals
from beltrami.diffusion.normal_variation import normals_of_small_variation
from beltrami.diffusion.smoothing import average, averaging_rows, shares_of, smooth
from beltrami.diffusion.taubin import taubin_steps
from beltrami.diffusion.vertex_update import fit_to_normals, require_agreeing_normals
from beltrami.diffusion.windowed_sinc import sinc_coefficients
from beltrami.errors import BeltramiError
from beltrami.mesh.mesh import Mesh
from beltrami.operators.laplacian import laplacian
from beltrami.solvers.locality import LocalRows, local_rows


@dataclass(frozen=True)
class SmoothingMethod:
    """A method: new positions of (mesh, held, progress, **options), and its options."""

    run: Callable[..., Floats]
    options: tuple[str, ...]


def _averaging(
    mesh: Mesh,
    held: Booleans,
    progress: Progress | None,
    *,
    steps: int = 10,
    step: float = 1.0,
    weights: str = "combinatorial",
    features: float | None = None,
) -> Floats:
    if features is None:
        pair = laplacian(mesh, weights, "degree")
        return smooth(pair, mesh.vertices, steps, step, hold=held, progress=progress)
    if not 0 <= step <= 1:
        raise BeltramiError(f"along features the step must be from 0 to 1, not {step}")
    rows = _rows(mesh, weights, features, held)
    return average(rows, mesh.vertices, np.full(_whole(steps), float(step)), progress)


def _taubin(
    mesh: Mesh,
    held: Booleans,
    progress: Progress | None,
    *,
    steps: int = 10,
    step: float = 0.5,
    pass_band: float = 0.1,
    weights: str = "combinatorial",
    features: float | None = None,
) -> Floats:
    rounds = taubin_steps(step, pass_band, _whole(steps))
    rows = _rows(mesh, weights, features, held)
    return average(rows, mesh.vertices, rounds, progress)


def _windowed_sinc(
    mesh: Mesh,
    held: Booleans,
    progress: Progress | None,
    *,
    steps: int = 20,
    pass_band: float = 0.1,
    weights: str = "combinatorial",
    features: float | None = None,
) -> Floats:
    coefficients = sinc_coefficients(pass_band, steps)
    rows = _rows(mesh, weights, features, held, alike=False)
    return filter_rows(rows, mesh.vertices, coefficients, progress)


def _rows(
    mesh: Mesh, weights: str, features: float | None, held: Booleans, alike: bool = True
) -> LocalRows:
    """Return the rows of W̃, which look along features only where there are some."""
    pair = laplacian(mesh, weights, "degree")
    pair.require_non_negative("averaging")
    if features is None:
        return averaging_rows(pair, held, columns=mesh.dimension if alike else 0)
    along, corners = weights_along(mesh, pair.edge_weight, feature_edges(mesh, features))
    alone = held | corners | (np.diff(along.indptr) == 0)
    return local_rows(along.indptr, along.indices, shares_of(along), alone)


def _heat(method: str) -> Callable[..., Floats]:
    def run(
        mesh: Mesh,
        held: Booleans,
        progress: Progress | None,
        *,
        time: float | None = None,
        steps: int | None = None,
        weights: str | None = None,
        mass: str | None = None,
    ) -> Floats:
        pair = laplacian(mesh, weights, mass)
        return heat(pair, mesh.vertices, _needed(time), method, steps, hold=held, progress=progress)

    return run


def _bilaplacian(
    mesh: Mesh,
    held: Booleans,
    progress: Progress | None,
    *,
    time: float | None = None,
    steps: int = 1,
    weights: str | None = None,
    mass: str | None = None,
) -> Floats:
    pair = laplacian(mesh, weights, mass)
    return bilaplacian_flow(pair, mesh.vertices, _needed(time), _whole(steps, 1), held, progress)


def _flow(conformal: bool) -> Callable[..., Floats]:
    def run(
        mesh: Mesh,
        held: Booleans,
        progress: Progress | None,
        *,
        time: float | None = None,
        steps: int = 10,
        weights: str | None = None,
        mass: str | None = None,
    ) -> Floats:
        span = (_needed(time), _whole(steps, 1))
        return curvature_flow(mesh, weights, mass, *span, held, progress, conformal=conformal)

    return run


def _of_normals(guided: bool) -> Callable[..., Floats]:
    def run(
        mesh: Mesh,
        held: Booleans,
        progress: Progress | None,
        *,
        steps: int = 10 if guided else 20,
        contrast: float = 0.35,
    ) -> Floats:
        if not (0 < contrast < np.inf):
            raise BeltramiError(f"the contrast must be > 0, not {contrast}")
        require_agreeing_normals(mesh)
        rounds = filtered_normals(mesh, face_rings(mesh.topology), contrast, guided=guided)
        normals = mesh.face_normals
        for _ in stages(_whole(steps), progress):
            normals = next(rounds)
        return fit_to_normals(mesh.topology, mesh.vertices, normals, held)

    return run


def _tv_normals(
    mesh: Mesh,
    held: Booleans,
    progress: Progress | None,
    *,
    steps: int = 200,
    fidelity: float = 1.0,
) -> Floats:
    del progress  # it is short
    if not (0 < fidelity < np.inf):
        raise BeltramiError(f"the fidelity must be > 0, not {fidelity}")
    require_agreeing_normals(mesh)
    normals = normals_of_small_variation(mesh, fidelity, _whole(steps))
    return fit_to_normals(mesh.topology, mesh.vertices, normals, held)


def _needed(time: float | None) -> float:
    if time is None:
        raise BeltramiError(
            "flows need a time: for heat about the square of the size of the details that are to "
            "go, over 4"
        )
    if not 0 <= time < np.inf:
        raise BeltramiError(f"time must be finite and >= 0, not {time}")
    return float(time)


def _whole(steps: int, least: int = 0) -> int:
    if not (least <= steps < np.inf) or steps != int(steps):
        raise BeltramiError(f"steps must be a whole number >= {least}, not {steps}")
    return int(steps)


_POLYNOMIAL = ("steps", "step", "pass_band", "weights", "features")
_FLOW = ("time", "steps", "weights", "mass")
SMOOTHING_METHODS = {
    "averaging": SmoothingMethod(_averaging, ("steps", "step", "weights", "features")),
    "taubin": SmoothingMethod(_taubin, _POLYNOMIAL),
    "windowed_sinc": SmoothingMethod(_windowed_sinc, ("steps", "pass_band", "weights", "features")),
    "implicit": SmoothingMethod(_heat("implicit"), _FLOW),
    "explicit": SmoothingMethod(_heat("explicit"), _FLOW),
    "bilaplacian": SmoothingMethod(_bilaplacian, _FLOW),
    "curvature_flow": SmoothingMethod(_flow(False), _FLOW),
    "conformal_flow": SmoothingMethod(_flow(True), _FLOW),
    "bilateral_normals": SmoothingMethod(_of_normals(False), ("steps", "contrast")),
    "guided_normals": SmoothingMethod(_of_normals(True), ("steps", "contrast")),
    "tv_normals": SmoothingMethod(_tv_normals, ("steps", "fidelity")),
}
