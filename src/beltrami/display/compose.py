"""Panels in rows, with captions above and colour bars below."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike

import numpy as np
from PIL import Image as Pillow
from PIL import ImageDraw

from beltrami._arrays import Floats
from beltrami.display.scene import Panel, Style
from beltrami.display.srgb import Image, as_color
from beltrami.display.text import Font, load_font, plain, wrapped


def compose(
    pictures: Sequence[Image],
    panels: Sequence[Panel],
    style: Style,
    *,
    columns: int,
    colorbar: bool,
    font: str | PathLike[str] | None = None,
) -> Image:
    """(h, w, 3) uint8: the pictures side by side, ``columns`` in a row.

    A band for captions is added above the pictures if there is any caption, and one for colour
    bars below if there is any function; a bar shows the colours with the values at its ends, and
    in its middle where that is zero.
    """
    width, height = style.size
    letters = load_font(font, max(round(width * 0.036), 11))
    small = load_font(font, max(round(width * 0.028), 10))
    texts = [panel.caption if font else plain(panel.caption) for panel in panels]
    texts = [wrapped(text, letters, 0.94 * width) for text in texts]
    line = round(letters.size * 1.3)
    above = max(line * (text.count("\n") + 1) if text else 0 for text in texts)
    above += round(letters.size * 0.5) if above else 0
    bars = [panel.table if colorbar and panel.limits is not None else None for panel in panels]
    below = round(small.size * 2.9) if any(bar is not None for bar in bars) else 0

    columns = min(columns, len(panels))
    rows = -(-len(panels) // columns)
    cell = above + height + below
    canvas = np.empty((rows * cell, columns * width, 3), np.uint8)
    canvas[:] = np.rint(255 * as_color(style.background))
    ink = _ink(style)
    for k, (picture, bar) in enumerate(zip(pictures, bars, strict=True)):
        x, y = k % columns * width, k // columns * cell
        canvas[y + above : y + above + height, x : x + width] = picture
        if bar is not None:
            left, right, top, bottom = _bar_box(x, y + above + height, width, small)
            canvas[top - 1 : bottom + 1, left - 1 : right + 1] = ink  # a thin frame
            canvas[top:bottom, left:right] = _ramp(bar, right - left)
    if not above and not below:
        return canvas
    page = Pillow.fromarray(canvas)
    draw = ImageDraw.Draw(page)
    for k, (panel, text) in enumerate(zip(panels, texts, strict=True)):
        x, y = k % columns * width, k // columns * cell
        if text:
            place = (x + width / 2, y + above - round(letters.size * 0.25))
            draw.multiline_text(
                place, text, fill=ink, font=letters, anchor="md", align="center",
                spacing=line - letters.size,
            )  # fmt: skip
        if bars[k] is not None and panel.limits is not None:
            box = _bar_box(x, y + above + height, width, small)
            _label(draw, box, panel.limits, small, ink, bool(font))
    return np.asarray(page).copy()


def _ink(style: Style) -> tuple[int, int, int]:
    """Dark text on a light background, light text on a dark one."""
    dark = as_color(style.background) @ [0.2126, 0.7152, 0.0722] < 0.45
    return (235, 235, 235) if dark else (40, 40, 46)


def _bar_box(x: int, y: int, width: int, font: Font) -> tuple[int, int, int, int]:
    """Left, right, top and bottom of the colour bar of the panel whose picture ends at y."""
    thick = max(round(font.size * 0.6), 6)
    top = y + round(font.size * 0.5)
    return x + round(0.2 * width), x + round(0.8 * width), top, top + thick


def _ramp(table: Floats, width: int) -> Image:
    """(1, width, 3): the colours of the table from left to right."""
    t = np.linspace(0, len(table) - 1, width)
    columns = [np.interp(t, np.arange(len(table)), channel) for channel in table.T]
    return np.rint(255 * np.stack(columns, axis=1)).astype(np.uint8)[None]


def _label(
    draw: ImageDraw.ImageDraw,
    box: tuple[int, int, int, int],
    limits: tuple[float, float],
    font: Font,
    ink: tuple[int, int, int],
    typographic: bool,
) -> None:
    """Write the limits below the ends of the bar, and 0 below the middle if it is there."""
    left, right, _, bottom = box
    marks = [(left, limits[0]), (right, limits[1])]
    if limits[0] == -limits[1] != 0:
        marks.append(((left + right) // 2, 0.0))
    for x, value in marks:
        text = f"{value + 0.0:.3g}"  # no minus zero
        text = text.replace("-", "−") if typographic else text
        draw.text((x, bottom + 0.3 * font.size), text, fill=ink, font=font, anchor="mt")
