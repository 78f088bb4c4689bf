"""load: a mesh by its name, from a local folder or fetched once into the user's cache."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path
from typing import Final

from beltrami._optional import require
from beltrami.datasets.registry import Dataset, describe
from beltrami.errors import DatasetError
from beltrami.io.registry import read_mesh
from beltrami.mesh.mesh import Mesh

LOCAL: Final = "BELTRAMI_DATA"
_PATIENCE = 30.0  # seconds without an answer


def load(name: str) -> Mesh:
    """Return the mesh of a data set; ``fetch`` says where it comes from, and what is raised.

    ``describe(name)`` tells its licence, its author and its facts.

    Examples
    --------
    >>> import beltrami as bt
    >>> bt.datasets.load("spott")
    Traceback (most recent call last):
        ...
    beltrami.errors.UnknownNameError: unknown data set 'spott': choose one of ... mean 'spot'?
    """
    return read_mesh(fetch(name))


def fetch(name: str) -> Path:
    """Return the file of a data set, with the digest of the registry.

    Where the environment variable BELTRAMI_DATA names a folder, the file is taken from there and
    nothing is fetched. Otherwise it is in the user's cache, fetched by pooch (extra ``data``) when
    it is first asked for; a file there that was changed is fetched again.

    Raises
    ------
    UnknownNameError
        If there is no such data set.
    DatasetError
        If the file is not in the folder of BELTRAMI_DATA, or cannot be fetched, or is not the one
        of the registry; the error says where to put it by hand (``error.path``).
    MissingExtraError
        If the file has to be fetched and pooch is not installed.
    """
    dataset = describe(name)
    local = os.environ.get(LOCAL)
    return _in_folder(dataset, Path(local)) if local else _in_cache(dataset)


def _in_folder(dataset: Dataset, folder: Path) -> Path:
    place = folder / dataset.file
    if not place.is_file():
        raise DatasetError(
            f"the data set {dataset.name!r} is not in the folder of {LOCAL}: put "
            f"{dataset.url} there, as {place}, or unset the variable",
            place,
        )
    digest = hashlib.sha256(place.read_bytes()).hexdigest()
    if digest != dataset.sha256:
        raise DatasetError(
            f"{place} is not the file of the data set {dataset.name!r}: its SHA-256 is {digest}, "
            f"and that of {dataset.url} is {dataset.sha256}",
            place,
        )
    return place


def _in_cache(dataset: Dataset) -> Path:
    pooch = require("pooch", "data", f"fetching {dataset.file}")
    folder = Path(pooch.os_cache("beltrami"))
    try:
        found = pooch.retrieve(
            dataset.url,
            f"sha256:{dataset.sha256}",
            fname=dataset.file,
            path=folder,
            downloader=pooch.HTTPDownloader(timeout=_PATIENCE, stream=False),  # closes it, too
        )
    except (OSError, ValueError) as cause:  # no network, no such page; another file came
        place = folder / dataset.file
        reason = " ".join(f"{type(cause).__name__}: {cause}".split())
        raise DatasetError(
            f"cannot fetch {dataset.file} of the data set {dataset.name!r} ({reason}). Put "
            f"{dataset.url} there by hand, as {place}, or into a folder named by {LOCAL}",
            place,
        ) from cause
    return Path(found)
