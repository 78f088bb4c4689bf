"""Normals of small total variation: even parts, and creases between them."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._arrays import Booleans, Floats
from beltrami._jit import kernel
from beltrami.errors import BeltramiError
from beltrami.mesh.mesh import Mesh

_LEAST = 1e-2  # length of an evened normal whose direction is still one


def normals_of_small_variation(mesh: Mesh, fidelity: float, rounds: int = 200) -> Floats:
    r"""Return (m, 3) unit normals near those of the mesh, and as even as ``fidelity`` allows.

    They minimise :math:`\sum_e \ell_e |n_f - n_g| + \frac\alpha2 \sum_f A_f |n_f - n^0_f|^2` over
    all vectors n_f, and are then made of length 1: e are the edges of two faces, ℓ_e their length
    and A_f the areas, in units of the mean length and the mean area, and α the ``fidelity``. A
    crease costs its length times the height of the jump, whether it is sharp or wide: so it stays
    sharp (after Zhang, Wu, Zhang and Deng 2015, who keep n_f of length 1 throughout).

    The dual problem, for one vector of length <= ℓ_e on each edge, is solved by projected gradients
    with momentum (Beck and Teboulle 2009), steps scaled by the edges' own areas.
    Cost: O(rounds m).

    Raises
    ------
    BeltramiError
        If the fidelity is so small that normals which point apart are evened out to nothing.
    """
    normals, lost = evened_normals(mesh, fidelity, rounds)
    if lost.any():
        raise BeltramiError(
            f"with a fidelity of {fidelity:g} the normals of {lost.sum()} faces are evened out "
            "to nothing, with those that point the other way: take a larger one"
        )
    return normals


def evened_normals(mesh: Mesh, fidelity: float, rounds: int) -> tuple[Floats, Booleans]:
    """Return those of ``normals_of_small_variation``, and (m,) the faces that lost theirs.

    These have the normals of the mesh.
    """
    twins = mesh.topology.twins
    sides = np.flatnonzero(twins.ravel() > np.arange(twins.size))
    left, right = sides // 3, twins.ravel()[sides] // 3
    lengths = mesh.edge_lengths[mesh.topology.face_edges.ravel()[sides]]
    areas = mesh.face_areas
    if not len(sides) or not lengths.any():
        return np.array(mesh.face_normals), np.zeros(mesh.n_faces, np.bool_)
    caps = lengths / lengths.mean()
    pull = np.full(len(areas), 0.0)
    np.divide(areas.mean(), fidelity * areas, out=pull, where=areas > 0)
    start = np.asarray(mesh.face_normals)
    normals = _minimise(left, right, caps, pull, start, rounds)
    size = np.linalg.norm(normals, axis=1)
    lost = (size < _LEAST) & start.any(axis=1)
    unit = normals / np.where(size > 0, size, 1)[:, None]
    return np.where(lost[:, None], start, unit), lost


@kernel
def _minimise(left: Any, right: Any, caps: Any, pull: Any, start: Any, rounds: int) -> Any:
    """Run the rounds on the dual vectors q, the last ones p; n = n⁰ - pull Σ ± q.

    Each round makes the n of the next one on its way over the edges.
    """
    e = np.uint64(left.size)
    p, q, steps = np.zeros((e, 3)), np.zeros((e, 3)), np.empty(e)
    for k in range(e):
        f, g = np.uint64(left[k]), np.uint64(right[k])
        steps[k] = 1 / (3 * (pull[f] + pull[g]) + 1e-300)
    n, coming = start.copy(), np.empty_like(start)
    t = 1.0
    for _ in range(rounds):
        following = (1 + np.sqrt(1 + 4 * t * t)) / 2
        momentum = (t - 1) / following
        t = following
        coming[:] = start
        for k in range(e):
            f, g, step = np.uint64(left[k]), np.uint64(right[k]), steps[k]
            x = q[k, 0] + step * (n[f, 0] - n[g, 0])
            y = q[k, 1] + step * (n[f, 1] - n[g, 1])
            z = q[k, 2] + step * (n[f, 2] - n[g, 2])
            size = np.sqrt(x * x + y * y + z * z)
            shrink = caps[k] / size if size > caps[k] else 1.0
            x, y, z = shrink * x, shrink * y, shrink * z
            a = x + momentum * (x - p[k, 0])
            b = y + momentum * (y - p[k, 1])
            c = z + momentum * (z - p[k, 2])
            p[k, 0], p[k, 1], p[k, 2] = x, y, z
            q[k, 0], q[k, 1], q[k, 2] = a, b, c
            coming[f, 0] -= pull[f] * a
            coming[f, 1] -= pull[f] * b
            coming[f, 2] -= pull[f] * c
            coming[g, 0] += pull[g] * a
            coming[g, 1] += pull[g] * b
            coming[g, 2] += pull[g] * c
        n, coming = coming, n
    n[:] = start
    for k in range(e):
        f, g = np.uint64(left[k]), np.uint64(right[k])
        for d in range(3):
            n[f, d] -= pull[f] * p[k, d]
            n[g, d] += pull[g] * p[k, d]
    return n
