import numpy as np
import pytest
from PIL import Image

from beltrami.io.registry import read_mesh


def test_several_meshes_side_by_side(beltrami, sphere, tmp_path):
    output = tmp_path / "p.png"
    done = beltrami("render", sphere, sphere, "-o", output, "--size", 90, 60)
    assert done.exit_code == 0, done.stderr
    with Image.open(output) as picture:
        width, height = picture.size
        assert width == 180
        assert height > 60  # captions
    beltrami("render", sphere, sphere, "-o", output, "--size", 90, 60, "--no-captions")
    with Image.open(output) as picture:
        assert picture.size == (180, 60)


def test_a_function_gives_colours(beltrami, sphere, tmp_path):
    np.save(tmp_path / "f.npy", read_mesh(sphere).vertices[:, 1])
    output = tmp_path / "p.png"
    beltrami("render", sphere, "--data", tmp_path / "f.npy", "-o", output, "--size", 90, 60)
    with Image.open(output) as picture:
        red, _, blue = np.asarray(picture.convert("RGB"), dtype=int)[:60].transpose(2, 0, 1)
    assert (red - blue).max() > 60  # diverging: red where it is positive ...
    assert (blue - red).max() > 60  # ... blue where it is negative


@pytest.mark.parametrize(
    ("arguments", "code", "text"),
    [
        (("--colormap", "viridis"), 2, "--data"),
        (("--limits", 0, 1), 2, "--data"),
        (("--up", "w"), 1, "'x', 'y', 'z'"),
        (("--zoom", 0), 1, "zoom"),
        (("--size", 0, 0), 1, "size"),
    ],
)
def test_options_that_do_not_fit(beltrami, sphere, tmp_path, arguments, code, text):
    done = beltrami("render", sphere, "-o", tmp_path / "p.png", *arguments)
    assert done.exit_code == code
    assert text in done.stderr
    assert not (tmp_path / "p.png").exists()
