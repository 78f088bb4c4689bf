"""Proven bounds on the spectrum of a pair (L, B), from its small parts (theorem 9, E62)."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami._jit import kernel
from beltrami.mesh.door import require_mesh, topology_of
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.topology import Topology
from beltrami.operators.face_parts import face_numbers, split_masses
from beltrami.operators.soundness import require_sound


def largest_face_eigenvalue(side_weights: Floats, corner_masses: Floats) -> float:
    r"""Return the largest eigenvalue over the pairs (L_f, B_f) of the faces.

    L and B are sums over the faces, so :math:`L_f \le \lambda B_f` in each of them gives
    :math:`L \le \lambda B`. A pair has the eigenvalue 0 (constants) and the two roots of
    :math:`\lambda^2 - t\lambda + s` with :math:`t = \sum_i L_{ii} / b_i` and
    :math:`s = (w_i w_j + w_j w_k + w_k w_i)(b_i + b_j + b_k) / (b_i b_j b_k)`.

    Chapter items: T9.

    Parameters
    ----------
    side_weights
        (m, 3) the part of the weight of each side (opposite each corner) that a face brings.
    corner_masses
        (m, 3) the part of the mass of each corner that a face brings; positive.

    Examples
    --------
    >>> equilateral = np.full((1, 3), 0.5)  # combinatorial weights, shared by two faces
    >>> largest_face_eigenvalue(equilateral, 2 * equilateral)
    1.5
    """
    return float(_largest_root(side_weights, corner_masses))


def side_weights(domain: Mesh | Topology, edge_weight: Floats, kind: str) -> Floats:
    """Split the weights of the edges among their faces: cotangents as they come, others evenly."""
    if kind == "cotangent" and isinstance(domain, Mesh):
        return face_numbers(domain).half_cotangents
    topology = topology_of(domain)
    per_face = edge_weight / topology.edge_face_count
    return np.asarray(per_face[topology.face_edges])


def corner_masses(domain: Mesh | Topology, sides: Floats, kind: str) -> Floats:
    """Split the masses of the vertices among their faces: as they come, unit masses evenly."""
    topology = topology_of(domain)
    numbers = None
    if kind not in ("degree", "unit"):
        mesh = require_mesh(domain, f"the {kind} mass")
        require_sound(mesh)
        numbers = face_numbers(mesh)
    return split_masses(kind, sides, topology.faces, topology.n_vertices, numbers)


def largest_edge_eigenvalue(
    edges: Integers, edge_weight: Floats, degrees: Floats, masses: Floats
) -> float:
    """Bound the spectrum of a graph without faces, for a diagonal mass.

    With non-negative weights each edge takes the part w_ij / d_i of the mass of its ends, and
    its pair has the eigenvalue d_i / b_i + d_j / b_j: 2 for the degree mass (theorem 9).
    With negative ones, the disks of Gershgorin: (L_ii + Σ|w_ij|) / b_i.
    """
    if not len(edges):
        return 0.0
    if (edge_weight >= 0).all():
        ratio = degrees / masses
        used = edges[edge_weight > 0]
        return float(ratio[used].sum(axis=1).max(initial=0.0))
    ends = edges.ravel()
    reach = np.bincount(ends, np.repeat(np.abs(edge_weight), 2), len(masses))
    return float(((degrees + reach) / masses).max())


@kernel
def _largest_root(weights: Any, masses: Any) -> float:
    """Maximum over the faces of the larger root."""
    largest = 0.0
    for f in range(weights.shape[0]):
        weight = max(abs(weights[f, 0]), abs(weights[f, 1]), abs(weights[f, 2]))
        mass = max(masses[f, 0], masses[f, 1], masses[f, 2])
        if weight == 0:
            continue  # it brings nothing to L, and perhaps nothing to B
        if mass == 0:
            return np.inf
        u, v, w = weights[f, 0] / weight, weights[f, 1] / weight, weights[f, 2] / weight
        a, b, c = masses[f, 0] / mass, masses[f, 1] / mass, masses[f, 2] / mass
        root = _root(u, v, w, a, b, c) if a > 0 and b > 0 and c > 0 else _light(u, v, w, a, b, c)
        largest = max(largest, root * (weight / mass))
    return largest


@kernel
def _root(u: float, v: float, w: float, a: float, b: float, c: float) -> float:
    """Larger root for weights and masses of about 1, whose squares are numbers in any unit."""
    t = (v + w) / a + (w + u) / b + (u + v) / c
    s = (u * v + v * w + w * u) * ((a + b + c) / a / b / c)
    return float((t + max(t * t - 4 * s, 0.0) ** 0.5) / 2)


@kernel
def _light(u: float, v: float, w: float, a: float, b: float, c: float) -> float:
    """Larger root where a corner has no mass: what is left is the edge between the others.

    So it is for weights that a callable made zero. A corner with a stiffness and no mass has no
    bound.
    """
    for _ in range(3):
        if a == 0 and v == 0 and w == 0 and b > 0 and c > 0:
            return u / b + u / c
        u, v, w, a, b, c = v, w, u, b, c, a
    return np.inf
