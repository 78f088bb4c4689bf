"""Filters that smooth meshes, ours and those of peers: at defaults and at many parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

from benchmarks.packages import package

DEFAULT = "default"
Smoother = tuple[str, Any, Callable[[], Any]]  # filter, parameter or DEFAULT, call to positions

ROUNDS = (1, 2, 3, 5, 10, 20, 40, 80)
BANDS = (0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5)
TIMES = (0.03, 0.1, 0.3, 1.0, 3.0)  # in squares of the mean edge
OWN: tuple[tuple[str, str, tuple[Any, ...]], ...] = (
    ("averaging", "steps", ROUNDS),
    ("taubin", "steps", ROUNDS),
    ("windowed_sinc", "pass_band", BANDS),
    ("implicit", "time", TIMES),
    ("bilaplacian", "time", (0.01, 0.1, 1.0, 10.0)),  # in fourth powers
    ("curvature_flow", "time", TIMES),
    ("bilateral_normals", "contrast", (0.25, 0.35, 0.5, 0.7)),
    ("guided_normals", "contrast", (0.2, 0.3, 0.45, 0.7)),
    ("tv_normals", "fidelity", (0.5, 1.0, 1.5, 2.2, 3.2, 5.0)),
)


def own(mesh: Any) -> Iterator[Smoother]:
    """Yield our methods; flows have no default, so theirs is the middle of their times."""
    smooth_mesh = package("beltrami").smooth_mesh
    edge = float(mesh.edge_lengths.mean())

    def call(method: str, options: dict[str, Any]) -> Any:
        # afresh, so that nothing is found that an earlier call has derived
        bt = package("beltrami")
        return smooth_mesh(bt.Mesh(mesh.vertices, mesh.faces), method, **options).vertices

    for method, option, values in OWN:
        unit = (edge**4 if method == "bilaplacian" else edge**2) if option == "time" else 1
        plain = {"time": values[len(values) // 2] * unit} if option == "time" else {}
        if method == "implicit" or method == "curvature_flow":
            plain["steps"] = 1
        yield f"beltrami {method}", DEFAULT, partial(call, method, plain)
        for value in values:
            yield (
                f"beltrami {method}",
                value,
                partial(call, method, {**plain, option: value * unit}),
            )


def peers(mesh: Any) -> Iterator[Smoother]:
    """Yield the filters of each peer that is installed."""
    V, F = np.array(mesh.vertices), np.array(mesh.faces)
    for distribution, of in (("trimesh", _trimesh), ("pyvista", _pyvista),
                             ("pymeshlab", _pymeshlab), ("igl", _igl)):  # fmt: skip
        try:
            library = package(distribution)
        except ImportError:
            print(f"{distribution} is not installed")
            continue
        yield from of(library, V, F)


def _trimesh(trimesh: Any, V: Any, F: Any) -> Iterator[Smoother]:
    smoothing = package("trimesh.smoothing")

    def call(name: str, options: dict[str, Any]) -> Any:
        one = trimesh.Trimesh(V.copy(), F.copy(), process=False)
        return getattr(smoothing, name)(one, **options).vertices

    for name, options in (
        ("laplacian", {"volume_constraint": False}),
        ("laplacian", {"volume_constraint": True}),
        ("humphrey", {}),
        ("taubin", {}),
    ):
        label = f"trimesh {name}" + " with volume" * options.get("volume_constraint", False)
        yield label, DEFAULT, partial(call, f"filter_{name}", options)
        for rounds in ROUNDS:
            yield label, rounds, partial(call, f"filter_{name}", {**options, "iterations": rounds})


def _pyvista(pyvista: Any, V: Any, F: Any) -> Iterator[Smoother]:
    data = pyvista.PolyData(V, np.c_[np.full(len(F), 3), F].ravel())
    yield "pyvista smooth", DEFAULT, lambda: data.smooth().points
    for rounds in (5, 20, 80, 320):
        yield "pyvista smooth", rounds, lambda k=rounds: data.smooth(n_iter=k).points
    yield "pyvista smooth_taubin", DEFAULT, lambda: data.smooth_taubin().points
    for band in BANDS:
        options = {"n_iter": 20, "pass_band": band, "normalize_coordinates": True}
        yield "pyvista smooth_taubin", band, lambda o=options: data.smooth_taubin(**o).points


def _pymeshlab(pymeshlab: Any, V: Any, F: Any) -> Iterator[Smoother]:
    def call(name: str, options: dict[str, Any]) -> Any:
        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(V, F.astype(np.int32)))
        getattr(meshes, f"apply_coord_{name}_smoothing")(**options)
        return meshes.current_mesh().vertex_matrix()

    fine = {"stepsmoothnum": 1, "normalthr": 30.0, "stepfitnum": 20}
    for label, name, key, options, values in (
        ("laplacian", "laplacian", "stepsmoothnum", {}, (1, 2, 3, 5, 8, 14)),
        ("laplacian, equal weights", "laplacian", "stepsmoothnum", {"cotangentweight": False},
         (1, 2, 3, 5, 8, 14)),
        ("taubin", "taubin", "stepsmoothnum", {}, (5, 10, 20, 40, 80)),
        ("two steps", "two_steps", "stepsmoothnum", {}, (1, 3, 6)),
        ("two steps", "two_steps", "stepnormalnum", fine, (3, 8, 20)),
    ):  # fmt: skip
        if options is not fine:
            yield f"pymeshlab {label}", DEFAULT, partial(call, name, dict(options))
        for value in values:
            yield f"pymeshlab {label}", value, partial(call, name, {**options, key: value})


def _igl(igl: Any, V: Any, F: Any) -> Iterator[Smoother]:
    """Implicit fairing as its tutorial has it: cotangents, SciPy's solver; it has no default."""
    splu = package("scipy.sparse.linalg").splu
    edge = np.linalg.norm(V[F] - V[np.roll(F, 1, axis=1)], axis=2).mean()

    def call(time: float) -> Any:
        L, M = igl.cotmatrix(V, F), igl.massmatrix(V, F, igl.MASSMATRIX_TYPE_BARYCENTRIC)
        return splu((M - time * edge**2 * L).tocsc()).solve(M @ V)

    yield "igl implicit", DEFAULT, partial(call, TIMES[len(TIMES) // 2])
    for time in TIMES:
        yield "igl implicit", time, partial(call, time)
