"""Any damaged mesh, in any unit: a certified map, or an error that says why."""

import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import strategies
from beltrami.errors import BeltramiError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.tree_cotree import cut_to_disk
from beltrami.parameterization.atlas import atlas
from beltrami.parameterization.certificate import certify
from beltrami.parameterization.flatten import flatten
from beltrami.parameterization.parameterize import METHODS, parameterize


@st.composite
def meshes(draw):
    mesh = draw(strategies.any_meshes())
    x = mesh.vertices * 10.0 ** draw(st.sampled_from([0, 0, 0, -12, 12, -40, 40]))
    if draw(st.integers(0, 3)) == 0:
        x = x * np.r_[np.ones(x.shape[1] - 1), 10.0 ** draw(st.integers(-12, 0))]
    if draw(st.integers(0, 5)) == 0:
        x = np.c_[x, x[:, :1] / 3, x[:, 1:2] / 7]
    return Mesh(x, mesh.faces)


CALLS = {
    **{method: lambda mesh, method=method: parameterize(mesh, method) for method in METHODS},
    "square": lambda mesh: parameterize(mesh, boundary="square", seams=1),
    "flatten": flatten,
    "atlas": lambda mesh: atlas(mesh, size=4096, padding=0).map,
}


@pytest.mark.parametrize("name", CALLS)
@settings(max_examples=60)
@given(meshes())
def test_a_certified_map_or_an_error_that_says_why(name, mesh):
    before = mesh.vertices.copy()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            psi = CALLS[name](mesh)
        except BeltramiError:
            return
    assert np.isfinite(psi.uv).all()
    assert psi.is_bijective == certify(psi.mesh.topology, psi.uv).is_bijective
    assert psi.is_bijective or name == "flatten"
    assert psi.distortion.singular_values.shape == (mesh.n_faces, 2)
    np.testing.assert_array_equal(psi.vertex_map[psi.mesh.faces], mesh.faces)
    np.testing.assert_array_equal(mesh.vertices, before)


@settings(max_examples=100)
@given(meshes())
def test_disks_or_an_error(mesh):
    try:
        cut = cut_to_disk(mesh)
    except BeltramiError:
        return
    topology = cut.mesh.topology
    assert topology.is_manifold
    assert topology.euler_characteristic == topology.n_components == len(topology.boundary_loops)
