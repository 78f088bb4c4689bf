"""Colour of each pixel: light and values interpolated in the triangle it sees (l. 70, 107)."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, Integers
from beltrami._jit import kernel
from beltrami.display.raster import Visible
from beltrami.display.srgb import Image, to_linear
from beltrami.display.texture import look_up
from beltrami.display.triangles import GRID, Triangles

_LINEAR = to_linear(np.linspace(0.0, 1.0, 1025))  # sRGB to light, interpolated: exact to 1e-6


class Paint(NamedTuple):
    """What the triangles are painted with.

    Attributes
    ----------
    values : (t, 3, 1) or (t, 3, 3) float
        At the corners: a number in [0, 1] that the table turns into a colour, or sRGB.
    table : (k, 3) float
        sRGB colours of 0 to 1.
    front, back : (t, 3) float
        Light at the corners, seen from outside and from inside.
    inside : (3,) float
        The tint of the inside.
    tint : float
        How much of that tint the inside takes, in [0, 1].
    background : (3,) float
        sRGB.
    line, wire : (3,) float
        sRGB of the level lines and of the sides.
    missing : (3,) float
        sRGB of triangles with a value that is NaN.
    wire_width : float
        In samples; 0 draws no sides.
    uv : (t, 3, 2) float
        Where the corners lie on a texture, if there is one; NaN paints the values instead.
    pixels, levels
        Of a ``Texture``; empty for none.
    """

    values: Floats
    table: Floats
    front: Floats
    back: Floats
    inside: Floats
    tint: float
    background: Floats
    line: Floats
    wire: Floats
    wire_width: float
    uv: Floats = np.zeros((0, 3, 2))
    pixels: NDArray[np.float32] = np.zeros((0, 3), np.float32)
    levels: Integers = np.zeros((0, 3), np.int64)
    missing: Floats = np.zeros(3)


def shade(
    triangles: Triangles,
    visible: Visible,
    strokes: NDArray[np.float32],
    paint: Paint,
    samples: int,
) -> Image:
    """(h, w, 3) uint8: the picture, each pixel the mean of samples x samples.

    The number f(x) and the light I(x) are interpolated between the corners, perspective
    correct, and the colour is looked up per sample: colours and level sets are those of the
    piecewise linear f, not a blend of colours of the vertices. A sample has the sRGB value
    colour * light, so with white paint the picture shows 255 I. The samples of a pixel are
    averaged as light, not as sRGB values: half covered is then half as bright to the eye, and
    thin dark lines on white do not look ragged.

    Chapter items: P8, P13.

    Parameters
    ----------
    strokes
        (h', w') coverage of each sample by level lines, or an empty array.
    """
    return np.asarray(
        _shade(
            triangles.xy,
            triangles.nearness,
            triangles.borders,
            visible.triangle,
            strokes,
            np.ascontiguousarray(paint.values),
            np.ascontiguousarray(paint.table),
            np.ascontiguousarray(paint.front),
            np.ascontiguousarray(paint.back),
            np.ascontiguousarray(paint.inside),
            float(paint.tint),
            np.stack([paint.background, paint.line, paint.wire, paint.missing]),
            float(paint.wire_width),
            np.ascontiguousarray(paint.uv),
            paint.pixels,
            paint.levels,
            samples,
            _LINEAR,
        )
    )


@kernel
def _shade(
    xy: Any,
    nearness: Any,
    borders: Any,
    seen: Any,
    strokes: Any,
    values: Any,
    table: Any,
    front: Any,
    back: Any,
    inside: Any,
    tint: float,
    extras: Any,
    wire_width: float,
    uv: Any,
    pixels: Any,
    levels: Any,
    samples: int,
    linear: Any,
) -> Any:
    """Colour all samples, and average those of each pixel."""
    height, width = seen.shape[0] // samples, seen.shape[1] // samples
    image = np.empty((height, width, 3), np.uint8)
    color, total = np.empty(3), np.empty(3)
    b = np.empty(3)
    for py in range(height):
        for px in range(width):
            total[:] = 0.0
            for s in range(samples * samples):
                y, x = py * samples + s // samples, px * samples + s % samples
                t = seen[y, x]
                if t < 0:
                    color[:] = extras[0]
                else:
                    behind, wire = _barycentric(xy[t], x, y, borders[t], wire_width, b)
                    light = _shared(back[t] if behind else front[t], nearness[t], b)
                    if levels.shape[0] == 0 or np.isnan(uv[t]).any():
                        _paint(values[t], table, extras[3], b, color)
                    else:
                        _read(pixels, levels, uv[t], xy[t], nearness[t], x, y, b, color)
                    for c in range(3):
                        if behind:
                            color[c] += tint * (inside[c] - color[c])
                        color[c] *= light
                        color[c] += wire * (extras[2, c] - color[c])
                        if strokes.size:
                            color[c] += strokes[y, x] * (extras[1, c] - color[c])
                for c in range(3):
                    total[c] += color[c] if samples == 1 else _look_up(linear, color[c])
            for c in range(3):
                value = total[c]
                if samples > 1:
                    value = _encode(value / (samples * samples))
                image[py, px, c] = np.uint8(min(max(value, 0.0), 1.0) * 255.0 + 0.5)
    return image


@kernel
def _barycentric(xy: Any, x: int, y: int, border: Any, wire_width: float, b: Any) -> Any:
    """Set b to the coordinates on the screen; return (seen from inside, coverage by sides)."""
    px, py = (x << 8) + 128, (y << 8) + 128
    area = 0.0
    for c in range(3):
        i, j = (c + 1) % 3, (c + 2) % 3
        dx, dy = xy[j, 0] - xy[i, 0], xy[j, 1] - xy[i, 1]
        b[c] = dx * (py - xy[i, 1]) - dy * (px - xy[i, 0])
        area += b[c]
    wire = 0.0
    if wire_width > 0:
        wire = _sides(xy, border, b, abs(area), wire_width)
    for c in range(3):
        b[c] /= area
    return area > 0, wire  # y points downwards


@kernel
def _sides(xy: Any, border: Any, edge: Any, area: float, width: float) -> float:
    """Cover by the sides: thinner in small triangles, so that fine meshes turn grey, not black."""
    around = 0.0
    nearest = 1e30
    for c in range(3):
        i, j = (c + 1) % 3, (c + 2) % 3
        length = np.sqrt((xy[j, 0] - xy[i, 0]) ** 2.0 + (xy[j, 1] - xy[i, 1]) ** 2.0)
        around += length
        if border[c] and length > 0:
            nearest = min(nearest, abs(edge[c]) / length)
    inner = area / around / GRID  # radius of the inscribed circle, in samples
    half = min(width / 2, 0.25 * inner)
    return min(max(half + 0.5 - nearest / GRID, 0.0), min(1.0, 2 * half))


@kernel
def _shared(light: Any, nearness: Any, b: Any) -> float:
    """Turn b into the coordinates on the surface; return the light there."""
    total = 0.0
    for c in range(3):
        b[c] *= nearness[c]
        total += b[c]
    mean = 0.0
    for c in range(3):
        b[c] /= total
        mean += b[c] * light[c]
    return mean


@kernel
def _paint(values: Any, table: Any, missing: Any, b: Any, color: Any) -> None:
    """Set the colour: interpolate the value, then look it up; or interpolate sRGB."""
    if values.shape[1] == 3:
        for c in range(3):
            color[c] = b[0] * values[0, c] + b[1] * values[1, c] + b[2] * values[2, c]
        return
    value = b[0] * values[0, 0] + b[1] * values[1, 0] + b[2] * values[2, 0]
    if np.isnan(value):
        color[:] = missing
        return
    place = min(max(value, 0.0), 1.0) * (table.shape[0] - 1)
    k = min(int(place), table.shape[0] - 2)
    for c in range(3):
        color[c] = table[k, c] + (place - k) * (table[k + 1, c] - table[k, c])


@kernel
def _read(
    pixels: Any, levels: Any, uv: Any, xy: Any, nearness: Any, x: int, y: int, b: Any, color: Any
) -> None:
    """Set the colour to that of the texture, as sharp as the steps to the next samples allow."""
    u = b[0] * uv[0, 0] + b[1] * uv[1, 0] + b[2] * uv[2, 0]
    v = b[0] * uv[0, 1] + b[1] * uv[1, 1] + b[2] * uv[2, 1]
    across = down = 0.0
    for step in range(2):
        _barycentric(xy, x + 1 - step, y + step, nearness, 0.0, b)
        _shared(nearness, nearness, b)
        du = b[0] * uv[0, 0] + b[1] * uv[1, 0] + b[2] * uv[2, 0] - u
        dv = b[0] * uv[0, 1] + b[1] * uv[1, 1] + b[2] * uv[2, 1] - v
        across, down = max(across, abs(du)), max(down, abs(dv))
    look_up(pixels, levels, u, v, across, down, color)


@kernel
def _look_up(table: Any, value: float) -> float:
    """Interpolate a table over [0, 1]."""
    place = min(max(value, 0.0), 1.0) * (table.size - 1)
    k = min(int(place), table.size - 2)
    return table[k] + (place - k) * (table[k + 1] - table[k])


@kernel
def _encode(light: float) -> float:
    """Return the sRGB value of an amount of light."""
    if light <= 0.0031308:
        return 12.92 * light
    return 1.055 * light ** (1 / 2.4) - 0.055
