"""Ctrl-C is heard, even where Python loses it."""

from __future__ import annotations

import _thread
import sys
import threading
from typing import Any

_AGAIN = 0.1  # seconds


def hear_again(unraisable: Any) -> None:
    """Interrupt once more if an interrupt fell where no exception can be raised.

    That is in a callback from C or in a destructor, such as those that run while kernels are
    loaded: Python writes "Exception ignored" and goes on. To be used as ``sys.unraisablehook``.
    """
    if not issubclass(unraisable.exc_type, KeyboardInterrupt):
        sys.__unraisablehook__(unraisable)
        return
    timer = threading.Timer(_AGAIN, _thread.interrupt_main)
    timer.daemon = True
    timer.start()
