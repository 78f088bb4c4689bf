import numpy as np
import pytest

from beltrami.display.camera import Camera
from beltrami.display.raster import visible_triangles
from beltrami.display.triangles import GRID, project_faces

CAMERA = Camera((0, 0, 4), (0, 0, 0), (0, 1, 0), 90)


def test_corners_are_projected_to_the_grid():
    x = np.array([[0.0, 0, 0], [1, 0, 1], [0, 1, -2]])
    triangles = project_faces(x, np.array([[0, 1, 2]]), CAMERA, (100, 60))
    expected = CAMERA.project(x, (100, 60))
    assert np.abs(triangles.xy[0] / GRID - expected[:, :2]).max() <= 0.5 / GRID
    assert np.allclose(triangles.nearness[0], 6 / expected[:, 2])  # 6: the greatest depth
    assert triangles.borders.all()
    assert len(triangles.cut) == 0


def test_faces_behind_the_eye_are_dropped():
    x = np.array([[0.0, 0, 5], [1, 0, 5], [0, 1, 9], [0, 0, 0], [1, 0, 0], [0, 1, 0]])
    triangles = project_faces(x, np.arange(6).reshape(2, 3), CAMERA, (100, 60))
    assert triangles.face.tolist() == [1]
    behind = project_faces(x[:3], np.array([[0, 1, 2]]), CAMERA, (100, 60))
    assert len(behind.face) == 0


def test_a_face_that_reaches_behind_the_eye_covers_what_it_should():
    # the plane y = -1, from far in front to behind the eye: seen below the horizon
    x = np.array([[-500.0, -1, -900], [500, -1, -900], [500, -1, 300], [-500, -1, 300]])
    faces = np.array([[0, 2, 1], [0, 3, 2]])
    size = (100, 100)
    triangles = project_faces(x, faces, CAMERA, size)
    assert len(triangles.cut)
    seen = visible_triangles(triangles, size).triangle >= 0
    horizon = CAMERA.project([[0, -1, -900]], size)[0, 1]
    rows = np.arange(100) + 0.5 > horizon
    assert np.array_equal(seen, np.tile(rows[:, None], (1, 100)))


def test_values_are_carried_to_the_corners_of_the_pieces():
    x = np.array([[-5.0, -1, -9], [5, -1, -9], [5, -1, 30], [0, 0, 0], [1, 0, 0], [0, 1, 0]])
    triangles = project_faces(x, np.array([[0, 2, 1], [3, 4, 5]]), CAMERA, (100, 100))
    assert sorted(set(triangles.face.tolist())) == [0, 1]
    positions = triangles.carry(x[np.array([[0, 2, 1], [3, 4, 5]])])
    depth = CAMERA.view_coordinates(positions.reshape(-1, 3))[:, 2]
    assert np.allclose(triangles.nearness.ravel() * depth, 13)  # the greatest depth
    cut = positions[triangles.face == 0]
    assert np.allclose(cut[..., 1], -1)  # still in the plane of the face
    assert depth.min() > 0


@pytest.mark.parametrize("seed", [620_118_943, 71_450_336_281])
def test_the_pieces_make_up_the_part_that_can_be_drawn(seed):
    rng = np.random.default_rng(seed)
    corners = rng.normal(size=(40, 3, 3)) * 6 + [0, 0, 3]
    faces = np.arange(120).reshape(40, 3)
    triangles = project_faces(corners.reshape(-1, 3), faces, CAMERA, (64, 64))
    positions = triangles.carry(corners)
    u, v = positions[:, 1] - positions[:, 0], positions[:, 2] - positions[:, 0]
    pieces = np.bincount(
        triangles.face, np.linalg.norm(np.cross(u, v), axis=1) / 2, minlength=len(faces)
    )
    # the near plane is so near that the pieces are the part with z < 4, found by sampling
    b = rng.dirichlet([1, 1, 1], 20_000)
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = np.linalg.norm(np.cross(u, v), axis=1) / 2
    part = np.array([((b @ c)[:, 2] < 4).mean() for c in corners])
    assert ((part > 0) & (part < 1)).sum() > 5
    assert np.abs(pieces - part * area).max() < 0.02 * area.max()


def test_only_sides_of_the_face_are_borders():
    x = np.array([[0.0, -1, 30], [-1, -1, -9], [1, -1, -9]])
    triangles = project_faces(x, np.array([[0, 1, 2]]), CAMERA, (100, 100))
    assert triangles.face.tolist() == [0, 0]  # a trapezium, in two pieces
    for piece, borders in zip(triangles.carry(x[None]), triangles.borders, strict=True):
        for c in range(3):
            ends = piece[[(c + 1) % 3, (c + 2) % 3]]
            half = (30 - ends[:, 2]) / 39  # of the width of the face at this depth
            far = np.allclose(ends[:, 2], -9)
            slanting = np.allclose(ends[:, 0], half) or np.allclose(ends[:, 0], -half)
            assert borders[c] == (far or slanting)
    assert triangles.borders.sum() == 3
