"""The index page of a tour in a real Chromium: pictures load, nothing is fetched, phones fit."""

import json
import re
import subprocess
from html import unescape
from pathlib import Path

import pytest

from browsers import FLAGS as COMMON
from browsers import chromium

pytestmark = pytest.mark.browser

FLAGS = ("--headless", "--disable-gpu", *COMMON)
# Put into a copy of the page: when all is loaded, what there is is written where --dump-dom sees.
PROBE = """<script>addEventListener("load", () => {
  const told = document.createElement("output");
  told.id = "told";
  told.textContent = JSON.stringify({
    widths: [...document.images].map(image => image.naturalWidth),
    overflow: document.documentElement.scrollWidth - document.documentElement.clientWidth,
    missing: [...document.querySelectorAll("nav a")].filter(
      link => !document.querySelector(link.hash)).length,
  });
  document.body.append(told);
});</script>"""


def visit(page: Path, folder: Path, width: int):
    """Load the page; return what the probe tells, and each address that it asked for."""
    probed = page.with_name("probed.html")
    probed.write_text(page.read_text("utf-8").replace("</body>", PROBE + "</body>"), "utf-8")
    log = folder / "net.json"
    done = subprocess.run(
        [
            chromium(),
            *FLAGS,
            f"--user-data-dir={folder / 'profile'}",
            f"--window-size={width},900",
            f"--log-net-log={log}",
            "--dump-dom",
            probed.as_uri(),
        ],
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    told = re.search(r'<output id="told">(.*?)</output>', done.stdout)
    assert told, done.stderr[-2000:]
    return json.loads(unescape(told[1])), asked_by_pages(log)


def asked_by_pages(log: Path):
    """Return the addresses that pages asked for; the browser's own requests have no origin."""
    events = [event.get("params", {}) for event in json.loads(log.read_text("utf-8"))["events"]]
    requests = [one for one in events if one.get("initiator", "not an origin") != "not an origin"]
    return {one["url"] for one in requests if not one["url"].startswith("file:")}


@pytest.fixture
def page(beltrami, sphere, tmp_path):
    assert beltrami("tour", sphere, "-o", tmp_path / "tour").exit_code == 0
    return tmp_path / "tour" / "index.html"


@pytest.mark.parametrize("width", [1280, 500])
def test_the_page_is_whole_and_alone(page, tmp_path, width):
    told, asked = visit(page, tmp_path, width)
    assert len(told["widths"]) >= 6
    assert min(told["widths"]) > 100
    assert told["overflow"] <= 0
    assert told["missing"] == 0
    assert not asked
    assert "<script" not in page.read_text("utf-8")


def test_the_test_sees_a_broken_picture_and_a_request(page, tmp_path):
    text = page.read_text("utf-8")
    evil = '<img src="http://127.0.0.1:9/a.png"><img src="gone.png"></body>'
    page.write_text(text.replace("</body>", evil), "utf-8")
    told, asked = visit(page, tmp_path, 1280)
    assert told["widths"][-2:] == [0, 0]
    assert "http://127.0.0.1:9/a.png" in asked
