import sys

import numpy as np
import pytest

from beltrami.errors import MissingExtraError, UnknownNameError
from beltrami.mesh.export import TARGETS
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import icosphere

X, F = icosphere(0).vertices, icosphere(0).faces


def test_arrays_are_copies_that_may_be_changed():
    x, f = icosphere(0).to("arrays")
    assert np.array_equal(x, X)
    assert np.array_equal(f, F)
    x[:], f[:] = 0, 0
    assert icosphere(0).area > 0


def test_trimesh_merges_nothing():
    pytest.importorskip("trimesh")
    soup = Mesh(X[F].reshape(-1, 3), np.arange(60).reshape(-1, 3))
    assert soup.to("trimesh").vertices.shape == (60, 3)


def test_unknown_target():
    with pytest.raises(UnknownNameError, match="'trimesh'") as caught:
        icosphere(0).to("trimsh")
    assert caught.value.choices == TARGETS


@pytest.mark.parametrize(
    ("target", "extra"),
    [
        ("trimesh", "io"),
        ("meshio", "io"),
        ("pyvista", "view"),
        ("open3d", "view"),
        ("polyscope", "view"),
    ],
)
def test_a_library_that_is_not_installed(monkeypatch, target, extra):
    monkeypatch.setitem(sys.modules, target, None)
    with pytest.raises(MissingExtraError) as caught:
        icosphere(0).to(target)
    assert (caught.value.package, caught.value.extra) == (target, extra)
