"""Where results go: content-addressed files, each there as a whole or not at all.

Names are made here, of digests; none comes from an input, so none can lead out of the folder.
"""

from __future__ import annotations

import errno
import hashlib
import os
import re
import shutil
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, Final

from beltrami._optional import require
from beltrami.batch.failures import StoreError
from beltrami.batch.sources import MAGIC

_AT_ONCE: Final = ("s3", "s3a", "gs", "gcs", "az", "abfs", "abfss", "adl", "oci")
_FILE: Final = re.compile(r"files/([0-9a-f]{2})/\1[0-9a-f]{62}\.[a-z]{3}")
_WORK: Final = re.compile(r"work/([0-9a-f]{2})/\1[0-9a-f]{62}\.json")
INCOMING: Final = "incoming"  # what is half-written
MARK: Final = ".steps"  # of files there that tell how far somebody is
_BLOCK: Final = 1 << 20


@dataclass(frozen=True)
class Kept:
    """A file in a store: its name, made of its digest, and its size."""

    name: str
    sha256: str
    bytes: int


def is_name(name: object) -> bool:
    """Say whether this is the name of a file that a store makes, and of nothing else.

    Examples
    --------
    >>> is_name("files/" + "ab/" + "ab" * 32 + ".npz"), is_name("files/../../evil.npz")
    (True, False)
    """
    return isinstance(name, str) and _FILE.fullmatch(name) is not None


def work_name(key: str) -> str:
    """Return the name of the record of a piece of work."""
    name = f"work/{key[:2]}/{key}.json"
    if not _WORK.fullmatch(name):
        raise StoreError(errno.EINVAL, "not the key of any work", key)
    return name


class Store:
    """A folder of results, on this machine or behind any URL that fsspec knows.

    Parameters
    ----------
    place
        A folder, which is made if need be, or a URL such as ``s3://bucket/results``.
    """

    def __init__(self, place: str | os.PathLike[str]) -> None:
        fsspec = require("fsspec", "batch", "a batch")
        self.place = os.fspath(place)
        with self._told():  # of protocols that are not known, or not installed
            self._files, path = fsspec.core.url_to_fs(self.place)
        protocol = self._files.protocol
        names = (protocol,) if isinstance(protocol, str) else tuple(protocol)
        self.is_local = "file" in names
        self._at_once = any(name in _AT_ONCE for name in names)
        self.root = os.path.realpath(path) if self.is_local else str(path).rstrip("/")
        if not self.is_local and any(sign in self.root for sign in MAGIC):
            raise StoreError(errno.EINVAL, "a place of results is no pattern", self.place)

    @contextmanager
    def claimed(self) -> Iterator[None]:
        """Make the folder, keep other runs out, clear away what a killed run left half-written.

        Raises
        ------
        StoreError
            If another run is writing there, on this machine, or the folder cannot be made.
        """
        if not self.is_local:
            with self._told():
                self._files.makedirs(self.root, exist_ok=True)
            yield
            return
        with self._told():
            incoming = Path(self.root, INCOMING)
            self._inside(incoming)
            incoming.mkdir(parents=True, exist_ok=True)
            descriptor = os.open(Path(self.root, ".lock"), os.O_WRONLY | os.O_CREAT, 0o666)
        with open(descriptor, "wb") as lock:
            if not lock_file(lock):
                raise StoreError(errno.EBUSY, "another batch is writing its results", self.place)
            for left in incoming.iterdir():
                if left.is_dir() and not left.is_symlink():
                    shutil.rmtree(left, ignore_errors=True)
                elif left.suffix == MARK:
                    left.unlink()
            yield

    def keep(self, suffix: str, write: Callable[[Path], object]) -> Kept:
        """Let ``write`` make a file, and keep it under the name of its content.

        Raises
        ------
        StoreError
            If it cannot be written; then nothing of it is left.
        """
        with self._scratch() as folder:
            path = Path(folder, f"whole{suffix}")
            digest, size = self._made(path, write)
            kept = Kept(f"files/{digest[:2]}/{digest}{suffix}", digest, size)
            if self.size(kept.name) != size:
                self._put(path, kept.name)
        return kept

    def replace(self, name: str, write: Callable[[Path], object]) -> Kept:
        """Let ``write`` make a file that replaces the one of this name, as a whole."""
        with self._scratch() as folder:
            path = Path(folder, "whole")
            digest, size = self._made(path, write)
            self._put(path, name)
        return Kept(name, digest, size)

    def read(self, names: Sequence[str]) -> list[bytes | None]:
        """Return the contents of files; None for those that are not there.

        Raises
        ------
        StoreError
            If one is there and cannot be read.
        """
        with self._told("read"):
            if self.is_local or not names:
                return [_content(self._path(name)) for name in names]
            found: Any = self._files.cat([self._path(n) for n in names], on_error="return")
            contents = [found[self._path(name)] for name in names]
            for content in contents:
                if isinstance(content, Exception) and not isinstance(content, FileNotFoundError):
                    raise content
        return [content if isinstance(content, bytes) else None for content in contents]

    def size(self, name: str) -> int | None:
        """Return the size of a file; None if it is not there."""
        with self._told("read"), suppress(FileNotFoundError, NotADirectoryError):
            if self.is_local:
                return Path(self._path(name)).stat().st_size
            return int(self._files.info(self._path(name))["size"])
        return None

    def _path(self, name: str) -> str:
        return os.path.join(self.root, *name.split("/")) if self.is_local else f"{self.root}/{name}"

    def _made(self, path: Path, write: Callable[[Path], object]) -> tuple[str, int]:
        """Let ``write`` make a file; return its digest and its size."""
        try:
            write(path)
            return _digest(path)
        except StoreError:
            raise
        except OSError as error:
            raise _trouble(error, self.place) from error

    def _put(self, path: Path, name: str) -> None:
        """Move a whole file to its name; no reader ever sees a part of it."""
        target = self._path(name)
        with self._told():
            if self.is_local:
                folder = Path(target).parent
                self._inside(folder)  # before anything is made there
                folder.mkdir(parents=True, exist_ok=True)
                _flush(path)
                os.replace(path, target)
            elif self._at_once:
                self._files.put_file(str(path), target)
            else:
                half = f"{self.root}/{INCOMING}/{os.path.basename(path.parent)}"
                self._files.makedirs(f"{self.root}/{INCOMING}", exist_ok=True)
                self._files.makedirs(target.rpartition("/")[0], exist_ok=True)
                self._files.put_file(str(path), half)
                self._files.mv(half, target)

    def _inside(self, folder: Path) -> None:
        """Refuse a link that leads out of the store."""
        real = os.path.realpath(folder)
        if os.path.commonpath([real, self.root]) != self.root:
            raise StoreError(errno.EPERM, f"{folder} is a link that leads out of the results", real)

    @contextmanager
    def _scratch(self) -> Iterator[str]:
        """Make a folder for half-written files: within the store, if it is local."""
        home = os.path.join(self.root, INCOMING) if self.is_local else None
        try:
            if home is not None:
                os.makedirs(home, exist_ok=True)
            folder = tempfile.mkdtemp(prefix="part-", dir=home)
        except OSError as error:
            raise _trouble(error, self.place) from error
        try:
            yield folder
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    @contextmanager
    def _told(self, done: str = "written") -> Iterator[None]:
        """Turn what a file system raises into a StoreError."""
        try:
            yield
        except StoreError:
            raise
        except Exception as error:  # remote file systems raise anything
            raise _trouble(error, self.place, done) from error


def lock_file(file: IO[bytes]) -> bool:
    """Lock a file until it is closed or its process ends; False if another one has it."""
    try:
        import fcntl
    except ImportError:  # Windows: two runs at a time are not told apart there
        return True
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def _trouble(error: Exception, place: str, done: str = "written") -> StoreError:
    number = getattr(error, "errno", None) or errno.EIO
    reason = getattr(error, "strerror", None) or f"{type(error).__name__}: {error}"
    return StoreError(number, f"results cannot be {done}: {reason}", place)


def _content(path: str) -> bytes | None:
    with suppress(FileNotFoundError, NotADirectoryError):
        return Path(path).read_bytes()
    return None


def _digest(path: Path) -> tuple[str, int]:
    sha, size = hashlib.sha256(), 0
    with path.open("rb") as file:
        while block := file.read(_BLOCK):
            sha.update(block)
            size += len(block)
    return sha.hexdigest(), size


def _flush(path: Path) -> None:
    """Wait until a file is on the disk, so that no record names what a power cut may take."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
