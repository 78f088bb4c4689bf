"""Example 1: isometry, conformality and curvature; what bending keeps (E1)."""

import numpy as np
import pytest

import charts
from beltrami.surfaces.surface import ParametricSurface
from charts import inside

BOX = ((-0.8, 0.9), (-0.7, 1.0))


def bent(s):
    """The plane rolled up to a cylinder of curvature s."""
    if s == 0:
        return ParametricSurface(lambda u, v: (u, v, 0 * u), BOX)
    return ParametricSurface(lambda u, v: (np.sin(s * u) / s, v, (1 - np.cos(s * u)) / s), BOX)


def between_helicoid_and_catenoid(angle):
    def phi(u, v):
        c, s = np.cos(angle), np.sin(angle)
        return (
            c * np.sinh(v) * np.sin(u) + s * np.cosh(v) * np.cos(u),
            -c * np.sinh(v) * np.cos(u) + s * np.cosh(v) * np.sin(u),
            c * u + s * v,
        )

    return ParametricSurface(phi, BOX)


def _by_brioschi(surface, u, v):
    """K from E, F, G and their derivatives alone, by differences."""
    h = 1e-3

    def form(a, b):
        g = surface.first_fundamental_form(u + a * h, v + b * h)
        return np.stack([g[..., 0, 0], g[..., 0, 1], g[..., 1, 1]])

    E, F, G = form(0, 0)
    u1, v1 = (form(1, 0) - form(-1, 0)) / (2 * h), (form(0, 1) - form(0, -1)) / (2 * h)
    (Eu, Fu, Gu), (Ev, Fv, Gv) = u1, v1
    Evv = ((form(0, 1) - 2 * form(0, 0) + form(0, -1)) / h**2)[0]
    Guu = ((form(1, 0) - 2 * form(0, 0) + form(-1, 0)) / h**2)[2]
    Fuv = ((form(1, 1) - form(1, -1) - form(-1, 1) + form(-1, -1)) / (4 * h**2))[1]
    nil = 0 * E
    a = [[Fuv - Evv / 2 - Guu / 2, Eu / 2, Fu - Ev / 2], [Fv - Gu / 2, E, F], [Gv / 2, F, G]]
    b = [[nil, Ev / 2, Gu / 2], [Ev / 2, E, F], [Gu / 2, F, G]]
    det = [np.linalg.det(np.moveaxis(np.array(m), -1, 0)) for m in (a, b)]
    return (det[0] - det[1]) / (E * G - F**2) ** 2


@pytest.mark.chapter("X1")
def test_i_equal_to_id_belongs_to_the_map_not_to_the_surface():
    """The polar plane and the cylinder of radius 2 have I ≠ Id, and are flat all the same."""
    assert bent(0).is_isometric()
    assert bent(1.1).is_isometric()
    for surface in (charts.polar_plane(), charts.cylinder(2)):
        assert not surface.is_isometric()
        assert surface.is_flat()
    assert charts.cylinder(1).is_isometric()
    assert charts.cylinder().first_fundamental_form(1, 1).round(13).tolist() == [[4, 0], [0, 1]]
    polar = charts.polar_plane().first_fundamental_form(2, 1).round(13)
    assert polar.tolist() == [[1, 0], [0, 4]]
    for surface in (charts.sphere(), charts.torus(), charts.mobius()):
        assert not surface.is_flat()
        assert not surface.is_isometric()


@pytest.mark.chapter("X1")
def test_flat_in_parts_is_not_flat():
    half = ParametricSurface(lambda u, v: (u, v, np.where(u > 0, u, 0.0) ** 4 * v**2), BOX)
    assert np.array_equal(half.gaussian_curvature([-0.5, -0.1], 0.5), [0, 0])
    assert half.gaussian_curvature(0.5, 0.5) < -1e-3
    assert not half.is_flat()


@pytest.mark.chapter("X1")
def test_a_sheared_plane_is_neither_isometric_nor_conformal_but_flat():
    sheared = ParametricSurface(lambda u, v: (u + 0.01 * v, v), BOX)
    assert not sheared.is_isometric()
    assert not sheared.is_conformal()
    assert sheared.is_flat()
    stretched = ParametricSurface(lambda u, v: (1.001 * u, v), BOX)
    assert not stretched.is_conformal()
    doubled = ParametricSurface(lambda u, v: (2 * u, 2 * v), BOX)
    assert doubled.is_conformal()
    assert not doubled.is_isometric()


@pytest.mark.chapter("X1")
def test_a_point_is_no_conformal_image():
    point = ParametricSurface(lambda u, v: (0 * u, 0 * v, 1), BOX)
    assert not point.is_conformal()
    assert not point.is_isometric()


@pytest.mark.chapter("X1")
def test_the_stereographic_map_is_conformal():
    surface = charts.stereographic()
    assert surface.is_conformal()
    assert not surface.is_isometric()
    assert not charts.sphere().is_conformal()
    u, v = inside(surface)
    factor = 4 / (1 + u**2 + v**2) ** 2
    g = surface.first_fundamental_form(u, v)
    assert np.allclose(g, factor[:, None, None] * np.eye(2), rtol=1e-13, atol=1e-14)
    assert np.allclose(surface.area_element(u, v), factor, rtol=1e-13)  # areas by λ ...
    directions = np.array([[1.0, 0.3], [-0.4, 0.8]])
    on_surface = surface.jacobian(u, v) @ directions.T
    lengths = np.linalg.norm(on_surface, axis=1) / np.linalg.norm(directions, axis=1)
    assert np.allclose(lengths, np.sqrt(factor)[:, None], rtol=1e-13)  # ... lengths by sqrt(λ)


@pytest.mark.chapter("X1")
def test_conformal_maps_keep_angles_and_others_do_not():
    directions = np.array([[1.0, 0.3], [-0.4, 0.8]])

    def cosine(a, b):
        return (a * b).sum(-1) / (np.linalg.norm(a, axis=-1) * np.linalg.norm(b, axis=-1))

    flat = cosine(*directions)
    for surface, kept in ((charts.stereographic(), True), (charts.sphere(), False)):
        images = surface.jacobian(0.3, 0.4) @ directions.T
        assert (abs(cosine(images[:, 0], images[:, 1]) - flat) < 1e-13) == kept


@pytest.mark.chapter("P3")
@pytest.mark.parametrize("s", [0.0, 0.4, 1.3])
def test_bending_the_plane_keeps_i_and_k_and_changes_mean_curvature(s):
    surface = bent(s)
    u, v = inside(surface)
    assert surface.is_isometric(bent(0))
    assert np.allclose(surface.gaussian_curvature(u, v), 0, atol=1e-13)
    assert np.allclose(surface.mean_curvature(u, v), -s / 2, rtol=1e-12, atol=1e-13)


@pytest.mark.chapter("P3")
@pytest.mark.parametrize("angle", [0.0, 0.6, np.pi / 2])
def test_bending_the_helicoid_to_the_catenoid_keeps_k(angle):
    surface = between_helicoid_and_catenoid(angle)
    assert surface.is_isometric(between_helicoid_and_catenoid(0.2))
    assert not surface.is_isometric()
    u, v = inside(surface)
    assert np.allclose(surface.gaussian_curvature(u, v), -(np.cosh(v) ** -4.0), rtol=1e-11)
    assert np.allclose(surface.mean_curvature(u, v), 0, atol=1e-13)


@pytest.mark.chapter("P3")
@pytest.mark.parametrize(
    "name", ["torus", "skewed_sphere", "stereographic", "mobius", "klein", "cylinder"]
)
def test_gaussian_curvature_depends_on_i_alone(name):
    surface = getattr(charts, name)()
    u, v = inside(surface)
    K = surface.gaussian_curvature(u, v)
    assert np.allclose(K, _by_brioschi(surface, u, v), rtol=1e-4, atol=1e-4)


@pytest.mark.chapter("P3", "X1")
def test_closed_forms_of_curvature():
    R, r = 2.0, 0.7
    torus = charts.torus(R, r)
    u, v = inside(torus)
    K = np.cos(v) / (r * (R + r * np.cos(v)))
    H = (R + 2 * r * np.cos(v)) / (2 * r * (R + r * np.cos(v)))  # the normal is outward
    assert np.allclose(torus.gaussian_curvature(u, v), K, rtol=1e-12, atol=1e-14)
    assert np.allclose(torus.mean_curvature(u, v), H, rtol=1e-12)
    for surface, side in ((charts.sphere(), 1), (charts.skewed_sphere(), -1)):
        u, v = inside(surface)
        assert np.allclose(surface.gaussian_curvature(u, v), 1, rtol=1e-10)
        outward = np.linalg.det(
            np.stack([surface(u, v), *np.moveaxis(surface.jacobian(u, v), -1, 0)], -1)
        )
        assert (np.sign(outward) == -side).all()
        assert np.allclose(surface.mean_curvature(u, v), -side, rtol=1e-10)
    assert charts.cylinder(2).mean_curvature(1.0, 1.0) == pytest.approx(1 / 4)


@pytest.mark.chapter("P3")
@pytest.mark.parametrize(("name", "chi"), [("sphere", 2), ("torus", 0), ("klein", 0)])
def test_total_curvature_is_2_pi_chi(name, chi):
    surface, n = getattr(charts, name)(), 64
    u = np.linspace(0, 2 * np.pi, n, endpoint=False)[:, None]
    v, weight = np.polynomial.legendre.leggauss(n)
    low, high = surface.domain.v
    v = (low + high + (high - low) * v) / 2
    area = surface.area_element(u, v) * weight * (high - low) / 2 * 2 * np.pi / n
    total = (surface.gaussian_curvature(u, v) * area).sum()
    assert total == pytest.approx(2 * np.pi * chi, abs=1e-9)
    assert surface.mesh(8, 8).euler_characteristic == chi
