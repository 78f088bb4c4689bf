"""The name that was meant, for one that does not exist."""

from __future__ import annotations

import difflib
from collections.abc import Sequence

_ELSEWHERE = {  # the chapter's names, and other libraries': only hints, in errors
    "conformal": "cotangent least_squares_conformal", "cot": "cotangent", "lumped": "barycentric",
    "full": "consistent", "mixed": "voronoi", "graph": "combinatorial", "uniform": "combinatorial",
    "umbrella": "combinatorial", "laplacian": "averaging", "lscm": "least_squares_conformal",
    "heat": "implicit", "backward_euler": "implicit", "forward_euler": "explicit", "expm": "exact",
    "mean_curvature_flow": "curvature_flow", "dijkstra": "edges",
}  # fmt: skip


def nearest(name: str, choices: Sequence[str]) -> str:
    """Return the choice that goes elsewhere by this name, or is spelt most like it, or "".

    Examples
    --------
    >>> nearest("conformal", ("combinatorial", "cotangent")), nearest("cotan", ("cotangent",))
    ('cotangent', 'cotangent')
    """
    known = [ours for ours in _ELSEWHERE.get(name.lower(), "").split() if ours in choices]
    return next(iter(known or difflib.get_close_matches(name, choices, n=1)), "")
