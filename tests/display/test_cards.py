import base64
import io
import re
import subprocess
import sys
from html.parser import HTMLParser

import numpy as np
import pytest
from hypothesis import given, settings
from PIL import Image

import beltrami as bt
from beltrami.display import cards
from beltrami.display.sketches import sparsity_sketch, spectrum_sketch
from strategies import any_meshes

VOID = {"img", "br"}


class Card(HTMLParser):
    """The cells of a card; fails if a tag is not closed."""

    def __init__(self, text):
        super().__init__()
        self.open, self.cells, self.pictures = [], [], []
        self.feed(text)
        assert not self.open
        self.rows = dict(zip(self.cells[::2], self.cells[1::2], strict=True))

    def handle_starttag(self, tag, attributes):
        assert tag in {"div", "img", "strong", "table", "tr", "td"}
        if tag not in VOID:
            self.open.append(tag)
        if tag == "td":
            self.cells.append("")
        if tag == "img":
            self.pictures.append(dict(attributes))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, text):
        if self.open[-1] == "td":
            self.cells[-1] += text


def noisy_blob():
    mesh = bt.shapes.blob(500)
    noise = np.random.default_rng(0).normal(size=(mesh.n_vertices, 1))
    return mesh.with_vertices(mesh.vertices + 0.01 * noise * mesh.vertex_normals)


THINGS = {
    "Mesh": lambda: bt.shapes.torus(),
    "Laplacian": lambda: bt.laplacian(bt.shapes.icosphere(2)),
    "FourierBasis": lambda: bt.fourier_basis(bt.laplacian(bt.shapes.icosphere(2)), 20),
    "Parameterization": lambda: bt.parameterize(bt.shapes.icosphere(2)),
    "TextureAtlas": lambda: bt.atlas(bt.shapes.icosphere(2)),
    "Denoised": lambda: bt.denoise(noisy_blob()),
    "Diagnosis": lambda: bt.diagnose(bt.shapes.torus()),
}


@pytest.fixture(scope="module")
def things():
    return {name: make() for name, make in THINGS.items()}


@pytest.mark.parametrize("name", THINGS)
def test_each_card_has_its_name_its_lines_and_its_picture(things, name):
    thing = things[name]
    text, png = thing._repr_html_(), thing._repr_png_()
    card = Card(text)
    assert f"<strong>{name}</strong>" in text
    assert len(card.cells) >= 8
    assert "http" not in text
    if name == "Diagnosis":
        assert png is None
        assert not card.pictures
        return
    with Image.open(io.BytesIO(png)) as picture:
        assert picture.mode == "RGBA"
        assert picture.getchannel("A").getextrema() == (0, 255)
    inside = card.pictures[0]["src"].removeprefix("data:image/png;base64,")
    assert base64.b64decode(inside) == png
    assert len(text) < 150_000


def test_what_the_cards_say_is_what_the_objects_hold(things):
    said = {name: Card(thing._repr_html_()).rows for name, thing in things.items()}
    torus, pair, basis = (things[name] for name in ("Mesh", "Laplacian", "FourierBasis"))
    assert said["Mesh"]["faces"] == str(torus.n_faces)
    assert said["Mesh"]["surface"] == "closed, genus 1"
    assert said["Laplacian"]["matrices"] == f"162 × 162, {pair.stiffness.nnz} entries"
    assert said["Laplacian"]["weights"] == "cotangent, 0 of 480 negative"
    assert said["Laplacian"][""] == "positive semi-definite"
    assert said["FourierBasis"]["eigenvalues"] == f"0 to {basis.eigenvalues[-1]:.4g}"
    assert said["Parameterization"]["bijection"] == "yes, decided exactly"
    assert f"σ = {things['Denoised'].sigma:.3g}" in said["Denoised"]["noise"]
    assert any("no defects" in cell for cell in Card(things["Diagnosis"]._repr_html_()).cells)


def test_a_folded_map_says_no():
    flat = bt.shapes.disk(14)
    bump = 3 * np.exp(-6 * ((flat.vertices - [0.35, 0.15]) ** 2).sum(axis=1))
    psi = bt.flatten(bt.Mesh(np.column_stack([flat.vertices, bump]), flat.faces))
    rows = Card(psi._repr_html_()).rows
    assert rows["bijection"] == "NO"
    assert rows["flipped faces"] == str(len(psi.flipped)) != "0"


def test_the_sparsity_of_a_band_is_a_band():
    order = np.arange(1000)
    picture = sparsity_sketch(np.r_[order[1:], order], np.r_[order[:-1], order], 1000)
    i, j = np.indices(picture.shape[:2])
    alpha = picture[..., 3]
    assert alpha.diagonal().min() > 90
    assert alpha[abs(i - j) > 1].max() == 0
    assert alpha[i == j - 1].max() == 0  # the entries are below the diagonal


def test_the_spectrum_rises_to_the_right():
    picture = spectrum_sketch(np.arange(100.0), size=(100, 100))
    heights = (picture[..., 3] > 0).sum(axis=0)
    assert abs(heights - np.arange(1, 101)).max() <= 1
    assert picture[-1, :, 3].min() == 255  # the columns stand on the ground
    assert spectrum_sketch(np.zeros(3)) is None


@given(mesh=any_meshes())
@settings(max_examples=15)
def test_no_mesh_and_no_diagnosis_is_refused(mesh):
    rows = Card(mesh._repr_html_()).rows
    assert rows["faces"] == str(mesh.n_faces)
    bad = (~np.isfinite(mesh.vertices).all(axis=1)).sum()
    assert ("not finite" in rows) == (bad > 0)
    found = bt.diagnose(mesh)
    assert Card(found._repr_html_()).cells.count("✗") == len(found.defects)


@pytest.mark.parametrize(
    ("mesh", "surface"),
    [
        (bt.Mesh([], np.zeros((0, 3), int)), "none"),
        (bt.Mesh(np.eye(5), [[0, 1, 2]]), "boundary of 1 loop, genus 0"),
        (bt.Mesh(np.eye(3), [[0, 1, 2], [0, 1, 2], [0, 1, 2]]), "not manifold: see"),
    ],
)
def test_odd_meshes_are_told(mesh, surface):
    assert Card(mesh._repr_html_()).rows["surface"].startswith(surface)


def test_large_meshes_are_not_examined(monkeypatch):
    monkeypatch.setattr(cards, "_EXAMINED", 100)
    mesh = bt.shapes.icosphere(2)
    assert "large" in Card(mesh._repr_html_()).rows["surface"]
    assert "half_edges" not in vars(mesh.topology)


def test_names_from_files_are_no_html():
    mesh = bt.shapes.icosphere(1).with_data(**{"<script>alert(1)</script>": np.zeros(42)})
    assert "<script" not in mesh._repr_html_()
    assert Card(mesh._repr_html_()).rows["data"] == "<script>alert(1)</script>"


@pytest.mark.parametrize(
    "color",
    [
        np.full((42, 3), 0.5),
        np.full((42, 4), 200, np.uint8),
        np.full((42, 3), np.nan),
        np.full((42, 3), 1e9),
        np.full(42, 3),
        np.full((42, 2), 0.5),
    ],
)
def test_colours_of_any_kind(color):
    assert bt.shapes.icosphere(1).with_data(color=color)._repr_png_() is not None


def test_notebooks_choose_the_card():
    formatters = pytest.importorskip(
        "IPython.core.formatters", reason="IPython is not installed: make test-neighbours"
    )
    shown, _ = formatters.DisplayFormatter().format(bt.shapes.icosphere(1))
    assert re.search(r"<td[^>]*>42, 3 coordinates each", shown["text/html"])
    assert shown["image/png"][:4] == b"\x89PNG"
    assert shown["text/plain"] == "<Mesh: 42 vertices in R³, 80 faces>"


def test_nothing_is_loaded_before_something_is_shown():
    code = (
        "import sys, beltrami; mesh = beltrami.shapes.icosphere(1)\n"
        "print('beltrami.display.cards' in sys.modules)\n"
        "mesh._repr_html_()\n"
        "print('beltrami.display.cards' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "True"]
