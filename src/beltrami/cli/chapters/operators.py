"""Operators: three weights, their masses, and mean curvature (sections 3.2.2 to 3.2.5)."""

from __future__ import annotations

import numpy as np

from beltrami.cli.chapters.chapter import Chapter, Figure, Stage, number
from beltrami.operators.laplacian import laplacian
from beltrami.operators.pair import Laplacian
from beltrami.operators.weights import WEIGHTS

HEAD = ("weights", "smallest weight", "negative edges", "degrees", "λ bound, B = D", "Σ⟨Lx, x⟩ / 2")


def operators(stage: Stage) -> Chapter:
    """Compare the weights on the mesh, and draw its mean curvature."""
    mesh = stage.mesh
    pairs = {kind: laplacian(mesh, kind) for kind in WEIGHTS}
    rows = tuple(_row(kind, pair, mesh.vertices) for kind, pair in pairs.items())
    cotangent = pairs["cotangent"]
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
        ),
        (HEAD, *rows),
        _curvature(stage, cotangent),
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


def _curvature(stage: Stage, pair: Laplacian) -> tuple[Figure, ...]:
    """B⁻¹ L x = 2 H n: its half along the normal is the mean curvature."""
    mesh = stage.mesh
    if mesh.dimension != 3:
        return ()
    mean = np.einsum("nc,nc->n", pair.apply(mesh.vertices), mesh.vertex_normals) / 2
    mean[mesh.topology.boundary_edges.ravel()] = 0  # on a boundary it is no curvature
    limit = float(np.quantile(np.abs(mean), 0.95))
    caption = "Mean curvature: half of B⁻¹ L x along the normal; red bulges, blue is hollow."
    options = {"limits": (-limit, limit), "colormap": "diverging", "level_set": None}
    return (stage.draw("curvature.png", caption, mesh, mean, **options),)
