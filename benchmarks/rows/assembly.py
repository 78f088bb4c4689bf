"""Cotangent stiffness and lumped barycentric mass, from two raw arrays."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from benchmarks.cases import Case
from benchmarks.claims import Contender, Goal, Row
from benchmarks.packages import package

Pair = tuple[csr_array, NDArray[np.float64]]


def positive(result: tuple[Any, Any]) -> Pair:
    """Bring (stiffness, mass) to a positive semi-definite CSR matrix and a vector of areas."""
    stiffness, mass = result
    areas = mass.diagonal() if hasattr(mass, "diagonal") and mass.ndim == 2 else np.asarray(mass)
    sign = 1.0 if stiffness.diagonal().sum() > 0 else -1.0
    return csr_array(stiffness) * sign, areas


def difference(a: Pair, b: Pair) -> float:
    """Largest difference of an entry, over the largest entry; of the two matrices the worse."""
    return max(
        float(abs(a[0] - b[0]).max() / abs(a[0]).max()),
        float(abs(a[1] - b[1]).max() / abs(a[1]).max()),
    )


def ours(case: Case) -> list[Contender]:
    bt = package("beltrami")
    V, F = case.vertices, case.faces

    def assembled(mesh: Any) -> tuple[Any, Any]:
        laplacian = bt.laplacian(mesh, weights="cotangent", mass="barycentric")
        return laplacian.stiffness, laplacian.mass

    @cache
    def known() -> Any:
        mesh = bt.Mesh(V, F)
        assembled(mesh)  # computes what the topology keeps
        return mesh

    return [
        Contender("beltrami", lambda _: assembled(bt.Mesh(V, F)), canonical=positive, ours=True),
        Contender(
            "beltrami, topology known",
            lambda mesh: assembled(mesh.with_vertices(V)),
            known,
            positive,
            ours=True,
        ),
    ]


def peer(name: str, run: Callable[[Any], tuple[Any, Any]], **keywords: Any) -> Contender:
    return Contender(name, run, canonical=positive, **keywords)


def contenders(case: Case) -> Sequence[Contender]:
    V, F = case.vertices, case.faces

    def igl(faces: NDArray[Any]) -> tuple[Any, Any]:
        igl = package("igl")
        return igl.cotmatrix(V, faces), igl.massmatrix(V, faces, igl.MASSMATRIX_TYPE_BARYCENTRIC)

    @cache
    def lapy_mesh() -> Any:
        return package("lapy").TriaMesh(V, F)

    def lapy(mesh: Any) -> tuple[Any, Any]:
        return package("lapy").Solver._fem_tria(mesh, lump=True)

    def potpourri3d(_: None) -> tuple[Any, Any]:
        pp3d = package("potpourri3d")
        return pp3d.cotan_laplacian(V, F), pp3d.vertex_areas(V, F)

    def gpytoolbox(_: None) -> tuple[Any, Any]:
        gpy = package("gpytoolbox")
        return gpy.cotangent_laplacian(V, F), gpy.massmatrix(V, F, type="barycentric")

    def robust(_: None) -> tuple[Any, Any]:
        return package("robust_laplacian").mesh_laplacian(V, F)

    small = F.astype(np.int32)
    return [
        *ours(case),
        peer("LaPy, its mesh given", lapy, prepare=lapy_mesh),
        peer("LaPy", lambda _: lapy(package("lapy").TriaMesh(V, F))),
        peer("libigl", lambda _: igl(F)),
        peer("libigl, 32-bit faces", lambda _: igl(small)),
        peer("potpourri3d", potpourri3d),
        peer("gpytoolbox", gpytoolbox),
        peer("robust_laplacian (intrinsic)", robust, tolerance=None),
    ]


ASSEMBLY = Row(
    name="assembly",
    work="cotangent stiffness and barycentric mass, from the raw arrays",
    contenders=contenders,
    goals=(Goal(0.2), Goal(0.2, of="beltrami, topology known")),
    alone=True,
    difference=difference,
)
