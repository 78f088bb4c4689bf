"""From the axes of a grid to its edges, weights and masses: the pair (L, B)."""

from __future__ import annotations

from math import prod
from typing import NamedTuple

import numpy as np

from beltrami._arrays import Floats, Integers, read_only
from beltrami.errors import MeshError, check_name
from beltrami.grids.axis import Axes
from beltrami.mesh.edge_matrix import laplacian_matrix
from beltrami.operators.areas import diagonal_matrix
from beltrami.operators.pair import Laplacian

GRID_WEIGHTS = ("combinatorial", "distance", "dirichlet")
GRID_MASSES = ("degree", "voronoi", "unit")


class Kinds(NamedTuple):
    """The names of the weights and of the mass, with the defaults filled in."""

    weights: str
    mass: str


def kinds(weights: str | None, mass: str | None) -> Kinds:
    """Fill in the defaults: combinatorial weights; their degree, or cells for Dirichlet weights.

    Raises UnknownNameError if a name is misspelt.
    """
    given = "combinatorial" if weights is None else weights
    name = check_name("weights of a grid", given, GRID_WEIGHTS)
    natural = "voronoi" if name == "dirichlet" else "degree"
    return Kinds(name, check_name("mass of a grid", natural if mass is None else mass, GRID_MASSES))


def axis_weights(axes: Axes, kind: str) -> Floats:
    r"""Return the (d,) weights of the edges along each axis.

    1, or :math:`1/h_a^2`, or :math:`\prod_b h_b / h_a^2`. Raises MeshError if a step is too
    small or too large for floats.
    """
    steps = np.array([axis.spacing for axis in axes])
    with np.errstate(over="ignore", under="ignore", divide="ignore", invalid="ignore"):
        squares = np.ones(len(axes)) if kind == "combinatorial" else 1 / steps**2
        weights = squares * (steps.prod() if kind == "dirichlet" else 1.0)
        rows = 8 * len(axes) * weights  # no entry of L, and no eigenvalue, is larger
    if not (np.isfinite(rows) & (weights > 0)).all():
        raise MeshError(f"{kind} weights of steps {steps.tolist()} are out of the range of floats")
    return np.asarray(weights)


def cell_measure(axes: Axes) -> float:
    """Return the product of the steps; MeshError if it is out of the range of floats."""
    measure = prod(axis.spacing for axis in axes)
    if not 0 < measure < float("inf"):
        raise MeshError(f"the cells of a grid have the measure {measure}: scale its steps")
    return measure


def lattice_edges(axes: Axes) -> tuple[Integers, Integers]:
    """Return the edges of the grid, (p, 2) i < j in lexicographic order, and the axis of each.

    The neighbours of a point are those one step away, modulo p on a periodic axis. On a circle
    of two they are one point, and the edge is listed once; on one of a single point there is no
    other. Cost: O(d n).
    """
    numbers = np.arange(prod(axis.size for axis in axes), dtype=np.int64)
    steps, along, taken = [], [], []  # in the order of the steps: nothing is to be sorted
    stride = 1
    for a, axis in reversed(list(enumerate(axes))):
        place = numbers // stride % axis.size
        ways = [(stride, place < axis.size - 1)]
        if axis.periodic and axis.size > 2:
            ways.append(((axis.size - 1) * stride, place == 0))
        for step, possible in ways:
            steps.append(step)
            along.append(a)
            taken.append(possible)
        stride *= axis.size
    start, way = np.nonzero(np.stack(taken, axis=1))
    edges = np.stack([start, start + np.array(steps)[way]], axis=1)
    return edges, np.array(along)[way]


def lattice_pair(axes: Axes, names: Kinds) -> Laplacian:
    """Return the pair of a grid; MeshError for the degree mass of a grid without edges."""
    edges, axis_of = lattice_edges(axes)
    doubled = axis_weights(axes, names.weights) * [axis.coincidence for axis in axes]
    edge_weight = read_only(np.asarray(doubled[axis_of]))
    n = prod(axis.size for axis in axes)
    stiffness = laplacian_matrix(edges, edge_weight, n)
    if names.mass == "degree":
        require_neighbours(axes)
        masses = stiffness.diagonal()
    else:
        masses = np.full(n, cell_measure(axes) if names.mass == "voronoi" else 1.0)
    return Laplacian(stiffness, diagonal_matrix(masses), read_only(edges), edge_weight, *names)


def require_neighbours(axes: Axes) -> None:
    """Raise MeshError for a grid of one point: its degree is zero."""
    if all(axis.size == 1 for axis in axes):
        raise MeshError(
            "a grid of one point has no neighbours, so D cannot be inverted",
            vertices=[0],
            remedy='Use mass="unit" or "voronoi".',
        )
