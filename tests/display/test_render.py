import numpy as np
import pytest
from PIL import Image

from beltrami.display.render import render
from beltrami.errors import (
    DimensionError,
    EmptyMeshError,
    MeshError,
    NonFiniteError,
    UnknownNameError,
)
from beltrami.mesh.mesh import Mesh

SMALL = {"size": (64, 48)}


def test_the_same_input_gives_the_same_bits(coarse_sphere):
    f = coarse_sphere.vertices[:, 0]
    copy = Mesh(coarse_sphere.vertices.copy(), coarse_sphere.faces.copy())
    first, second = (
        render(m, f, wireframe=True, caption="f", **SMALL) for m in (coarse_sphere, copy)
    )
    assert np.array_equal(first, second)


def test_the_picture_is_written_and_returned(coarse_sphere, tmp_path):
    image = render(coarse_sphere, path=tmp_path / "a.png", **SMALL)
    assert image.shape == (48, 64, 3)
    assert image.dtype == np.uint8
    with Image.open(tmp_path / "a.png") as read:
        assert np.array_equal(np.asarray(read), image)


def test_a_bad_suffix_is_found_before_the_work(tmp_path):
    with pytest.raises(UnknownNameError):
        render([], path=tmp_path / "a.jpg")


def test_panels_do_not_depend_on_their_neighbours(coarse_sphere, square):
    both = render([coarse_sphere, square], **SMALL)
    assert np.array_equal(both[:, :64], render(coarse_sphere, **SMALL))
    assert np.array_equal(both[:, 64:], render(square, **SMALL))


def test_columns(square):
    assert render([square] * 3, columns=2, **SMALL).shape == (96, 128, 3)
    assert render([square] * 3, columns=9, **SMALL).shape == (48, 192, 3)
    with pytest.raises(MeshError):
        render(square, columns=0, **SMALL)


def test_unreferenced_vertices_change_nothing(square):
    f = np.array([-1.0, 0, 1, 2])
    more = Mesh(np.concatenate([square.vertices, [[9, 9, 9]]]), square.faces)
    assert np.array_equal(render(square, f, **SMALL), render(more, np.append(f, 99), **SMALL))


def test_a_common_camera_shows_sizes(sphere):
    small = sphere.with_vertices(sphere.vertices / 2)
    options = {"background": "black", "antialias": 1, "size": (100, 100)}
    common = render([sphere, small], camera="common", **options).any(axis=2)
    assert 3.8 < common[:, :100].sum() / common[:, 100:].sum() < 4.3
    own = render([sphere, small], **options).any(axis=2)
    assert own[:, :100].sum() == own[:, 100:].sum()


@pytest.mark.chapter("F3.1")
def test_zoom_shows_the_faces_larger(coarse_sphere):
    # figure 3.1: the part between 0.375 and 0.625 of the picture fills it at zoom 4
    options = {"shading": "flat", "antialias": 1, "view": (0, 0)}
    large = render(coarse_sphere, size=(400, 400), **options)
    near = render(coarse_sphere, size=(100, 100), zoom=4, **options)
    assert np.abs(large[150:250, 150:250].astype(int) - near).mean() < 1


def test_without_a_height_panels_are_as_high_as_what_is_seen(sphere):
    flat = sphere.with_vertices(sphere.vertices * [1, 0.2, 1])
    options = {"view": (0, 0), "background": "black", "level_set": None, "caption": ["a", "b"]}
    f = [sphere.vertices[:, 1], None]
    square = render([flat, flat], f, size=(100, 100), **options)
    fitted = render([flat, flat], f, size=(100, None), **options)
    lost = len(square) - len(fitted)
    assert 55 < lost < 80
    # the rows that are gone are of the background, as many above as below
    drawn = square[:, 100:].any(axis=2).any(axis=1)
    assert drawn.sum() == fitted[:, 100:].any(axis=2).any(axis=1).sum()
    above = len(render(flat, size=(100, 100), caption="a")) - 100
    height = 100 - lost
    assert any(
        np.array_equal(fitted[above:][:height], square[above + cut :][:height])
        for cut in (lost // 2, lost // 2 + 1)
    )


def test_without_a_height_the_highest_panel_rules(sphere):
    flat = sphere.with_vertices(sphere.vertices * [1, 0.2, 1])
    assert render([flat, sphere], size=(100, None), view=(0, 0)).shape == (100, 200, 3)
    for size in ((0, None), (None, None), (None, 50), (10, 10, None)):
        with pytest.raises(MeshError):
            render(flat, size=size)


def test_antialiasing_smooths_the_silhouette_and_keeps_the_rest(sphere):
    options = {"color": "white", "background": "black", "size": (80, 80), "shading": "gouraud"}
    hard, soft = (render(sphere, antialias=k, **options).astype(int) for k in (1, 3))
    inside = np.hypot(*np.meshgrid(np.arange(80) - 39.5, np.arange(80) - 39.5)) < 33
    assert np.abs(hard - soft)[inside].max() <= 6
    edge = ~inside
    assert len(np.unique(soft[edge])) > len(np.unique(hard[edge]))


@pytest.mark.parametrize("path", ["vertices", "f"])
def test_nan_is_refused(square, path):
    x, f = square.vertices.copy(), np.ones(4)
    (x if path == "vertices" else f)[2] = np.nan
    with pytest.raises(NonFiniteError) as caught:
        render(Mesh(x, square.faces), f)
    assert caught.value.vertices.tolist() == [2]


@pytest.mark.parametrize(
    ("mesh", "f", "error"),
    [
        (Mesh(np.zeros((3, 4)), [[0, 1, 2]]), None, DimensionError),
        (Mesh(np.eye(3), [[0, 1, 2]]), np.ones(4), DimensionError),
        (Mesh(np.eye(3), np.zeros((0, 3), int)), None, EmptyMeshError),
        ([], None, EmptyMeshError),
    ],
)
def test_what_cannot_be_drawn_is_refused(mesh, f, error):
    with pytest.raises(error):
        render(mesh, f)


def test_a_planar_mesh_is_seen_from_above(square):
    flat = Mesh(square.vertices[:, :2], square.faces)
    image = render(flat, background="black", antialias=1, color="white", size=(50, 50))
    lit = (image == 255).all(axis=2)
    side = 0.94 * 50 / np.sqrt(2)  # the square inscribed in the disk, but for perspective
    assert abs(np.sqrt(lit.sum()) - side) < 2
    assert set(np.unique(image)) == {0, 255}
