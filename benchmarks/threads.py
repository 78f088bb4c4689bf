"""One thread for everybody: the goals are stated for one core."""

from __future__ import annotations

import os
import sys

VARIABLES = (
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "NUMBA_NUM_THREADS",
    "VTK_SMP_MAX_THREADS",
)


def one_thread() -> None:
    """Limit the numerical libraries to one thread, here and in the processes started from here.

    Raises
    ------
    RuntimeError
        If numpy is loaded already: its BLAS would have counted the cores by then.
    """
    if "numpy" in sys.modules:
        raise RuntimeError("numpy is loaded before the threads are limited: call this first")
    os.environ.update(dict.fromkeys(VARIABLES, "1"))


def thread_settings() -> str:
    """Tell the settings as they are now, for the report."""
    return ", ".join(f"{name}={os.environ.get(name, 'not set')}" for name in VARIABLES)
