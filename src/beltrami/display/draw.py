"""Draw one panel: project, find what is seen, light it, colour it."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats
from beltrami.display.camera import Camera
from beltrami.display.level_lines import level_lines, stroke
from beltrami.display.light import from_the_side, incident, over_the_shoulder
from beltrami.display.raster import visible_triangles
from beltrami.display.scene import CLAY, INK, SLATE, Panel, Style
from beltrami.display.shade import Paint, shade
from beltrami.display.srgb import Image, as_color
from beltrami.display.triangles import project_faces
from beltrami.mesh.geometry import in_space
from beltrami.mesh.mesh import Mesh

# How much light comes from everywhere, and from the second lamp: more where colours have to be
# read, less where only the shape is to be seen.
_AMBIENT, _AMBIENT_OF_FUNCTIONS = 0.34, 0.65
_FILL, _FILL_OF_FUNCTIONS = 0.20, 0.20
_FAR = 1e100  # as good as infinite beside limits of 0 and 1


def draw_panel(panel: Panel, style: Style) -> Image:
    """(h, w, 3) uint8: the picture of one mesh; O(m + samples)."""
    samples = style.antialias
    size = (style.size[0] * samples, style.size[1] * samples)
    positions, faces = in_space(panel.mesh.vertices, panel.mesh.faces)
    triangles = project_faces(positions, faces, panel.camera, size)
    visible = visible_triangles(triangles, size, style.back == "hide")
    width = samples * (style.line_width or max(min(style.size) / 400, 1.0))
    strokes = np.zeros((0, 0), np.float32)
    if panel.levels and panel.values is not None:
        f = triangles.carry(panel.values[faces])[..., 0]
        lines = (level_lines(triangles, f, level) for level in panel.levels)
        strokes = stroke(visible, lines, width, panel.camera.focal_length(size))
    plain = panel.values is None and panel.texture is None
    front, back = corner_light(panel.mesh, panel.camera, style, not plain)
    values, table = _colors(panel, style)
    color = as_color(style.color)
    texture = {} if panel.texture is None else panel.texture._asdict()
    if panel.texture is not None:
        texture["uv"] = triangles.carry(panel.texture.uv)
    paint = Paint(
        values=triangles.carry(values[faces]),
        table=table,
        front=triangles.carry(front),
        back=triangles.carry(back),
        inside=np.array(SLATE) * (color.max() / max(CLAY) if plain else 1.0),
        tint=0.0 if style.back != "tint" else (1.0 if plain else 0.55),
        background=as_color(style.background),
        line=np.array(INK),
        wire=np.array(INK),
        wire_width=0.6 * width if style.wireframe else 0.0,
        missing=as_color(style.color if style.missing is None else style.missing),
        **texture,
    )
    return shade(triangles, visible, strokes, paint, samples)


def _colors(panel: Panel, style: Style) -> tuple[Floats, Floats]:
    """Numbers in [0, 1] and their table, or the colours of the vertices."""
    if panel.values is None:
        plain = np.tile(as_color(style.color), (2, 1))
        return np.zeros((panel.mesh.n_vertices, 1)), plain
    if panel.limits is None or panel.table is None:
        return panel.values, np.zeros((2, 3))
    low, high = panel.limits
    half = high / 2 - low / 2  # of large limits, the difference overflows
    if half == 0:  # a constant function has the colour in the middle
        return np.where(np.isnan(panel.values), np.nan, 0.5), panel.table
    with np.errstate(over="ignore"):
        scaled = (panel.values / 2 - low / 2) / half
    # Pixels beyond the limits are cut in the kernel: a cut at the vertices would bend f inside
    # the faces. Here only infinities go, since the difference of two has no value.
    return np.clip(scaled, -_FAR, _FAR), panel.table


def corner_light(mesh: Mesh, camera: Camera, style: Style, colored: bool) -> Floats:
    """(2, m, 3) light at the corners of the faces, seen from outside and from inside.

    It is ambient (3 + <n, up>) / 4 + fill I_2 + (1 - ambient) I, at most 1, with I the intensity
    of the chapter under the main light and I_2 under the weak one from the side; ambient = 0 and
    fill = 0 leave I. The inside is lit through the opposite normals. A corner at a vertex without
    a normal takes the normal of its face. A planar mesh has no shape to show: without a light of
    the user, it has light 1 everywhere, and its colours are those of the bar.

    Chapter items: P13.
    """
    points, faces = in_space(mesh.vertices, mesh.faces)
    if mesh.dimension == 2 and style.light is None:
        return np.ones((2, *faces.shape))
    if style.shading == "flat":
        middles = points[faces].mean(axis=1)
        by_face = _both_sides(mesh.face_normals, middles, camera, style, colored)
        return np.repeat(by_face[:, :, None], 3, axis=2)
    normals = mesh.vertex_normals
    light = _both_sides(normals, points, camera, style, colored)[:, faces]
    face, corner = np.nonzero((normals == 0).all(axis=1)[faces])
    if len(face):
        at = points[faces[face, corner]]
        light[:, face, corner] = _both_sides(mesh.face_normals[face], at, camera, style, colored)
    return light


def _both_sides(
    normals: Floats, points: Floats, camera: Camera, style: Style, colored: bool
) -> Floats:
    """(2, k) light of each row from outside, and from inside."""
    sides = (normals, -normals)
    return np.stack([_light(side, points, camera, style, colored) for side in sides])


def _light(normals: Floats, points: Floats, camera: Camera, style: Style, colored: bool) -> Floats:
    """Light of each row: sky, weak lamp and main lamp."""
    ambient = _AMBIENT_OF_FUNCTIONS if colored else _AMBIENT
    ambient = ambient if style.ambient is None else style.ambient
    fill = _FILL_OF_FUNCTIONS if colored else _FILL
    fill = fill if style.fill is None else style.fill
    main = over_the_shoulder(camera) if style.light is None else style.light
    sky = ambient * (3 + normals @ camera.axes[1]) / 4
    side = fill * incident(normals, points, from_the_side(camera))
    return np.minimum(sky + side + max(1 - ambient, 0.0) * incident(normals, points, main), 1.0)
