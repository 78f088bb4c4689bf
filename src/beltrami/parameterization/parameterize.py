"""parameterize: any surface to the plane, by convex combinations, certified (section 3.3.7)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, as_indices, whole
from beltrami._kinds import checked
from beltrami.errors import MeshError, NotADiskError, check_name
from beltrami.mesh.cut import Cut
from beltrami.mesh.door import require_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.tree_cotree import cut_to_disk
from beltrami.operators.soundness import refuse_unreferenced, require_sound
from beltrami.operators.weights import Weigher
from beltrami.parameterization.boundary import SPACINGS, Curve
from beltrami.parameterization.components import CONFORMAL, Request, map_component, settle
from beltrami.parameterization.holes import HOLES, Filled, emptied, fill_holes
from beltrami.parameterization.layout import part_of, side_by_side
from beltrami.parameterization.parameterization import Parameterization, certified

METHODS = ("auto", "tutte", "free", *CONFORMAL)
DEFAULT_WEIGHTS: dict[str, tuple[str | Weigher, ...]] = {
    "auto": ("mean_value", "combinatorial", "clamped"),
    "tutte": ("mean_value",),
    "free": ("clamped", "mean_value", "combinatorial"),
}
_WORDS = {"auto": "relaxed from", "tutte": "Tutte,", "free": "free boundary, from"}


@checked
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
        ``"tutte"``: one solve with the weights as they are. ``"auto"``: weights are corrected
        while the map is bad (see ``reweighted``), then the symmetric Dirichlet energy is lowered
        as far as it falls without a fold, the boundary held (see ``relax``); of large disks that
        of a coarser mesh comes first (see ``disk_map``). ``"free"``: the
        boundary is let go, and does not cross itself: the least distortion, in the unit of length
        of the mesh. ``"least_squares_conformal"`` and ``"spectral_conformal"``: angles are
        kept as far as a free boundary allows, areas are not, and the boundary may overlap (see
        ``conformal_energy``); the unit of length is that of the mesh.
    weights
        ``"combinatorial"``, ``"distance"``, ``"mean_value"``, ``"clamped"`` or a callable: all
        positive. ``"cotangent"`` is negative where two angles add to more than π, and may fold
        (E90). By default ``"mean_value"`` for the method ``"tutte"``, and at first for
        ``"auto"``: where its start is bad, or what is made of it has an energy above 5, the best
        of what is made from ``"mean_value"``, ``"combinatorial"`` and ``"clamped"``. For
        ``"free"`` it is ``"clamped"``, and the others where that ends above 50.
    boundary
        ``"circle"``, ``"square"``, a number of sides or the corners of a convex polygon: see
        ``place_boundary``.
    spacing
        ``"arclength"`` or ``"uniform"``.
    corners
        Vertices of the boundary that go to the corners of the polygon, not those of a hole that
        is filled; of ``"least_squares_conformal"`` the two vertices that are held.
    bulge
        Bend its sides outwards, by this part of their length: where inner edges have both ends on
        one side, 0.01 helps.
    cut
        False refuses what is not a disk, rather than cutting it.
    holes
        What to do with all boundaries of a component but the longest: ``"cut"`` leads a seam to
        each; ``"fill"`` closes them with faces that are dropped when the map is made, so that
        they lie within it as holes, of any shape, and nothing is torn.
    seams
        Up to so many more cuts in each component, from the boundary to the vertex that is
        stretched most, as long as each lowers the distortion by 5 %.
    strict
        Never return a map that is no bijection. Where ``"auto"`` and ``"free"`` fold in spite of
        all seams, the disk is drawn exactly, by whole numbers (see ``draw``), and then relaxed
        with a free boundary: its ``method`` says so. Other methods raise. False returns the
        map as it is, and says that it folds.

    Returns
    -------
    Parameterization
        Components lie side by side, their areas in the proportion of those of the surface.

    Raises
    ------
    FoldedMapError
        With the faces, if the map is not a bijection. For ``"auto"`` and ``"free"`` up to eight
        more seams are tried before (with ``cut=True``), and then the drawing.
    NotADiskError
        If ``cut`` is False and a component is not a disk.
    NotOrientableError
        If neighbouring faces disagree on the outside.
    BoundaryCurveError
        If the polygon is not convex, or an inner edge has both ends on one of its sides.
    MeshError
        If an option is given that a conformal map does not use, or not two vertices to hold.
    EmptyMeshError, NonFiniteError, DegenerateFaceError, UnreferencedVertexError
        If the mesh is not sound.

    Notes
    -----
    Tutte's maps take one sparse factorisation for both coordinates. Symmetric weights go to
    Cholesky, several times faster than LU, which those of the mean value need. Conformal maps,
    and each Newton's step of relaxation, take one of twice as many unknowns; ``"auto"`` takes
    about five of them on large meshes, and more on coarser ones.

    Examples
    --------
    >>> from beltrami.mesh.shapes import torus
    >>> psi = parameterize(torus(24, 16))
    >>> psi.is_bijective, len(psi.cut_edges), round(psi.distortion.symmetric_dirichlet, 1)
    (True, 40, 2.3)
    """
    check_name("method of parameterisation", method, METHODS)
    require_sound(require_mesh(mesh, "a parameterisation"))
    if not mesh.topology.referenced.all():
        refuse_unreferenced(mesh.topology)
    whole("the number of seams", seams, least=0)
    check_name("spacing", spacing, SPACINGS)
    if method in CONFORMAL:
        _refuse_what_is_not_used(mesh, method, weights, boundary, spacing, corners, bulge)
    kinds = DEFAULT_WEIGHTS.get(method, ()) if weights is None else (weights,)
    filled = fill_holes(mesh) if check_name("treatment of holes", holes, HOLES) == "fill" else None
    if filled is not None and filled.mesh.n_faces == mesh.n_faces:
        filled = None
    given = mesh if filled is None else filled.mesh
    current = cut_to_disk(given) if cut else _as_it_is(given)
    known = current.mesh if filled is None else filled.apart.mesh  # fillings have no vertices
    places = None if corners is None else as_indices(corners, known.n_vertices, "corners")
    asked = Request(method, kinds, boundary, spacing, places, bulge, seams, cut, draw=strict)
    labels = current.mesh.components()
    uv, drawn = np.zeros((current.mesh.n_vertices, 2)), 0
    for component in range(int(labels.max()) + 1):
        found = map_component(current, uv, labels == component, asked)
        current, uv, drawn = found.cut, found.uv, drawn + found.drawn
    if filled is not None:
        current, uv = _without(filled, mesh, current, uv, asked)
        labels = current.mesh.components()
    uv = side_by_side(current.mesh, uv, labels)
    return certified(mesh, current, uv, in_words(method, weights, drawn), strict=strict)


def _without(
    filled: Filled, mesh: Mesh, current: Cut, uv: Floats, asked: Request
) -> tuple[Cut, Floats]:
    """Take the fillings of holes out, and relax what they held."""
    rim = current.mesh.topology.on_boundary
    current, values = emptied(filled, mesh, current, np.column_stack([uv, rim]))
    uv, rim = values[:, :2].copy(), values[:, 2] > 0
    if not asked.rescue:
        return current, uv
    labels = current.mesh.components()
    for component in range(int(labels.max()) + 1):
        part, number = part_of(current.mesh, labels == component)
        held = None if asked.method == "free" else rim[number]
        uv[number] = settle(part, uv[number], held)
    return current, uv


def in_words(method: str, weights: str | Weigher | None, drawn: int) -> str:
    """Say how a map was made."""
    if method in CONFORMAL:
        return method.replace("_", " ")
    named = "default" if weights is None else weights if isinstance(weights, str) else "given"
    words = f"{_WORDS[method]} {named} weights"
    return f"{words}; {drawn} components by Schnyder woods, relaxed" if drawn else words


def _refuse_what_is_not_used(
    mesh: Mesh,
    method: str,
    weights: str | Weigher | None,
    boundary: Curve,
    spacing: str,
    corners: ArrayLike | None,
    bulge: float,
) -> None:
    """Raise MeshError for options that conformal maps would ignore."""
    on_circle = isinstance(boundary, str) and boundary == "circle"
    if weights is not None or not on_circle or spacing != SPACINGS[0] or bulge != 0:
        raise MeshError(
            f"{method.replace('_', ' ')} maps have cotangent weights and a free boundary: weights, "
            "boundary, spacing and bulge are not for them"
        )
    if corners is None:
        return
    if method == "spectral_conformal":
        raise MeshError("spectral conformal maps hold no vertex: corners are not for them")
    held = as_indices(corners, mesh.n_vertices, "held vertices")
    if len(held) != 2 or held[0] == held[1]:
        raise MeshError("least squares conformal maps hold two vertices", vertices=held)


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
