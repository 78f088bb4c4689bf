"""Functions and texture coordinates out of their sections."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, Integers
from beltrami.compression.container import DATA, PREDICTED, PREDICTED_UV, UV, Section
from beltrami.compression.functions import decode_array
from beltrami.compression.numbers import surroundings
from beltrami.compression.predicted import decode_predicted
from beltrami.compression.varint import Reader
from beltrami.compression.wedges import decode_uv
from beltrami.errors import FileFormatError


def decode_attributes(
    sections: list[Section], path: object, faces: Integers, n: int
) -> tuple[dict[str, NDArray[Any]], Floats | None]:
    """Return (functions by name, texture coordinates), in the order of the file."""
    functions: dict[str, NDArray[Any]] = {}
    uv: Floats | None = None
    near = None
    for section in sections:
        reader = section.reader(path)
        if section.kind in (DATA, PREDICTED):
            if section.kind == DATA:
                name, values = decode_array(reader, n)
            else:
                near = surroundings(faces, n) if near is None else near
                name, values = decode_predicted(reader, n, near)
            if name in functions:
                raise FileFormatError(path, f"two functions of the name {name!r}")
            functions[name] = values
        elif section.kind in (UV, PREDICTED_UV):
            if uv is not None:
                raise FileFormatError(path, "texture coordinates are there twice")
            plain = section.kind == UV
            uv = _plain_uv(reader, len(faces)) if plain else decode_uv(reader, faces, n)
    return functions, uv


def _plain_uv(reader: Reader, m: int) -> Floats:
    _, values = decode_array(reader, m)
    if values.shape != (m, 6) or values.dtype != np.float64:
        raise reader.fault("texture coordinates of a wrong shape")
    return values.reshape(m, 3, 2)
