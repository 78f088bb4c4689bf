"""What denoise mixes: linear filters, and filters of normals, of many strengths."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from beltrami._arrays import Floats
from beltrami.diffusion.face_rings import FaceRings, face_rings
from beltrami.diffusion.linear_filters import (
    Linear,
    equal_rows,
    low_passed,
    low_passes,
    rows_along_borders,
    rows_by_length,
    rows_by_normals,
)
from beltrami.diffusion.normal_filters import filtered_normals
from beltrami.diffusion.normal_variation import evened_normals
from beltrami.diffusion.vertex_update import fit_to_normals
from beltrami.mesh.mesh import Mesh
from beltrami.solvers.locality import LocalRows

_VARIATION_ROUNDS = 100
EVENING = Linear(0.5)  # leaves normals that tell the directions of the noise
EVENING_IF_STRONG = Linear(0.2)
_EQUAL, _BY_LENGTH = Linear(1.0), Linear(1.0, by_length=True)


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
    """What the filters of a mesh and of slightly changed copies share.

    Attributes
    ----------
    rows
        Of W̃ with equal weights.
    rings
        Of the faces.
    evened
        The mesh after a low pass: by its lengths and normals the other rows are weighed.
    evening
        That low pass.
    """

    rows: LocalRows
    rings: FaceRings
    evened: Mesh
    evening: Linear

    @classmethod
    def of(cls, mesh: Mesh, evening: Linear = EVENING) -> Bench:
        """Prepare it; vertices of no face are left alone."""
        rows = equal_rows(mesh)
        evened = mesh.with_vertices(low_passed(rows, mesh.vertices, evening))
        return cls(rows, face_rings(mesh.topology), evened, evening)

    @property
    def normals(self) -> Floats:
        """(n, 3), of the vertices of the evened mesh: directions of the noise."""
        return self.evened.vertex_normals

    def moved(self, mesh: Mesh, evening: Linear | None = None) -> Bench:
        """Return that of the same mesh at other positions, or after another low pass."""
        evening = evening or self.evening
        evened = mesh.with_vertices(low_passed(self.rows, mesh.vertices, evening))
        return replace(self, evened=evened, evening=evening)


def along_normals(mesh: Mesh, moved: Floats) -> Floats:
    """Keep of each displacement what is along the normals of the moved mesh.

    So nothing slides in the surface, and little shrinks.
    """
    normals = mesh.with_vertices(moved).vertex_normals
    way = np.einsum("ij,ij->i", moved - mesh.vertices, normals)
    return np.asarray(mesh.vertices + way[:, None] * normals)


def filtered(
    mesh: Mesh, bench: Bench, filters: Sequence[Filter], start: Floats | None = None
) -> list[Floats]:
    """Return the positions (n, 3) by each of the filters.

    ``start`` are positions to filter the normals of, instead of those of the mesh; displacements
    are projected as seen from the mesh. Low passes look at the evened mesh of the bench.
    """
    from_here = mesh if start is None else mesh.with_vertices(start)
    rounds = _all_rounds(from_here, bench, [f for f in filters if isinstance(f, OfNormals)])
    smooth = _all_low_passes(from_here, bench, [f for f in filters if isinstance(f, Linear)])
    found = []
    for one in filters:
        if isinstance(one, Linear):
            found.append(along_normals(mesh, smooth[one]))
        elif isinstance(one, OfVariation):
            found.append(_of_variation(from_here, one.fidelity))
        else:
            moved = rounds[one.guided, one.contrast, one.rounds]
            found.append(along_normals(mesh, moved) if one.projected else moved)
    return found


def _all_low_passes(mesh: Mesh, bench: Bench, filters: list[Linear]) -> dict[Linear, Floats]:
    """Run those of one kind together."""
    found: dict[Linear, Floats] = {}
    evened = bench.evened
    for kind in dict.fromkeys(one.kind for one in filters):
        if kind == _EQUAL:
            weighted = bench.rows
        elif kind == _BY_LENGTH:
            weighted = rows_by_length(evened)
        elif kind.in_parts:
            weighted = rows_by_normals(evened, kind.contrast)
        else:
            weighted = rows_along_borders(evened, kind.along, by_length=kind.by_length)
        some = [one for one in filters if one.kind == kind]
        found.update(zip(some, low_passes(weighted, mesh.vertices, some), strict=True))
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
    """Faces whose normals even out to nothing keep theirs: the probe changes which these are."""
    held = np.zeros(mesh.n_vertices, np.bool_)
    normals, _ = evened_normals(mesh, fidelity, _VARIATION_ROUNDS)
    return fit_to_normals(mesh.topology, mesh.vertices, normals, held)
