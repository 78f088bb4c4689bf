import numpy as np
import pytest

from beltrami.display.framing import FILL, fit_camera
from beltrami.errors import EmptyMeshError, MeshError, UnknownNameError
from beltrami.mesh.mesh import Mesh


@pytest.mark.parametrize("view", [(0, 0), (30, 20), (-170, -60), (1, 2, 3)])
def test_the_ball_has_the_same_disk_from_all_sides(sphere, view):
    camera = fit_camera(sphere, view)
    size = (400, 300)
    angle = np.linspace(0, 2 * np.pi, 50)
    distance = np.linalg.norm(camera.position)
    # the tangent cone touches the unit sphere on a circle at the distance 1 / d from its centre
    height, radius = 1 / distance, np.sqrt(1 - 1 / distance**2)
    right, up, forward = camera.axes
    circle = radius * (np.cos(angle)[:, None] * right + np.sin(angle)[:, None] * up)
    image = camera.project(circle - height * forward, size)[:, :2] - np.array(size) / 2
    assert np.allclose(np.linalg.norm(image, axis=1), FILL * 150)


def test_unreferenced_vertices_do_not_count(square):
    more = Mesh(np.concatenate([square.vertices, [[50, 60, 70]]]), square.faces)
    assert np.array_equal(fit_camera(more).position, fit_camera(square).position)


@pytest.mark.parametrize(
    ("up", "front", "right", "above"),
    [
        ("y", (0, 0, 1), (1, 0, 0), (0, 1, 0)),
        ("z", (0, -1, 0), (1, 0, 0), (0, 0, 1)),
        ("x", (0, 1, 0), (0, 0, 1), (1, 0, 0)),
    ],
)
def test_views(sphere, up, front, right, above):
    def towards(view):
        camera = fit_camera(sphere, view, up=up)
        return camera.position / np.linalg.norm(camera.position)

    assert np.allclose(towards((0, 0)), front)
    assert np.allclose(towards((90, 0)), right)
    assert np.allclose(towards((180, 0)), -np.array(front))
    assert np.allclose(towards((25, 90)), above)
    assert np.allclose(fit_camera(sphere, (0, 0), up=up).axes[:2], [right, above])


def test_a_vector_is_a_view(sphere):
    camera = fit_camera(sphere, (1, 2, 2))
    assert np.allclose(camera.position / np.linalg.norm(camera.position), np.array([1, 2, 2]) / 3)


def test_zoom_magnifies_and_keeps_the_eye(sphere):
    one, three = fit_camera(sphere, (0, 0)), fit_camera(sphere, (0, 0), zoom=3)
    point = [[0.1, 0.05, 0.3]]
    offset = [camera.project(point, (100, 100))[0, :2] - 50 for camera in (one, three)]
    assert np.allclose(3 * offset[0], offset[1])
    assert np.array_equal(one.position, three.position)


def test_focus_is_in_the_middle(sphere):
    camera = fit_camera(sphere, focus=(0.3, 0.2, 0.1), zoom=5)
    assert np.allclose(camera.project([[0.3, 0.2, 0.1]], (80, 60))[0, :2], [40, 30])


def test_planar_meshes_are_seen_from_above_and_others_are_not():
    triangle = [[0, 0], [2, 0], [0, 2]]
    flat = fit_camera(Mesh(triangle, [[0, 1, 2]]))
    assert np.allclose(flat.axes, [[1, 0, 0], [0, 1, 0], [0, 0, -1]])
    solid = fit_camera(Mesh(np.pad(triangle, ((0, 0), (0, 1))), [[0, 1, 2]]))
    assert abs(solid.axes[2, 2]) < 0.9


def test_several_meshes_share_a_ball(sphere):
    moved = sphere.with_vertices(sphere.vertices + np.array([4, 0, 0]))
    camera = fit_camera([sphere, moved], (0, 0))
    assert np.allclose(camera.target, [2, 0, 0])
    assert np.allclose(camera.position[2], 3 * fit_camera(sphere, (0, 0)).position[2])


@pytest.mark.parametrize("scale", [2.0**-300, 2.0**300])
def test_the_unit_of_length_does_not_matter(square, scale):
    scaled = fit_camera(square.with_vertices(square.vertices * scale))
    assert np.array_equal(scaled.position / scale, fit_camera(square).position)


def test_one_point_can_be_looked_at():
    assert np.isfinite(fit_camera(Mesh(np.ones((3, 3)), [[0, 1, 2]])).position).all()


@pytest.mark.parametrize(
    ("options", "error"),
    [
        ({"up": "w"}, UnknownNameError),
        ({"zoom": 0}, MeshError),
        ({"view": (0, 0, 0)}, MeshError),
        ({"view": 3}, MeshError),
        ({"view": (np.inf, 0)}, MeshError),
    ],
)
def test_what_is_no_view_is_refused(square, options, error):
    with pytest.raises(error):
        fit_camera(square, **options)


def test_nothing_to_look_at():
    with pytest.raises(EmptyMeshError):
        fit_camera(Mesh(np.zeros((3, 3)), np.zeros((0, 3), int)))
