"""Fifty rounds of uniform averaging: X <- X/2 + D^-1 W X / 2, the operator given."""

from __future__ import annotations

import time
from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from benchmarks.cases import Case
from benchmarks.claims import Contender, Goal, Row
from benchmarks.packages import package

ROUNDS = 50
STEP = 0.5
FLOOR = "bandwidth floor"


def difference(a: NDArray[Any], b: NDArray[Any]) -> float:
    """Largest distance of a coordinate, over the size of the mesh."""
    return float(abs(a - b).max() / np.ptp(a, axis=0).max())


def averaging(faces: NDArray[np.int64], n: int) -> csr_array:
    """D^-1 W of a closed mesh, by scipy alone."""
    i, j = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    W = csr_array((np.ones(2 * len(i)), (np.r_[i, j], np.r_[j, i])), shape=(n, n))
    W.data[:] = 1  # each edge came from its two faces
    degrees = np.diff(W.indptr)
    W.data /= np.repeat(degrees, degrees)
    W.indices = W.indices.astype(np.int32)
    W.indptr = W.indptr.astype(np.int32)
    return W


def floor_seconds(case: Case) -> float:
    """Time to move what each round must: 4-byte indices, positions once in and once out.

    The speed is that of copying 128 MB, measured here and now.
    """
    n = len(case.vertices)
    entries = 3 * len(case.faces)  # of a closed mesh: two for each edge
    moved = ROUNDS * (4 * entries + 4 * n + 2 * case.vertices.nbytes)
    source = np.ones(2**24)
    target = np.empty_like(source)
    np.copyto(target, source)
    start = time.process_time()
    for _ in range(3):
        np.copyto(target, source)
    seconds = (time.process_time() - start) / 3
    return moved * seconds / (source.nbytes + target.nbytes)


def ours(case: Case) -> Contender:
    bt = package("beltrami")

    def operator() -> Any:
        """Make it afresh each time, so that no run finds the reordering of an earlier one."""
        laplacian = bt.laplacian(bt.Mesh(case.vertices, case.faces), weights="combinatorial")
        if laplacian.weights.nnz == 0:  # the peers too have their matrix when the time starts
            raise RuntimeError("the Laplacian has no weights")
        return laplacian

    return Contender(
        "beltrami",
        lambda laplacian: bt.smooth(laplacian, case.vertices, ROUNDS, step=STEP),
        operator,
        ours=True,
    )


def with_trimesh(case: Case) -> Contender:
    @cache
    def start() -> tuple[Any, Any]:
        trimesh = package("trimesh")
        mesh = trimesh.Trimesh(case.vertices, case.faces, process=False)
        return mesh, trimesh.smoothing.laplacian_calculation(mesh, equal_weight=True)

    def fresh() -> tuple[Any, Any]:
        mesh, operator = start()
        return mesh.copy(), operator

    def run(given: tuple[Any, Any]) -> Any:
        return package("trimesh").smoothing.filter_laplacian(
            given[0],
            lamb=STEP,
            iterations=ROUNDS,
            volume_constraint=False,
            laplacian_operator=given[1],
        )

    return Contender("trimesh, operator given", run, fresh, lambda mesh: np.array(mesh.vertices))


def with_pyvista(case: Case) -> Contender:
    @cache
    def start() -> Any:
        return package("pyvista").PolyData.from_regular_faces(case.vertices, case.faces)

    def run(mesh: Any) -> Any:
        return mesh.smooth(n_iter=ROUNDS, relaxation_factor=STEP)

    return Contender(
        "PyVista (in place)", run, start, lambda mesh: np.array(mesh.points), tolerance=None
    )


def with_pymeshlab(case: Case) -> Contender:
    def start() -> Any:
        pymeshlab = package("pymeshlab")
        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(case.vertices, case.faces))
        return meshes

    def run(meshes: Any) -> Any:
        meshes.apply_coord_laplacian_smoothing(
            stepsmoothnum=ROUNDS, boundary=True, cotangentweight=False
        )
        return meshes

    return Contender(
        "PyMeshLab (own step)",
        run,
        start,
        lambda meshes: meshes.current_mesh().vertex_matrix(),
        tolerance=None,
    )


def contenders(case: Case) -> Sequence[Contender]:
    V = case.vertices
    matrix = cache(lambda: averaging(case.faces, len(V)))

    def with_scipy(W: csr_array) -> NDArray[np.float64]:
        X = V
        for _ in range(ROUNDS):
            X = (1 - STEP) * X + STEP * (W @ X)
        return X

    return [
        ours(case),
        with_trimesh(case),
        Contender("scipy alone, matrix given", with_scipy, matrix, counts=False),
        with_pyvista(case),
        with_pymeshlab(case),
        Contender(FLOOR, lambda _: floor_seconds(case), counts=False, times_itself=True),
    ]


SMOOTHING = Row(
    name="smoothing",
    work=f"{ROUNDS} rounds of uniform averaging, the reordering included",
    contenders=contenders,
    goals=(Goal(0.5), Goal(3, against=FLOOR)),
    difference=difference,
)
