"""Optional packages: imported when needed, missed with a clear error."""

from __future__ import annotations

import importlib
from typing import Any

from beltrami.errors import MissingExtraError


def require(package: str, extra: str, purpose: str) -> Any:
    """Import an optional package, or say which extra brings it.

    Raises
    ------
    MissingExtraError
        If the package is not installed.

    Examples
    --------
    >>> require("json", "io", "reading").__name__
    'json'
    """
    try:
        return importlib.import_module(package)
    except ImportError as cause:
        raise MissingExtraError(package, extra, purpose) from cause
