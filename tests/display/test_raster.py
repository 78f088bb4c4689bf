import numpy as np
import pytest

from beltrami.display.raster import NOTHING, _cover, visible_triangles
from beltrami.display.triangles import GRID, Triangles


def on_screen(xy, nearness=None):
    """Triangles given by screen coordinates in samples."""
    xy = np.asarray(xy, dtype=np.float64)
    nearness = np.ones(xy.shape[:2]) if nearness is None else np.asarray(nearness, float)
    return Triangles(
        np.rint(xy * GRID).astype(np.int64),
        nearness,
        np.arange(len(xy)),
        np.ones(xy.shape[:2], bool),
        np.zeros((0, 3, 3)),
    )


def by_barycentric_coordinates(triangles, size):
    """The same in numpy: solve for the coordinates of each middle, take the nearest."""
    x, y = np.meshgrid(np.arange(size[0]) + 0.5, np.arange(size[1]) + 0.5)
    seen = np.full(x.shape, NOTHING)
    nearest = np.zeros(x.shape)
    for t, (corners, near) in enumerate(zip(triangles.xy / GRID, triangles.nearness, strict=True)):
        system = np.vstack([corners.T, np.ones(3)])
        b = np.tensordot(np.linalg.inv(system), np.stack([x, y, np.ones_like(x)]), axes=1)
        depth = np.tensordot(near, b, axes=1)
        better = (b >= 0).all(axis=0) & (depth > nearest)
        seen[better], nearest[better] = t, depth[better]
    return seen, nearest


@pytest.mark.chapter("P8")
@pytest.mark.parametrize("seed", [55_310_882, 9_004_417_263])
def test_against_numpy(seed):
    rng = np.random.default_rng(seed)
    # some corners off the screen; no middle of a sample on a side
    xy = rng.uniform(-15, 75, (12, 3, 2))
    triangles = on_screen(xy, rng.uniform(1, 2, (12, 3)))
    size = (60, 45)
    visible = visible_triangles(triangles, size)
    seen, nearest = by_barycentric_coordinates(triangles, size)
    assert np.array_equal(visible.triangle, seen)
    assert np.allclose(visible.nearness, nearest, rtol=1e-6)
    assert len(np.unique(seen)) > 5


@pytest.mark.chapter("F3.1", "P8")
@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_the_nearer_triangle_wins_in_both_orders(order):
    corners = np.array([[2, 2], [18, 2], [2, 18]])
    near = np.array([[1.0] * 3, [2.0] * 3])[list(order)]
    visible = visible_triangles(on_screen([corners, corners], near), (20, 20))
    assert set(np.unique(visible.triangle)) == {NOTHING, order.index(1)}


def test_triangles_that_pierce_each_other_meet_in_the_middle():
    corners = [[0, 0], [20, 0], [20, 20]], [[0, 0], [20, 0], [20, 20]]
    visible = visible_triangles(on_screen(corners, [[1, 2, 2], [2, 1, 1]]), (20, 20))
    assert (visible.triangle[:, 10:][visible.triangle[:, 10:] >= 0] == 0).all()
    assert (visible.triangle[:, :10][visible.triangle[:, :10] >= 0] == 1).all()


def test_of_two_at_the_same_depth_the_first_is_seen():
    corners = [[2, 2], [18, 2], [2, 18]]
    seen = visible_triangles(on_screen([corners, corners]), (20, 20)).triangle
    assert set(np.unique(seen)) == {NOTHING, 0}


@pytest.mark.parametrize("shift", [0.0, 0.5, 0.25])  # 0.5: all vertices at middles of samples
def test_shared_sides_leave_no_crack_and_no_sample_twice(shift):
    # a fan around a vertex, with both orientations, sides in all directions, and a square rim
    rim = [(4, 4), (12, 4), (20, 4), (20, 12), (20, 20), (12, 20), (4, 20), (4, 12)]
    fan = [[rim[i], rim[(i + 1) % 8], (12, 12)] for i in range(8)]
    fan[3] = fan[3][::-1]
    triangles = on_screen(np.array(fan) + shift)
    seen, _, covered = _cover(triangles.xy, triangles.nearness, 30, 30, False)
    assert covered == 16 * 16  # half-open: a square of side 16 has 256 middles
    assert (seen >= 0).sum() == covered


def test_a_strip_of_random_triangles_covers_each_sample_once():
    rng = np.random.default_rng(31_007_552_918)
    inner = rng.uniform(5, 35, 2)
    angles = np.sort(rng.uniform(0, 2 * np.pi, 40))
    rim = 20 + 19 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    fan = np.stack([rim, np.roll(rim, -1, axis=0), np.tile(inner, (40, 1))], axis=1)
    triangles = on_screen(fan)
    seen, _, covered = _cover(triangles.xy, triangles.nearness, 40, 40, False)
    assert (seen >= 0).sum() == covered
    x, y = np.meshgrid(np.arange(40) + 0.5, np.arange(40) + 0.5)
    a, b = np.rint(rim * GRID) / GRID, np.rint(np.roll(rim, -1, axis=0) * GRID) / GRID
    side = [
        (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]) for p, q in zip(a, b, strict=True)
    ]
    assert np.array_equal(seen >= 0, (np.array(side) >= 0).all(axis=0))


def test_backs_can_be_hidden():
    front = [[2, 2], [2, 18], [18, 2]]  # counter-clockwise to the viewer, as y points down
    triangles = on_screen([front, front[::-1]], [[1] * 3, [2] * 3])
    size = (20, 20)
    assert set(np.unique(visible_triangles(triangles, size).triangle)) == {NOTHING, 1}
    assert set(np.unique(visible_triangles(triangles, size, True).triangle)) == {NOTHING, 0}


def test_triangles_without_area_are_not_drawn():
    triangles = on_screen([[[2, 2], [10, 10], [18, 18]], [[5, 5]] * 3])
    assert (visible_triangles(triangles, (20, 20)).triangle == NOTHING).all()


def test_a_triangle_around_the_whole_screen():
    triangles = on_screen([[[-5e5, -5e5], [5e5, -5e5], [0, 5e5]]])
    assert (visible_triangles(triangles, (20, 30)).triangle == 0).all()
