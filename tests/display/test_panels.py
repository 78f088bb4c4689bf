import numpy as np
import pytest

from beltrami.display.camera import Camera
from beltrami.display.panels import make_panels, paired, place_cameras
from beltrami.errors import DimensionError, EmptyMeshError, MeshError, UnknownNameError
from beltrami.mesh.mesh import Mesh


@pytest.fixture
def triangle():
    return Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])


def test_one_mesh_and_several_functions(triangle):
    f = np.arange(3.0)
    meshes, functions, captions = paired(triangle, (f, None, f), None)
    assert meshes == [triangle] * 3
    assert functions[0] is f
    assert functions[1] is None
    assert captions == ["", "", ""]


def test_several_meshes_share_one_function(triangle, square):
    f = np.arange(3.0)
    _, functions, _ = paired([triangle, triangle], f, ["a", "b"])
    assert all(g is f for g in functions)
    assert paired([triangle, square], None, None)[1] == [None, None]


def test_a_list_of_numbers_or_of_rows_is_one_function(triangle):
    assert paired(triangle, [1, 2, 3], None)[1] == [[1, 2, 3]]
    rows = [[0, 0, 1], [0, 1, 0], [1, 0, 0]]
    assert paired(triangle, rows, None)[1] == [rows]


@pytest.mark.parametrize(
    ("f", "caption"),
    [([np.ones(3)] * 3, None), (None, ["a"]), (None, "one for two"), (None, ["a"] * 3)],
)
def test_lists_of_other_lengths_are_refused(triangle, f, caption):
    with pytest.raises(DimensionError):
        paired([triangle, triangle], f, caption)


def test_no_mesh():
    with pytest.raises(EmptyMeshError):
        paired([], None, None)


def test_cameras(triangle, sphere):
    own = place_cameras([triangle, sphere], None, up="z")
    assert not np.array_equal(own[0].target, own[1].target)
    shared = place_cameras([triangle, sphere], "common")
    assert shared[0] is shared[1]
    given = Camera((0, 0, 9), (0, 0, 0), (0, 1, 0))
    assert place_cameras([triangle, sphere], given, view=None, up="y") == [given, given]


@pytest.mark.parametrize(
    "option", [{"view": (0, 0)}, {"up": "z"}, {"zoom": 2}, {"focus": (0, 0, 0)}]
)
def test_a_camera_and_a_view_contradict(triangle, option):
    camera = Camera((0, 0, 9), (0, 0, 0), (0, 1, 0))
    with pytest.raises(MeshError, match=next(iter(option))):
        place_cameras([triangle], camera, **option)


def panels(mesh, functions, limits=None, level_set="auto", colormap=None):
    k = len(functions)
    cameras = place_cameras([mesh] * k, None)
    return make_panels([mesh] * k, functions, [""] * k, cameras, colormap, limits, level_set)


SIGNED, POSITIVE = np.array([-1.0, 0, 4]), np.array([1.0, 2, 3])


def test_limits_are_own_or_common(triangle):
    own = panels(triangle, [SIGNED, None, POSITIVE])
    assert [p.limits for p in own] == [(-4, 4), None, (1, 3)]
    common = panels(triangle, [POSITIVE, SIGNED, None], "common")
    assert [p.limits for p in common] == [(-4, 4), (-4, 4), None]
    assert np.array_equal(common[0].table, common[1].table)
    assert panels(triangle, [None], "common")[0].limits is None


def test_level_sets(triangle):
    assert [p.levels for p in panels(triangle, [SIGNED, POSITIVE])] == [(0,), ()]
    assert panels(triangle, [SIGNED], level_set=None)[0].levels == ()
    assert panels(triangle, [POSITIVE], level_set=2)[0].levels == (2,)
    assert panels(triangle, [POSITIVE], level_set=np.array([1.5, 2.5]))[0].levels == (1.5, 2.5)


def test_colours_have_no_limits_and_no_lines(triangle):
    (panel,) = panels(triangle, [np.eye(3)], level_set=0.5)
    assert panel.limits is None
    assert panel.levels == ()


@pytest.mark.parametrize(
    ("options", "error"),
    [
        ({"limits": "shared"}, UnknownNameError),
        ({"level_set": "zero"}, UnknownNameError),
        ({"level_set": np.nan}, MeshError),
        ({"colormap": "jet"}, UnknownNameError),
    ],
)
def test_impossible_options_are_refused(triangle, options, error):
    with pytest.raises(error):
        panels(triangle, [SIGNED], **options)
