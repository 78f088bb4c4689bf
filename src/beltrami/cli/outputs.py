"""Outputs are checked before the work, so that no work is lost for a name."""

from __future__ import annotations

import errno
import os
from pathlib import Path

VALUES = (".npy", ".txt", ".csv", ".ply", ".gii", ".mgh", ".mgz")  # what values are written to


def check_mesh_output(path: Path) -> None:
    """Raise now what writing a mesh to ``path`` would raise after the work."""
    from beltrami.io import extras
    from beltrami.io.registry import WRITERS, suffix_of

    _check_place(path)
    suffix_of(path, None, (*WRITERS, *extras.WRITERS))


def check_texture_output(path: Path) -> None:
    """Raise now what writing a mesh with texture coordinates would raise after the work."""
    from beltrami.errors import check_name
    from beltrami.io.registry import TEXTURED

    _check_place(path)
    named = path.with_suffix("") if path.suffix.lower() == ".gz" else path
    check_name("format for texture coordinates", named.suffix.lower(), TEXTURED)


def check_values_output(path: Path) -> None:
    """Raise now what writing values to ``path`` would raise after the work."""
    from beltrami.errors import check_name

    _check_place(path)
    check_name("format for values", path.suffix.lower(), VALUES)


def check_picture_output(path: Path) -> None:
    """Raise now what writing a picture to ``path`` would raise after the work."""
    from beltrami.display.images import check_suffix

    _check_place(path)
    check_suffix(path)


def check_frames_output(path: Path) -> str:
    """Raise now what writing frames to ``path`` would raise later; return .npy, .gif, .webp or "".

    The last means a folder of pictures, which may be there already.
    """
    from beltrami.display.images import ANIMATED
    from beltrami.errors import check_name

    suffix = path.suffix.lower()
    if path.is_dir() or not suffix:
        place = Path(os.path.realpath(path))
        if not place.is_dir():
            _check_place(place)
        elif not os.access(place, os.W_OK):
            raise PermissionError(errno.EACCES, "Folder cannot be written", str(path))
        return ""
    _check_place(path)
    return check_name("format for frames (a folder has no suffix)", suffix, (".npy", *ANIMATED))


def check_compressed_output(path: Path) -> None:
    """Raise now what writing a compressed mesh to ``path`` would raise after the work."""
    from beltrami.errors import check_name

    _check_place(path)
    check_name("format for compressed meshes", path.suffix.lower(), (".btm",))


def check_basis_output(path: Path) -> None:
    """Raise now what writing a basis to ``path`` would raise after the work."""
    from beltrami.errors import check_name

    _check_place(path)
    check_name("format for a basis", path.suffix.lower(), (".npz",))


def check_page_output(path: Path) -> None:
    """Raise now what writing a page to ``path`` would raise after the work."""
    from beltrami.display.page import SUFFIXES
    from beltrami.errors import check_name

    _check_place(path)
    check_name("suffix of a page", path.suffix.lower(), SUFFIXES)


def _check_place(path: Path) -> None:
    """Refuse a directory, and a folder that is not there or cannot be written."""
    place = Path(os.path.realpath(path))
    if place.is_dir():
        raise IsADirectoryError(errno.EISDIR, "Is a directory: name a file in it", str(path))
    if not place.parent.is_dir():
        raise FileNotFoundError(errno.ENOENT, "No such folder: make it first", str(path.parent))
    if not os.access(place.parent, os.W_OK):
        raise PermissionError(errno.EACCES, "Folder cannot be written", str(path.parent))
