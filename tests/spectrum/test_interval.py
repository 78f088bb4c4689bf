"""The interval around the spectrum: proven, and not far from it."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_array

import dense_oracles as oracle
from beltrami.errors import MeshError
from beltrami.mesh.mesh import Mesh
from beltrami.operators.laplacian import laplacian
from beltrami.operators.pair import MASSES
from beltrami.operators.weights import WEIGHTS
from beltrami.spectrum.interval import Interval, probes, spectral_interval
from meshes_of_the_errata import MESHES, flipped, triangle

pytestmark = pytest.mark.chapter("T9")


def _spectrum(pair):
    return oracle.spectrum(pair.stiffness.toarray(), pair.mass.toarray())


@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("weights", WEIGHTS)
@pytest.mark.parametrize("name", ["bad", "leaves", "pl"])
def test_it_holds_the_spectrum(name, weights, mass):
    pair = laplacian(MESHES[name](), weights, mass)
    low, high = spectral_interval(pair)
    assert low == 0
    assert _spectrum(pair)[-1] <= high * (1 + 1e-9)
    assert high <= pair.spectral_bound()


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 2**40), st.floats(0.02, 1), st.sampled_from(["voronoi", "consistent"]))
def test_on_flipped_and_stretched_meshes(seed, aspect, mass):
    pair = laplacian(flipped(seed, n=25, aspect=aspect), mass=mass)
    largest = _spectrum(pair)[-1]
    assert largest <= spectral_interval(pair).high * (1 + 1e-9)


def test_a_quarter_of_the_consistent_mass_is_needed():
    """One equilateral triangle attains the 4 between the two masses; the disks see 4/3 more."""
    pair = laplacian(triangle(60, 60), mass="consistent")
    lumped = laplacian(triangle(60, 60), mass="barycentric")
    assert _spectrum(pair)[-1] == pytest.approx(4 * _spectrum(lumped)[-1])


@pytest.mark.parametrize("weights", ["combinatorial", "distance"])
@pytest.mark.parametrize("mass", ["voronoi", "barycentric", "unit"])
def test_positive_weights_leave_a_factor_of_two_at_most(weights, mass):
    """Where the faces' own pairs are pessimistic by tens: thin faces have small shares."""
    pair = laplacian(MESHES["bad"](), weights, mass)
    assert spectral_interval(pair).high <= 2 * _spectrum(pair)[-1]


def test_it_is_sharper_than_the_faces_where_they_are_thin():
    pair = laplacian(MESHES["bad"]())
    assert spectral_interval(pair).high < pair.spectral_bound() / 10


def test_negative_weights_of_a_graph_go_below_zero():
    W = np.array([[0, -1.0, 3], [-1, 0, 2], [3, 2, 0]])
    pair = laplacian(csr_array(W), mass="unit")
    low, high = spectral_interval(pair)
    values = _spectrum(pair)
    assert low <= values[0]
    assert values[-1] <= high
    W = np.array([[0, -3.0, 1], [-3, 0, 1], [1, 1, 0]])
    pair = laplacian(csr_array(W), mass="unit")
    assert spectral_interval(pair).low <= _spectrum(pair)[0] < 0


def test_masses_that_are_zero_are_named():
    mesh = Mesh([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]])
    pair = laplacian(mesh, lambda mesh: np.array([1.0, 0, 0]), "unit")
    assert spectral_interval(pair).high > 0
    zero = dataclasses.replace(pair, mass=csr_array(np.diag([1.0, 0, 1])))
    with pytest.raises(MeshError) as caught:
        spectral_interval(zero)
    assert caught.value.vertices.tolist() == [1]


@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_units(unit):
    mesh = MESHES["cur"]()
    one = spectral_interval(laplacian(mesh)).high
    other = spectral_interval(laplacian(mesh.with_vertices(unit * mesh.vertices))).high
    assert other * unit**2 == pytest.approx(one, rel=1e-9)


def test_probes_come_near_both_ends_and_stay_inside():
    places = np.sort(probes(Interval(-3.0, 5.0)))
    assert (places[0], places[-1]) == (-3, 5)
    assert np.diff(places).max() < 8 / 200
    assert 0 < places[places > -3][0] + 3 < 1e-15
