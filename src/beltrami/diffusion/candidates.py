"""What denoise mixes: linear filters, and filters of normals, of many strengths."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.polynomial import Chebyshev

from beltrami._arrays import Floats
from beltrami.diffusion.face_rings import FaceRings, face_rings
from beltrami.diffusion.normal_filters import filtered_normals
from beltrami.diffusion.normal_variation import normals_of_small_variation
from beltrami.diffusion.smoothing import shares_of
from beltrami.diffusion.vertex_update import fit_to_normals
from beltrami.diffusion.windowed_sinc import filter_rows
from beltrami.errors import BeltramiError
from beltrami.mesh.mesh import Mesh
from beltrami.solvers.locality import LocalRows, local_rows

_VARIATION_ROUNDS = 100
_TAIL = 1e-4  # of the gain, that the cut series of a linear filter may leave out
_DEGREE = 160  # at most


@dataclass(frozen=True)
class Linear:
    """The gain 1/(1 + t k^p) of the frequencies k of Id - W̃, along the normals."""

    time: float
    order: int

    def __str__(self) -> str:
        return f"linear 1/(1 + {self.time:.3g} k^{self.order})"


@dataclass(frozen=True)
class OfNormals:
    """Rounds of a bilateral or guided filter of the normals."""

    guided: bool
    contrast: float
    rounds: int
    projected: bool = False

    def __str__(self) -> str:
        kind = "guided" if self.guided else "bilateral"
        along = ", along normals" if self.projected else ""
        return f"{kind} normals, contrast {self.contrast:g}, {self.rounds} rounds{along}"


@dataclass(frozen=True)
class OfVariation:
    """Normals of small total variation."""

    fidelity: float

    def __str__(self) -> str:
        return f"total variation of normals, fidelity {self.fidelity:g}"


Filter: TypeAlias = Linear | OfNormals | OfVariation

LINEAR: tuple[Filter, ...] = tuple(
    Linear(float(time), order)
    for order in (2, 3)
    for time in np.geomspace(0.03, 1000, 12) ** (order / 2)
)
OF_NORMALS: tuple[Filter, ...] = (
    *(OfNormals(False, c, k) for c in (0.25, 0.4, 0.6, 0.9) for k in (3, 6, 12, 24)),
    *(OfNormals(True, c, k) for c in (0.2, 0.3, 0.45, 0.7) for k in (3, 6, 12, 24)),
    *(OfVariation(fidelity) for fidelity in (0.7, 1.0, 1.5, 2.2, 3.2, 5.0, 8.0)),
)
SECOND: tuple[Filter, ...] = tuple(
    OfNormals(guided, contrast, rounds, projected)
    for projected in (False, True)
    for guided in (False, True)
    for contrast in (0.1, 0.2, 0.35)
    for rounds in (3, 12, 30)
)


@dataclass(frozen=True, eq=False)
class Bench:
    """What all filters of one topology share: the rows of W̃ and the rings of the faces."""

    rows: LocalRows
    rings: FaceRings

    @classmethod
    def of(cls, mesh: Mesh) -> Bench:
        """Prepare it; vertices of no face are left alone."""
        A = mesh.topology.adjacency
        alone = np.diff(A.indptr) == 0
        rows = local_rows(A.indptr, A.indices, shares_of(A), alone)
        return cls(rows, face_rings(mesh.topology))


def along_normals(mesh: Mesh, moved: Floats) -> Floats:
    """Keep of each displacement what is along the normals of the moved mesh.

    So nothing slides in the surface, and little shrinks.
    """
    normals = mesh.with_vertices(moved).vertex_normals
    way = np.einsum("ij,ij->i", moved - mesh.vertices, normals)
    return np.asarray(mesh.vertices + way[:, None] * normals)


def smooth_normals(mesh: Mesh, bench: Bench) -> Floats:
    """(n, 3) normals of the mesh after a linear filter of medium strength."""
    moved = filter_rows(bench.rows, mesh.vertices, _series(_low_pass(3.0, 2)))
    return mesh.with_vertices(moved).vertex_normals


def filtered(
    mesh: Mesh, bench: Bench, filters: Sequence[Filter], start: Floats | None = None
) -> list[Floats]:
    """Return the positions (n, 3) by each of the filters.

    ``start`` are positions to filter the normals of, instead of those of the mesh; displacements
    are projected as seen from the mesh. A variation that leaves no normals moves nothing.
    """
    from_here = mesh if start is None else mesh.with_vertices(start)
    rounds = _all_rounds(from_here, bench, [f for f in filters if isinstance(f, OfNormals)])
    found = []
    for one in filters:
        if isinstance(one, Linear):
            moved = filter_rows(
                bench.rows, from_here.vertices, _series(_low_pass(one.time, one.order))
            )
            found.append(along_normals(mesh, moved))
        elif isinstance(one, OfVariation):
            found.append(_of_variation(from_here, one.fidelity))
        else:
            moved = rounds[one.guided, one.contrast, one.rounds]
            found.append(along_normals(mesh, moved) if one.projected else moved)
    return found


def _all_rounds(
    mesh: Mesh, bench: Bench, filters: list[OfNormals]
) -> dict[tuple[bool, float, int], Floats]:
    """Run each filter of normals once, to its largest number of rounds."""
    wanted: dict[tuple[bool, float], set[int]] = {}
    for one in filters:
        wanted.setdefault((one.guided, one.contrast), set()).add(one.rounds)
    held = np.zeros(mesh.n_vertices, np.bool_)
    found = {}
    for (guided, contrast), stops in wanted.items():
        normals = filtered_normals(mesh, bench.rings, contrast, guided=guided)
        for k in range(1, max(stops) + 1):
            evened = next(normals)
            if k in stops:
                found[guided, contrast, k] = fit_to_normals(
                    mesh.topology, mesh.vertices, evened, held
                )
    return found


def _of_variation(mesh: Mesh, fidelity: float) -> Floats:
    held = np.zeros(mesh.n_vertices, np.bool_)
    try:
        normals = normals_of_small_variation(mesh, fidelity, _VARIATION_ROUNDS)
    except BeltramiError:  # evened out to nothing
        return mesh.vertices
    return fit_to_normals(mesh.topology, mesh.vertices, normals, held)


def _low_pass(time: float, order: int) -> Callable[[Floats], Floats]:
    return lambda k: 1 / (1 + time * k**order)


def _series(gain: Callable[[Floats], Floats]) -> Floats:
    """Return c with gain(k) near Σ c_i T_i(1 - k) on 0 <= k <= 2, and equal at 0."""
    c = np.asarray(Chebyshev.interpolate(lambda x: gain(1 - x), _DEGREE).coef, np.float64)
    tails = np.cumsum(np.abs(c[::-1]))[::-1]
    c = c[: max(2, int(np.count_nonzero(tails > _TAIL)))]
    return np.asarray(c * (float(gain(np.zeros(1))[0]) / c.sum()))
