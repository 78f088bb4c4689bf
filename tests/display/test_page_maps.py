"""Maps in a page: what travels is the map, whether made for it or given with the mesh."""

import numpy as np
import pytest

from beltrami.display.page import page
from beltrami.errors import FileFormatError, MeshError, UnknownNameError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import blob, grid, icosphere
from beltrami.parameterization.atlas import atlas
from page_reader import faces_from, read_page, values_from


@pytest.fixture(scope="module")
def charts():
    """An atlas, one face without coordinates, and another with a corner without."""
    mesh = atlas(blob(500)).mesh
    uv = np.add(mesh.corner_uv, (5, -2))
    uv[11] = np.nan
    uv[40, 2, 0] = np.inf
    return Mesh(mesh.vertices, mesh.faces, None, uv)


def written(mesh, path, **options):
    done = page(mesh, path, modes=4, noise=0, laplacians=("combinatorial",), **options)
    return done, *read_page(path.read_text("utf-8"))


def test_coordinates_of_the_mesh_travel(charts, tmp_path):
    _, header, sections = written(charts, tmp_path / "p.html", texture="checkerboard")
    own = header["own"]
    assert own["step"] <= 1 / 8192
    assert own["without"] == 2
    faces = faces_from(sections["faces"])
    cut = faces.copy().ravel()
    cut[np.cumsum(sections["own seam corners"])] = np.cumsum(sections["own seam vertices"])
    copies = np.cumsum(sections["own seam copies"])
    original = np.concatenate([np.arange(charts.n_vertices), copies])
    np.testing.assert_array_equal(original[cut], faces.ravel())
    cut = cut.reshape(-1, 3)
    uv = own["step"] * values_from(sections["own plane"], cut) + own["origin"]
    bare = np.isin(cut, np.cumsum(sections["own bare"]))
    assert (bare.all(axis=1) == bare.any(axis=1)).all()
    numbers = np.cumsum(sections["numbers"])
    given = {}
    for face, corners in zip(charts.faces.tolist(), charts.corner_uv, strict=True):
        given[frozenset(face)] = dict(zip(face, corners, strict=True))
    for face, corners, none in zip(numbers[faces].tolist(), cut, bare[:, 0], strict=True):
        truth = np.array([given[frozenset(face)][v] for v in face])
        assert none == (not np.isfinite(truth).all())
        if not none:
            away = uv[corners] - truth
            away -= np.rint(away[0])  # pictures go on periodically: whole ones do not count
            assert np.abs(away).max() <= own["step"] * 0.501


def test_what_is_said_of_coordinates(tmp_path):
    flat = grid(6, 6)
    x = flat.vertices[:, :2]
    for uv, bijective, flipped in (
        (x, True, 0),
        (x * [-1, 1], False, flat.n_faces),
        (x * [1, 0], False, flat.n_faces),
        (np.abs(x - x[:, :1].mean()), False, None),
    ):
        mesh = Mesh(flat.vertices, flat.faces, None, uv[flat.faces])
        _, header, _ = written(mesh, tmp_path / "p.html", plane=False, texture="checkerboard")
        own = header["own"]
        assert own["bijective"] is bijective
        assert flipped is None or own["flipped"] == flipped
        assert own["cut"] == 0
        assert (own["area"] is None) == (not uv[:, 1].any())  # infinite
    apart = np.array(mesh.corner_uv)
    apart[: len(apart) // 2] += 7  # another island: what parts them is cut
    mesh = Mesh(flat.vertices, flat.faces, None, apart)
    _, header, _ = written(mesh, tmp_path / "p.html", plane=False, texture="checkerboard")
    half = Mesh(flat.vertices, flat.faces[: len(apart) // 2])
    rest = Mesh(flat.vertices, flat.faces[len(apart) // 2 :])
    shared = set(map(tuple, half.edges.tolist())) & set(map(tuple, rest.edges.tolist()))
    assert header["own"]["cut"] == len(shared) > 0


def test_what_cannot_be_decided_is_said(tmp_path):
    book = Mesh(
        [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, -1, 1]], [[0, 1, 2], [0, 1, 3], [0, 1, 4]]
    )
    uv = np.array([[0, 0], [1, 0], [0, 1], [0.3, 1], [0.6, 1]])[book.faces]
    mesh = Mesh(book.vertices, book.faces, None, uv)
    _, header, _ = written(mesh, tmp_path / "p.html", plane=False, texture="checkerboard")
    assert not header["own"]["bijective"]
    assert "more than two faces" in header["own"]["undecided"]


def test_without_a_texture_coordinates_stay_at_home(charts, tmp_path):
    _, header, sections = written(charts, tmp_path / "p.html", plane=False)
    assert header["own"] is header["picture"] is None
    assert not header["textured"]
    assert not any(name.startswith("own") for name in sections)


def test_pictures_travel(charts, tmp_path):
    picture = np.random.default_rng(1).uniform(size=(9, 5, 3))
    for mesh in (charts, icosphere(1)):
        done, header, sections = written(mesh, tmp_path / "p.html", texture=picture)
        assert len(done.notes) == 1  # of the noise
        assert header["picture"] == {"kind": "image/png", "width": 5, "height": 9}
        assert header["textured"]
        assert (header["own"] is None) == (mesh is not charts)
        folded = sections["picture"].ravel()
        data = np.where(folded < 0, -2 * folded - 1, 2 * folded).astype(np.uint8).tobytes()
        assert data.startswith(b"\x89PNG")


def test_a_picture_on_coordinates_alone_says_what_it_lost(charts, tmp_path):
    picture = np.random.default_rng(1).uniform(size=(300, 300, 3))
    done, header, sections = written(charts, tmp_path / "p.html", plane=False, texture=picture)
    assert header["picture"]["kind"] == "image/jpeg"
    assert len(sections["picture"]) > 10_000
    assert [note.split(",")[0] for note in done.notes if "texture" in note] == [
        "the texture travels as JPEG"
    ]


def test_edges_without_coordinates_are_not_cut(tmp_path):
    flat = grid(6, 6)
    uv = flat.vertices[flat.faces, :2]
    uv[:30] = np.nan
    mesh = Mesh(flat.vertices, flat.faces, None, uv)
    _, header, _ = written(mesh, tmp_path / "p.html", plane=False, texture="checkerboard")
    assert header["own"]["without"] == 30
    assert header["own"]["cut"] == 0
    assert header["own"]["bijective"]


@pytest.mark.parametrize(
    ("options", "error"),
    [
        ({"texture": "chequers"}, UnknownNameError),
        ({"texture": "missing.png"}, FileNotFoundError),
        ({"texture": __file__}, FileFormatError),
        ({"texture": np.full((2, 2), 3.0)}, MeshError),
        ({"texture": "checkerboard", "plane": False}, MeshError),
        ({"texture": np.ones((2, 2)), "plane": False}, MeshError),
    ],
)
def test_textures_that_do_not_fit(options, error, tmp_path):
    with pytest.raises(error):
        page(icosphere(1), tmp_path / "p.html", **options)
    assert not list(tmp_path.iterdir())


def test_coordinates_that_spread_too_far(charts, tmp_path):
    for uv in (np.array(charts.corner_uv) * 1e6, np.full_like(charts.corner_uv, np.nan)):
        mesh = Mesh(charts.vertices, charts.faces, None, uv)
        with pytest.raises(MeshError, match=r"4096|plane=False"):
            page(mesh, tmp_path / "p.html", plane=False, texture=np.ones((2, 2)))
    mesh = Mesh(charts.vertices, charts.faces, None, np.zeros_like(charts.corner_uv))
    _, header, _ = written(mesh, tmp_path / "p.html", plane=False, texture="checkerboard")
    assert header["own"]["flipped"] == mesh.n_faces


def test_a_picture_without_a_map_is_missed(tmp_path):
    faces = icosphere(1).faces.copy()
    faces[5] = faces[5, ::-1]
    done, header, sections = written(
        Mesh(icosphere(1).vertices, faces), tmp_path / "p.html", texture=np.ones((2, 2))
    )
    assert "picture" not in sections
    assert header["picture"] is None
    assert any("without the texture" in note for note in done.notes)
