"""Nodal domains: where a function has one sign, counted along the edges."""

from __future__ import annotations

import numbers
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Booleans, Floats, Integers, as_function, read_only
from beltrami.errors import BeltramiError, DimensionError, check_name
from beltrami.mesh.connectivity import component_labels
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.topology import Topology
from beltrami.operators.pair import Laplacian

NODAL_KINDS = ("strong", "weak")


@dataclass(frozen=True, eq=False, repr=False)
class NodalDomains:
    """The nodal domains of a function; ``nodal_domains`` makes them.

    Attributes
    ----------
    count : how many there are
    positive, negative : (n,) the number of the domain of that sign of each vertex, or -1. Strong
        domains leave vertices where f is zero out; a vertex of zero may be in a weak domain of
        either sign. Positive domains come first, each in the order of their first vertex
    kind : ``"strong"`` or ``"weak"``
    """

    count: int
    positive: Integers
    negative: Integers
    kind: str

    def __post_init__(self) -> None:
        read_only(self.positive)
        read_only(self.negative)

    def __repr__(self) -> str:
        return f"<NodalDomains: {self.count} {self.kind} ones of {len(self.positive)} vertices>"


def nodal_domains(
    domain: Mesh | Topology | Laplacian, f: ArrayLike, kind: str = "strong", *, zero: float = 1e-9
) -> NodalDomains:
    r"""Find the nodal domains of a function, the connected parts in which it has one sign.

    Along the edges of a mesh these are also the nodal domains of the linear interpolant.
    Eigenvectors of large eigenvalues oscillate more: Courant's theorem bounds the domains of the
    k-th one, and its discrete form does so for connected graphs with *positive* weights and a
    diagonal mass. If :math:`\lambda_{k-1} < \lambda_k = \dots = \lambda_{k+r-1}`, an eigenvector
    of λ_k has at most k weak domains, and at most k + r - 1 strong ones.

    Chapter items: P51.

    Parameters
    ----------
    domain
        A mesh or a topology; or a Laplacian, whose edges with the weight 0 do not count.
    f
        (n,) function.
    kind
        ``"strong"``: parts of {f > 0} and of {f < 0}. ``"weak"``: parts of {f >= 0} and of
        {f <= 0} in which f is not zero everywhere; they may overlap.
    zero
        Values up to this part of the largest one are zero: eigenvectors do not vanish exactly.

    Raises
    ------
    DimensionError, NonFiniteError, UnknownNameError, BeltramiError
        If f, the kind or the threshold is not valid.

    Notes
    -----
    Cost: O(n + p). The theorem is in E. Davies, G. Gladwell, J. Leydold and P. Stadler, Discrete
    nodal domain theorems (Linear Algebra and its Applications 336, 2001).

    Examples
    --------
    >>> from beltrami.mesh.shapes import grid
    >>> mesh = grid(4, 4)
    >>> x, y = (mesh.vertices - 0.5).T
    >>> nodal_domains(mesh, x).count, nodal_domains(mesh, x * y).count
    (2, 4)
    >>> nodal_domains(mesh, x * y, "weak").count
    2
    """
    check_name("kind of nodal domains", kind, NODAL_KINDS)
    edges, n = _edges(domain)
    values = as_function(f, n)
    if values.ndim != 1:
        raise DimensionError(f"nodal domains are of one function ({n},), not {values.shape}")
    if not isinstance(zero, numbers.Real) or not 0 <= zero < 1:
        raise BeltramiError(f"zero is a part of the largest value, from 0 to 1, not {zero!r}")
    signs = _signs(values, float(zero))
    labels = []
    count = 0
    for sign in (1, -1):
        inside = signs == sign if kind == "strong" else signs != -sign
        label, more = _parts(edges, inside, signs == sign)
        labels.append(np.where(label >= 0, label + count, -1))
        count += more
    return NodalDomains(count, *labels, kind)


def _edges(domain: Mesh | Topology | Laplacian) -> tuple[Integers, int]:
    if isinstance(domain, Laplacian):
        return domain.edges[domain.edge_weight != 0], domain.n
    if isinstance(domain, Mesh | Topology):
        return domain.edges, domain.n_vertices
    raise DimensionError(
        f"an object of type {type(domain).__name__} has no edges",
        remedy="Give a Mesh, a Topology, or laplacian(...) of what you have.",
    )


def _signs(f: Floats, zero: float) -> Integers:
    """Return 1, 0 or -1 for each value."""
    size = np.abs(f)
    return np.where(size > zero * size.max(initial=0.0), np.sign(f), 0).astype(np.int64)


def _parts(edges: Integers, inside: Booleans, needed: Booleans) -> tuple[Integers, int]:
    """Label and count the connected parts of ``inside`` that have a vertex that is needed."""
    n = len(inside)
    kept = edges[inside[edges].all(axis=1)]
    labels = component_labels(kept, n)
    number = np.full(n, -1)
    with_one = np.unique(labels[needed])
    number[with_one] = np.arange(len(with_one))
    return np.where(inside, number[labels], -1), len(with_one)
