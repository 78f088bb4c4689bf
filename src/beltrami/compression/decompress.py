"""decompress: bytes that may be anything, and the mesh that they describe."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Integers, whole
from beltrami._kinds import checked
from beltrami._progress import Progress
from beltrami.compression.attributes_reading import decode_attributes
from beltrami.compression.connectivity import decode_connectivity
from beltrami.compression.container import (
    CONNECTIVITY,
    GRID,
    KEEPS_ORDER,
    NAMES,
    ORDER,
    PROGRESSIVE,
    SPECTRUM,
    Section,
    bytes_of,
    unpack,
)
from beltrami.compression.geometry import decode_positions
from beltrami.compression.ordering import decode_order
from beltrami.compression.spectral_reading import decode_spectrum
from beltrami.compression.varint import Reader
from beltrami.errors import FileFormatError
from beltrami.mesh.mesh import Mesh

MAX_VERTICES = 10_000_000
_ALWAYS = 1 << 20  # numbers that are not too many


@checked
def decompress(
    source: bytes | str | os.PathLike[str],
    max_vertices: int = MAX_VERTICES,
    progress: Progress | None = None,
    *,
    partial: bool = False,
) -> Mesh:
    """Read a compressed mesh; the same bytes give the same bits on every machine.

    Chapter items: P58, P66, P68.

    Parameters
    ----------
    source
        The bytes that ``compress`` returned, or the name of a file of them.
    max_vertices
        Refuse files that declare more, or more than 8 times as many faces or coordinates in all
        (and some): bounds time and memory where bytes cannot be trusted.
    progress
        Called with (vertices decoded, n).
    partial
        Take a file of the mode ``"spectral"`` that was cut off anywhere behind the first
        coefficients: all faces, and the coarser shape of the coefficients that are there, of which
        no bound is known. Functions that were cut off are left out. A whole file gives the whole
        mesh.

    Raises
    ------
    FileFormatError
        If these are not the bytes of such a file; it says at which byte.
    MeshError
        If ``max_vertices`` is no whole number.

    Notes
    -----
    Time and memory are proportional to the numbers of vertices and faces that the file declares.

    Examples
    --------
    >>> from beltrami.compression.compress import compress
    >>> from beltrami.mesh.shapes import icosphere
    >>> decompress(compress(icosphere(1), bits=10))
    <Mesh: 42 vertices in R³, 80 faces>
    """
    max_vertices = whole("max_vertices", max_vertices, least=0)
    data, path = bytes_of(source)
    features, sections = unpack(data, path, partial)
    cut = sections.pop() if sections and sections[-1].is_cut else None
    faces, n = decode_connectivity(_the(CONNECTIVITY, sections, path), max_vertices)
    most = (8 * max_vertices + _ALWAYS) // max(n, 1)
    if features & PROGRESSIVE:
        last = cut if cut is not None and cut.kind == SPECTRUM else None
        reader = last.reader(path) if last else _the(SPECTRUM, sections, path)
        x = decode_spectrum(reader, faces, n, progress, last is not None, most)
    else:
        x = decode_positions(_the(GRID, sections, path), faces, n, progress, most)
    functions, uv = decode_attributes(sections, path, faces, n)
    if bool(features & KEEPS_ORDER) != any(section.kind == ORDER for section in sections):
        raise FileFormatError(path, "the order of the vertices is announced and not there")
    if features & KEEPS_ORDER:
        order = decode_order(_the(ORDER, sections, path), n)
        faces = order[faces]
        x = _sorted_back(x, order)
        functions = {name: _sorted_back(values, order) for name, values in functions.items()}
    return Mesh(x, faces, functions, uv)


def _the(kind: int, sections: list[Section], path: object) -> Reader:
    """Return the reader of the section of this kind."""
    for section in sections:
        if section.kind == kind:
            return section.reader(path)
    raise FileFormatError(path, f"there is no section {NAMES[kind]!r}, or not the whole of it")


def _sorted_back(values: NDArray[Any], order: Integers) -> NDArray[Any]:
    """Give row i of ``values`` the number order[i]."""
    result = np.empty_like(values)
    result[order] = values
    return result
