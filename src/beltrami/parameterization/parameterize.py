"""parameterize: any surface to the plane, by convex combinations, certified (section 3.3.7)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Booleans, Floats, Integers, read_only
from beltrami.errors import MeshError, NotADiskError, check_name
from beltrami.mesh.cut import Cut, cut_along, edges_between, shortest_paths
from beltrami.mesh.door import require_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.tree_cotree import cut_to_disk
from beltrami.operators.soundness import refuse_unreferenced, require_sound
from beltrami.operators.weights import Weigher, edge_weights
from beltrami.parameterization.boundary import Curve, place_boundary, refuse_dividing_edges
from beltrami.parameterization.harmonic import solve_harmonic
from beltrami.parameterization.holes import HOLES, fill_holes, without_fillings
from beltrami.parameterization.layout import part_of, side_by_side
from beltrami.parameterization.parameterization import Parameterization, certified
from beltrami.parameterization.relaxation import relax
from beltrami.parameterization.reweighting import Step, assess, reweighted

METHODS = ("auto", "tutte", "free")
_STEPS = 30  # of reweighting, at most
_DEFAULTS: dict[str, tuple[str, ...]] = {
    "auto": ("clamped", "mean_value", "combinatorial"),
    "tutte": ("mean_value",),
    "free": ("clamped", "mean_value", "combinatorial"),
}
_BAD = 50.0  # symmetric Dirichlet energy above which other weights are tried
_RELAXATIONS = 50  # steps of it, at most
_RESCUES = 8  # seams to be tried where a map folds
_WORTH = 0.95  # a seam is kept if it lowers the distortion to this part


@dataclass(frozen=True)
class _Request:
    """What was asked for, to map each component alike."""

    method: str
    weights: tuple[str | Weigher, ...]  # the next ones only where those before give a bad map
    boundary: Curve
    spacing: str
    corners: ArrayLike | None
    bulge: float


def parameterize(
    mesh: Mesh,
    method: str = "auto",
    weights: str | Weigher | None = None,
    boundary: Curve = "circle",
    *,
    spacing: str = "arclength",
    corners: ArrayLike | None = None,
    bulge: float = 0.0,
    cut: bool = True,
    holes: str = "cut",
    seams: int = 0,
    strict: bool = True,
) -> Parameterization:
    r"""Map a surface to the plane without a fold (l. 669 and theorem 21).

    The boundary goes to a convex curve, and each inner vertex to a weighted mean of its
    neighbours. If the surface is a disk and the weights are positive this is a bijection (Tutte
    1963, Floater 1997; E89 has the conditions that the chapter omits). In floating point the
    theorem does not suffice: whether the result is a bijection is decided exactly, and said.

    Chapter items: T21, P69, P72, P73, P74, U39.

    Parameters
    ----------
    mesh
        Any oriented surface. What is not a disk is cut into one by ``cut_to_disk``.
    method
        ``"auto"``: weights are corrected until the distortion stops falling (see
        ``reweighted``); ``"tutte"``: one solve with the weights as they are; ``"free"``: then let
        the boundary go, and lower the symmetric Dirichlet energy as far as it falls without a
        fold or a crossing of the boundary (see ``relax``): the least distortion, in the unit of
        length of the mesh.
    weights
        ``"combinatorial"``, ``"distance"``, ``"mean_value"``, ``"clamped"`` or a callable: all
        positive. ``"cotangent"`` is negative where two angles add to more than π, and may fold
        (E90). By default ``"mean_value"`` for the method ``"tutte"``; else ``"clamped"``, and
        where that folds or has an energy above 50 the best of it, ``"mean_value"`` and
        ``"combinatorial"``.
    boundary
        ``"circle"``, ``"square"``, a number of sides or the corners of a convex polygon: see
        ``place_boundary``.
    spacing
        ``"arclength"`` or ``"uniform"``.
    corners
        Vertices of the boundary that go to the corners of the polygon.
    bulge
        Bend its sides outwards, by this part of their length: where inner edges have both ends on
        one side, 0.01 helps.
    cut
        False refuses what is not a disk, rather than cutting it.
    holes
        What to do with all boundaries of a component but the longest: ``"cut"`` leads a seam to
        each; ``"fill"`` closes them with faces that are dropped when the map is made, so that
        they lie within it as holes, and nothing is torn.
    seams
        Up to so many more cuts in each component, from the boundary to the vertex that is
        stretched most, as long as each lowers the distortion by 5 %.
    strict
        Raise if the map is not a bijection; False returns it all the same, and says so.

    Returns
    -------
    Parameterization
        Components lie side by side, their areas in the proportion of those of the surface.

    Raises
    ------
    FoldedMapError
        With the faces, if the map is not a bijection. For ``"auto"`` up to eight more seams are
        tried before (with ``cut=True``).
    NotADiskError
        If ``cut`` is False and a component is not a disk.
    NotOrientableError
        If neighbouring faces disagree on the outside.
    BoundaryCurveError
        If the polygon is not convex, or an inner edge has both ends on one of its sides.
    EmptyMeshError, NonFiniteError, DegenerateFaceError, UnreferencedVertexError
        If the mesh is not sound.

    Notes
    -----
    One sparse factorisation for both coordinates at each step. Symmetric weights stay symmetric
    and go to Cholesky, several times faster than LU, which those of the mean value need.

    Examples
    --------
    >>> from beltrami.mesh.shapes import torus
    >>> psi = parameterize(torus(24, 16))
    >>> psi.is_bijective, len(psi.cut_edges), round(psi.distortion.symmetric_dirichlet, 1)
    (True, 40, 2.4)
    """
    check_name("method of parameterisation", method, METHODS)
    require_sound(require_mesh(mesh, "a parameterisation"))
    if not mesh.topology.referenced.all():
        refuse_unreferenced(mesh.topology)
    if seams < 0:
        raise MeshError(f"the number of seams cannot be {seams}")
    if check_name("treatment of holes", holes, HOLES) == "fill":
        filled = fill_holes(mesh)
        psi = parameterize(
            filled.mesh,
            method,
            weights,
            boundary,
            spacing=spacing,
            corners=corners,
            bulge=bulge,
            cut=cut,
            seams=seams,
            strict=strict,
        )
        return without_fillings(psi, mesh, filled, strict=strict)
    kinds: tuple[str | Weigher, ...] = (weights,) if weights is not None else _DEFAULTS[method]
    asked = _Request(method, kinds, boundary, spacing, corners, bulge)
    current = cut_to_disk(mesh) if cut else _as_it_is(mesh)
    labels = current.mesh.components()
    uv = np.zeros((current.mesh.n_vertices, 2))
    for component in range(int(labels.max()) + 1):
        faces = labels == component
        current, uv = _mapped(current, uv, faces, asked, seams if cut else 0, rescue=cut)
    uv = side_by_side(current.mesh, uv, labels)
    how = {"auto": "reweighted from", "tutte": "Tutte,", "free": "free boundary, from"}
    named = "default" if weights is None else weights if isinstance(weights, str) else "given"
    words = f"{how[method]} {named} weights"
    return certified(mesh, current, uv, words, strict=strict)


def _as_it_is(mesh: Mesh) -> Cut:
    """Return an empty cut of a surface whose components are disks; NotADiskError otherwise."""
    found = cut_to_disk(mesh)
    if len(found.edges):
        raise NotADiskError(
            "the surface is not a disk: it would have to be cut",
            edges=found.edges,
            remedy="Allow it with cut=True, or cut it yourself.",
        )
    return found


def _mapped(
    current: Cut, uv: Floats, faces: Booleans, asked: _Request, seams: int, *, rescue: bool
) -> tuple[Cut, Floats]:
    """Map one component; return the mesh with the seams that it needed, and all positions."""
    part, number = part_of(current.mesh, faces)
    best = _solved(part, number, asked)
    tries = 0
    while True:
        folded = best.flips > 0 and rescue and asked.method != "tutte"
        if tries >= (max(_RESCUES, seams) if folded else seams):
            break
        tries += 1
        found = []
        for seam in _seams(part, best):
            longer = _extended(current, number[seam])
            pieces = part_of(longer.mesh, faces)
            found.append((_solved(*pieces, asked), longer, *pieces))
        if not found:
            break
        step, longer, new_part, new_number = min(found, key=lambda one: one[0].rank)
        better = (step.flips, step.rank[1]) < (best.flips, _WORTH * best.rank[1])
        if not better and not folded:
            break
        current, part, number, best = longer, new_part, new_number, step
    added = current.mesh.n_vertices - len(uv)
    uv = np.concatenate([uv, np.zeros((added, 2))])
    uv[number] = relax(part, best.uv, _RELAXATIONS)[0] if asked.method == "free" else best.uv
    return current, uv


def _solved(part: Mesh, number: Integers, asked: _Request) -> Step:
    """Map a disk."""
    loop = part.topology.boundary_loops[0]
    corners = asked.corners
    if corners is not None:
        place = {int(v): q for q, v in enumerate(number)}
        wanted = np.asarray(corners).ravel().tolist()
        corners = np.array([place.get(int(v), -1) for v in wanted])
    placed = place_boundary(
        part, loop, asked.boundary, spacing=asked.spacing, corners=corners, bulge=asked.bulge
    )
    if not (isinstance(asked.boundary, str) and asked.boundary == "circle"):
        refuse_dividing_edges(part, loop, placed)
    steps: list[Step] = []
    for kind in asked.weights:
        W = edge_weights(part, kind)
        if asked.method == "tutte":
            steps.append(assess(part, solve_harmonic(W, loop, placed, part.vertices)))
        else:
            steps.append(reweighted(part, W, loop, placed, _STEPS)[0])
        if steps[-1].rank <= (0, _BAD):
            break
    return min(steps, key=lambda step: step.rank)


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
