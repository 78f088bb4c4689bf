"""Denoising without a parameter, beside heat at its best time (sections 3.3.1 and 3.3.5)."""

from __future__ import annotations

import numpy as np

from beltrami.cli.chapters.chapter import Chapter, Stage
from beltrami.cli.chapters.noise import with_noise
from beltrami.diffusion.denoise import denoise
from beltrami.diffusion.denoised import Denoised
from beltrami.diffusion.smooth_mesh import smooth_mesh
from beltrami.io.registry import write_mesh
from beltrami.mesh.mesh import Mesh

LEVEL = 0.2  # of the noise, in mean edges
TIMES = (0.1, 0.2, 0.4, 0.8, 1.6)  # of heat, in squares of mean edges
_MOST = 50_000  # faces, up to which filters of normals are tried


def denoising(stage: Stage) -> Chapter:
    """Add noise, remove it blindly, and compare with heat at the best of some times."""
    mesh = stage.mesh
    if mesh.dimension != 3:
        text = "The noise of a mesh is measured along its normals, and a plane has none."
        return Chapter("Denoising", "3.3.1", (text,))
    edge = float(mesh.edge_lengths.mean())
    noisy = with_noise(mesh, LEVEL)
    heated = [smooth_mesh(noisy, "implicit", time=edge**2 * t, steps=1) for t in TIMES]
    best = min(heated, key=lambda one: distance(mesh, one))
    method = "auto" if mesh.n_faces <= _MOST else "linear"
    found = denoise(noisy, method)
    shown = {"with noise": noisy, "heat, best time": best, "denoise": found.mesh}
    rows = tuple(
        (name, f"{distance(mesh, one) / edge:.3f}", f"{angle(mesh, one):.1f}°")
        for name, one in shown.items()
    )
    write_mesh(stage.folder / "noisy.ply", noisy)
    write_mesh(stage.folder / "denoised.ply", found.mesh)
    captions = [
        f"{name}: {row[1]}, angle {row[2][:-1]}" for name, row in zip(shown, rows, strict=True)
    ]
    return Chapter(
        "Denoising",
        "3.3.1",
        (
            "How long heat should act depends on the noise and on the shape, and who denoises "
            "knows neither. denoise measures the noise, tries filters of many strengths, and mixes "
            "them so that Stein's estimate of the error, which needs no truth, is least.",
            *_told(found, edge),
        ),
        (("mesh", "distance (mean edges)", "angle of normals"), *rows),
        (
            stage.draw(
                "blind.png",
                f"The mesh; noise of {LEVEL} mean edges along its normals; heat at the best of "
                f"{len(TIMES)} times, chosen knowing the first; denoise, which sees only the "
                "second. Distances in mean edges, and angles of the normals in degrees, from the "
                "first.",
                [mesh, *shown.values()],
                caption=["truth", *captions],
                columns=2,
                camera="common",
            ),
        ),
        (("noisy.ply", "with noise"), ("denoised.ply", "what denoise made of it")),
        (f"beltrami denoise noisy.ply --method {method} -o denoised.ply",),
    )


def _told(found: Denoised, edge: float) -> tuple[str, ...]:
    """Say what was found and done."""
    done = [f"{100 * weight:.0f} % {name}" for name, weight in found.mixture[:3]]
    return (
        f"Here it finds noise of {found.sigma / edge:.3f} mean edges where {LEVEL} were added, and "
        f"expects an error of {found.predicted_error / edge:.3f}. Most of the mixture: "
        + ("; ".join(done) or "nothing to do")
        + ".",
        *found.warnings,
    )


def distance(mesh: Mesh, other: Mesh) -> float:
    """Root of the mean squared distance of the vertices."""
    return float(np.sqrt(((mesh.vertices - other.vertices) ** 2).sum(axis=1).mean()))


def angle(mesh: Mesh, other: Mesh) -> float:
    """Mean angle of the normals of faces, in degrees."""
    cosines = np.einsum("ij,ij->i", mesh.face_normals, other.face_normals)
    return float(np.degrees(np.arccos(np.clip(cosines, -1, 1))).mean())
