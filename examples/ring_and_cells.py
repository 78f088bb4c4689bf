"""Figures 3.2 and 3.4: the angles of the cotangent weights, and the cells of vertices and edges.

python examples/ring_and_cells.py FOLDER
"""

import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib import get_data_path
from PIL import Image, ImageDraw

import beltrami as bt
from beltrami.display.framing import fit_camera
from beltrami.display.text import load_font

INK, BLUE, ORANGE, RED, PAPER = "#0d0d12", "#2166ac", "#c8590a", "#b2182b", "#f4f1ea"
FINE = 3  # drawn so many times larger, then made small: smooth lines


class Cells(NamedTuple):
    """Triangles that together are cells: (q, 3, 2) corners, and the cell of each."""

    corners: np.ndarray
    owner: np.ndarray

    def areas(self, n: int) -> np.ndarray:
        """(n,) signed areas of the cells."""
        u, v = (self.corners[:, k] - self.corners[:, 0] for k in (1, 2))
        return np.bincount(self.owner, u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0], n) / 2


class Canvas:
    """One panel: a planar mesh coloured by the library's rasteriser, with ink on top."""

    def __init__(self, mesh, colors, camera, title, size=(520, 470)):
        self.size = tuple(FINE * s for s in size)
        self.camera = camera
        image = bt.render(
            mesh, colors, size=self.size, camera=camera, level_set=None, colorbar=False, antialias=1
        )
        self.image = Image.fromarray(image)
        self.ink = ImageDraw.Draw(self.image)
        self.ink.text((self.size[0] / 2, 20 * FINE), title, INK, self.font(17), "mm")

    def font(self, size):
        """Load the font that matplotlib brings, which has Greek letters and indices."""
        return load_font(Path(get_data_path(), "fonts", "ttf", "DejaVuSans.ttf"), FINE * size)

    def place(self, points):
        """Pixels of points of the plane."""
        points = np.atleast_2d(points)
        return self.camera.project(np.c_[points, np.zeros(len(points))], self.size)[:, :2]

    def line(self, points, color=INK, width=1.0):
        """Draw a line through points of the plane."""
        flat = [tuple(p) for p in self.place(points)]
        self.ink.line(flat, color, round(FINE * width), joint="curve")

    def dot(self, point, color=INK, radius=4.0):
        """Draw a disk around a point."""
        self.ink.circle(tuple(self.place(point)[0]), FINE * radius, color)

    def label(self, point, text, color=INK, size=16):
        """Write at a point."""
        at = tuple(self.place(point)[0])
        paper = {"stroke_width": 3 * FINE, "stroke_fill": "white"}
        self.ink.text(at, text, color, self.font(size), "mm", **paper)

    def foot(self, text, row=0):
        """Write below the drawing."""
        at = (self.size[0] / 2, self.size[1] - FINE * (38 - 21 * row))
        self.ink.text(at, text, INK, self.font(15), "mm")

    def picture(self):
        """Return the panel in its final size."""
        return self.image.resize([s // FINE for s in self.size], Image.Resampling.BOX)


def rgb(color):
    """Turn a colour like "#2166ac" into three numbers in [0, 1]."""
    return np.array([int(color[k : k + 2], 16) for k in (1, 3, 5)]) / 255


def side_by_side(canvases, path):
    """Write the panels as one picture."""
    pictures = [np.asarray(canvas.picture()) for canvas in canvases]
    Image.fromarray(np.concatenate(pictures, axis=1)).save(path)


# ---------------------------------------------------------------- figure 3.2


def ring() -> bt.Mesh:
    """Make a vertex 0 with seven neighbours around it, one of them far away."""
    turn = np.radians([8, 62, 108, 163, 215, 262, 318])
    reach = np.array([0.9, 1.0, 1.3, 0.95, 1.4, 0.8, 0.9])
    rim = reach[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    k = np.arange(1, 8)
    return bt.Mesh(np.vstack([[0, 0], rim]), np.stack([0 * k, k, k % 7 + 1], axis=1))


def facing(mesh: bt.Mesh, i: int, j: int) -> list[tuple[int, int, float]]:
    """Each face of the edge (i, j), the vertex that faces the edge there, and its angle (E17)."""
    found = []
    for f in np.intersect1d(mesh.face_ring(i), mesh.face_ring(j)):
        (c,) = np.flatnonzero(~np.isin(mesh.faces[f], (i, j)))
        found.append((int(f), int(mesh.faces[f, c]), float(mesh.corner_angles[f, c])))
    return found


def draw_ring(mesh: bt.Mesh, j: int, path: Path) -> tuple[dict[int, float], dict[int, float]]:
    """Draw figure 3.2; return the angles drawn, by vertex, and the weights drawn, by neighbour.

    Left, the two angles that face the edge (0, j); right, the weights of all edges at 0.

    Chapter items: F3.2.
    """
    camera, x = fit_camera(mesh), mesh.vertices
    pair = facing(mesh, 0, j)
    apart = bt.Mesh(x[mesh.faces].reshape(-1, 2), np.arange(3 * mesh.n_faces).reshape(-1, 3))
    tint = np.tile(rgb(PAPER), (mesh.n_faces, 1))
    for (f, _, _), color in zip(pair, (BLUE, ORANGE), strict=True):
        tint[f] = 0.75 + 0.25 * rgb(color)
    left = Canvas(apart, np.repeat(tint, 3, axis=0), camera, "The angles that face the edge (i, j)")
    right = Canvas(mesh, np.tile(rgb(PAPER), (8, 1)), camera, "The weights of the edges at i")
    for canvas in (left, right):
        for edge in mesh.edges:
            canvas.line(x[edge])
    left.line(x[[0, j]], INK, 3.5)
    angles = {}
    names = zip(pair, ("α", "β"), ("k₁", "k₂"), (BLUE, ORANGE), strict=True)
    for (_, k, angle), name, corner, color in names:
        toward = np.array([x[0] - x[k], x[j] - x[k]])
        draw_angle(left, x[k], toward, f"{name}\n{np.degrees(angle):.1f}°", color)
        left.dot(x[k], color)
        left.label(1.13 * x[k], corner, color)
        angles[k] = angle
    left.label(x[0] - [0.16, -0.02], "i")
    left.label(1.1 * x[j], "j")
    W = bt.edge_weights(mesh, "cotangent").toarray()
    a, b = angles.values()
    left.foot(f"wᵢⱼ = (cot α + cot β) / 2 = {(1 / np.tan(a) + 1 / np.tan(b)) / 2:.3f}")
    weights = {int(k): float(W[0, k]) for k in mesh.ring(0)}
    for k, w in weights.items():
        color = BLUE if w >= 0 else RED
        right.line(x[[0, k]], color, 1 + 6 * abs(w))
        right.label(0.6 * x[k], f"{w:.3f}".replace("-", "−"), color)
    right.foot("Negative where the two angles add to more than 180°")
    for canvas in (left, right):
        canvas.dot(x[0])
    side_by_side([left, right], path)
    return angles, weights


def draw_angle(canvas, corner, sides, text, color):
    """Draw an arc between two sides, and its text on the bisector."""
    start, end = (np.arctan2(*side[::-1]) for side in sides)
    turn = (end - start + np.pi) % (2 * np.pi) - np.pi  # the short way
    t = start + turn * np.linspace(0, 1, 40)
    arc = np.stack([np.cos(t), np.sin(t)], axis=1)
    canvas.line(corner + 0.24 * arc, color, 3)
    canvas.label(corner + 0.43 * arc[20], text, color, 15)


# ---------------------------------------------------------------- figure 3.4


def acute_patch() -> bt.Mesh:
    """Make a planar mesh of 24 acute triangles, a little irregular, and so a Delaunay one.

    Their angles are about 75°, 60° and 45°, where the three centres are far apart.
    """
    sides = np.array([[1, 0], [0.37, 1.25], [-0.63, 1.25]])
    around = np.concatenate([sides, -sides])
    outer = np.stack([2 * around, around + np.roll(around, -1, axis=0)], 1).reshape(-1, 2)
    x = np.concatenate([[[0, 0]], around, outer])
    move = np.random.default_rng(34).uniform(-0.05, 0.05, x.shape)
    return bt.Mesh(x + move, bt.shapes.disk(2).topology)


def centers(mesh: bt.Mesh, kind: str) -> np.ndarray:
    """(m, 2) points c_f of the faces: the "circumcenter" or the "incenter"."""
    x = mesh.vertices[mesh.faces]
    if kind == "incenter":
        share = np.linalg.norm(np.roll(x, 1, axis=1) - np.roll(x, -1, axis=1), axis=2)
    else:
        share = np.sin(2 * mesh.corner_angles)
    return np.einsum("fc,fcd->fd", share / share.sum(axis=1, keepdims=True), x)


def vertex_cells(mesh: bt.Mesh) -> Cells:
    """Cells of the vertices: corner, middle of a side, circumcentre, in each face (definition 10).

    They are the nearest points where no face is obtuse; then the circumcentres lie inside.
    """
    x, c = mesh.vertices[mesh.faces], centers(mesh, "circumcenter")
    parts = []
    for k in range(3):
        a, b, z = x[:, k], x[:, (k + 1) % 3], x[:, (k + 2) % 3]
        parts += [np.stack([a, (a + b) / 2, c], 1), np.stack([a, c, (a + z) / 2], 1)]
    return Cells(np.concatenate(parts), np.repeat(mesh.faces.T, 2, axis=0).ravel())


def edge_cells(mesh: bt.Mesh, kind: str) -> Cells:
    """Cells of the edges: its two ends and the centre of the face, in each face.

    With the incentres they are the points nearest to the edge (definition 11); the areas of
    theorem 3 are those with the circumcentres (E21).
    """
    x, c = mesh.vertices[mesh.faces], centers(mesh, kind)
    parts = [np.stack([x[:, (k + 1) % 3], x[:, (k + 2) % 3], c], 1) for k in range(3)]
    return Cells(np.concatenate(parts), mesh.topology.face_edges.T.ravel())


def draw_cells(mesh: bt.Mesh, i: int, j: int, path: Path) -> dict[str, np.ndarray]:
    """Draw figure 3.4; return the areas of all the cells drawn, by the name of their centre.

    Left, the cells of the vertices; in the middle, those of the edges by definition 11; right,
    those of theorem 3. The cells of the vertex i and of the edge (i, j) are dark.

    Chapter items: F3.4.
    """
    camera = fit_camera(mesh)
    (e,) = np.flatnonzero((mesh.edges == sorted((i, j))).all(axis=1))
    drawn = {
        "vertex": ("Eᵢ: the points nearest to a vertex", "Aᵢ", vertex_cells(mesh), i),
        "incenter": ("Eₑ: the points nearest to an edge", "Aₑ", edge_cells(mesh, "incenter"), e),
        "circumcenter": ("The cells of theorem 3", "Aₑ", edge_cells(mesh, "circumcenter"), e),
    }
    canvases, areas = [], {}
    for name, (title, symbol, cells, marked) in drawn.items():
        number = mesh.n_vertices if name == "vertex" else mesh.topology.n_edges
        areas[name] = cells.areas(number)
        hue = bt.colouring(mesh.topology) if name == "vertex" else direction(mesh)
        canvas = Canvas(*coloured(cells, hue, marked), camera, title, (400, 470))
        kind = "incenter" if name == "incenter" else "circumcenter"
        ink_cells(canvas, mesh, cells, centers(mesh, kind))
        for v in (i,) if name == "vertex" else (i, j):
            canvas.dot(mesh.vertices[v], INK, 5)
        canvas.foot(f"{symbol} = {areas[name][marked]:.4f}, dots: the {kind}s")
        canvas.foot(f"all of them / area of the mesh = {areas[name].sum() / mesh.area:.6f}", row=1)
        canvases.append(canvas)
    side_by_side(canvases, path)
    return areas


def direction(mesh: bt.Mesh) -> np.ndarray:
    """(p,) 0, 1 or 2: towards which side of a hexagon an edge runs, so three in each face."""
    x, y = (mesh.vertices[mesh.edges[:, 1]] - mesh.vertices[mesh.edges[:, 0]]).T
    return np.round(np.arctan2(y, x) / (np.pi / 3)).astype(int) % 3


def coloured(cells: Cells, hue: np.ndarray, marked: int) -> tuple[bt.Mesh, np.ndarray]:
    """Return the triangles of the cells as a mesh, and a pale colour for each hue."""
    pale = np.array([rgb(c) for c in ("#dbe7f3", "#fbe3cf", "#e2efd9", "#f6dde3")])
    color = pale[hue]
    color[marked] = rgb("#6fa3cf")
    flat = bt.Mesh(cells.corners.reshape(-1, 2), np.arange(3 * len(cells.owner)).reshape(-1, 3))
    return flat, np.repeat(color[cells.owner], 3, axis=0)


def ink_cells(canvas: Canvas, mesh: bt.Mesh, cells: Cells, points: np.ndarray) -> None:
    """Draw the mesh in ink, the borders of the cells in orange, and the centres."""
    outside = {}
    for triangle, owner in zip(cells.corners.round(9), cells.owner, strict=True):
        for a, b in ((0, 1), (1, 2), (2, 0)):
            side = tuple(sorted((tuple(triangle[a]), tuple(triangle[b]))))
            outside.setdefault(side, set()).add(int(owner))
    for side, owners in outside.items():
        if len(owners) == 2:
            canvas.line(np.array(side), ORANGE, 1.6)
    for edge in mesh.edges:
        canvas.line(mesh.vertices[edge], INK, 1.0)
    for point in points:
        canvas.dot(point, ORANGE, 2.5)


def main(folder: str) -> None:
    """Draw both figures into a folder."""
    out = Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    draw_ring(ring(), 2, out / "ring.png")
    draw_cells(acute_patch(), 0, 1, out / "cells.png")


if __name__ == "__main__":
    main(sys.argv[1])
