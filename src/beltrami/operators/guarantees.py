"""Guarantees: what each kind of weights needs and promises, told by the object (S1 to S6)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami.mesh.connectivity import component_labels


@dataclass(frozen=True)
class WeightKind:
    """What is true of weights of one kind on every mesh.

    Attributes
    ----------
    needs_positions, needs_faces
        What they are made of: combinatorial weights need neither, so that a decoder that knows
        the edges alone makes the same ones (l. 139 of the chapter).
    symmetric
        Whether w_ij = w_ji; a Laplacian needs it.
    non_negative
        Whether no mesh makes a weight negative.
    of_a_surface
        Whether <Lf, f> is the Dirichlet energy of a piecewise linear function on the surface, so
        that L is positive semi-definite whatever the signs.
    linear_precision
        Whether L x = 0 at the inner vertices of every planar mesh.
    """

    needs_positions: bool
    needs_faces: bool
    symmetric: bool = True
    non_negative: bool = True
    of_a_surface: bool = False
    linear_precision: bool = False


_COTANGENT = WeightKind(True, True, non_negative=False, of_a_surface=True, linear_precision=True)
GIVEN = WeightKind(False, False, non_negative=False)  # by a matrix: nothing is known

WEIGHT_KINDS = {
    "combinatorial": WeightKind(False, False),
    "distance": WeightKind(True, False),
    "gaussian": WeightKind(True, False),
    "cotangent": _COTANGENT,
    "intrinsic_delaunay": _COTANGENT,
    "clamped": WeightKind(True, True),
    "tufted": WeightKind(True, True, of_a_surface=True),
    "mean_value": WeightKind(True, True, symmetric=False, linear_precision=True),
}


@dataclass(frozen=True, eq=False)
class LaplacianProperties:
    """What is true of a Laplacian, told and not assumed.

    Chapter items: T7, T9, P16.

    Attributes
    ----------
    symmetric
        Whether L = L': always, since what is not is refused.
    positive_semidefinite
        Whether <Lf, f> >= 0 is proven for all f: no weight is negative, or <Lf, f> is the energy
        of an interpolant. False says that nothing is proven.
    non_negative_weights
        Whether no weight is negative: then averaging is defined, and with the degree mass the
        spectrum lies in [0, 2] (theorem 9).
    negative_edges
        (q, 2) int: the edges with a negative weight.
    maximum_principle
        Whether each value of a solution of Lf = 0 is a mean, with weights >= 0, of its neighbours,
        so that averaging, interpolation and, with a diagonal mass, heat (exact or by implicit
        steps) stay between the least and largest value given. The consistent mass lets heat leave
        them. The same as ``non_negative_weights``.
    linear_precision
        Whether L x = 0 at inner vertices of any planar mesh: cotangents, intrinsic ones too.
    spectral_bound
        An upper bound on the eigenvalues of the pair (L, B).
    kernel_dimension
        Number of independent functions with Lf = 0 (theorem 7): the components of the graph; None
        where negative weights leave it open.
    needs_positions, needs_faces
        What the weights are made of.
    """

    symmetric: bool
    positive_semidefinite: bool
    non_negative_weights: bool
    negative_edges: Integers
    maximum_principle: bool
    linear_precision: bool
    spectral_bound: float
    kernel_dimension: int | None
    needs_positions: bool
    needs_faces: bool


def properties_of(
    kind: str, edges: Integers, edge_weight: Floats, n: int, negative: Integers, bound: float
) -> LaplacianProperties:
    """Tell the properties of weights of this kind, given which are negative and the bound."""
    known = WEIGHT_KINDS.get(kind, GIVEN)
    non_negative = not len(negative)
    return LaplacianProperties(
        symmetric=True,
        positive_semidefinite=non_negative or known.of_a_surface,
        non_negative_weights=non_negative,
        negative_edges=negative,
        maximum_principle=non_negative,
        linear_precision=known.linear_precision,
        spectral_bound=bound,
        kernel_dimension=_kernel_dimension(known, edges, edge_weight, n, non_negative),
        needs_positions=known.needs_positions,
        needs_faces=known.needs_faces,
    )


def _kernel_dimension(
    kind: WeightKind, edges: Integers, edge_weight: Floats, n: int, non_negative: bool
) -> int | None:
    """Count components: an energy without gradient is constant on each one (E45)."""
    if kind.of_a_surface:  # the faces connect, also where a weight is zero
        joined = edges
    elif non_negative:
        joined = edges[edge_weight > 0]
    else:
        return None
    return int(component_labels(joined, n).max(initial=np.int64(-1))) + 1
