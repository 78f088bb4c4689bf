import os

import numpy as np
import pytest
from PIL import Image

from beltrami.display import images
from beltrami.display.images import check_suffix, write_image
from beltrami.errors import UnknownNameError


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
