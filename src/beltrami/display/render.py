"""render: pictures of meshes and functions, in one call."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from os import PathLike
from typing import Any

from numpy.typing import ArrayLike

from beltrami._kinds import checked
from beltrami.display.camera import Camera
from beltrami.display.compose import compose
from beltrami.display.cropping import rows_seen
from beltrami.display.draw import draw_panel
from beltrami.display.images import check_suffix, write_image
from beltrami.display.light import Light
from beltrami.display.panels import Levels, make_panels, paired, place_cameras
from beltrami.display.scene import CLAY, Style
from beltrami.display.srgb import Color, Image
from beltrami.errors import MeshError
from beltrami.io.picture import Picture
from beltrami.mesh.mesh import Mesh


@checked
def render(
    mesh: Mesh | Sequence[Mesh],
    f: ArrayLike | Sequence[ArrayLike | None] | None = None,
    path: str | PathLike[str] | None = None,
    *,
    size: tuple[int, int | None] = (800, 800),
    view: ArrayLike | None = None,
    up: str = "y",
    zoom: float = 1.0,
    focus: ArrayLike | None = None,
    camera: Camera | str | None = None,
    texture: Picture | Sequence[Picture | None] | None = None,
    caption: str | Sequence[str] | None = None,
    columns: int | None = None,
    colormap: str | ArrayLike | None = None,
    limits: tuple[float, float] | str | None = None,
    level_set: Levels = "auto",
    colorbar: bool = True,
    font: str | PathLike[str] | None = None,
    shading: str = "gouraud",
    color: Color = CLAY,
    missing: Color | None = None,
    background: Color = "white",
    back: str = "tint",
    light: Light | None = None,
    ambient: float | None = None,
    fill: float | None = None,
    wireframe: bool = False,
    line_width: float | None = None,
    antialias: int = 2,
) -> Image:
    """Draw meshes and functions on them: perspective, z-buffer, Gouraud shading (l. 70, 107).

    No display, window or graphics card is needed, and the same input gives the same bytes.

    Chapter items: F3.1, P8, P13.

    Parameters
    ----------
    mesh
        One mesh, or several to be drawn side by side; in the plane or in space.
    f
        A function on the vertices: (n,), or (n, 3) sRGB colours in [0, 1] or as uint8. Or a list
        of such arrays (or None), one for each mesh, or all on the one mesh.
    path
        File to write as well: ``.png``, ``.webp`` or ``.gif``.
    size
        (width, height) of each panel, in pixels; captions and colour bars come on top of that.
        With None for the height panels are as high as what is seen on them, at most square.
    view, up, zoom, focus
        Where the eye is: see ``framing.fit_camera``. The default is three quarters from
        the front, with y upwards; brains, scans and prints often want ``up="z"``.
    camera
        A ``Camera`` for all panels, which then rules out the four above; or ``"common"``: one
        camera fitted to all meshes, so that their sizes and places compare. By default each
        mesh fills its panel.
    texture
        A picture on meshes with ``corner_uv``: ``"checkerboard"``, a file, or an array (h, w, 3)
        or (h, w); see ``make_texture``. Or a list of these (or None), one for each mesh.
    caption, columns
        Text above each panel; panels in a row (all by default).
    colormap
        A name or a table (``color_table``). By default ``"diverging"`` for a function of both
        signs and ``"sequential"`` for others.
    limits
        (low, high): the values at the ends of the map, beyond which colours do not change; or
        ``"common"`` for the same limits in all panels. By default those of each function,
        symmetric around 0 for the diverging map.
    level_set
        Values whose level sets are drawn as lines. ``"auto"``: 0 if f has both signs.
    colorbar, font
        Whether to draw a bar with the limits; a TrueType file for text, as the bundled font has
        ASCII letters only (others are spelled out).
    shading
        ``"gouraud"``: light interpolated between the vertices; ``"flat"``: constant on a face.
    color, background
        A name, ``"#rrggbb"``, or sRGB in [0, 1].
    missing
        The colour of faces with a vertex where f is NaN, as maps have it where nothing was
        measured. By default NaN is an error.
    back
        The inside of the surface, where faces turn their backs: ``"tint"`` in slate, so that
        holes and flipped faces are told from the outside, ``"same"``, or ``"hide"``.
    light, ambient, fill
        Main light (from above the left shoulder by default), light from everywhere, and a weak
        light from the side. ``ambient=0, fill=0`` is the intensity max(<n, l>, 0) of the chapter.
        A planar mesh has the light 1 everywhere unless ``light`` is given.
    wireframe, line_width
        Draw the sides of the faces; width of level lines in pixels (sides: 0.6 of it).
    antialias
        Each pixel is the mean of antialias x antialias samples; 1 for hard edges.

    Returns
    -------
    (h, w, 3) uint8
        sRGB.

    Raises
    ------
    EmptyMeshError, DimensionError, NonFiniteError
        If a mesh has no face, more than three dimensions, or NaN; or a function does not fit.
    MeshError, UnknownNameError
        If an option has no such value.

    Notes
    -----
    Cost: O(m + w h antialias²) for m faces.

    Examples
    --------
    >>> tent = Mesh([[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1], [0.5, 1, 0.5]],
    ...             [[0, 4, 1], [1, 4, 2], [2, 4, 3], [3, 4, 0]])
    >>> render(tent, size=(90, 60)).shape
    (60, 90, 3)
    >>> heights = tent.vertices[:, 1]
    >>> render([tent, tent], [None, heights - 0.5], size=(90, 60), caption=["shape", "f"]).shape
    (109, 180, 3)
    """
    if path is not None:
        check_suffix(path)  # before the work, not after
    cropped = _lacks_height(size)
    style = Style(
        (size[0], size[0]) if cropped else size,  # type: ignore[arg-type]  # Style looks at it
        shading,
        color,
        background,
        back,
        light,
        ambient,
        fill,
        wireframe,
        line_width,
        antialias,
        missing,
    )
    meshes, functions, captions = paired(mesh, f, caption)
    cameras = place_cameras(meshes, camera, view=view, up=up, zoom=zoom, focus=focus)
    panels = make_panels(
        meshes,
        functions,
        captions,
        cameras,
        colormap,
        limits,
        level_set,
        texture,
        missing is not None,
    )
    if columns is not None and columns < 1:
        raise MeshError(f"{columns} columns, where at least 1 is needed")
    pictures = [draw_panel(panel, style) for panel in panels]
    if cropped:
        rows = rows_seen(panels, size[0])
        pictures = [picture[rows] for picture in pictures]
        style = replace(style, size=(size[0], rows.stop - rows.start))
    image = compose(
        pictures, panels, style, columns=columns or len(panels), colorbar=colorbar, font=font
    )
    if path is not None:
        write_image(path, image)
    return image


def _lacks_height(size: Any) -> bool:
    return isinstance(size, tuple | list) and len(size) == 2 and size[1] is None
