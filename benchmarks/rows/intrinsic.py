"""The Laplacian of the intrinsic Delaunay triangles, from two raw arrays."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from benchmarks.cases import Case
from benchmarks.claims import Contender, Goal, Row
from benchmarks.packages import package
from benchmarks.rows.assembly import difference, peer

COVER = "beltrami, cover"


def contenders(case: Case) -> Sequence[Contender]:
    V, F = case.vertices, case.faces

    def ours(weights: str) -> tuple[Any, Any]:
        bt = package("beltrami")
        laplacian = bt.laplacian(bt.Mesh(V, F), weights=weights, mass="barycentric")
        return laplacian.stiffness, laplacian.mass

    def robust(**options: float) -> tuple[Any, Any]:
        return package("robust_laplacian").mesh_laplacian(V, F, **options)

    def igl(_: None) -> tuple[Any, Any]:
        stiffness, lengths, faces = package("igl").intrinsic_delaunay_cotmatrix(V, F)
        igl = package("igl")
        return stiffness, igl.massmatrix_intrinsic(lengths, faces, igl.MASSMATRIX_TYPE_BARYCENTRIC)

    return [
        peer("beltrami", lambda _: ours("intrinsic_delaunay"), ours=True),
        peer(COVER, lambda _: ours("tufted"), ours=True),
        peer("robust_laplacian (cover), lengths kept", lambda _: robust(mollify_factor=0)),
        peer("robust_laplacian (cover)", lambda _: robust(), tolerance=None),
        peer("libigl", igl),
    ]


INTRINSIC = Row(
    name="intrinsic",
    work="intrinsic Delaunay stiffness and barycentric mass, from the raw arrays",
    contenders=contenders,
    goals=(Goal(1), Goal(1, of=COVER)),
    difference=difference,
)
