import numpy as np
import pytest

from beltrami.display.scene import Style, check_mesh
from beltrami.errors import DimensionError, EmptyMeshError, MeshError, NonFiniteError
from beltrami.mesh.mesh import Mesh


@pytest.mark.parametrize(
    "options",
    [
        {"size": (0, 10)},
        {"size": (10, 10, 10)},
        {"size": (10.5, 10)},
        {"size": (40_000, 10)},
        {"shading": "phong"},
        {"back": "green"},
        {"color": "no colour"},
        {"background": (2, 0, 0)},
        {"antialias": 0},
        {"antialias": 9},
        {"ambient": -1},
        {"fill": np.nan},
        {"line_width": 0},
        {"line_width": np.inf},
    ],
)
def test_impossible_styles_are_refused(options):
    with pytest.raises(ValueError):
        Style(**options)


def test_the_message_names_the_option():
    with pytest.raises(MeshError, match="ambient"):
        Style(ambient=-1)


@pytest.mark.parametrize(
    ("mesh", "error"),
    [
        (Mesh(np.zeros((3, 4)), [[0, 1, 2]]), DimensionError),
        (Mesh(np.zeros((3, 3)), np.zeros((0, 3), int)), EmptyMeshError),
        (Mesh([[0, 0, 0], [1, 0, 0], [0, np.nan, 0]], [[0, 1, 2]]), NonFiniteError),
        (Mesh([[0, 0, 0], [1, 0, 0], [0, np.inf, 0]], [[0, 1, 2]]), NonFiniteError),
    ],
)
def test_what_cannot_be_drawn_is_refused(mesh, error):
    with pytest.raises(error):
        check_mesh(mesh)
