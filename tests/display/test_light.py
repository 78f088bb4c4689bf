import numpy as np
import pytest

from beltrami.display.camera import Camera
from beltrami.display.light import (
    DirectionalLight,
    SpotLight,
    from_the_side,
    light_intensity,
    over_the_shoulder,
)
from beltrami.errors import DimensionError, MeshError, UnknownNameError
from beltrami.mesh.mesh import Mesh


@pytest.mark.chapter("U11", "P12")
def test_a_lamp_above_lights_the_north_pole_and_not_the_south(sphere):
    # erratum E11: with the printed l(i) = (v_i - s) / |v_i - s| it is the other way round
    intensity = light_intensity(sphere, SpotLight((0, 0, 3)))
    north, south = sphere.vertices[:, 2].argmax(), sphere.vertices[:, 2].argmin()
    assert intensity[north] == pytest.approx(1)
    assert intensity[south] == 0


@pytest.mark.chapter("U11", "P12")
def test_a_lamp_lights_the_vertices_that_see_it(sphere):
    lamp = np.array([0.4, -1.1, 2.3])
    # a convex mesh hides no vertex but from the lights behind all its faces there
    middles = sphere.vertices[sphere.faces].mean(axis=1)
    faces_see = np.einsum("fx,fx->f", sphere.face_normals, lamp - middles) > 0
    sees = np.zeros(sphere.n_vertices, bool)
    sees[sphere.faces[faces_see]] = True
    lit = light_intensity(sphere, SpotLight(lamp)) > 0
    height = sphere.vertices @ lamp - 1  # > 0 at the points of the round sphere that see the lamp
    clear = np.abs(height) > 0.01  # normals of the mesh are not quite those of the sphere
    assert (~clear).sum() < 40
    assert np.array_equal(lit[clear], height[clear] > 0)
    assert 0 < lit.sum() < sphere.n_vertices
    assert not (lit & ~sees).any()


@pytest.mark.chapter("U11")
def test_intensity_is_the_cosine(sphere):
    lamp = np.array([0.5, 0.7, 4.0])
    towards = lamp - sphere.vertices
    cosine = np.einsum("ix,ix->i", sphere.vertex_normals, towards)
    cosine /= np.linalg.norm(towards, axis=1)
    assert np.allclose(light_intensity(sphere, SpotLight(lamp)), np.maximum(cosine, 0), atol=1e-14)


def test_the_length_of_a_direction_does_not_matter(sphere):
    one = light_intensity(sphere, DirectionalLight((1, 2, 2)))
    assert np.allclose(one, np.maximum(sphere.vertex_normals @ [1 / 3, 2 / 3, 2 / 3], 0))
    assert np.allclose(light_intensity(sphere, DirectionalLight((1e-200, 2e-200, 2e-200))), one)


@pytest.mark.chapter("P11")
def test_a_far_lamp_is_a_direction(sphere):
    far = light_intensity(sphere, SpotLight((0, 0, 1e9)))
    assert np.allclose(far, light_intensity(sphere, DirectionalLight((0, 0, 1))), atol=1e-8)


@pytest.mark.chapter("P12")
def test_a_lamp_in_a_vertex_gives_it_no_light_and_no_nan(square):
    intensity = light_intensity(square, SpotLight(square.vertices[2]))
    assert intensity.tolist() == [0, 0, 0, 0]


def test_flat_shading_has_one_value_per_face(square):
    intensity = light_intensity(square, SpotLight((0, 0, 2)), shading="flat")
    distance = np.sqrt((1 / 3) ** 2 * 2 + 4)  # from (±1/3, ±1/3, 0) to the lamp
    assert np.allclose(intensity, 2 / distance)


def test_a_vertex_without_normal_is_dark():
    flat = Mesh([[0, 0, 0], [1, 0, 0], [2, 0, 0], [9, 9, 9]], [[0, 1, 2]])
    assert light_intensity(flat, DirectionalLight((0, 0, 1))).tolist() == [0, 0, 0, 0]


def test_the_default_lights_come_from_where_they_say():
    camera = Camera((5, 0, 0), (0, 0, 0), (0, 1, 0))  # right is -z
    main, side = over_the_shoulder(camera).direction, from_the_side(camera).direction
    assert main[0] > 0
    assert main[1] > 0
    assert main[2] > 0  # left
    assert side[0] > 0
    assert side[2] < 0  # right


@pytest.mark.parametrize(
    ("make", "value", "error"),
    [
        (DirectionalLight, (0, 0, 0), MeshError),
        (DirectionalLight, (0, 1), DimensionError),
        (SpotLight, np.zeros((3, 3)), DimensionError),
    ],
)
def test_what_is_no_light_is_refused(make, value, error):
    with pytest.raises(error):
        make(value)


def test_an_unknown_shading_is_refused(square):
    with pytest.raises(UnknownNameError):
        light_intensity(square, SpotLight((0, 0, 1)), shading="phong")


@pytest.mark.parametrize("light", [DirectionalLight((0, 1, 1)), SpotLight((0, 1, 1))])
def test_points_of_other_shapes_are_refused(light):
    assert light.towards([[5, 0, 0], [0, 0, 0]]).shape == (2, 3)
    for points in (np.zeros((4, 2)), np.zeros(3), [[0, 0, 0], [1, 1]], [["x", "y", "z"]]):
        with pytest.raises(DimensionError):
            light.towards(points)
