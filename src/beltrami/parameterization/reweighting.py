"""Reweighted Tutte maps: weights that even out the stretch, all positive (the default method)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from beltrami._arrays import Floats, Integers
from beltrami.errors import MeshError
from beltrami.mesh.mesh import Mesh
from beltrami.parameterization.distortion import Distortion, measured, slopes
from beltrami.parameterization.harmonic import plan_harmonic, solve_harmonic
from beltrami.parameterization.predicates import orientation

_PATIENCE = 3  # steps without a better map before the exponent is halved
_LEAST_EXPONENT = 0.1  # of the stretch: below it, the map is as good as it gets
_FARTHEST = 250.0  # of their sums over the steps: weights neither overflow nor vanish
_LARGEST = np.log(1e6)  # of the logarithms of stretches, about their median


@dataclass(frozen=True, eq=False)
class Step:
    """One of the maps: positions, faces that are not counter-clockwise, distortion."""

    uv: Floats
    flips: int
    distortion: Distortion

    @property
    def rank(self) -> tuple[int, float]:
        """What makes a map better: first no flips, then little distortion."""
        energy = self.distortion.symmetric_dirichlet
        return self.flips, energy if np.isfinite(energy) else np.inf


def reweighted(
    mesh: Mesh,
    W: csr_array,
    loop: Integers,
    placed: Floats,
    steps: int,
    *,
    enough: float = 1.0,
    symmetric: bool = False,
) -> tuple[Step, int]:
    r"""Return the best of a sequence of Tutte maps, and how many there were.

    After each solve the weights are divided by the stretch at the neighbour,
    :math:`w_{ij} \leftarrow w_{ij} / \sigma_j^\eta`, where :math:`\sigma_j` is the mean over the
    faces around j of the stretch of the inverse map, so that regions that are too small grow (S.
    Yoshizawa, A. Belyaev, H.-P. Seidel, A fast and simple stretch-minimizing mesh
    parameterization, 2004, where η = 1). Weights stay positive: each map is within the theorem of
    Tutte and Floater, and only rounding can fold it. While it does, the mean is that of the
    logarithms, which a few wild faces do not rule. After three steps with η = 1 without a
    better map it goes back to the best one, and on from there with η = 1/2, 1/4, 1/8.

    It stops at an energy that is low ``enough``, or after so many steps. Rows of W may be scaled as
    one likes: with :math:`w_{ij} / (\sigma_i \sigma_j)^\eta` symmetric weights stay symmetric.
    """
    n = mesh.n_vertices
    i, j = np.repeat(np.arange(n), np.diff(W.indptr)), W.indices
    total = np.zeros(n)  # logarithms of the products of all stretches
    plan = plan_harmonic(W, loop, mesh.vertices) if symmetric else None
    g = slopes(mesh)
    best: Step | None = None
    exponent, failed, done = 1.0, 0, 0
    while done < steps and exponent > _LEAST_EXPONENT:
        weights = W.data * np.exp(-(total[i] + total[j]))
        scaled = csr_array((weights, W.indices, W.indptr), shape=W.shape)
        uv = solve_harmonic(scaled, loop, placed, mesh.vertices, symmetric=symmetric, plan=plan)
        step = assess(mesh, uv, g)
        done += 1
        if step.rank <= (0, enough):
            return step, done
        here = total, _log_stretch(mesh, step)
        if best is None or step.rank < best.rank:
            best, kept, failed = step, here, 0
        else:
            failed += 1
        if failed == _PATIENCE or (failed and exponent < 1):
            exponent /= 2
        start, change = here if exponent == 1 else kept
        total = start + exponent * change
        total = np.clip(total - total.mean(), -_FARTHEST, _FARTHEST)
    if best is None:
        raise MeshError("no step of reweighting was allowed")
    return best, done


def assess(mesh: Mesh, uv: Floats, g: Floats | None = None) -> Step:
    """Count the flips exactly, and measure; g are the slopes, if they are known."""
    a, b, c = uv[mesh.faces].transpose(1, 0, 2)
    flips = int(np.count_nonzero(orientation(a, b, c) <= 0))
    return Step(uv, flips, measured(mesh, uv, g))


def _log_stretch(mesh: Mesh, step: Step) -> Floats:
    """Return for each vertex the logarithm of the mean stretch of the inverse map around it."""
    s = step.distortion.singular_values
    middle = np.median(s[np.isfinite(s).all(axis=1)])
    if middle > 0:  # by a power of 2: logarithms round alike in every unit of length
        s = np.ldexp(s, 1 - int(np.frexp(middle)[1]))
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        stretch = np.log(np.hypot(s[:, 0], s[:, 1]) / np.sqrt(2)) - np.log(s.prod(axis=1))
    known = np.isfinite(stretch)
    stretch = np.where(known, stretch, stretch[known].max() if known.any() else 0.0)
    stretch = np.clip(stretch - np.median(stretch), -_LARGEST, _LARGEST)
    around = np.bincount(mesh.faces.ravel(), np.repeat(mesh.face_areas, 3), mesh.n_vertices)
    values = stretch if step.flips else np.exp(2 * stretch)
    shares = np.repeat(mesh.face_areas * values, 3)
    mean = np.bincount(mesh.faces.ravel(), shares, mesh.n_vertices) / around
    return mean if step.flips else np.log(mean) / 2
