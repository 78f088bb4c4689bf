import os

import numpy as np
import pytest
from PIL import Image

from beltrami.display import images
from beltrami.display.images import ANIMATED, check_suffix, write_animation, write_image
from beltrami.errors import BeltramiError, UnknownNameError


@pytest.fixture
def picture():
    return np.random.default_rng(208_113_947).integers(0, 256, (20, 30, 3), dtype=np.uint8)


@pytest.mark.parametrize("suffix", [".png", ".webp", ".PNG"])
def test_nothing_is_lost(tmp_path, picture, suffix):
    write_image(tmp_path / f"a{suffix}", picture)
    with Image.open(tmp_path / f"a{suffix}") as read:
        assert np.array_equal(np.asarray(read.convert("RGB")), picture)


def test_gif(tmp_path):
    picture = np.zeros((20, 30, 3), np.uint8)
    picture[:, 10:] = [200, 100, 50]
    write_image(tmp_path / "a.gif", picture)
    with Image.open(tmp_path / "a.gif") as read:
        assert read.format == "GIF"
        assert np.array_equal(np.asarray(read.convert("RGB")), picture)


def test_other_suffixes_are_refused_and_nothing_is_written(tmp_path, picture):
    for name in ("a.jpg", "a", "a.png.tiff"):
        with pytest.raises(UnknownNameError):
            write_image(tmp_path / name, picture)
        with pytest.raises(UnknownNameError):
            check_suffix(tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_a_failure_leaves_the_old_file_and_no_draft(tmp_path, picture, monkeypatch):
    path = tmp_path / "a.png"
    path.write_bytes(b"old")

    def fail(_, file, **__):
        file.write(b"half")
        raise OSError("disk full")

    monkeypatch.setattr(images.Pillow.Image, "save", fail)
    with pytest.raises(OSError, match="disk full"):
        write_image(path, picture)
    assert path.read_bytes() == b"old"
    assert os.listdir(tmp_path) == ["a.png"]


def test_the_same_picture_is_the_same_file(tmp_path, picture):
    write_image(tmp_path / "a.png", picture)
    write_image(tmp_path / "b.png", picture)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


@pytest.mark.parametrize("suffix", ANIMATED)
def test_animations_have_all_frames(tmp_path, suffix):
    images = [np.full((8, 6, 3), shade, np.uint8) for shade in (0, 90, 200)]
    path = tmp_path / f"a{suffix}"
    write_animation(path, iter(images), 50)
    with Image.open(path) as picture:
        assert picture.n_frames == 3
        for k, image in enumerate(images):
            picture.seek(k)
            assert np.array_equal(np.asarray(picture.convert("RGB")), image)
            assert picture.info["duration"] == 20
        assert picture.info["loop"] == 0


def test_animations_that_cannot_be(tmp_path):
    image = np.zeros((4, 4, 3), np.uint8)
    with pytest.raises(UnknownNameError):
        write_animation(tmp_path / "a.png", [image], 10)
    for rate in (0, -1, np.inf, np.nan):
        with pytest.raises(BeltramiError, match="pictures a second"):
            write_animation(tmp_path / "a.gif", [image], rate)
    with pytest.raises(BeltramiError, match="needs a picture"):
        write_animation(tmp_path / "a.gif", [], 10)
    assert not list(tmp_path.iterdir())
