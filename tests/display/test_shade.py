import numpy as np
import pytest

from beltrami.display.raster import visible_triangles
from beltrami.display.shade import Paint, shade
from beltrami.display.srgb import from_linear, to_linear
from beltrami.display.triangles import GRID, Triangles

NO_STROKES = np.zeros((0, 0), np.float32)


def on_screen(xy, nearness=None, borders=None):
    xy = np.asarray(xy, dtype=np.float64)
    nearness = np.ones(xy.shape[:2]) if nearness is None else np.asarray(nearness, float)
    borders = np.ones(xy.shape[:2], bool) if borders is None else np.asarray(borders)
    grid = np.rint(xy * GRID).astype(np.int64)
    return Triangles(grid, nearness, np.arange(len(xy)), borders, np.zeros((0, 3, 3)))


def painted(t, **changes):
    """White paint and full light on t triangles, on black, but for the changes."""
    usual = {
        "values": np.zeros((t, 3, 1)),
        "table": np.ones((2, 3)),
        "front": np.ones((t, 3)),
        "back": np.ones((t, 3)),
        "inside": np.ones(3),
        "tint": 0.0,
        "background": np.zeros(3),
        "line": np.zeros(3),
        "wire": np.zeros(3),
        "wire_width": 0.0,
    }
    return Paint(**{**usual, **changes})


def picture(triangles, paint, size=(40, 40), samples=1, strokes=NO_STROKES):
    big = (size[0] * samples, size[1] * samples)
    return shade(triangles, visible_triangles(triangles, big), strokes, paint, samples)


LOWER = np.array([[[0, 0], [0, 40], [40, 40]]])  # counter-clockwise: a front


@pytest.mark.chapter("P8", "P13")
def test_light_is_linear_in_a_triangle_that_faces_the_camera():
    light = np.array([[0.1, 0.9, 0.5]])
    image = picture(on_screen(LOWER), painted(1, front=light))
    y, x = np.nonzero(np.tri(40, k=-1))
    u, v = (x + 0.5) / 40, (y + 0.5) / 40  # point = (0, 0) + v (0, 1) + u (1, 0)
    expected = 0.1 + 0.8 * (v - u) + 0.4 * u
    assert np.abs(image[y, x, 0] - 255 * expected).max() <= 0.51


@pytest.mark.chapter("P8")
def test_colours_are_linear_in_a_triangle_that_faces_the_camera():
    corners = np.array([[[0.2, 0.4, 1.0], [1.0, 0.0, 0.5], [0.0, 1.0, 0.25]]])
    image = picture(on_screen(LOWER), painted(1, values=corners))
    y, x = np.nonzero(np.tri(40, k=-1))
    u, v = ((x + 0.5) / 40)[:, None], ((y + 0.5) / 40)[:, None]
    expected = (1 - v) * corners[0, 0] + (v - u) * corners[0, 1] + u * corners[0, 2]
    assert np.abs(image[y, x] - 255 * expected).max() <= 0.51


@pytest.mark.parametrize("seed", [404_118_873, 66_219_730_554])
def test_against_numpy(seed):
    rng = np.random.default_rng(seed)
    xy, near = rng.uniform(-5, 45, (4, 3, 2)), rng.uniform(0.5, 2, (4, 3))
    triangles = on_screen(xy, near)
    f, table = rng.random((4, 3, 1)), rng.random((5, 3))
    front, back, inside = rng.random((4, 3)), rng.random((4, 3)), rng.random(3)
    paint = painted(
        4, values=f, table=table, front=front, back=back, inside=inside, tint=0.4
    )  # fmt: skip
    image = picture(triangles, paint)
    seen = visible_triangles(triangles, (40, 40)).triangle
    for y, x in zip(*np.nonzero(seen >= 0), strict=True):
        t = seen[y, x]
        corners = triangles.xy[t] / GRID
        b = np.linalg.solve(np.vstack([corners.T, np.ones(3)]), [x + 0.5, y + 0.5, 1])
        b = b * near[t] / (b @ near[t])
        front_seen = np.linalg.det(corners[1:] - corners[0]) < 0
        color = [np.interp(b @ f[t, :, 0], np.linspace(0, 1, 5), c) for c in table.T]
        color = np.array(color)
        if not front_seen:
            color = color + 0.4 * (inside - color)
        color = color * (b @ (front if front_seen else back)[t])
        assert np.abs(image[y, x] - 255 * color).max() <= 0.51
    assert len(np.unique(seen)) > 3


def test_numbers_are_interpolated_and_not_their_colours():
    # from 0 to 1 through a table that is green in the middle only: blended ends are never green
    table = np.array([[1.0, 0, 0], [0, 1, 0], [0, 0, 1]])
    f = np.array([[[0.0], [0.0], [1.0]]])  # f = x / 40
    image = picture(on_screen(LOWER), painted(1, values=f, table=table))
    assert image[39, 20, 1] >= 245
    assert image[39, 0, 0] >= 245
    assert image[38, 37, 2] >= 220


def test_a_constant_colour_has_the_same_byte_everywhere():
    image = picture(on_screen(3 * LOWER), painted(1, table=np.full((2, 3), 0.6)), samples=3)
    assert set(np.unique(image[np.tri(40, k=-1, dtype=bool)])) == {153}


@pytest.mark.parametrize("samples", [2, 3])
def test_samples_are_averaged_as_light(samples):
    # each pixel sees a mixture of black and white: the picture is the sRGB of the mean light
    triangles = on_screen(samples * np.array([[[0, 0], [0, 40], [20, 40]]]))
    image = picture(triangles, painted(1), samples=samples)
    hard = picture(triangles, painted(1), size=(40 * samples, 40 * samples))
    light = to_linear(hard / 255.0).reshape(40, samples, 40, samples, 3).mean(axis=(1, 3))
    assert np.abs(image - 255 * from_linear(light)).max() <= 0.6
    assert len(np.unique(image)) > 2


def test_the_background_is_seen_where_nothing_is():
    paint = painted(1, background=np.array([0.2, 0.4, 0.6]))
    for samples in (1, 2):
        image = picture(on_screen(samples * LOWER), paint, samples=samples)
        assert image[5, 30].tolist() == [51, 102, 153]


def test_strokes_are_drawn_over_the_paint():
    strokes = np.zeros((40, 40), np.float32)
    strokes[30, 5], strokes[30, 6] = 1, 0.5
    image = picture(on_screen(LOWER), painted(1, line=np.array([1.0, 0, 0])), strokes=strokes)
    assert image[30, 4:7].tolist() == [[255, 255, 255], [255, 0, 0], [255, 128, 128]]


def test_sides_are_darkened_and_nothing_else():
    image = picture(on_screen(LOWER), painted(1, wire_width=2.0))[..., 0]
    y, x = np.nonzero(np.tri(40, k=-1))
    distance = np.minimum(np.minimum(x + 0.5, 39.5 - y), (y - x) / np.sqrt(2))
    expected = 255 * (1 - np.clip(1.5 - distance, 0, 1))
    assert np.abs(image[y, x] - expected).max() <= 0.51


def test_a_cut_is_no_side():
    borders = [[False, True, False]]  # the side from corner 2 to corner 0 only
    image = picture(on_screen(LOWER, borders=borders), painted(1, wire_width=2.0))[..., 0]
    y, x = np.nonzero(np.tri(40, k=-1))
    expected = 255 * (1 - np.clip(1.5 - (y - x) / np.sqrt(2), 0, 1))
    assert np.abs(image[y, x] - expected).max() <= 0.51


def test_sides_of_small_triangles_are_thin():
    grid = np.arange(0, 40, 2.0)
    tiles = [
        [[x, y], [x, y + 2], [x + 2, y + 2]] for x in grid for y in grid
    ] + [[[x, y], [x + 2, y + 2], [x + 2, y]] for x in grid for y in grid]  # fmt: skip
    image = picture(on_screen(tiles), painted(len(tiles), wire_width=3.0))
    assert 100 < image.mean() < 230  # grey: with lines of the full width it would be black
