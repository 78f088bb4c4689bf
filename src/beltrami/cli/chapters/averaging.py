"""Averaging: W̃ᵏ on the coordinates (section 3.2.2, figure 3.3)."""

from __future__ import annotations

from beltrami.cli.chapters.chapter import Chapter, Stage, number
from beltrami.diffusion.smooth_mesh import smooth_mesh
from beltrami.io.registry import write_mesh
from beltrami.operators.laplacian import laplacian

ROUNDS = (0, 5, 20, 100)


def averaging(stage: Stage) -> Chapter:
    """Average the positions with their neighbours, and watch the energy and the volume."""
    mesh = stage.mesh
    smoothed = [smooth_mesh(mesh, steps=rounds) for rounds in ROUNDS]
    pair = laplacian(mesh, "combinatorial")
    closed = mesh.is_closed and mesh.is_oriented and mesh.topology.is_edge_manifold
    energy = [pair.dirichlet_energy(one.vertices) for one in smoothed]
    rows = tuple(
        (
            str(rounds),
            number(value / energy[0]),
            number(one.volume / mesh.volume) if closed else "open",
            number(one.area / mesh.area),
        )
        for rounds, value, one in zip(ROUNDS, energy, smoothed, strict=True)
    )
    write_mesh(stage.folder / "smoothed.ply", smoothed[1])
    return Chapter(
        "Iterated averaging",
        "3.2.2",
        (
            "Each round replaces a vertex by the mean of its neighbours: x becomes D⁻¹W x. The "
            "energy ⟨Lx, x⟩ falls with each round, sharp features go first, and the shape shrinks.",
        ),
        (("rounds", "energy / first", "volume / first", "area / first"), *rows),
        (
            stage.draw(
                "averaging.png",
                "After 0, 5, 20 and 100 rounds, drawn to one scale.",
                smoothed,
                caption=[f"{rounds} rounds" for rounds in ROUNDS],
                columns=2,
                camera="common",
            ),
        ),
        (("smoothed.ply", f"the mesh after {ROUNDS[1]} rounds"),),
        (f"beltrami smooth {stage.name} --steps {ROUNDS[1]} -o smoothed.ply",),
    )
