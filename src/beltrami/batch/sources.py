"""Sources: from patterns, folders and URLs to single meshes, each of them once."""

from __future__ import annotations

import errno
import glob
import os
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from beltrami._optional import require
from beltrami.errors import BeltramiError, shown
from beltrami.io import extras
from beltrami.io.registry import READERS

MESHES = (*READERS, *extras.READERS, ".btm")
Sources: TypeAlias = "str | os.PathLike[str] | Sequence[str | os.PathLike[str]]"
MAGIC = ("*", "?", "[")


@dataclass(frozen=True, slots=True)
class Source:
    """A mesh to read: its name for people, and where it is for every worker."""

    name: str
    place: str


@dataclass(frozen=True)
class Found:
    """The meshes that were found, by name, and how many files were none."""

    sources: tuple[Source, ...]
    left_out: int


def find_sources(sources: Sources, out: str | None = None) -> Found:
    """Return every mesh that is meant, once, sorted by name.

    Parameters
    ----------
    sources
        Names of files; patterns (``**`` is any folders); folders, which stand for all meshes in
        and below them; URLs of fsspec (``s3://bucket/*.ply``, ``zip://**.obj::meshes.zip``); or a
        list of them.
    out
        A local folder of results: what is in it is no source.

    Raises
    ------
    FileNotFoundError
        If a local file is not there, or a pattern or a folder has no mesh.
    BeltramiError
        If a URL is of a protocol that is not known or not installed.
    """
    given: list[object] = [sources]
    if isinstance(sources, Iterable) and not isinstance(sources, str | os.PathLike):
        given = list(sources)
    if not given:
        raise BeltramiError("a batch needs a mesh, a pattern or a folder")
    found: dict[str, Source] = {}
    left_out = 0
    for one in given:
        if not isinstance(one, str | os.PathLike):
            raise BeltramiError(f"a source is a name, a pattern or a URL, not {shown(one)}")
        text = os.fspath(one)
        places, chosen = _expanded(text)
        meshes = places if chosen else [place for place in places if _is_mesh(place.place)]
        meshes = [mesh for mesh in meshes if out is None or not _is_in(mesh.place, out)]
        left_out += len(places) - len(meshes)
        if not meshes:
            raise FileNotFoundError(errno.ENOENT, "No mesh there", text)
        found.update((mesh.place, mesh) for mesh in meshes)
    ordered = sorted(found.values(), key=lambda source: (source.name, source.place))
    return Found(tuple(ordered), left_out)


def readable(text: str) -> str:
    r"""Return a text that UTF-8 can write: names of files may be bytes that mean nothing there.

    Examples
    --------
    >>> print(readable("caf\udce9.ply"))
    caf\udce9.ply
    """
    return text.encode("utf-8", "backslashreplace").decode("utf-8")


def _expanded(text: str) -> tuple[list[Source], bool]:
    """Return the files of a name or a pattern, and whether each was named by itself."""
    if "://" in text or "::" in text:
        return _of_url(text)
    if os.path.isdir(text):
        below = os.path.join(glob.escape(text), "**")
        return list(_locally(glob.iglob(below, recursive=True))), False
    if os.path.exists(text):
        return [Source(readable(text), os.path.abspath(text))], True
    if any(sign in text for sign in MAGIC):
        return list(_locally(glob.iglob(text, recursive=True))), False
    raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), text)


def _locally(names: Iterable[str]) -> Iterator[Source]:
    for name in names:
        if os.path.isfile(name):
            yield Source(readable(name), os.path.abspath(name))


def _of_url(url: str) -> tuple[list[Source], bool]:
    """Return the files of a URL; those of http are taken as they are written."""
    head, chain, rest = url.partition("::")
    if head.startswith(("http://", "https://")) or not any(sign in head for sign in MAGIC):
        return [Source(url, url)], True
    fsspec: Any = require("fsspec", "batch", "a batch")
    protocol = head.partition("://")[0]
    try:
        files, path = fsspec.core.url_to_fs(url)
        files.invalidate_cache()  # this process may have listed it before others added to it
        names = [str(name).lstrip("/") for name in sorted(files.glob(path))]
    except OSError:
        raise
    except Exception as cause:  # protocols that are not known, not installed or raise anything
        raise BeltramiError(f"{url} cannot be searched: {cause}") from cause
    urls = [f"{protocol}://{name}{chain}{rest}" for name in names]
    return [Source(one, one) for one in urls], False


def _is_mesh(place: str) -> bool:
    """Say whether the name of a file promises a mesh."""
    name = place.partition("::")[0].lower().removesuffix(".gz")
    return os.path.splitext(name)[1] in MESHES


def _is_in(place: str, folder: str) -> bool:
    return os.path.realpath(place).startswith(os.path.join(os.path.realpath(folder), ""))
