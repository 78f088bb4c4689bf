"""Two different drums with the same spectrum, to rounding: what a spectrum does not tell.

C. Gordon, D. Webb and S. Wolpert (1992): two polygons of seven right triangles each. What maps the
eigenfunctions of one to those of the other works triangle by triangle, and so it does on meshes.
T. Driscoll (SIAM Review 39, 1997) has their eigenvalues to twelve digits, for drums twice as large.
"""

import numpy as np
import pytest

import analytic_spectra as truth
from beltrami.mesh.mesh import Mesh
from beltrami.operators.laplacian import laplacian

ONE = [(0, 0), (0, 1), (2, 3), (2, 2), (3, 2), (2, 1), (1, 1), (1, 0)]
OTHER = [(1, 0), (0, 1), (0, 2), (2, 2), (2, 3), (3, 2), (2, 1), (1, 1)]
THIRD = [(0, 0), (0, 1), (2, 3), (3, 3), (2, 2), (2, 1), (1, 1), (1, 0)]  # a triangle elsewhere
FALLING = [(0, 0), (0, 1), (1, 0), (2, 2)]  # unit squares of OTHER
DRISCOLL = 4 * np.array([2.53794399980, 3.65550971352, 5.17555935622, 6.53755744376, 7.24807786256])


def _inside(points, polygon):
    x, y = points.T
    inside = np.zeros(len(points), bool)
    for (a, b), (c, d) in zip(polygon, [*polygon[1:], polygon[0]], strict=True):
        crosses = (b > y) != (d > y)
        with np.errstate(divide="ignore", invalid="ignore"):
            inside ^= crosses & (x < a + (y - b) * (c - a) / (d - b))
    return inside


def _drum(polygon, k, falling=()):
    """The polygon by k squares for each unit of length; diagonals fall in these unit squares.

    They have the weight 0, but the slanted sides must be along them.
    """
    i, j = (axis.ravel() for axis in np.meshgrid(np.arange(3 * k), np.arange(3 * k)))
    a, b, c, d = ((j + t) * (3 * k + 1) + i + s for s, t in ((0, 0), (1, 0), (1, 1), (0, 1)))
    down = np.isin(3 * (j // k) + i // k, [3 * y + x for x, y in falling])
    one = np.where(down[:, None], np.stack([a, b, d], 1), np.stack([a, b, c], 1))
    two = np.where(down[:, None], np.stack([b, c, d], 1), np.stack([a, c, d], 1))
    f = np.concatenate([one, two])
    y, x = np.divmod(np.arange((3 * k + 1) ** 2), 3 * k + 1)
    points = np.stack([x, y], axis=1) / k
    f = f[_inside(points[f].mean(axis=1), polygon)]
    used, faces = np.unique(f, return_inverse=True)
    return Mesh(points[used], faces.reshape(-1, 3))


def _spectrum(mesh, mass):
    rim = np.zeros(mesh.n_vertices, bool)
    rim[np.concatenate(mesh.boundary_loops)] = True
    return truth.smallest(laplacian(mesh, mass=mass), 12, rim)


def test_the_two_drums_sound_the_same():
    one, other = _drum(ONE, 12), _drum(OTHER, 12, FALLING)
    assert one.area == pytest.approx(3.5) == other.area
    first, second = _spectrum(one, "voronoi"), _spectrum(other, "voronoi")
    assert np.allclose(first, second, rtol=1e-11)
    degrees = [np.bincount(m.faces.ravel()).tolist() for m in (one, other)]
    assert degrees[0] != degrees[1]


def test_and_so_does_no_other_polygon():
    first = _spectrum(_drum(ONE, 12), "voronoi")
    third = _drum(THIRD, 12)
    assert third.area == pytest.approx(3.5)
    assert np.abs(_spectrum(third, "voronoi") / first - 1).max() > 0.02


def test_the_eigenvalues_are_the_known_ones():
    """Errors are a h^4/3, from the corners that turn inwards, and b h²: three meshes tell λ."""
    sizes = np.array([8, 16, 32])
    values = [_spectrum(_drum(ONE, k), "voronoi")[:5] for k in sizes]
    model = np.stack([np.ones(3), sizes ** (-4 / 3), sizes**-2.0], axis=1)
    assert np.allclose(np.linalg.solve(model, values)[0], DRISCOLL, rtol=1e-4)
    assert not np.allclose(values[-1], DRISCOLL, rtol=1e-3)
    smooth = np.stack([np.ones(2), sizes[1:] ** -2.0], axis=1)
    assert not np.allclose(np.linalg.solve(smooth, values[1:])[0], DRISCOLL, rtol=5e-4)


def test_the_ninth_is_that_of_one_triangle():
    """sin πx sin 2πy - sin 2πx sin πy on each triangle, mirrored; it tends to 5π²."""
    h = 1 / 12
    exact = 4 / h**2 * (np.sin(np.pi * h / 2) ** 2 + np.sin(np.pi * h) ** 2)
    for drum in (_drum(ONE, 12), _drum(OTHER, 12, FALLING)):
        assert _spectrum(drum, "voronoi")[8] == pytest.approx(exact, rel=1e-11)
