"""Functions and texture coordinates of a mesh: each written in the shorter of two ways."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, require_finite
from beltrami.compression.connectivity import Connectivity
from beltrami.compression.container import DATA, PREDICTED, PREDICTED_UV, UV, Section
from beltrami.compression.functions import encode_array
from beltrami.compression.numbers import surroundings
from beltrami.compression.predicted import encode_exactly, encode_within
from beltrami.compression.wedges import encode_uv
from beltrami.errors import MeshError, check_name


@dataclass(frozen=True, eq=False)
class Attributes:
    """The sections, and what they will decode to, in the order of the file."""

    sections: list[Section]
    functions: dict[str, NDArray[Any]]
    uv: Floats | None


def encode_attributes(
    functions: Mapping[str, NDArray[Any]],
    uv: Floats | None,
    found: Connectivity,
    effort: str,
    errors: Mapping[str, float],
    uv_error: float | None,
) -> Attributes:
    """Write functions (n, ...) and (m, 3, 2) coordinates that are in the order of the file.

    Exactly, but for those with an error.
    """
    near = surroundings(found.faces, len(found.vertices))
    sections, become = [], dict(functions)
    for name, values in functions.items():
        if name in errors:
            require_bound(name, values, errors[name])
            payload, become[name] = encode_within(name, values, errors[name], near, effort)
            _check(name, values, become[name], errors[name])
            sections.append(Section(PREDICTED, payload))
            continue
        plain = Section(DATA, encode_array(name, values))
        short = encode_exactly(name, values, near, effort)
        sections.append(_shorter(plain, PREDICTED, short))
    if uv is not None:
        if uv_error is not None:
            require_bound("uv", uv, uv_error)
        n = len(found.vertices)
        short, rounded = encode_uv(found.faces, n, uv, uv_error, effort)
        plain = Section(UV, encode_array("uv", uv.reshape(-1, 6)))
        if uv_error is not None and short is not None:
            _check("uv", uv.reshape(-1, 2), rounded.reshape(-1, 2), uv_error)
            sections.append(Section(PREDICTED_UV, short))
            uv = rounded
        else:
            sections.append(_shorter(plain, PREDICTED_UV, short))
    return Attributes(sections, become, uv)


def check_errors(functions: Mapping[str, NDArray[Any]], errors: Mapping[str, float]) -> None:
    """Raise where an error belongs to no function."""
    for name in errors:
        check_name("function", name, list(functions))


def require_bound(name: str, values: NDArray[Any], max_error: float) -> None:
    """Raise unless these are finite floats and the error is positive."""
    if values.dtype.kind != "f":
        raise MeshError(
            f"{name!r} has the type {values.dtype}, which is kept exactly",
            remedy="Give errors for functions of floating-point numbers only.",
        )
    if not 0 < max_error < np.inf:
        raise MeshError(f"the largest error of {name!r} must be positive, not {max_error}")
    require_finite(values.reshape(len(values), -1), f"the function {name!r}")


def _shorter(plain: Section, kind: int, short: bytes | None) -> Section:
    if short is None or len(plain.payload) <= len(short):
        return plain
    return Section(kind, short)


def _check(name: str, values: NDArray[Any], become: NDArray[Any], max_error: float) -> None:
    """Raise where the rounding of the type itself is larger than the bound."""
    off = (become.astype(np.float64) - values).reshape(len(values), -1)
    if len(off) and float(np.sqrt((off**2).sum(axis=1)).max()) > max_error:
        raise MeshError(
            f"{name!r} cannot be kept within {max_error:.3g}: its type rounds by more",
            remedy="Allow a larger error, or leave the error out: then it is kept exactly.",
        )
