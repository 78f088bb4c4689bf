"""The page in a real Firefox: another engine, another compiler of shaders, the same numbers."""

import numpy as np
import pytest

from beltrami.diffusion.heat import heat
from beltrami.display.page import page as write_page
from beltrami.mesh.shapes import blob
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.fourier_basis import fourier_basis
from firefox import firefox

pytestmark = pytest.mark.firefox

MODES = 16
PICTURE = np.zeros((8, 8, 3))
PICTURE[:4, :, 0] = PICTURE[4:, :, 1] = 0.9  # red above green
FRAMES = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"


@pytest.fixture(scope="module")
def shape():
    return blob(1000)


@pytest.fixture(scope="module")
def file(shape, tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "blob.html"
    f = {"square": shape.vertices[:, 0] ** 2}
    write_page(shape, path, f, modes=MODES, up="z", texture=PICTURE)
    return path


@pytest.fixture(scope="module")
def window(tmp_path_factory):
    with firefox(tmp_path_factory.mktemp("profile")) as opened:
        yield opened


@pytest.fixture
def visit(window, file):
    window.open(file)
    yield window
    assert window.complaints() == []


def values(visit):
    numbers = visit.js("Array.from(beltrami.app.data.numbers)")
    found = np.empty(len(numbers))
    found[numbers] = visit.js("Array.from(beltrami.values())")
    return found


def test_every_panel_is_drawn(visit):
    for panel in visit.js("beltrami.app.panels.map((panel) => panel.id)"):
        visit.js(f"(beltrami.open('{panel}'), {FRAMES})")
        stage = visit.screenshot()[150:600, :700]
        assert 0.01 < (np.abs(stage - 255).max(axis=2) > 20).mean() < 0.7
        assert "NaN" not in visit.js("document.querySelector('main').innerText")


def test_heat_is_that_of_the_library(visit, shape):
    pair = laplacian(shape)
    basis = fourier_basis(pair, MODES)
    f = shape.vertices[:, 0] ** 2
    visit.js("beltrami.open('heat')")
    choose = "(id, x) => { const e = document.getElementById(id); e.value = x; return e; }"
    told = "dispatchEvent(new Event"
    visit.js(f"(({choose})('heat-source', '2')).{told}('change'))")
    visit.js(f"(({choose})('heat-time', -1.2)).{told}('input'))")
    t = visit.js("beltrami.app.panel.state.time")
    truth = heat(pair, f, t, "spectral", basis=basis, tolerance=1.0)
    steps = np.array(visit.js("beltrami.app.spectrum.steps"))
    bound = np.abs(np.exp(-t * basis.eigenvalues) * basis.forward(f)) @ steps / 2
    assert np.abs(values(visit) - truth).max() <= bound + 1e-5 * np.abs(truth).max()
    assert np.abs(truth).max() > 20 * bound


def test_a_click_chooses_a_point_and_a_drag_turns(visit):
    visit.js("(beltrami.open('heat'), " + FRAMES + ")")
    seen = visit.screenshot()[150:550, :700]
    rows, columns = np.nonzero(np.abs(seen - 255).max(axis=2) > 20)
    middle = len(rows) // 2
    place = columns[middle], 150 + rows[middle]
    marked = visit.js("beltrami.app.marked")
    visit.drag(place, place)
    assert visit.js("beltrami.app.marked") != marked
    azimuth = visit.js("beltrami.app.camera.azimuth")
    visit.drag(place, (place[0] + 80, place[1]))
    assert visit.js("beltrami.app.camera.azimuth") != azimuth


def test_the_picture_lies_on_the_map(visit):
    visit.js("(beltrami.open('plane'), " + FRAMES + ")")
    seen = visit.screenshot()[120:, 370:710]
    disk = np.abs(seen - 255).max(axis=2) > 20
    rows = np.flatnonzero(disk[150:450].any(axis=1)) + 150
    column = disk[rows].any(axis=0).nonzero()[0]
    middle = (column.min() + column.max()) // 2
    upper, lower = (seen[rows.min() + part * np.ptp(rows) // 4, middle] for part in (1, 3))
    assert upper[0] > 200 > 60 > upper[1]
    assert lower[1] > 200 > 60 > lower[0]


def test_a_page_asks_for_nothing(visit):
    refused = visit.js(
        "new Promise((done) => {"
        "document.addEventListener('securitypolicyviolation', (e) => done(e.effectiveDirective));"
        "fetch('http://127.0.0.1:9/').catch(() => 0); })"
    )
    assert refused == "connect-src"


def test_a_firefox_that_ends_is_no_riddle(tmp_path, monkeypatch):
    monkeypatch.setenv("BELTRAMI_FIREFOX", "false")
    with pytest.raises(pytest.fail.Exception, match="does not listen"), firefox(tmp_path):
        pass


def test_no_proxy_stands_between(monkeypatch, tmp_path):
    monkeypatch.setenv("http_proxy", "http://127.0.0.1:9")
    monkeypatch.setenv("https_proxy", "http://127.0.0.1:9")
    monkeypatch.delenv("no_proxy", raising=False)
    monkeypatch.delenv("NO_PROXY", raising=False)
    with firefox(tmp_path) as opened:
        assert opened.js("1 + 1") == 2
