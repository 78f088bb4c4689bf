"""Where Chromium is, how it is started, and where node is."""

import os
import shutil

import pytest

FLAGS = (
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--host-resolver-rules=MAP * ~NOTFOUND",  # whatever the browser itself wants to know
)
WEBGL = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")  # without a graphics card


def chromium():
    names = (os.environ.get("BELTRAMI_CHROMIUM", ""), "chromium", "chromium-browser")
    found = next(filter(None, map(shutil.which, filter(None, names))), None)
    if found is None:
        pytest.fail("Chromium is not installed: install it, or name it in BELTRAMI_CHROMIUM")
    return found


def node():
    """Return the node that playwright brings, which needs no installation of its own."""
    from playwright._impl._driver import compute_driver_executable

    return compute_driver_executable()[0]
