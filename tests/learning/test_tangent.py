"""Frames are right-handed and orthonormal; gradients are those of least squares along edges."""

import numpy as np
import pytest

import beltrami as bt
from beltrami.errors import MeshError
from beltrami.learning.tangent import tangent_frames, tangent_gradient

SHAPES = {
    "sphere": bt.shapes.icosphere(2),
    "torus": bt.shapes.torus(12, 7),
    "open": bt.shapes.cylinder(9, 4),
    "flat": bt.shapes.disk(3),
}


def applied(mesh, f):
    """The gradient at the vertices as vectors of R³."""
    frames = tangent_frames(mesh)
    x, y = tangent_gradient(mesh, frames)
    return (x @ f)[:, None] * frames[:, 0] + (y @ f)[:, None] * frames[:, 1]


@pytest.mark.parametrize("mesh", SHAPES.values(), ids=SHAPES)
def test_frames(mesh):
    frames = tangent_frames(mesh)
    gram = np.einsum("nac,nbc->nab", frames, frames)
    assert np.abs(gram - np.eye(3)).max() < 1e-12
    assert np.abs(np.linalg.det(frames) - 1).max() < 1e-12
    assert np.array_equal(frames[:, 2], mesh.vertex_normals)


@pytest.mark.parametrize("mesh", SHAPES.values(), ids=SHAPES)
def test_gradient_is_the_least_squares_fit_along_the_edges(mesh):
    f = np.random.default_rng(3).normal(size=mesh.n_vertices)
    frames = tangent_frames(mesh)
    x, y = tangent_gradient(mesh, frames)
    space = np.c_[mesh.vertices, np.zeros(mesh.n_vertices)][:, :3]
    for i in range(0, mesh.n_vertices, 5):
        ring = mesh.ring(i)
        t = (space[ring] - space[i]) @ frames[i, :2].T
        fit = np.linalg.lstsq(t, f[ring] - f[i], rcond=None)[0]
        assert [(x @ f)[i], (y @ f)[i]] == pytest.approx(fit, rel=1e-9, abs=1e-9)


def test_linear_functions_of_the_plane_are_met_whatever_the_unit():
    disk = bt.shapes.disk(4)
    slope = np.array([2.0, -3.0])
    for unit in (1e-12, 1.0, 1e12, 1e-60, 1e60):
        mesh = bt.Mesh(disk.vertices[:, :2] * unit, disk.faces)
        found = applied(mesh, mesh.vertices @ slope / unit)
        assert np.abs(found * unit - [2, -3, 0]).max() < 1e-11


def test_gradients_of_a_sphere_converge_to_the_tangent_part():
    errors = []
    for level in (2, 3, 4):
        mesh = bt.shapes.icosphere(level)
        true = np.array([0, 0, 1]) - mesh.vertices[:, 2:] * mesh.vertices
        errors.append(np.abs(applied(mesh, mesh.vertices[:, 2]) - true).max())
    assert errors[1] < 0.6 * errors[0]  # of the first order: rings of five are not symmetric
    assert errors[2] < 0.6 * errors[1]


def test_constants_have_no_gradient_and_frames_may_point_anywhere():
    mesh = bt.shapes.torus(12, 7)
    x, y = tangent_gradient(mesh, tangent_frames(mesh))
    assert np.abs(x.sum(axis=1)).max() < 1e-12
    assert np.abs(y.sum(axis=1)).max() < 1e-12
    turn = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)
    f = mesh.vertices[:, 0] ** 2
    turned = applied(bt.Mesh(mesh.vertices @ turn.T, mesh.faces), f)
    assert np.abs(turned - applied(mesh, f) @ turn.T).max() < 1e-11


def test_a_direction_without_edges_has_the_component_zero():
    line = bt.Mesh([[0, 0, 0], [1, 0, 0], [2, 0, 0], [1, 1, 0.0]], [[0, 1, 3], [1, 2, 3]])
    frames = tangent_frames(line).copy()
    frames[3] = frames[3][[0, 2, 1]]  # seen from aside: its edges lie in a line
    x, y = tangent_gradient(line, frames)
    assert not y[[3]].toarray().any()
    assert (x @ line.vertices[:, 0])[3] == pytest.approx(1)


def test_a_vertex_without_a_normal_is_named():
    doubled = bt.Mesh(np.eye(3), [[0, 1, 2], [0, 2, 1]])
    with pytest.raises(MeshError, match="have no normal") as caught:
        tangent_frames(doubled)
    assert caught.value.vertices.tolist() == [0, 1, 2]


@pytest.mark.parametrize(("height", "slope"), [(1e-3, 1.0), (1e-5, 0.0)])
@pytest.mark.parametrize("unit", [1e-9, 1.0, 1e9])
def test_a_direction_in_which_the_edges_hardly_extend_has_no_slope(height, slope, unit):
    mesh = bt.Mesh(unit * np.array([[0.0, 0], [1, 0], [0, height]]), [[0, 1, 2]])
    x, y = tangent_gradient(mesh, tangent_frames(mesh))
    f = mesh.vertices.sum(axis=1)
    assert np.isclose((x @ f)[0], 1, rtol=1e-9)
    assert np.isclose((y @ f)[0], slope, rtol=1e-9)
