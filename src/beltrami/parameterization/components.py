"""One component of a surface to the plane: a map, seams where it is bad, a drawing at the last."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from beltrami._arrays import Booleans, Floats, Integers, read_only
from beltrami.errors import MeshError
from beltrami.mesh.cut import Cut, cut_along, edges_between, shortest_paths
from beltrami.mesh.mesh import Mesh
from beltrami.operators.weights import Weigher, edge_weights
from beltrami.parameterization.boundary import Curve, place_boundary, refuse_dividing_edges
from beltrami.parameterization.coarse_to_fine import disk_map
from beltrami.parameterization.conformal import least_squares_conformal, spectral_conformal
from beltrami.parameterization.harmonic import is_symmetric, solve_harmonic
from beltrami.parameterization.layout import part_of
from beltrami.parameterization.relaxation import relax
from beltrami.parameterization.reweighting import Step, assess
from beltrami.parameterization.schnyder import draw

CONFORMAL = ("least_squares_conformal", "spectral_conformal")
_SETTLED = 3e-3  # decrease in a step at which the relaxation inside a fixed boundary stops
_TO_THE_LAST = 1e-4  # likewise, with a free boundary
_ROUGHLY = 1e-2  # likewise, as long as maps are compared
_RELAXATIONS = 200  # steps of it, at most
_FROM_DRAWING = 300  # steps of relaxation that make a map of a drawing
_AT_REST = 1e-5  # decrease in a step at which these stop
_RESCUES = 8  # seams to be tried where a map folds
_WORTH = 0.95  # a seam is kept if it lowers the distortion to this part


@dataclass(frozen=True)
class Request:
    """What was asked for, to map each component alike."""

    method: str
    weights: tuple[str | Weigher, ...]  # the next ones only where those before give a bad map
    boundary: Curve
    spacing: str
    corners: Integers | None
    bulge: float
    seams: int
    cut: bool
    draw: bool  # where all else folds
    rough: bool = False  # not relaxed to the last: that is left to ``settle``

    @property
    def compares(self) -> bool:
        """Whether several maps are to be compared, for which rough ones are good enough."""
        return self.rough or (self.cut and self.seams > 0)

    @property
    def rescue(self) -> bool:
        """Whether what folds is to be mapped in another way."""
        return self.method in ("auto", "free")


@dataclass(frozen=True, eq=False)
class Mapped:
    """The mesh with the seams that a component needed, positions of all, and if it was drawn.

    ``first`` is the map of the component without a seam.
    """

    cut: Cut
    uv: Floats
    drawn: bool
    first: Step


def map_component(
    current: Cut, uv: Floats, faces: Booleans, asked: Request, start: Step | None = None
) -> Mapped:
    """Map one component, with more seams where it is bad and they are allowed.

    ``start`` is its map without a seam, if that is known.
    """
    part, number = part_of(current.mesh, faces)
    first = best = _solved(current, part, number, asked) if start is None else start
    seams, tries = asked.seams if asked.cut else 0, 0
    while True:
        folded = best.flips > 0 and asked.cut and asked.rescue
        if tries >= (max(_RESCUES, seams) if folded else seams):
            break
        tries += 1
        found = []
        for seam in _seams(part, best):
            longer = _extended(current, number[seam])
            pieces = part_of(longer.mesh, faces)
            found.append((_solved(longer, *pieces, asked), longer, *pieces))
        if not found:
            break
        step, longer, new_part, new_number = min(found, key=lambda one: one[0].rank)
        better = (step.flips, step.rank[1]) < (best.flips, _WORTH * best.rank[1])
        if not better and not folded:
            break
        current, part, number, best = longer, new_part, new_number, step
    added = current.mesh.n_vertices - len(uv)
    uv = np.concatenate([uv, np.zeros((added, 2))])
    drawn = best.flips > 0 and asked.rescue and asked.draw
    finish = asked.method == "free" and asked.compares and not asked.rough and not best.flips
    uv[number] = _drawn(part) if drawn else settle(part, best.uv, None) if finish else best.uv
    return Mapped(current, uv, drawn, first)


def _solved(current: Cut, part: Mesh, number: Integers, asked: Request) -> Step:
    """Map a disk, a part of the cut surface whose vertices have these numbers there."""
    loop = part.topology.boundary_loops[0]
    if asked.method == "spectral_conformal":
        return assess(part, spectral_conformal(part))
    if asked.method == "least_squares_conformal":
        return assess(part, least_squares_conformal(part, _held(number, asked.corners)))
    placed = place_boundary(
        current.mesh,
        number[loop],
        asked.boundary,
        spacing=asked.spacing,
        corners=asked.corners,
        bulge=asked.bulge,
    )
    if not (isinstance(asked.boundary, str) and asked.boundary == "circle"):
        refuse_dividing_edges(part, loop, placed, current.vertex_map[number])
    if asked.method == "tutte":
        W, symmetric = edge_weights(part, asked.weights[0]), is_symmetric(asked.weights[0])
        uv = solve_harmonic(W, loop, placed, part.vertices, symmetric=symmetric)
        return assess(part, uv)
    free = asked.method == "free"
    settled = (_ROUGHLY if asked.compares else _TO_THE_LAST) if free else _SETTLED
    return disk_map(
        part, asked.weights, loop, placed, free=free, settled=settled, rough=free and asked.rough
    )


def _held(number: Integers, corners: Integers | None) -> Integers | None:
    """Return the vertices of a component that are to be held, if any are given."""
    if corners is None:
        return None
    outside = ~np.isin(corners, number)
    if outside.any():
        raise MeshError(
            "the vertices that are held belong to another component", vertices=corners[outside]
        )
    return np.searchsorted(number, corners)


def settle(part: Mesh, uv: Floats, held: Booleans | None) -> Floats:
    """Relax a map, to the last with a free boundary."""
    return relax(part, uv, _RELAXATIONS, held, _TO_THE_LAST if held is None else _SETTLED)[0]


def _drawn(part: Mesh) -> Floats:
    """Draw a disk without its geometry, then relax it to it."""
    return relax(part, draw(part.topology), _FROM_DRAWING, None, _AT_REST)[0]


def _seams(part: Mesh, step: Step) -> list[Integers]:
    """Return paths of vertices from the boundary: to the farthest vertex, and to the worst face."""
    loop = part.topology.boundary_loops[0]
    distance, before = shortest_paths(part, loop)
    worst = part.faces[int(step.distortion.energy.argmax())]
    targets = [int(distance.argmax()), int(worst[distance[worst].argmax()])]
    paths = []
    for path in ([target] for target in targets):
        while before[path[-1]] >= 0:
            path.append(int(before[path[-1]]))
        if len(path) > 1:
            paths.append(np.array(path, np.int64))
    return paths


def _extended(current: Cut, path: Integers) -> Cut:
    """Cut along a path of vertices too."""
    mesh = current.mesh
    chosen = np.zeros(mesh.topology.n_edges, np.bool_)
    chosen[edges_between(mesh.topology, path[1:], path[:-1])] = True
    longer = cut_along(mesh, chosen)
    chain = current.vertex_map
    edges = np.concatenate([current.edges, np.sort(chain[longer.edges], axis=1)])
    return replace(longer, vertex_map=read_only(chain[longer.vertex_map]), edges=read_only(edges))
