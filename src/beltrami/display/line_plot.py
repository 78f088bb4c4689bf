"""Line plots by matplotlib, without its windows: one look for all of them."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np

from beltrami._arrays import Floats
from beltrami._optional import require
from beltrami.display.images import write_image
from beltrami.display.srgb import Image

COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00")
_DPI = 100


class LinePlot:
    """One pair of axes of a size in pixels; ``axes`` are matplotlib's.

    Raises
    ------
    MissingExtraError
        If matplotlib is not installed: ``pip install "beltrami[plot]"``.
    """

    def __init__(self, size: tuple[int, int], purpose: str) -> None:
        figure_of: Any = require("matplotlib.figure", "plot", purpose)
        agg: Any = require("matplotlib.backends.backend_agg", "plot", purpose)
        figure = figure_of.Figure(
            figsize=(size[0] / _DPI, size[1] / _DPI), dpi=_DPI, layout="constrained"
        )
        self._canvas = agg.FigureCanvasAgg(figure)
        self.axes: Any = figure.add_subplot()
        self.axes.grid(visible=True, which="major", color="0.9")
        self.axes.spines[["top", "right"]].set_visible(False)

    def picture(self) -> Image:
        """Draw, with a legend of what has a label: (h, w, 3) uint8."""
        self.axes.legend(frameon=False)
        self._canvas.draw()
        return np.ascontiguousarray(np.asarray(self._canvas.buffer_rgba())[..., :3])


def plot_rates(
    curves: Mapping[str, tuple[Floats, Floats]],
    path: str | os.PathLike[str],
    *,
    size: tuple[int, int] = (900, 560),
) -> Image:
    """Draw errors over bits per vertex, a line for each name, and write it to ``path``.

    Errors are drawn in logarithms; those that are 0 are left out.
    """
    plot = LinePlot(size, "plots of rates and errors")
    for i, (name, (rates, errors)) in enumerate(curves.items()):
        some = errors > 0
        style = {"color": COLORS[i % len(COLORS)], "marker": "o", "ms": 4, "label": name}
        plot.axes.plot(rates[some], errors[some], **style)
    labels = {"xlabel": "bits per vertex", "ylabel": "RMS error / diagonal of the bounding box"}
    plot.axes.set(yscale="log", **labels)
    image = plot.picture()
    write_image(path, image)
    return image
