"""The picture of a page: as PNG or JPEG of few enough bytes."""

from __future__ import annotations

import io
from dataclasses import dataclass

from PIL import Image as Pillow

from beltrami.io.picture import Picture, as_pillow

MOST_BYTES = 200_000  # a quarter more in the page, of 3 MB
LONGEST = 2048  # pixels that every graphics card with WebGL2 takes
_QUALITIES = (92, 85, 75, 60)


@dataclass(frozen=True)
class PagePicture:
    """A picture ready to travel.

    Attributes
    ----------
    data
        The bytes of a file.
    kind
        ``"image/png"``, without loss, or ``"image/jpeg"``.
    size
        Width and height.
    note
        What it lost, or nothing.
    """

    data: bytes
    kind: str
    size: tuple[int, int]
    note: str


def page_picture(picture: Picture) -> PagePicture:
    """Pack a picture: as PNG if that is small enough, else as JPEG; coarser where that is not.

    Examples
    --------
    >>> packed = page_picture([[0.0, 1.0]])
    >>> packed.kind, packed.size, packed.note
    ('image/png', (2, 1), '')
    """
    given = as_pillow(picture)
    longest = min(LONGEST, max(given.size))
    while True:
        image = given.copy()
        image.thumbnail((longest, longest), Pillow.Resampling.LANCZOS)
        smaller = f" of {image.width} x {image.height} pixels" if image.size != given.size else ""
        data = _bytes(image, "PNG", optimize=True)
        if len(data) <= MOST_BYTES:
            return PagePicture(
                data, "image/png", image.size, smaller and f"travels as PNG{smaller}"
            )
        for quality in _QUALITIES:
            data = _bytes(image, "JPEG", quality=quality, optimize=True)
            if len(data) <= MOST_BYTES:
                note = f"travels as JPEG{smaller}, quality {quality}"
                return PagePicture(data, "image/jpeg", image.size, note)
        longest = longest * 3 // 4


def _bytes(image: Pillow.Image, kind: str, **options: int) -> bytes:
    file = io.BytesIO()
    image.save(file, format=kind, **options)
    return file.getvalue()
