"""Tufted Laplacians of points; they need robust_laplacian, and are skipped without it."""

import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.errors import (
    DimensionError,
    UnknownNameError,
)
from beltrami.mesh.shapes import icosphere
from beltrami.operators.laplacian import laplacian
from beltrami.operators.point_cloud import PointCloud
from meshes_of_the_errata import MESHES

pytest.importorskip("robust_laplacian")


@pytest.mark.chapter("P4", "P35")
def test_points_of_the_sphere():
    """Dirichlet energies ∫|∇f|² = l(l + 1) ∫f², and areas of 4π."""
    points = MESHES["closed"]().vertices
    cloud = laplacian(PointCloud(points), "tufted")
    assert cloud.properties.maximum_principle
    assert cloud.masses.sum() == pytest.approx(4 * np.pi, rel=0.05)
    x, y, z = points.T
    for f, value in ((z, 2), (x * y, 6), (x * z, 6)):
        assert cloud.dirichlet_energy(f) / cloud.norm(f) ** 2 == pytest.approx(value, rel=0.1)
    sphere = icosphere(3)
    regular = laplacian(PointCloud(sphere.vertices), "tufted")
    L = laplacian(sphere).stiffness
    assert abs(regular.stiffness - L).max() < 1e-12 * abs(L).max()
    few = laplacian(PointCloud(points, 6), "tufted")  # the number of neighbours matters
    assert abs(few.stiffness - cloud.stiffness).max() > 1e-3
    unit = laplacian(PointCloud(points), "tufted", "unit")
    assert (unit.masses == 1).all()


@pytest.mark.chapter("P4")
def test_points_of_the_plane():
    points = MESHES["open"]().vertices
    pair = laplacian(PointCloud(points, 20), "tufted")
    assert 0.9 < pair.masses.sum() < 1  # some is lost at the border
    energy = pair.dirichlet_energy(points[:, 0])  # ∫|∇x|² is that area
    assert energy == pytest.approx(pair.masses.sum(), rel=0.1)


def test_what_is_refused():
    cloud = PointCloud(MESHES["closed"]().vertices)
    with pytest.raises(UnknownNameError) as mass:
        laplacian(cloud, "tufted", "voronoi")
    assert mass.value.choices == ("barycentric", "degree", "unit")
    pair = laplacian(cloud, "tufted")
    assert pair.spectral_bound("degree") == pytest.approx(2)
    L, B = pair.stiffness.toarray(), pair.mass.toarray()
    assert oracle.spectrum(L, B)[-1] <= pair.spectral_bound() * (1 + 1e-12)
    with pytest.raises(UnknownNameError):
        pair.spectral_bound("voronoi")
    wide = np.pad(cloud.points, ((0, 0), (0, 1)))
    with pytest.raises(DimensionError, match="coordinates"):
        laplacian(PointCloud(wide), "tufted")
