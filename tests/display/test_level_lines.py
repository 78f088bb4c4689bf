import numpy as np
import pytest

from beltrami.display.level_lines import level_lines, stroke
from beltrami.display.raster import Visible, visible_triangles
from beltrami.display.triangles import GRID, Triangles


def on_screen(xy, nearness):
    xy = np.asarray(xy, dtype=np.float64)
    k = len(xy)
    grid = np.rint(xy * GRID).astype(np.int64)
    return Triangles(
        grid, np.asarray(nearness, float), np.arange(k), np.ones((k, 3), bool), np.zeros((0, 3, 3))
    )


@pytest.mark.chapter("P52")
def test_the_line_is_where_the_function_has_the_level():
    # f = x / 10 on the screen, at constant depth
    triangles = on_screen([[[0, 0], [40, 0], [0, 40]]], [[2, 2, 2]])
    f = np.array([[0.0, 4, 0]])
    (line,) = level_lines(triangles, f, 1.0)
    assert np.allclose(line[line[:, 1].argsort()], [[10, 0, 2], [10, 30, 2]])


def test_crossings_are_found_in_space_and_not_on_the_screen():
    # a side from depth 1 to depth 4: its middle in space, at depth 2.5, is at 4/5 of its image
    depth = np.array([[1.0, 4.0, 4.0]])
    triangles = on_screen([[[0, 0], [40, 0], [0, 40]]], 1 / depth)
    (line,) = level_lines(triangles, np.array([[-1.0, 1.0, 1.0]]), 0.0)
    # (1 - t) x / d: halfway in space, x = (0 + 160) / 2 and d = 5 / 2
    assert np.allclose(sorted(line.tolist()), [[0, 32, 0.4], [32, 0, 0.4]])


def test_neighbours_find_the_same_point():
    rng = np.random.default_rng(118_920_554)
    xy = rng.uniform(0, 50, (4, 2))
    near = rng.uniform(1, 2, 4)
    f = np.array([-0.3, 0.7, -0.9, 0.4])
    faces = np.array([[0, 1, 2], [1, 0, 3]])
    lines = level_lines(on_screen(xy[faces], near[faces]), f[faces], 0.0)
    ends = {tuple(end) for line in lines for end in line.tolist()}
    assert len(ends) == 3  # one shared, to the last bit


@pytest.mark.chapter("P52")
@pytest.mark.parametrize("f", [[1, 2, 3], [0, 0, 0], [0, 1, 1], [0, -1, -1], [0, 0, 1]])
def test_no_line_where_the_function_does_not_cross(f):
    triangles = on_screen([[[0, 0], [40, 0], [0, 40]]], [[1, 1, 1]])
    assert len(level_lines(triangles, np.array([f], float), 0.0)) == 0


def test_a_level_on_a_side_is_drawn_once():
    xy = np.array([[0, 0], [40, 0], [0, 40], [40, 40]])
    faces = np.array([[0, 1, 2], [3, 2, 1]])
    f = np.array([-1.0, 0, 0, 1])
    lines = level_lines(on_screen(xy[faces], np.ones((2, 3))), f[faces], 0.0)
    assert len(lines) == 1


def test_the_stroke_has_the_width_asked_for():
    visible = Visible(np.zeros((20, 40), np.int32), np.ones((20, 40), np.float32))
    line = np.array([[[-10.0, 8.3, 1], [50.0, 8.3, 1]]])
    cover = stroke(visible, [line], 3.0, 100.0)
    assert np.allclose(cover.sum(axis=0), 3.0)
    distance = np.abs(np.arange(20) + 0.5 - 8.3)
    assert np.allclose(cover, np.clip(2 - distance, 0, 1)[:, None], atol=1e-6)


def test_ends_are_round():
    visible = Visible(np.zeros((20, 20), np.int32), np.ones((20, 20), np.float32))
    cover = stroke(visible, [np.array([[[10.0, 10, 1], [10.0, 10.0001, 1]]])], 6.0, 100.0)
    x, y = np.meshgrid(np.arange(20) - 9.5, np.arange(20) - 9.5)
    assert np.allclose(cover, np.clip(3.5 - np.hypot(x, y), 0, 1), atol=1e-3)


def test_lines_are_hidden_by_what_is_nearer_and_not_drawn_on_the_background():
    nearness = np.ones((20, 40), np.float32)
    nearness[:, 10:20] = 2  # something before it
    nearness[:, 30:] = 0  # the background
    visible = Visible(np.zeros((20, 40), np.int32), nearness)
    cover = stroke(visible, [np.array([[[-9.0, 10, 1], [60.0, 10, 1]]])], 2.0, 100.0)
    drawn = cover.max(axis=0) > 0
    assert drawn[:10].all()
    assert drawn[20:30].all()
    assert not drawn[10:20].any()
    assert not drawn[30:].any()


def test_a_line_lies_on_its_own_slanting_face():
    # seen under 45 degrees: nearness changes by half over the triangle
    triangles = on_screen([[[0, 0], [60, 0], [0, 60]]], [[2, 1, 2]])
    visible = visible_triangles(triangles, (60, 60))
    lines = level_lines(triangles, np.array([[-1.0, -1.0, 1.0]]), 0.0)
    cover = stroke(visible, [lines], 3.0, 60.0)
    assert (cover.max(axis=0)[:28] > 0.9).all()


@pytest.mark.parametrize("seed", [19_400_283_117, 733_018_264])
def test_strokes_against_numpy(seed):
    rng = np.random.default_rng(seed)
    lines = np.ones((8, 2, 3))
    lines[..., :2] = rng.uniform(-10, 50, (8, 2, 2))
    lines[0, :, 1] = 17.3  # level
    lines[1, :, 0] = 9.8  # upright
    visible = Visible(np.zeros((30, 40), np.int32), np.ones((30, 40), np.float32))
    points = np.stack(np.meshgrid(np.arange(40) + 0.5, np.arange(30) + 0.5), axis=-1)
    expected = np.zeros((30, 40))
    for a, b in lines[..., :2]:
        t = np.clip((points - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
        distance = np.linalg.norm(points - a - t[..., None] * (b - a), axis=-1)
        expected = np.maximum(expected, np.clip(1.4 + 0.5 - distance, 0, 1))
    assert np.allclose(stroke(visible, [lines], 2.8, 100.0), expected, atol=1e-6)
