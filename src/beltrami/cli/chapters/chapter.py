"""What a chapter of the tour is made of, and the stage it plays on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from numpy.typing import ArrayLike

from beltrami.display.render import render
from beltrami.mesh.mesh import Mesh


@dataclass(frozen=True)
class Figure:
    """A picture of a chapter: its file and what is seen on it."""

    name: str
    caption: str


@dataclass(frozen=True)
class Chapter:
    """One chapter of the tour.

    Attributes
    ----------
    title, section
        What it shows, and the section of the text that it belongs to.
    text
        Paragraphs.
    rows
        A table: the first row is its head.
    figures
        Pictures in the folder of the tour.
    files
        Results in the folder: (name, what it is).
    commands
        How to get the same from the command line.
    seconds
        How long it took, if it was measured.
    warnings
        What was warned of on the way.
    """

    title: str
    section: str
    text: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...] = ()
    figures: tuple[Figure, ...] = ()
    files: tuple[tuple[str, str], ...] = ()
    commands: tuple[str, ...] = ()
    seconds: float | None = None
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Stage:
    """The mesh of the tour, its folder, and how its pictures are taken.

    Attributes
    ----------
    name
        What the mesh is called on the command line, in the folder of the tour.
    mesh, folder
        The mesh, and where results go.
    up, view
        The camera of all pictures.
    """

    name: str
    mesh: Mesh
    folder: Path
    up: str
    view: tuple[float, float] | None

    def draw(
        self,
        file: str,
        legend: str,
        meshes: Mesh | Sequence[Mesh],
        f: ArrayLike | Sequence[ArrayLike | None] | None = None,
        **options: Any,
    ) -> Figure:
        """Render a picture into the folder."""
        settings: dict[str, Any] = {"up": self.up, "view": self.view, "size": (560, None)}
        render(meshes, f, self.folder / file, **(settings | options))
        return Figure(file, legend)


def number(value: float) -> str:
    """Write a number for a table: four digits."""
    return f"{value:.4g}"
