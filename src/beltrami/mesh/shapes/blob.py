"""The blob: a swimming creature, at any resolution."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Booleans, Floats, Integers, read_only
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes.anatomy import LOWER, UPPER, pose, skin
from beltrami.mesh.shapes.implicit import field, project
from beltrami.mesh.shapes.parameters import whole
from beltrami.mesh.shapes.relaxation import flip_edges, relax, split_quads
from beltrami.mesh.shapes.subdivide import split_faces, with_midpoints
from beltrami.mesh.shapes.surface_nets import (
    crossed_cells,
    net_quads,
    net_vertices,
    well_composed,
)

SMALLEST = 500  # vertices; with fewer the neck has no longer three around it
LARGEST_BASE = 8000  # vertices of the mesh that is subdivided
FATTENING = 0.7  # of the shape, in grid steps, so that the grid sees its thin parts
SHRINKING = 8  # rounds of relaxation while the fat goes
SETTLING = 10  # rounds after that


def blob(n_vertices: int = 20_000) -> Mesh:
    """Model a swimming creature with a long neck: a closed surface of genus 0, at any resolution.

    The trunk, the slender neck, the head, the tail and the four paddles melt smoothly into
    each other. A crest runs along the back to the fluke of the tail; its sharp rim is a chain
    of edges at every resolution. The creature is about two units long, swims along +x with z
    up, and bends its neck to its left.

    Parameters
    ----------
    n_vertices
        How many vertices are wanted, 500 or more. With s the least number for which
        b = (n_vertices - 2) / 4^s + 2 is at most 8000, a mesh with about b vertices is made
        (within some per cent: the step of a grid decides) and s times cut into four: the
        result has exactly 4^s (b' - 2) + 2 vertices where b' is what b became.

    Returns
    -------
    Mesh
        Oriented outward, without boundary, the same on every call.

    Raises
    ------
    MeshError
        If ``n_vertices`` is not a whole number of at least 500.

    Notes
    -----
    The zero set of melted balls (``implicit``), symmetric about y = 0, fattened a little, is
    polygonised by surface nets with vertices on the plane of symmetry; while the fat is taken
    off, edge flips and tangential relaxation make the triangles regular. After subdivision the
    new vertices move to the zero set, and a smooth map bends the creature last. Cost: about
    two seconds for the base, then O(n).

    Examples
    --------
    >>> creature = blob(1000)
    >>> creature.n_faces == 2 * (creature.n_vertices - 2), 900 < creature.n_vertices < 1100
    (True, True)
    """
    steps, wanted = 0, whole("n_vertices", n_vertices, least=SMALLEST) - 2.0
    while wanted + 2 > LARGEST_BASE:
        steps, wanted = steps + 1, wanted / 4
    vertices, faces = _mirrored(*_half(wanted + 2))
    for _ in range(steps):
        n = len(vertices)
        faces, edges = split_faces(faces, n)
        vertices = with_midpoints(vertices, edges)
        vertices[n:] = project(vertices[n:], skin(), steps=2)
    return Mesh(read_only(pose(vertices)), read_only(faces))


def _half(wanted: float) -> tuple[Floats, Integers, Booleans]:
    """Mesh the half y >= 0 at rest; the last result marks the vertices on the plane y = 0."""
    vertices, quads, bound, h = _net(wanted)
    faces = split_quads(vertices, quads)
    for i in range(SHRINKING + SETTLING):
        level = FATTENING * h * max(0.0, 1 - i / SHRINKING)
        vertices = project(vertices, skin(), 3, level)
        faces = flip_edges(vertices, faces, bound)
        for _ in range(3):
            vertices = project(relax(vertices, faces, bound), skin(), 2, level)
    return vertices, faces, bound


def _net(wanted: float) -> tuple[Floats, Integers, Booleans, float]:
    """Polygonise the fattened half by the grid step that makes ``wanted`` vertices in all."""
    h = 5.2 / np.sqrt(wanted)
    for _ in range(5):
        values, lower = _grid_values(h)
        inside = well_composed(values < 0)
        values = np.where(inside, np.minimum(values, -0.01 * h), np.maximum(values, 0.01 * h))
        crossed = crossed_cells(inside)
        total = 2 * np.count_nonzero(crossed) - np.count_nonzero(crossed[:, 0])
        if abs(total / wanted - 1) < 0.02:
            break
        h *= np.sqrt(total / wanted)
    vertices = lower + h * net_vertices(values, crossed)
    bound = np.argwhere(crossed)[:, 1] == 0
    vertices[bound, 1] = 0.0
    return vertices, net_quads(inside, crossed), bound, h


def _grid_values(h: float) -> tuple[Floats, Floats]:
    """Sample the fattened function; the planes of points 0 and 1 along y are mirror images."""
    lower, upper = np.array(LOWER), np.array(UPPER)
    lower[1] = -h / 2
    counts = np.ceil((upper - lower) / h).astype(int) + 1
    axes = [lower[i] + h * np.arange(counts[i]) for i in range(3)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    values, _ = field(points.reshape(-1, 3), skin())
    return values.reshape(counts) - FATTENING * h, lower


def _mirrored(half: Floats, faces: Integers, bound: Booleans) -> tuple[Floats, Integers]:
    """Join a half mesh to its mirror image along the vertices on the plane."""
    n = len(half)
    image = np.arange(n)
    image[~bound] = n + np.arange(np.count_nonzero(~bound))
    vertices = np.concatenate([half, half[~bound] * (1.0, -1.0, 1.0)])
    return vertices, np.concatenate([faces, image[faces[:, ::-1]]])
