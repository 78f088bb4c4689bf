"""Textures: each pixel shows the right point of the picture, as sharp as it can be."""

import numpy as np
import pytest
from PIL import Image

from beltrami.display.camera import Camera
from beltrami.display.render import render
from beltrami.display.srgb import from_linear, to_linear
from beltrami.display.texture import checkerboard, look_up, make_texture
from beltrami.errors import (
    DimensionError,
    FileFormatError,
    MeshError,
    UnknownNameError,
)
from beltrami.io.picture import as_picture, png_bytes
from beltrami.mesh.mesh import Mesh

CORNERS = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
FACES = [[0, 1, 2], [0, 2, 3]]


def screen(uv=CORNERS, dimension=2):
    """The unit square, with texture coordinates."""
    x = np.hstack([CORNERS, np.zeros((4, dimension - 2))])
    return Mesh(x, FACES, corner_uv=np.asarray(uv, dtype=np.float64)[np.array(FACES)])


EYE = {"camera": Camera((0.5, 0.5, 1.0), (0.5, 0.5, 0), (0, 1, 0), 2 * np.degrees(np.arctan(0.5)))}


def drawn(picture, uv=CORNERS, size=(64, 64), **options):
    """Draw the square so that it just fills the picture."""
    settings = {"antialias": 1, **EYE, **options}
    return render(screen(uv), size=size, texture=picture, **settings)


@pytest.mark.chapter("P71")
def test_a_picture_on_a_square_is_the_picture():
    picture = np.random.default_rng(0).integers(0, 256, (64, 64, 3), dtype=np.uint8)
    shown = drawn(picture)
    assert np.abs(shown.astype(int) - picture).max() <= 1


def test_v_goes_upwards_and_u_to_the_right():
    picture = np.zeros((2, 2, 3))
    picture[0, 0] = [1, 0, 0]  # above, left
    shown = drawn(picture)
    assert shown[15, 15, 0] > 240
    assert shown[48, 15, 0] < 15 > shown[15, 48, 0]


def test_pictures_go_on_periodically():
    picture = np.random.default_rng(1).uniform(0, 1, (16, 16, 3))
    once, moved = drawn(picture), drawn(picture, CORNERS + np.array([3, -2]))
    assert np.abs(once.astype(int) - moved).max() <= 1


def test_between_pixels_it_is_linear():
    picture = np.zeros((1, 2, 3))
    picture[0, 1] = 1
    shown = drawn(picture, size=(128, 32))[16, 48:80, 0] / 255.0
    u = (np.arange(48, 80) + 0.5 - 48) / 32  # the square is 32 pixels wide
    expected = np.interp(u, [0.25, 0.75, 1.25], [0, 1, 0], period=1)
    np.testing.assert_allclose(shown, expected, atol=0.02)


@pytest.mark.chapter("P71")
def test_perspective_is_right_on_a_tilted_square():
    """Seen at a slant, each pixel shows the point where its line of sight meets the square."""
    ramp = np.broadcast_to(np.arange(256)[:, None, None] / 255.0, (256, 256, 3))
    camera = Camera((0.5, -1.2, 0.5), (0.5, 0.5, 0), (0, 0, 1), 40)
    x = np.hstack([CORNERS, np.zeros((4, 1))])
    mesh = Mesh(x, FACES, corner_uv=CORNERS[np.array(FACES)])
    shown = render(
        mesh, size=(200, 200), camera=camera, texture=ramp, antialias=1, ambient=1.0, fill=0.0,
        back="same",
    )  # fmt: skip
    for y in (0.2, 0.5, 0.8):
        px, py, _ = camera.project([[0.5, y, 0.0]], (200, 200))[0]
        light = 1 * (3 + camera.axes[1, 2]) / 4
        assert abs(shown[int(py), int(px), 0] - 255 * (1 - y) * light) < 4


def test_pictures_that_are_made_small_are_their_mean_light():
    board = np.indices((256, 256)).sum(axis=0) % 2.0  # finer than the pixels
    shown = drawn(board, size=(16, 16))
    grey = 255 * float(from_linear(np.array(0.5)))
    assert np.abs(shown.astype(float) - grey).max() <= 1


@pytest.mark.parametrize("shape", [(5, 3), (1, 1), (1, 7), (8, 1)])
def test_pictures_of_any_shape(shape):
    picture = np.full((*shape, 3), 0.5)
    assert np.abs(drawn(picture, size=(9, 9)).astype(int) - 128).max() <= 1
    texture = make_texture(screen(), picture)
    assert texture.levels[-1, 1:].tolist() == [1, 1]
    assert len(texture.pixels) == (texture.levels[:, 1] * texture.levels[:, 2]).sum()


def test_each_size_has_the_mean_of_the_one_before():
    picture = np.random.default_rng(2).uniform(0, 1, (8, 4, 3))
    texture = make_texture(screen(), picture)
    (_, w, h), (first, w2, h2) = texture.levels[:2]
    assert (w, h, w2, h2) == (4, 8, 2, 4)
    small = texture.pixels[first : first + 8].reshape(4, 2, 3)
    mean = to_linear(picture).reshape(4, 2, 2, 2, 3).mean(axis=(1, 3))
    np.testing.assert_allclose(to_linear(small.astype(float)), mean, atol=1e-6)


def test_look_up_against_numpy():
    rng = np.random.default_rng(3)
    picture = rng.uniform(0, 1, (6, 4, 3))
    texture = make_texture(screen(), picture)
    color = np.empty(3)
    for u, v in rng.uniform(-1, 2, (20, 2)):
        look_up(texture.pixels, texture.levels, u, v, 0.0, 0.0, color)
        x, y = u * 4 - 0.5, (1 - v) * 6 - 0.5
        j, i = int(np.floor(x)), int(np.floor(y))
        a, b = x - j, y - i
        four = [[picture[(i + q) % 6, (j + p) % 4] for p in (0, 1)] for q in (0, 1)]
        expected = (1 - b) * ((1 - a) * four[0][0] + a * four[0][1])
        expected += b * ((1 - a) * four[1][0] + a * four[1][1])
        np.testing.assert_allclose(color, expected, atol=1e-6)


@pytest.mark.chapter("P71")
def test_the_checkerboard_has_sixteen_squares_whatever_the_unit():
    for scale in (1.0, 1e-6, 1e7):
        row = drawn("checkerboard", CORNERS * scale + 0.3 * scale, size=(320, 320))[10, :, 0]
        assert np.count_nonzero(np.diff((row > 150).astype(int))) == 15
    assert checkerboard(32).shape == (32, 32, 3)


@pytest.mark.parametrize("none", [np.nan, np.inf, -np.inf])
def test_corners_without_coordinates_are_plain(none):
    uv = CORNERS[np.array(FACES)].copy()
    uv[0, 1] = none
    mesh = Mesh(CORNERS, FACES, corner_uv=uv)
    red = np.broadcast_to([1.0, 0, 0], (2, 2, 3))
    shown = render(mesh, size=(40, 40), texture=red, color="white", antialias=1, **EYE)
    assert shown[30, 35].tolist() == [255, 255, 255]
    assert shown[5, 10].tolist() == [255, 0, 0]


def test_a_file_and_an_array_are_alike(tmp_path):
    picture = np.random.default_rng(4).integers(0, 256, (8, 8, 3), dtype=np.uint8)
    Image.fromarray(picture).save(tmp_path / "a.png")
    (tmp_path / "b.png").write_bytes(png_bytes(picture))
    expected = drawn(picture)
    for name in ("a.png", "b.png"):
        assert (drawn(tmp_path / name) == expected).all()
        assert (drawn(str(tmp_path / name)) == expected).all()


def test_one_texture_for_each_panel():
    both = render([screen(), screen()], size=(40, 40), texture=["checkerboard", None])
    assert both.shape == (40, 80, 3)
    assert len(np.unique(both[:, :40].reshape(-1, 3), axis=0)) > 2
    with pytest.raises(DimensionError, match="1 textures for 2 panels"):
        render([screen(), screen()], texture=["checkerboard"])


def test_bad_textures_are_told(tmp_path):
    plain = Mesh(CORNERS, FACES)
    with pytest.raises(MeshError, match="without texture coordinates"):
        render(plain, texture="checkerboard")
    with pytest.raises(MeshError, match="a function and a texture"):
        render(screen(), np.arange(4.0), texture="checkerboard")
    with pytest.raises(UnknownNameError, match="checkerboard"):
        render(screen(), texture="chekerboard")
    with pytest.raises(DimensionError, match=r"\(h, w\) or \(h, w, 3\)"):
        as_picture(np.zeros((2, 2, 4)))
    with pytest.raises(MeshError, match=r"outside \[0, 1\]"):
        as_picture([[np.nan]])
    with pytest.raises(MeshError, match=r"outside \[0, 1\]"):
        as_picture([[2.0]])
    (tmp_path / "a.png").write_bytes(b"no picture")
    with pytest.raises(FileFormatError, match="expected a picture"):
        as_picture(tmp_path / "a.png")
    with pytest.raises(FileNotFoundError):
        as_picture(tmp_path / "b.png")
