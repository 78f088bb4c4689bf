"""Firefox, driven by its own protocol (WebDriver BiDi), on a screen that nobody sees (Xvfb).

Playwright wants a Firefox that it patched; this one is that of the system, such as Debian's.
"""

import base64
import contextlib
import io
import json
import os
import re
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

_PREFERENCES = {
    "webgl.force-enabled": True,  # without a graphics card
    "browser.shell.checkDefaultBrowser": False,
    "datareporting.policy.dataSubmissionEnabled": False,
    "toolkit.telemetry.reportingpolicy.firstRun": False,
    "network.captive-portal-service.enabled": False,
    "network.connectivity-service.enabled": False,
}


def _found(*names):
    for name in filter(None, names):
        if path := shutil.which(name):
            return path
    return pytest.fail(f"{names[-1]} is not installed: Debian has packages firefox-esr and xvfb")


@contextlib.contextmanager
def firefox(folder):
    """Give a ``Window``; ``folder`` takes its profile."""
    from websockets.sync.client import connect

    with contextlib.ExitStack() as stack:
        display = stack.enter_context(_screen())
        profile = tempfile.mkdtemp(dir=folder)
        with open(f"{profile}/user.js", "w", encoding="utf-8") as file:
            for name, value in _PREFERENCES.items():
                file.write(f"user_pref({json.dumps(name)}, {json.dumps(value)});\n")
        program = _found(os.environ.get("BELTRAMI_FIREFOX"), "firefox", "firefox-esr")
        command = [program, "--remote-debugging-port=0", "--no-remote", "--profile", profile]
        told = stack.enter_context(open(f"{profile}/told.txt", "w", encoding="utf-8"))
        options = {"env": os.environ | {"DISPLAY": display}, "stderr": told}
        process = stack.enter_context(_running(command, **options))
        address = _address(process, f"{profile}/told.txt")
        yield Window(stack.enter_context(connect(f"{address}/session", max_size=None, proxy=None)))


def _address(process, file):
    """Wait until Firefox says where it listens: in a file, as a full pipe would halt it."""
    told = ""
    for _ in range(600):
        told = Path(file).read_text("utf-8")
        if found := re.search(r"BiDi listening on (ws://\S+)\n", told):
            return found[1]
        if process.poll() is not None:
            break
        time.sleep(0.1)
    return pytest.fail(f"Firefox does not listen: {told[-500:]}")


@contextlib.contextmanager
def _running(command, **options):
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, text=True, **options) as process:
        try:
            yield process
        finally:
            process.terminate()


@contextlib.contextmanager
def _screen():
    """Give the name of a new screen."""
    read, write = os.pipe()
    size = ["-screen", "0", "1400x1000x24"]
    command = [_found("Xvfb"), "-displayfd", str(write), *size, "-nolisten", "tcp"]
    with _running(command, pass_fds=[write], stderr=subprocess.DEVNULL):
        os.close(write)
        with os.fdopen(read) as told:
            name = told.readline().strip()
        yield f":{name}"


class Window:
    """One tab of a running Firefox."""

    def __init__(self, socket):
        self.socket, self.count, self.events = socket, 0, []
        self.do("session.new", capabilities={})
        self.do("session.subscribe", events=["log.entryAdded", "network.beforeRequestSent"])
        self.tab = self.do("browsingContext.getTree")["contexts"][0]["context"]

    def do(self, method, **parameters):
        """Send a command; return its result, and keep what happens in between."""
        self.count += 1
        self.socket.send(json.dumps({"id": self.count, "method": method, "params": parameters}))
        while True:
            told = json.loads(self.socket.recv(timeout=60))
            if told["type"] == "event":
                self.events.append(told)
            elif told["id"] == self.count:
                assert told["type"] == "success", told
                return told["result"]

    def open(self, file, width=1100, height=700):
        """Show a file, and wait until it says that it is ready."""
        self.events.clear()
        size = {"width": width, "height": height}
        self.do("browsingContext.setViewport", context=self.tab, viewport=size)
        self.do("browsingContext.navigate", context=self.tab, url=file.as_uri(), wait="complete")
        for _ in range(200):
            if self.js("document.getElementById('waiting').hidden"):
                return
            time.sleep(0.05)
        pytest.fail(self.js("document.getElementById('waiting').textContent"))

    def js(self, expression):
        """Return what JavaScript makes of an expression, which may be a promise."""
        wrapped = f"(async () => JSON.stringify((await ({expression})) ?? null))()"
        target = {"context": self.tab}
        told = self.do(
            "script.evaluate", expression=wrapped, target=target, awaitPromise=True
        )  # fmt: skip
        assert told["type"] == "success", told["exceptionDetails"]["text"]
        return json.loads(told["result"]["value"])

    def screenshot(self):
        """Return the pixels of the window, (h, w, 3)."""
        told = self.do("browsingContext.captureScreenshot", context=self.tab)
        with Image.open(io.BytesIO(base64.b64decode(told["data"]))) as image:
            return np.asarray(image.convert("RGB"), dtype=int)

    def drag(self, start, end):
        """Press at a place of the window, move, and release; a click where nothing moves."""
        moves = [{"type": "pointerMove", "x": int(x), "y": int(y)} for x, y in (start, end)]
        down, up = ({"type": kind, "button": 0} for kind in ("pointerDown", "pointerUp"))
        mouse = {"type": "pointer", "id": "mouse", "actions": [moves[0], down, moves[1], up]}
        self.do("input.performActions", context=self.tab, actions=[mouse])

    def complaints(self):
        """Return what stands in the console, and what was asked of the network."""
        told = [event["params"] for event in self.events]
        asked = [one["request"]["url"] for one in told if "request" in one]
        return [one["text"] for one in told if "text" in one] + [
            url for url in asked if not url.startswith(("file:", "data:", "blob:"))
        ]
