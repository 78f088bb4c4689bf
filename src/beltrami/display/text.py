"""Text in pictures: the font that pillow brings, or one that the user names."""

from __future__ import annotations

import unicodedata
from os import PathLike, fspath
from typing import TypeAlias

from PIL import ImageFont

from beltrami.errors import MeshError

Font: TypeAlias = ImageFont.FreeTypeFont
# The bundled font has ASCII and little more.
_SPELLED = {
    "λ": "lambda",
    "Λ": "Lambda",
    "ς": "sigma",
    "−": "-",
    "–": "-",
    "—": "-",
    "×": "x",
    "≤": "<=",
    "≥": ">=",
    "‘": "'",
    "’": "'",
}


def load_font(path: str | PathLike[str] | None, size: int) -> Font:
    """Load a TrueType file at a size in pixels; without a path, the font bundled with pillow.

    Raises
    ------
    MeshError
        If the file is no font, or pillow was built without FreeType.
    """
    try:
        font = (
            ImageFont.load_default(size) if path is None else ImageFont.truetype(fspath(path), size)
        )
    except (OSError, ImportError) as cause:
        source = "pillow" if path is None else repr(fspath(path))
        raise MeshError(f"no font can be read from {source}: {cause}") from cause
    if not isinstance(font, ImageFont.FreeTypeFont):
        raise MeshError("pillow was built without FreeType, so that captions cannot be drawn")
    return font


def plain(text: str) -> str:
    """Spell what the bundled font cannot draw: no accents, Greek letters by name, else ``?``.

    Examples
    --------
    >>> plain("Möbius, λ = −2")
    'Mobius, lambda = -2'
    """
    out = []
    for character in text:
        if character == "\n" or " " <= character <= "~":
            out.append(character)
            continue
        name = unicodedata.name(character, "").split()
        if character in _SPELLED:
            out.append(_SPELLED[character])
        elif name[:1] == ["GREEK"] and "LETTER" in name:
            letter = name[name.index("LETTER") + 1]
            out.append(letter.lower() if "SMALL" in name else letter.capitalize())
        else:
            base = unicodedata.normalize("NFKD", character)
            kept = "".join(c for c in base if " " <= c <= "~")
            out.append(kept or "?")
    return "".join(out)


def wrapped(text: str, font: Font, width: float) -> str:
    """Break lines between words so that none is wider than ``width`` pixels, where words allow.

    Examples
    --------
    >>> wrapped("one two three", load_font(None, 20), 80).split(chr(10))
    ['one two', 'three']
    """
    lines = []
    for paragraph in text.split("\n"):
        line = ""
        for word in paragraph.split(" "):
            longer = f"{line} {word}" if line else word
            if line and font.getlength(longer) > width:
                lines.append(line)
                longer = word
            line = longer
        lines.append(line)
    return "\n".join(lines)
