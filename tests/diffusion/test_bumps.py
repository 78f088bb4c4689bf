import numpy as np
import pytest

from beltrami.diffusion.bumps import BUMP_DISTANCES, gaussian_bumps
from beltrami.diffusion.wave import wave
from beltrami.errors import (
    BeltramiError,
    DegenerateFaceError,
    DimensionError,
    MeshError,
    NonFiniteError,
    UnknownNameError,
)
from beltrami.geodesics.distance import geodesic_distance
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import cube, icosphere
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import MESHES

CENTRES, HEIGHTS, WIDTH = [3, 100, 250], np.array([1.0, -2.0, 0.5]), 0.4


@pytest.mark.chapter("P48")
@pytest.mark.parametrize("kind", BUMP_DISTANCES)
def test_bumps_are_a_superposition_of_gaussians(kind):
    mesh = MESHES["closed"]()
    expected = np.zeros(mesh.n_vertices)
    for centre, height in zip(CENTRES, HEIGHTS, strict=True):
        if kind == "euclidean":
            d = np.linalg.norm(mesh.vertices - mesh.vertices[centre], axis=1)
        else:
            d = geodesic_distance(mesh, centre, method=kind)
        expected += height * np.exp(-(d**2) / (2 * WIDTH**2))
    found = gaussian_bumps(mesh, CENTRES, WIDTH, HEIGHTS, distance=kind)
    assert np.allclose(found, expected, atol=1e-14)
    alike = gaussian_bumps(mesh, CENTRES, WIDTH, distance=kind)
    one_by_one = sum(gaussian_bumps(mesh, c, WIDTH, distance=kind) for c in CENTRES)
    assert np.allclose(alike, one_by_one, atol=1e-14)


@pytest.mark.chapter("P48")
def test_bumps_do_not_reach_through_the_body():
    """Two sides of a thin slab: near in space, far along the surface."""
    box = cube(8)
    slab = box.with_vertices(box.vertices * [1, 1, 0.02])
    middle = np.linalg.norm(slab.vertices - slab.vertices.mean(axis=0), axis=1)
    top, bottom = np.argsort(middle)[:2]
    assert gaussian_bumps(slab, top, 0.2, distance="euclidean")[bottom] > 0.9
    assert gaussian_bumps(slab, top, 0.2, distance="exact")[bottom] < 0.1


@pytest.mark.chapter("P48")
def test_balanced_bumps_have_no_mean():
    mesh = MESHES["obt"]()
    for mass in ("degree", "voronoi", "consistent"):
        pair = laplacian(mesh, mass=mass)
        balanced = gaussian_bumps(mesh, CENTRES, WIDTH, HEIGHTS, balance=pair)
        plain = gaussian_bumps(mesh, CENTRES, WIDTH, HEIGHTS)
        assert abs(pair.mean(balanced)) < 1e-15
        assert np.ptp(plain - balanced) < 1e-15
        assert abs(pair.mean(plain)) > 1e-3


@pytest.mark.chapter("P48", "Q3.8")
def test_a_wave_from_bumps_has_a_finite_speed():
    """Figure 3.6: on the unit sphere nothing has arrived yet at the distance time + 6 widths."""
    mesh = icosphere(4)
    f = gaussian_bumps(mesh, [0, 1], 0.12, [1, -1], distance="exact")
    distance = geodesic_distance(mesh, [0, 1], method="exact")
    pair = laplacian(mesh)
    for time, frame in wave(pair, f, None, [0.4, 0.8]):
        assert np.abs(frame[distance > time + 0.6]).max() < 0.003
        front = np.abs(frame[np.abs(distance - time) < 0.2])
        assert front.max() > 0.05


def test_components_without_a_centre_stay_flat():
    one = icosphere(1)
    x = np.concatenate([one.vertices, one.vertices + 9])
    both = Mesh(x, np.concatenate([one.faces, one.faces + 42]))
    for kind in ("heat", "exact", "edges"):
        f = gaussian_bumps(both, 3, 5.0, distance=kind)
        assert not f[42:].any()
        assert f[3] == 1


def test_what_is_refused():
    mesh = icosphere(1)
    with pytest.raises(UnknownNameError, match="Did you mean 'euclidean'"):
        gaussian_bumps(mesh, 0, 1, distance="euclidian")
    for width in (0, -1, np.nan, np.inf):
        with pytest.raises(BeltramiError, match="width of bumps"):
            gaussian_bumps(mesh, 0, width)
    with pytest.raises(DimensionError, match="2 bumps"):
        gaussian_bumps(mesh, [0, 1], 1, [1, 2, 3])
    with pytest.raises(NonFiniteError):
        gaussian_bumps(mesh, [0, 1], 1, [1, np.nan])
    with pytest.raises(MeshError, match="outside"):
        gaussian_bumps(mesh, [42], 1)
    with pytest.raises(BeltramiError, match="centre"):
        gaussian_bumps(mesh, [], 1)
    flat = Mesh([[0, 0], [1, 0], [2, 0]], [[0, 1, 2]])
    for kind in BUMP_DISTANCES:
        with pytest.raises(DegenerateFaceError):
            gaussian_bumps(flat, 0, 1, distance=kind)
