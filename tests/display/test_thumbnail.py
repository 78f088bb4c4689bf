import numpy as np
import pytest
from hypothesis import given, settings

from beltrami.display import thumbnail as thumbnails
from beltrami.display.thumbnail import thumbnail
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import blob, disk, icosphere
from strategies import any_meshes


@given(mesh=any_meshes())
@settings(max_examples=25)
def test_no_mesh_is_refused(mesh):
    picture = thumbnail(mesh, size=(40, 30))
    seen = np.isfinite(mesh.vertices[mesh.faces]).all(axis=(1, 2))
    corners = mesh.vertices[mesh.faces[seen]].reshape(-1, mesh.dimension)
    if picture is None:
        assert len(corners) == 0 or np.ptp(corners[:, :3], axis=0).max() == 0
    else:
        assert picture.shape == (30, 40, 4)


@pytest.mark.parametrize(
    "vertices",
    [
        np.full((3, 3), np.nan),
        np.zeros((3, 3)),
        [[0, 0, 0], [np.inf, 0, 0], [0, 1, 0]],
    ],
    ids=["NaN", "one point", "infinite"],
)
def test_where_nothing_is_to_be_seen_there_is_no_picture(vertices):
    assert thumbnail(Mesh(vertices, [[0, 1, 2]])) is None
    assert thumbnail(Mesh([], np.zeros((0, 3), int))) is None


@pytest.mark.parametrize("unit", [1e-300, 1e-9, 1e9, 1e300])
def test_units_and_places_do_not_matter(unit):
    mesh = icosphere(2)
    plain = thumbnail(mesh)
    moved = thumbnail(mesh.with_vertices(unit * (mesh.vertices + 3)))
    assert abs(plain.astype(int) - moved).max() <= 2


def test_the_mesh_fills_the_picture_and_the_rest_is_transparent():
    for mesh in (icosphere(3), blob(1500), disk(6)):
        alpha = thumbnail(mesh, size=(130, 100))[..., 3]
        rows, columns = (np.flatnonzero(alpha.any(axis=axis)) for axis in (1, 0))
        free = min(100 - np.ptp(rows) - 1, 130 - np.ptp(columns) - 1)
        assert 2 <= free <= 26
        assert alpha[[0, 0, -1, -1], [0, -1, 0, -1]].max() == 0
        assert alpha.max() == 255


def test_broken_faces_are_left_out_and_the_others_stay():
    mesh = icosphere(3)
    x = np.vstack([mesh.vertices, [[9e9, np.nan, 1]], [[7e7, 0, 0]]])  # the last is in no face
    dirty = Mesh(x, np.vstack([mesh.faces, [[0, 1, 642]]]))
    assert np.array_equal(thumbnail(dirty), thumbnail(mesh))


def test_of_many_faces_few_are_drawn_and_cover_the_same_place(monkeypatch):
    mesh = icosphere(5)
    whole = thumbnail(mesh)[..., 3] > 127
    monkeypatch.setattr(thumbnails, "_FACES", 4000)
    asked = []
    drawable = thumbnails._drawable

    def noted(*given):
        asked.append(drawable(*given))
        return asked[-1]

    monkeypatch.setattr(thumbnails, "_drawable", noted)
    part = thumbnail(mesh, mesh.vertices[:, 2])[..., 3] > 127
    assert asked[0].n_faces <= 4000
    assert (part & whole).sum() > 0.98 * whole.sum()
    assert (part & ~whole).sum() < 0.06 * whole.sum()


def test_colours_and_numbers_that_are_not_finite():
    mesh = icosphere(2)
    f = mesh.vertices[:, 2].copy()
    f[:5] = np.nan, np.inf, -np.inf, 0, 0
    red = np.tile(np.array([255, 0, 0], np.uint8), (mesh.n_vertices, 1))
    assert thumbnail(mesh, f).shape == (200, 260, 4)
    picture = thumbnail(mesh, red)
    inside = picture[picture[..., 3] == 255]
    assert inside[:, 0].min() > 60
    assert inside[:, 1:3].max() == 0
