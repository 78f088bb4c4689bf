"""What a compressed file says of itself, without decoding it."""

from __future__ import annotations

import os
from dataclasses import asdict, dataclass
from typing import Any

from beltrami.compression.container import (
    CONNECTIVITY,
    FEATURES,
    GRID,
    NAMES,
    SPECTRUM,
    VERSION,
    Section,
    bytes_of,
    unpack,
)
from beltrami.compression.geometry import Head, read_head
from beltrami.compression.spectral_head import SpectralHead, read_spectral_head
from beltrami.errors import FileFormatError


@dataclass(frozen=True)
class Contents:
    """What is in a compressed file.

    Parameters
    ----------
    n_vertices, dimension
        Of the mesh.
    max_error
        No vertex is farther than that from where it was, but for the rounding of coordinates.
    step
        Of the grid of positions, or of the coefficients.
    mode
        ``"grid"``, ``"smooth"`` (moved within the cells of the grid) or ``"spectral"``.
    effort
        ``"best"`` or ``"fast"``.
    sections
        The name of each section and the number of its bytes, its header included.
    size
        Bytes of the whole file.
    features
        In words.
    terms
        In the mode ``"spectral"``, how many coefficients the longest block has; else None.
    """

    n_vertices: int
    dimension: int
    max_error: float
    step: float
    mode: str
    effort: str
    sections: tuple[tuple[str, int], ...]
    size: int
    features: tuple[str, ...]
    terms: int | None = None
    version: int = VERSION

    def to_dict(self) -> dict[str, Any]:
        """Return the fields, with the sections as a list."""
        return asdict(self) | {
            "sections": [{"name": name, "bytes": size} for name, size in self.sections]
        }


def describe(source: bytes | str | os.PathLike[str]) -> Contents:
    """Read what a compressed file says of itself; its sections are checked, not decoded.

    Raises
    ------
    FileFormatError
        If these are not the bytes of such a file.

    Examples
    --------
    >>> from beltrami.compression.compress import compress
    >>> from beltrami.mesh.shapes import icosphere
    >>> contents = describe(compress(icosphere(1), max_error=0.01, mode="grid"))
    >>> contents.n_vertices, round(contents.max_error, 6), contents.effort
    (42, 0.01, 'best')
    """
    data, path = bytes_of(source)
    features, sections = unpack(data, path)
    by_kind = {section.kind: section for section in sections}
    if CONNECTIVITY not in by_kind or (GRID in by_kind) == (SPECTRUM in by_kind):
        raise FileFormatError(path, "there are no faces, or no positions, or two kinds of them")
    n = by_kind[CONNECTIVITY].reader(path).varint()
    head: Head | SpectralHead
    if SPECTRUM in by_kind:
        head = read_spectral_head(by_kind[SPECTRUM].reader(path), n)
        mode, terms = "spectral", head.terms
    else:
        head = read_head(by_kind[GRID].reader(path))
        mode, terms = ("smooth" if head.choice or head.is_free else "grid"), None
    return Contents(
        n,
        len(head.grid.origin),
        head.bound,
        head.grid.step,
        mode,
        head.effort,
        tuple((NAMES[section.kind], _bytes_of(section)) for section in sections),
        len(data),
        tuple(text for bit, text in FEATURES.items() if features & bit),
        terms,
    )


def _bytes_of(section: Section) -> int:
    """Return the bytes of a section with its kind, its length and its checksum."""
    length = len(section.payload)
    return length + 1 + max(1, -(-length.bit_length() // 7)) + 4
