"""The interactive page: the mesh turned by hand, and functions that are computed in the browser."""

from __future__ import annotations

from beltrami.cli.chapters.chapter import Chapter, Stage
from beltrami.cli.remedies import as_commands
from beltrami.display.page import page

PAGE = "page.html"
MODES = 64
LARGE = 50_000  # vertices from which fewer modes are taken, so that the page stays light


def interactive(stage: Stage) -> Chapter:
    """Write the page beside this one, without copies with noise, which take long."""
    mesh = stage.mesh
    modes = max(8, min(MODES, MODES * LARGE // mesh.n_vertices))
    written = page(
        mesh, stage.folder / PAGE, title="mesh", modes=modes, noise=0, up=stage.up
    )  # fmt: skip
    return Chapter(
        "Turn it, and let it compute",
        "3.1 to 3.3",
        (
            f"{PAGE} is one file that needs no network: turn the mesh, choose an eigenfunction, "
            "drag the time of heat, click where a wave begins, take M terms of the shape, draw a "
            "filter by hand, see the map to the plane. The sums are computed in the browser. With "
            "--noise 0.2 the command takes longer, and adds a noisy and a denoised copy.",
            *(
                as_commands(note[0].upper() + note[1:])
                for note in written.notes
                if "noise" not in note
            ),
        ),
        files=((PAGE, f"{written.size / 1e6:.1f} MB, {modes} modes of each Laplacian"),),
        commands=(f"beltrami page {stage.name} -o {PAGE} -k {modes} --up {stage.up} --noise 0",),
    )
