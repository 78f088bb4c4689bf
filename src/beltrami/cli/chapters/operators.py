"""Operators: three weights, their masses, and mean curvature (sections 3.2.2 to 3.2.5)."""

from __future__ import annotations

import numpy as np

from beltrami.cli.chapters.chapter import Chapter, Figure, Stage, number
from beltrami.operators.curvature import curvature
from beltrami.operators.laplacian import laplacian
from beltrami.operators.pair import Laplacian

SHOWN = ("combinatorial", "distance", "cotangent", "clamped", "tufted")
NAMES = ("mean curvature", "Gaussian curvature")
HEAD = ("weights", "smallest weight", "negative edges", "degrees", "λ bound, B = D", "Σ⟨Lx, x⟩ / 2")


def operators(stage: Stage) -> Chapter:
    """Compare the weights on the mesh, and draw its mean curvature."""
    mesh = stage.mesh
    pairs = {kind: laplacian(mesh, kind) for kind in SHOWN}
    rows = tuple(_row(kind, pair, mesh.vertices) for kind, pair in pairs.items())
    cotangent = pairs["cotangent"]
    text, figures, commands = _curvatures(stage)
    return Chapter(
        "Operators",
        "3.2.2 to 3.2.5",
        (
            "A Laplacian is a pair: a stiffness L = D - W made of weights of the edges, and a "
            "mass B made of areas or degrees.",
            "Only cotangent weights measure the surface: half the Dirichlet energy of the three "
            f"coordinates is its area, {number(mesh.area)}.",
            "With area masses an explicit heat step may be at most "
            f"{number(2 / cotangent.spectral_bound())} (length²), by the bound over the faces.",
            "What each choice promises is told by the object: laplacian(mesh).properties.",
            *text,
        ),
        (HEAD, *rows),
        figures,
        commands=(*commands, f"beltrami integrate {stage.name}"),
    )


def _row(kind: str, pair: Laplacian, x: np.ndarray) -> tuple[str, ...]:
    return (
        kind,
        number(float(pair.edge_weight.min())),
        str(int((pair.edge_weight < 0).sum())),
        f"{number(float(pair.degrees.min()))} to {number(float(pair.degrees.max()))}",
        number(pair.spectral_bound("degree")),
        number(pair.dirichlet_energy(x) / 2),
    )


def _curvatures(stage: Stage) -> tuple[tuple[str, ...], tuple[Figure, ...], tuple[str, ...]]:
    """Tell the theorem of Gauss and Bonnet, and draw both curvatures: text, figures, commands."""
    mesh = stage.mesh
    if mesh.dimension != 3 or not (mesh.is_manifold and mesh.is_oriented):
        return (), (), ()
    found = curvature(mesh)
    total = float(found.angle_defect.sum() + found.turning.sum()) / (2 * np.pi)
    text = (
        "The angles around a vertex miss 2π by the Gaussian curvature of its cell. All defects, "
        f"with the turning of the boundary, add to 2π times {total:.9f}: the Euler "
        f"characteristic is {mesh.euler_characteristic} (Gauss-Bonnet).",
    )
    least = 1e-6 / mesh.area**0.5, 1e-6 / mesh.area  # of a flat mesh only rounding is left
    shown = zip((found.mean, found.gaussian), least, strict=True)
    limits = [max(float(np.quantile(np.abs(values), 0.95)), low) for values, low in shown]
    figure = stage.draw(
        "curvature.png",
        "Mean curvature, half of B⁻¹ L x along the normal: red bulges, blue is hollow. Gaussian "
        "curvature: red as on a ball, blue as on a saddle.",
        mesh,
        [found.mean / limits[0], found.gaussian / limits[1]],
        caption=[f"{name}, in units of {number(x)}" for name, x in zip(NAMES, limits, strict=True)],
        limits=(-1, 1),
        colormap="diverging",
        level_set=None,
    )
    return text, (figure,), (f"beltrami curvature {stage.name} -o curvature.ply",)
