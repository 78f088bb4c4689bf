"""Write a picture: the format by the suffix, the file whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from PIL import Image as Pillow

from beltrami.display.srgb import Image
from beltrami.errors import BeltramiError, check_name
from beltrami.io.atomic import replacing

# Nothing is lost, but in GIF, which has 256 colours.
_OPTIONS: dict[str, tuple[str, dict[str, Any]]] = {
    ".png": ("PNG", {"optimize": False, "compress_level": 6}),
    ".webp": ("WEBP", {"lossless": True, "quality": 80}),
    ".gif": ("GIF", {}),
}
SUFFIXES = tuple(_OPTIONS)
ANIMATED = (".webp", ".gif")


def check_suffix(path: str | os.PathLike[str]) -> str:
    """Return the suffix, in small letters, if pictures can be written in that format.

    Raises
    ------
    UnknownNameError
        If they cannot.

    Examples
    --------
    >>> check_suffix("bunny.PNG")
    '.png'
    """
    return check_name("suffix of a picture", Path(path).suffix.lower(), SUFFIXES)


def write_image(path: str | os.PathLike[str], image: Image) -> None:
    """Write an (h, w, 3) uint8 picture as PNG, WebP or GIF.

    A picture that was there before stays whole if anything fails.

    Raises
    ------
    UnknownNameError
        If the suffix is not ``.png``, ``.webp`` or ``.gif``.
    """
    name, options = _OPTIONS[check_suffix(path)]
    with replacing(path) as file:
        Pillow.fromarray(image).save(file, format=name, **options)


def write_animation(path: str | os.PathLike[str], images: Iterable[Image], rate: float) -> None:
    """Write (h, w, 3) uint8 pictures of one size as an endless animation, WebP or GIF.

    Parameters
    ----------
    path
        What was there before stays whole if anything fails.
    images
        At least one; taken as they come.
    rate
        Pictures a second. GIF counts hundredths of seconds, so 30 becomes 33.3.

    Raises
    ------
    UnknownNameError
        If the suffix is not ``.webp`` or ``.gif``.
    BeltramiError
        If there is no picture, or the rate is not positive.
    """
    check_name("suffix of an animation", Path(path).suffix.lower(), ANIMATED)
    if not 0 < rate < float("inf"):
        raise BeltramiError(f"an animation has a positive number of pictures a second, not {rate}")
    name, options = _OPTIONS[check_suffix(path)]
    pictures = (Pillow.fromarray(image) for image in images)
    first = next(pictures, None)
    if first is None:
        raise BeltramiError("an animation needs a picture")
    with replacing(path) as file:
        first.save(
            file,
            format=name,
            save_all=True,
            append_images=pictures,
            duration=round(1000 / rate),
            loop=0,
            **options,
        )
