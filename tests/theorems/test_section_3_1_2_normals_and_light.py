"""Section 3.1.2: normals of faces and vertices, and the light that they give (E10, E11)."""

import numpy as np
import pytest

from beltrami.display.light import DirectionalLight, SpotLight, light_intensity
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import icosphere
from meshes_of_the_errata import MESHES

SURFACES = ("closed", "obt", "open", "cur", "tor")


def _in_space(mesh):
    return np.pad(mesh.vertices, ((0, 0), (0, 3 - mesh.dimension)))


def _face_normals(mesh):
    a, b, c = _in_space(mesh)[mesh.faces].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


@pytest.mark.chapter("U9")
@pytest.mark.parametrize("name", SURFACES)
def test_the_normal_of_a_face(name):
    mesh = MESHES[name]()
    normals = mesh.face_normals
    assert np.allclose(normals, _face_normals(mesh), atol=1e-12)
    turned = Mesh(mesh.vertices, mesh.faces[:, ::-1])
    assert np.allclose(turned.face_normals, -normals, atol=1e-12)
    if mesh.is_closed and name != "tor":  # convex: they point outwards
        middle = mesh.vertices[mesh.faces].mean(axis=1)
        assert ((normals * middle).sum(axis=1) > 0).all()


@pytest.mark.chapter("U10")
@pytest.mark.parametrize("name", SURFACES)
def test_the_printed_normal_of_a_vertex_is_that_of_uniform_weights(name):
    mesh = MESHES[name]()
    sums = np.zeros((mesh.n_vertices, 3))
    for c in range(3):
        np.add.at(sums, mesh.faces[:, c], _face_normals(mesh))
    printed = sums / np.linalg.norm(sums, axis=1, keepdims=True)
    assert np.allclose(mesh.weighted_normals("uniform"), printed, atol=1e-12)
    if name != "open":  # a plane has one normal
        assert np.abs(mesh.vertex_normals - printed).max() > 1e-2


def _check_cut(weights):
    """The normal at the corner of a cube does not tell how its three squares are cut."""
    x = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [1, 0, 1], [0, 1, 1]]
    squares = ([0, 2, 4, 1], [0, 1, 5, 3], [0, 3, 6, 2])
    for cuts in range(8):
        faces = []
        for k, (a, b, c, d) in enumerate(squares):
            through = [[a, b, c], [a, c, d]]
            across = [[a, b, d], [b, c, d]]
            faces += through if cuts >> k & 1 else across
        normal = Mesh(x, faces).weighted_normals(weights)[0]
        assert normal == pytest.approx(-np.ones(3) / np.sqrt(3), abs=1e-12)


@pytest.mark.chapter("U10")
def test_the_printed_normal_depends_on_the_cut_of_a_square():
    _check_cut("angle")
    for wrong in ("uniform", "area"):
        with pytest.raises(AssertionError):
            _check_cut(wrong)
    sphere = icosphere(3)  # which hides it: nearly regular
    for weights in ("uniform", "area", "angle"):
        assert np.abs(sphere.weighted_normals(weights) - sphere.vertices).max() < 0.012


def _intensity(towards):
    def intensity(mesh, s):
        direction = towards(mesh.vertices, s)
        direction = direction / np.linalg.norm(direction, axis=1, keepdims=True)
        return np.maximum((mesh.vertex_normals * direction).sum(axis=1), 0)

    return intensity


def _library(mesh, s):
    return light_intensity(mesh, SpotLight(s))


def _check_lit(intensity):
    """On a convex mesh the lit vertices are those that see the lamp."""
    mesh = MESHES["closed"]()
    for s in ([0, 0, 3.0], [1.4, -2.2, 0.7]):
        light = intensity(mesh, np.array(s))
        height = mesh.vertices @ s - 1  # positive where the sphere sees the lamp
        assert (light[height > 0.4] > 0).all()
        assert (light[height < -0.4] == 0).all()
        assert light.min() >= 0
        assert light.max() <= 1
        nearest = (mesh.vertices @ s).argmax()
        assert light[nearest] > 0.95


@pytest.mark.chapter("U11", "P12")
def test_the_light_points_towards_the_lamp():
    _check_lit(_library)
    _check_lit(_intensity(lambda x, s: s - x))
    for wrong in (lambda x, s: x - s, lambda x, s: s + x):  # as printed (E11), and another sign
        with pytest.raises(AssertionError):
            _check_lit(_intensity(wrong))
    mesh = MESHES["cur"]()
    lamp = np.array([0.2, 0.4, 2.0])
    expected = _intensity(lambda x, s: s - x)(mesh, lamp)
    assert np.allclose(_library(mesh, lamp), expected, atol=1e-12)
    assert light_intensity(mesh, SpotLight(mesh.vertices[5]))[5] == 0  # no direction, and no NaN


@pytest.mark.chapter("U11", "P11")
@pytest.mark.parametrize("name", ["closed", "obt", "cur"])
def test_a_light_at_infinity_is_the_limit_of_far_lamps(name):
    mesh = MESHES[name]()
    direction = np.array([1.0, 2.0, -2.0]) / 3
    far = light_intensity(mesh, SpotLight(1e9 * direction))
    light = light_intensity(mesh, DirectionalLight(3 * direction))
    assert np.allclose(far, light, atol=1e-7)
    assert np.allclose(light, np.maximum(mesh.vertex_normals @ direction, 0), atol=1e-12)
    plane = light_intensity(MESHES["open"](), DirectionalLight((0.6, 0, 0.8)))
    assert np.allclose(plane, 0.8)
