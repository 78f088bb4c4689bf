"""The examples draw what they say: the numbers in the figures are those of the definitions."""

import runpy
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import beltrami as bt
from cell_oracle import area, edge_cells, vertex_cells

EXAMPLES = Path(__file__).parents[1] / "examples"


@pytest.fixture(scope="module")
def figures():
    return runpy.run_path(str(EXAMPLES / "ring_and_cells.py"))


def angle(x, at, a, b):
    u, v = x[a] - x[at], x[b] - x[at]
    return np.arccos(u @ v / np.linalg.norm(u) / np.linalg.norm(v))


def opened(path):
    with Image.open(path) as picture:
        return np.asarray(picture).astype(int)


@pytest.mark.chapter("F3.2")
def test_the_ring_shows_the_angles_that_face_the_edge(figures, tmp_path, monkeypatch):
    written = []
    label = figures["Canvas"].label

    def noted(self, point, text, *rest):
        written.append(text)
        label(self, point, text, *rest)

    monkeypatch.setattr(figures["Canvas"], "label", noted)
    mesh, j = figures["ring"](), 2
    angles, weights = figures["draw_ring"](mesh, j, tmp_path / "ring.png")
    x = mesh.vertices
    assert angles == pytest.approx({1: angle(x, 1, 0, j), 3: angle(x, 3, 0, j)}, abs=1e-12)
    for name, value in zip(("α", "β"), angles.values(), strict=True):
        assert f"{name}\n{np.degrees(value):.1f}°" in written
    at_j = [angle(x, j, 0, k) for k in angles]  # the printed reading (E17)
    assert abs(np.array(at_j) - list(angles.values())).min() > 0.05
    for k, w in weights.items():
        facing = [angle(x, v, 0, k) for v in (k % 7 + 1, (k - 2) % 7 + 1)]
        assert w == pytest.approx((1 / np.tan(facing)).sum() / 2, abs=1e-12)
        assert (w < 0) == (sum(facing) > np.pi)
        assert f"{w:.3f}".replace("-", "−") in written
    assert min(weights.values()) < 0


@pytest.mark.chapter("F3.4")
def test_the_cells_drawn_are_those_of_the_definitions(figures, tmp_path):
    mesh = figures["acute_patch"]()
    drawn = figures["draw_cells"](mesh, 0, 1, tmp_path / "cells.png")
    square = 4 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    nearest = [area(cell) for cell in vertex_cells(mesh.vertices, square)[:7]]  # inside the mesh
    np.testing.assert_allclose(drawn["vertex"][:7], nearest, rtol=1e-9)
    np.testing.assert_allclose(drawn["vertex"], bt.vertex_areas(mesh), rtol=1e-9)
    near_edges = edge_cells(mesh.vertices, mesh.faces)
    wanted = [near_edges[tuple(edge)] for edge in mesh.edges.tolist()]
    np.testing.assert_allclose(drawn["incenter"], wanted, rtol=1e-9)
    np.testing.assert_allclose(drawn["circumcenter"], bt.edge_areas(mesh), rtol=1e-9)
    for areas in drawn.values():
        assert areas.min() > 0
        assert areas.sum() == pytest.approx(mesh.area, rel=1e-12)
    assert not np.allclose(drawn["incenter"], drawn["circumcenter"], rtol=0.1)  # E21


def test_the_cells_cover_their_share_of_the_picture(figures, tmp_path):
    figures["main"](tmp_path)
    assert opened(tmp_path / "ring.png").shape == (470, 1040, 3)
    pixels = opened(tmp_path / "cells.png")
    dark = (abs(pixels - [0x6F, 0xA3, 0xCF]).max(axis=2) < 3).reshape(470, 3, 400)
    counts = dark.sum(axis=(0, 2))
    areas = figures["draw_cells"](figures["acute_patch"](), 0, 1, tmp_path / "again.png")
    mesh = figures["acute_patch"]()
    (e,) = np.flatnonzero((mesh.edges == (0, 1)).all(axis=1))
    shares = np.array([areas["vertex"][0], areas["incenter"][e], areas["circumcenter"][e]])
    ratio = counts / shares
    assert ratio.max() < 1.25 * ratio.min()  # the rest is under the ink
