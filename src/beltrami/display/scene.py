"""The description of a picture: panels (what is drawn) and a style (how)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from beltrami._arrays import DROP, Floats, require_finite
from beltrami.display.camera import Camera
from beltrami.display.light import SHADINGS, Light
from beltrami.display.srgb import Color, as_color
from beltrami.display.texture import Texture
from beltrami.errors import DimensionError, EmptyMeshError, MeshError, check_name, shown
from beltrami.mesh.mesh import Mesh

CLAY = (0.94, 0.845, 0.76)
SLATE = (0.58, 0.65, 0.74)  # the inside of a surface
INK = (0.05, 0.05, 0.07)
BACKS = ("tint", "same", "hide")
_LONGEST = 65536  # samples along a side of a picture


@dataclass(frozen=True, eq=False)
class Style:
    """How panels are drawn; the parameters of ``render`` say what each field means."""

    size: tuple[int, int] = (800, 800)
    shading: str = "gouraud"
    color: Color = CLAY
    background: Color = "white"
    back: str = "tint"
    light: Light | None = None
    ambient: float | None = None
    fill: float | None = None
    wireframe: bool = False
    line_width: float | None = None
    antialias: int = 2
    missing: Color | None = None

    def __post_init__(self) -> None:
        check_name("shading", self.shading, SHADINGS)
        check_name("back", self.back, BACKS)
        as_color(self.color)
        as_color(self.background, "the background")
        if self.missing is not None:
            as_color(self.missing, "the colour of missing values")
        _check_counts("antialias", (self.antialias,), 1, 8)
        _check_counts("the size (width, height)", self.size, 2, _LONGEST // self.antialias)
        for name in ("ambient", "fill", "line_width"):
            value = getattr(self, name)
            if value is not None and not 0 <= value < np.inf:
                raise MeshError(f"{name} is {shown(value)}, where a number >= 0 is needed")
        if self.line_width == 0:
            raise MeshError("lines of the width 0", remedy="Give level_set=None to draw none.")


@dataclass(frozen=True, eq=False)
class Panel:
    """One mesh with one function on it.

    Attributes
    ----------
    mesh : Mesh
        In the plane or in space, with a face.
    camera : Camera
        Who looks at it.
    values : (n, 1) or (n, 3) float, or None
        The function, or sRGB colours of the vertices in [0, 1].
    limits : (float, float), or None
        The values at both ends of the colour map; None without a function.
    table : (k, 3) float, or None
        The colour map.
    levels : tuple of float
        The level sets to draw.
    caption : str
    texture : Texture, or None
        A picture on the surface, instead of the function.
    """

    mesh: Mesh
    camera: Camera
    values: Floats | None = None
    limits: tuple[float, float] | None = None
    table: Floats | None = None
    levels: tuple[float, ...] = ()
    caption: str = ""
    texture: Texture | None = None


def check_mesh(mesh: Mesh) -> None:
    """Refuse what cannot be drawn.

    Raises
    ------
    DimensionError
        In more than three dimensions.
    EmptyMeshError
        Without a face.
    NonFiniteError
        If a coordinate is NaN or infinite.
    """
    if mesh.dimension > 3:
        raise DimensionError(
            f"a mesh in {mesh.dimension} dimensions cannot be drawn",
            remedy="Keep two or three coordinates: mesh.with_vertices(mesh.vertices[:, :3]).",
        )
    if not mesh.n_faces:
        raise EmptyMeshError("a mesh without faces cannot be drawn")
    require_finite(mesh.vertices, "the position", DROP)


def _check_counts(what: str, values: Any, length: int, greatest: int) -> None:
    """Refuse anything but ``length`` whole numbers of 1 to ``greatest``."""
    given = np.asarray(values)
    if given.shape != (length,) or given.dtype.kind not in "iu":
        raise MeshError(f"{what} is {shown(values)}, where {length} whole number(s) are needed")
    if given.min() < 1 or given.max() > greatest:
        raise MeshError(f"{what} is {shown(values)}, where 1 to {greatest} is possible")
