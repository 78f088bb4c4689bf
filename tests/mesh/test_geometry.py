import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltrami.errors import UnknownNameError
from beltrami.mesh import geometry
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import cube, icosphere
from strategies import closed_meshes, generators, planar_meshes

# the corner of a cube at the origin: three unit squares, one of them cut through the corner
CORNER = np.array(
    [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [0, 1, 1], [1, 0, 1]], float
)
CORNER_FACES = np.array([[0, 4, 1], [0, 2, 4], [0, 3, 2], [2, 3, 5], [0, 1, 3], [1, 6, 3]])


def random_turn(rng, rows, columns):
    """An isometric map of R^columns into R^rows."""
    return np.linalg.qr(rng.normal(size=(rows, rows)))[0][:, :columns]


def areas_by_gram(vertices, faces):
    """Half the root of the Gram determinant of two sides, in any dimension."""
    u, v = (vertices[faces[:, k]] - vertices[faces[:, 0]] for k in (1, 2))
    uu, vv, uv = ((a * b).sum(axis=1) for a, b in ((u, u), (v, v), (u, v)))
    return np.sqrt(np.maximum(uu * vv - uv**2, 0)) / 2


@pytest.mark.chapter("U6", "U12")
@given(closed_meshes())
def test_areas_and_angles_by_other_formulas(mesh):
    x, f = mesh.vertices, mesh.faces
    assert geometry.face_areas(x, f) == pytest.approx(areas_by_gram(x, f), rel=1e-6, abs=1e-9)
    for c in range(3):
        u, v = x[f[:, (c + 1) % 3]] - x[f[:, c]], x[f[:, (c + 2) % 3]] - x[f[:, c]]
        cosine = (u * v).sum(axis=1) / np.linalg.norm(u, axis=1) / np.linalg.norm(v, axis=1)
        assert np.cos(geometry.corner_angles(x, f)[:, c]) == pytest.approx(cosine, abs=1e-12)


@pytest.mark.chapter("U12")
@given(closed_meshes())
def test_corner_angles_add_to_pi(mesh):
    assert mesh.corner_angles.sum(axis=1) == pytest.approx(np.pi, abs=1e-12)


@pytest.mark.chapter("U12")
@given(planar_meshes())
def test_angles_around_an_inner_vertex_of_a_plane_add_to_two_pi(mesh):
    sums = np.bincount(mesh.faces.ravel(), mesh.corner_angles.ravel(), mesh.n_vertices)
    inner = np.setdiff1d(np.unique(mesh.faces), mesh.topology.boundary_edges)
    assert sums[inner] == pytest.approx(2 * np.pi, abs=1e-9)


def test_angles_of_needles_are_exact():
    tiny = 1e-9
    x = np.array([[0, 0], [1, 0], [1, tiny], [0.5, tiny]])
    needle, blade = geometry.corner_angles(x, np.array([[0, 1, 2], [0, 1, 3]]))
    assert needle[0] == pytest.approx(tiny, rel=1e-9)
    assert needle[1] == np.pi / 2
    assert np.pi - blade[2] == pytest.approx(4 * tiny, rel=1e-6)


@pytest.mark.chapter("U5")
@given(planar_meshes(), generators())
def test_two_three_and_five_dimensions_agree(mesh, rng):
    for d in (3, 5):
        turned = mesh.with_vertices(mesh.vertices @ random_turn(rng, d, 2).T + rng.normal(size=d))
        assert turned.face_areas == pytest.approx(mesh.face_areas, rel=1e-6, abs=1e-12)
        assert turned.corner_angles == pytest.approx(mesh.corner_angles, abs=1e-6)
        assert turned.edge_lengths == pytest.approx(mesh.edge_lengths, rel=1e-12)


@given(closed_meshes(), generators())
def test_three_and_six_dimensions_agree(mesh, rng):
    lifted = mesh.with_vertices(mesh.vertices @ random_turn(rng, 6, 3).T)
    assert lifted.face_areas == pytest.approx(mesh.face_areas, rel=1e-6, abs=1e-9)
    assert lifted.corner_angles == pytest.approx(mesh.corner_angles, abs=1e-6)


@pytest.mark.parametrize("scale", [1e-100, 1e-60, 1e60, 1e100])
def test_the_unit_of_length_does_not_matter(scale):
    mesh = icosphere(1)
    scaled = mesh.with_vertices(mesh.vertices * scale)
    assert scaled.face_areas / scale / scale == pytest.approx(mesh.face_areas, rel=1e-12)
    assert scaled.corner_angles == pytest.approx(mesh.corner_angles, abs=1e-12)
    assert scaled.edge_lengths / scale == pytest.approx(mesh.edge_lengths, rel=1e-12)
    assert scaled.face_normals == pytest.approx(mesh.face_normals, abs=1e-12)
    for weights in geometry.NORMAL_WEIGHTS:
        assert scaled.weighted_normals(weights) == pytest.approx(
            mesh.weighted_normals(weights), abs=1e-12
        )
    assert scaled.volume / scale / scale / scale == pytest.approx(mesh.volume, rel=1e-12)
    assert not len(geometry.degenerate_faces(scaled.vertices, scaled.faces))


@pytest.mark.parametrize("scale", [1e-100, 1e100])
def test_the_unit_of_length_does_not_matter_in_five_dimensions(scale):
    mesh = icosphere(1)
    lifted = mesh.with_vertices(np.pad(mesh.vertices, ((0, 0), (0, 2))) * scale)
    assert lifted.face_areas / scale / scale == pytest.approx(mesh.face_areas, rel=1e-9)
    assert lifted.corner_angles == pytest.approx(mesh.corner_angles, abs=1e-9)


def test_translation_far_away():
    mesh = icosphere(2)
    far = mesh.with_vertices(mesh.vertices + np.array([1e6, -2e6, 3e6]))
    assert far.volume == pytest.approx(mesh.volume, rel=1e-7)
    assert far.area == pytest.approx(mesh.area, rel=1e-7)
    assert far.vertex_normals == pytest.approx(mesh.vertex_normals, abs=1e-6)


# ------------------------------------------------------------------------------ normals


@pytest.mark.chapter("U10")
def test_the_corner_of_a_cube():
    """E10: the plain sum is off by 19.47 degrees, the sum weighted by angles by nothing."""
    symmetric = -np.ones(3) / np.sqrt(3)
    mesh = Mesh(CORNER, CORNER_FACES)
    cosine = {w: mesh.weighted_normals(w)[0] @ symmetric for w in geometry.NORMAL_WEIGHTS}
    off = {w: np.degrees(np.arccos(min(c, 1.0))) for w, c in cosine.items()}
    assert off["uniform"] == pytest.approx(19.47122, abs=1e-4)
    assert off["area"] == pytest.approx(19.47122, abs=1e-4)  # the cut square counts in full here
    assert off["angle"] == pytest.approx(0, abs=1e-6)
    assert mesh.vertex_normals[0] == pytest.approx(symmetric, abs=1e-15)


@pytest.mark.chapter("U9", "U10")
def test_weights_by_a_loop():
    rng = np.random.default_rng(27182818284)
    mesh = icosphere(1)
    mesh = mesh.with_vertices(mesh.vertices + 0.1 * rng.normal(size=mesh.vertices.shape))
    x, f = mesh.vertices, mesh.faces
    cross = np.cross(x[f[:, 1]] - x[f[:, 0]], x[f[:, 2]] - x[f[:, 0]])
    length = np.linalg.norm(cross, axis=1)
    assert mesh.face_normals == pytest.approx(cross / length[:, None], abs=1e-14)
    weight = {
        "uniform": np.ones(f.shape),
        "area": np.repeat(length[:, None] / 2, 3, axis=1),
        "angle": mesh.corner_angles,
    }
    for name, shares in weight.items():
        sums = np.zeros(x.shape)
        for face, normal, share in zip(f, cross / length[:, None], shares, strict=True):
            sums[face] += share[:, None] * normal
        expected = sums / np.linalg.norm(sums, axis=1)[:, None]
        assert mesh.weighted_normals(name) == pytest.approx(expected, abs=1e-13)


def test_normals_point_outwards_and_have_length_one():
    for mesh in (icosphere(2), cube(3)):
        assert np.linalg.norm(mesh.vertex_normals, axis=1) == pytest.approx(1)
        assert ((mesh.vertex_normals * mesh.vertices).sum(axis=1) > 0).all()
    assert icosphere(2).vertex_normals == pytest.approx(icosphere(2).vertices, abs=0.02)


def test_normals_of_the_plane_point_up():
    flat = Mesh([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]])
    assert flat.face_normals.tolist() == [[0, 0, 1]]
    assert flat.vertex_normals.tolist() == [[0, 0, 1]] * 3


def test_normals_are_zero_where_there_is_none():
    x = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [5, 5, 5], [0, 1, 0]]
    mesh = Mesh(x, [[0, 1, 2]])
    assert not mesh.face_normals.any()
    assert not mesh.vertex_normals.any()
    pillow = Mesh(x, [[0, 1, 4], [0, 4, 1]])  # two normals that cancel
    for weights in geometry.NORMAL_WEIGHTS:
        assert not pillow.weighted_normals(weights).any()


def test_unknown_weights():
    with pytest.raises(UnknownNameError, match="'angle'"):
        cube().weighted_normals("angles")


def test_unit_of_rows_large_and_small():
    rows = np.array([[3e-200, 4e-200, 0], [0, -3e200, 4e200], [0, 0, 0], [5e-324, 0, 0]])
    assert geometry.unit(rows) == pytest.approx(
        np.array([[0.6, 0.8, 0], [0, -0.6, 0.8], [0, 0, 0], [1, 0, 0]])
    )


def test_unit_of_what_is_not_finite_is_not():
    inf, nan = np.inf, np.nan
    rows = np.array([[inf, 0, 0], [-inf, inf, 1], [nan, 2, 0], [3, -4, nan], [inf, nan, 1]])
    assert not np.isfinite(geometry.unit(rows)).all(axis=1).any()


def test_unit_against_numpy():
    random = np.random.default_rng(0)
    rows = random.standard_normal((100, 3)) * 10 ** random.uniform(-3, 3, (100, 3))
    expected = rows / np.linalg.norm(rows, axis=1)[:, None]
    for some in (rows, rows[::3], np.asfortranarray(rows), rows[:0]):
        found = geometry.unit(some)
        assert found == pytest.approx(expected[::3] if len(some) == 34 else expected[: len(some)])
    assert np.array_equal(geometry.unit(-rows), -geometry.unit(rows))


# ------------------------------------------------------------------------------ flat faces


@pytest.mark.parametrize("scale", [1e-100, 1.0, 1e100])
@pytest.mark.parametrize("d", [2, 3, 5])
def test_the_bound_on_flat_faces(scale, d):
    """area <= 1e-12 (longest edge)^2: half the height of a face on a side of length one."""
    x = np.zeros((5, d))
    x[:, :2] = [[0, 0], [1, 0], [0.5, 1.9e-12], [0.5, 2.1e-12], [2, 0]]
    faces = np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4], [0, 0, 3], [3, 1, 3], [3, 1, 1]])
    for turn in ([0, 1, 2], [1, 2, 0], [2, 1, 0]):
        found = geometry.degenerate_faces(x * scale, faces[:, turn]).tolist()
        assert found == [0, 2, 3, 4, 5]


def test_a_needle_is_flat_by_its_longest_edge_not_by_its_first():
    x = np.array([[0, 0], [0, 1e-13], [1, 0]])
    for faces in ([[0, 1, 2]], [[1, 2, 0]], [[2, 0, 1]]):
        assert geometry.degenerate_faces(x, np.array(faces)).tolist() == [0]
    x[1, 1] = 1e-9
    assert geometry.degenerate_faces(x, np.array([[0, 1, 2]])).tolist() == []


@given(st.sampled_from([np.nan, np.inf, -np.inf]), st.integers(0, 2), st.integers(0, 2))
def test_faces_that_are_not_finite_are_not_flat(value, row, column):
    for x in (np.zeros((3, 3)), np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])):
        x[row, column] = value
        assert geometry.degenerate_faces(x, np.array([[0, 1, 2]])).tolist() == []


def test_no_faces():
    for d in (2, 3, 5):
        x, none = np.zeros((2, d)), np.zeros((0, 3), np.int64)
        assert geometry.face_areas(x, none).shape == (0,)
        assert geometry.corner_angles(x, none).shape == (0, 3)
        assert geometry.vertex_normals(x, none, "angle").shape == (2, 3)
        assert geometry.degenerate_faces(x, none).shape == (0,)


def test_a_vertex_at_infinity_is_no_warning():
    x = icosphere(1).vertices.copy()
    x[0] = np.inf
    mesh = Mesh(x, icosphere(1).faces)
    far = (mesh.faces != 0).all(axis=1)
    assert np.allclose(mesh.face_normals[far], icosphere(1).face_normals[far])
    assert not np.isfinite(mesh.face_normals[~far]).all(axis=1).any()
