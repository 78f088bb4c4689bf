"""Pictures no higher than what is seen on them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from beltrami.display.framing import drawn_points
from beltrami.display.scene import Panel

_MARGIN = 0.04  # of the width, above and below


def rows_seen(panels: Sequence[Panel], width: int) -> slice:
    """Return the rows of square pictures that meshes reach in any panel, with a margin.

    Examples
    --------
    >>> from beltrami.display.framing import fit_camera
    >>> from beltrami.mesh.mesh import Mesh
    >>> strip = Mesh([[0, 0], [8, 0], [0, 1]], [[0, 1, 2]])
    >>> rows_seen([Panel(strip, fit_camera(strip))], 100)
    slice(40, 60, None)
    """
    heights = [
        panel.camera.project(drawn_points(panel.mesh), (width, width))[:, 1] for panel in panels
    ]
    low = min(float(y.min()) for y in heights) - _MARGIN * width
    high = max(float(y.max()) for y in heights) + _MARGIN * width
    first = int(np.clip(np.floor(low), 0, width - 1))
    return slice(first, int(np.clip(np.ceil(high), first + 1, width)))
