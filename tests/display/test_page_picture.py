import io

import numpy as np
import pytest
from PIL import Image

from beltrami.display.page_picture import LONGEST, MOST_BYTES, page_picture


def opened(packed):
    with Image.open(io.BytesIO(packed.data)) as image:
        assert f"image/{image.format.lower()}" == packed.kind
        assert image.size == packed.size
        return np.asarray(image.convert("RGB"), float) / 255


def test_small_pictures_lose_nothing():
    picture = np.random.default_rng(1).integers(0, 256, (30, 50, 3)).astype(np.uint8)
    packed = page_picture(picture)
    assert packed.kind == "image/png"
    assert packed.note == ""
    np.testing.assert_array_equal(opened(packed), picture / 255)


def smooth(height, width):
    y, x = np.ogrid[:height, :width]
    return np.stack([x / width + 0 * y, y / height + 0 * x, 0.5 + 0 * (x + y)], axis=2)


@pytest.mark.parametrize(
    ("noise", "size", "kind"),
    [
        (0.1, (400, 500), "image/jpeg"),
        (0.0, (20, 3000), "image/png"),
        (1.0, (900, 1200), "image/jpeg"),
    ],
)
def test_large_pictures_become_few_bytes_and_say_so(noise, size, kind):
    added = np.random.default_rng(1).normal(0, noise, (*size, 1)) if noise else 0.0
    packed = page_picture(np.clip(smooth(*size) + added, 0, 1))
    assert len(packed.data) <= MOST_BYTES
    assert max(packed.size) <= LONGEST
    assert packed.kind == kind
    assert kind.removeprefix("image/").upper() in packed.note
    smaller = packed.size != size[::-1]
    assert (f"{packed.size[0]} x {packed.size[1]}" in packed.note) == smaller
    found = opened(packed)
    truth = smooth(*found.shape[:2])
    assert np.abs(found.mean(axis=(0, 1)) - truth.mean(axis=(0, 1))).max() < 0.02
    assert packed.size[0] / packed.size[1] == pytest.approx(size[1] / size[0], rel=0.1)


@pytest.mark.parametrize(("length", "quality", "finer"), [(500, 92, None), (600, 75, 85)])
def test_the_best_quality_that_fits(length, quality, finer):
    added = np.random.default_rng(1).normal(0, 0.2, (length, length, 1))
    picture = np.rint(255 * np.clip(smooth(length, length) + added, 0, 1)).astype(np.uint8)
    packed = page_picture(picture)
    assert packed.note == f"travels as JPEG, quality {quality}"
    assert packed.size == (length, length)
    if finer:
        file = io.BytesIO()
        Image.fromarray(picture).save(file, format="JPEG", quality=finer, optimize=True)
        assert file.tell() > MOST_BYTES
