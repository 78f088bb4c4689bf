"""Wrong cotangents and areas that easy checks let pass, and the checks that do not (E17 to E30).

Row sums cannot see the angle at the wrong corner; a total area cannot see wrong cells; a mesh
without boundary cannot see what happens there. Each check here is a function of the formula:
the true one passes, and every wrong one fails.
"""

import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.operators.areas import vertex_areas
from beltrami.operators.laplacian import laplacian
from beltrami.operators.weights import edge_weights
from meshes_of_the_errata import IRREGULAR, MESHES
from voronoi_oracle import clipped_cells


def _library(mesh):
    return edge_weights(mesh, "cotangent").toarray()


def _printed_apex(mesh):
    return oracle.weights(mesh, "cotangent", apex="printed")


def _symmetrised_apex(mesh):
    """The angle at the wrong corner, hidden behind a symmetric matrix."""
    W = _printed_apex(mesh)
    return (W + W.T) / 2


def _times(factor):
    return lambda mesh: factor * _library(mesh)


def _boundary(factor):
    """Boundary edges left out (0) or counted twice (2)."""

    def weights(mesh):
        W = _library(mesh)
        i, j = mesh.topology.boundary_edges.T
        W[i, j] *= factor
        W[j, i] *= factor
        return W

    return weights


def _tangents(mesh):
    W = np.zeros((mesh.n_vertices,) * 2)
    tangents = np.tan(oracle.angles(mesh)) / 2
    for c in range(3):
        i, j = mesh.faces[:, (c + 1) % 3], mesh.faces[:, (c + 2) % 3]
        np.add.at(W, (i, j), tangents[:, c])
        np.add.at(W, (j, i), tangents[:, c])
    return W


def _absolute(mesh):
    return np.abs(_library(mesh))


def _check_row_sums(mesh, weights):
    """Σ_j w_ij = Σ over the faces of (cot B + cot C) / 2: true, and no test of the angles."""
    cot = 1 / np.tan(oracle.angles(mesh)) / 2
    expected = np.bincount(
        mesh.faces.ravel(), (cot.sum(axis=1, keepdims=True) - cot).ravel(), mesh.n_vertices
    )
    assert np.allclose(weights(mesh).sum(axis=1), expected, rtol=1e-7)


def _check_energy(mesh, weights):
    """f'(D - W)f is the Dirichlet energy of the interpolant."""
    for f in oracle.rough_functions(mesh, 3).T:
        energy = f @ oracle.stiffness(weights(mesh)) @ f
        assert energy == pytest.approx(oracle.dirichlet_energy(mesh, f), rel=1e-8)


def _check_linear_precision(mesh, weights):
    """Coordinates of the plane are harmonic inside."""
    W = weights(mesh)
    inside = np.setdiff1d(np.arange(mesh.n_vertices), mesh.topology.boundary_edges)
    off = (oracle.stiffness(W) @ mesh.vertices)[inside]
    assert np.abs(off).max() < 1e-10


@pytest.mark.chapter("Q3.3", "U12")
@pytest.mark.parametrize("name", IRREGULAR)
def test_row_sums_cannot_see_the_angle_at_the_wrong_corner(name):
    mesh = MESHES[name]()
    for weights in (_library, _printed_apex):
        _check_row_sums(mesh, weights)  # the trap
    with pytest.raises(AssertionError):
        _check_row_sums(mesh, _times(2))


WRONG = {
    "printed apex": _printed_apex,
    "symmetrised apex": _symmetrised_apex,
    "no half": _times(2),
    "minus": _times(-1),
    "tangents": _tangents,
}


@pytest.mark.chapter("Q3.3", "Q3.5", "U12", "P23")
@pytest.mark.parametrize("wrong", WRONG)
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_energy_sees_every_wrong_weight(name, wrong):
    mesh = MESHES[name]()
    _check_energy(mesh, _library)
    with pytest.raises(AssertionError):
        _check_energy(mesh, WRONG[wrong])


@pytest.mark.chapter("Q3.3", "Q3.5")
@pytest.mark.parametrize("name", ["open", "bad", "cur"])
def test_the_energy_sees_the_boundary_and_the_sign(name):
    """One cotangent on a boundary edge (E18), and the sign kept (E90)."""
    mesh = MESHES[name]()
    _check_energy(mesh, _library)
    for wrong in (_boundary(0), _boundary(2), _absolute):
        with pytest.raises(AssertionError):
            _check_energy(mesh, wrong)
    closed = MESHES["closed"]()  # which cannot see any of the three
    for weights in (_boundary(0), _boundary(2), _absolute):
        _check_energy(closed, weights)


@pytest.mark.chapter("Q3.3", "P21")
@pytest.mark.parametrize("name", ["open", "bad"])
def test_linear_precision_sees_the_angle_and_not_the_constant(name):
    mesh = MESHES[name]()
    for weights in (_library, _times(2), _times(-1)):
        _check_linear_precision(mesh, weights)
    for wrong in (_printed_apex, _symmetrised_apex, _tangents):
        with pytest.raises(AssertionError):
            _check_linear_precision(mesh, wrong)
    for kind in ("combinatorial", "distance"):
        with pytest.raises(AssertionError):
            _check_linear_precision(mesh, lambda m, k=kind: edge_weights(m, k).toarray())


# ------------------------------------------------------------------------------ areas (E22, E23)


def _circumcentric(mesh):
    return vertex_areas(mesh, "circumcentric")


def _printed_areas(mesh):
    """With 1/4 in place of 1/8, as it follows from the theorem as printed."""
    return 2 * _circumcentric(mesh)


def _areas_of_the_printed_apex(mesh):
    """The eighth of |e|² cot, with the cotangent at the wrong corner, then made to add up."""
    W = _symmetrised_apex(mesh)
    i, j = mesh.edges.T
    cells = np.repeat(mesh.edge_lengths**2 * W[i, j] / 4, 2)
    areas = np.bincount(mesh.edges.ravel(), cells, mesh.n_vertices)
    return areas * mesh.area / areas.sum()


def _thirds(mesh):
    return vertex_areas(mesh, "barycentric")


def _permuted(mesh):
    return np.roll(_circumcentric(mesh), 1)


def _check_total(mesh, areas):
    assert areas(mesh).sum() == pytest.approx(mesh.area, rel=1e-9)


def _check_cells(mesh, areas):
    cells, exact = clipped_cells(mesh.vertices)
    assert len(cells) > 100
    assert np.allclose(areas(mesh)[cells], exact, rtol=1e-9)


@pytest.mark.chapter("D10", "T3")
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_total_area_sees_the_constant_only(name):
    mesh = MESHES[name]()
    for areas in (_circumcentric, _thirds, _permuted, _areas_of_the_printed_apex):
        _check_total(mesh, areas)  # the trap
    with pytest.raises(AssertionError):
        _check_total(mesh, _printed_areas)


@pytest.mark.chapter("D10", "T3")
def test_single_cells_see_every_wrong_area():
    mesh = MESHES["open"]()
    _check_cells(mesh, _circumcentric)
    for wrong in (_printed_areas, _areas_of_the_printed_apex, _thirds, _permuted):
        with pytest.raises(AssertionError):
            _check_cells(mesh, wrong)
    with pytest.raises(AssertionError):  # not Delaunay: the formula itself is wrong (E23)
        _check_cells(MESHES["bad"](), _circumcentric)


@pytest.mark.chapter("P35", "P36")
def test_minus_the_laplacian_is_the_stiffness_over_the_area():
    """-Δx = 2x on the sphere: the sign, the half and the area must all be right (E30)."""
    mesh = MESHES["closed"]()
    x = mesh.vertices

    def check(operator, areas):
        assert (areas @ (operator * x).sum(axis=1)) / areas.sum() == pytest.approx(2, rel=1e-9)

    pair = laplacian(mesh)
    areas = pair.masses
    check(pair.apply(x), areas)
    L = pair.stiffness @ x
    degree = laplacian(mesh, mass="degree")
    for wrong in (-pair.apply(x), 2 * pair.apply(x), L, degree.apply(x), degree.normalized @ x):
        with pytest.raises(AssertionError):
            check(wrong, areas)
