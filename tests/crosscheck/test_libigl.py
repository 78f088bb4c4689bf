"""Areas, curvatures and energies against libigl, where it is installed."""

import numpy as np
import pytest

from beltrami.operators.areas import consistent_mass, vertex_areas
from beltrami.operators.curvature import curvature
from beltrami.operators.energy import ROUTES, dirichlet_energy
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import IRREGULAR, MESHES

igl = pytest.importorskip("igl")


def _arrays(mesh):
    x = np.pad(mesh.vertices, ((0, 0), (0, 3 - mesh.dimension)))
    return np.ascontiguousarray(x), np.ascontiguousarray(mesh.faces, dtype=np.int64)


@pytest.mark.chapter("Q3.3", "Q3.5", "P36")
@pytest.mark.parametrize("name", IRREGULAR)
def test_cotangent_matrix_and_energy(name):
    """Theirs is -L, with the same ½."""
    mesh = MESHES[name]()
    C = igl.cotmatrix(*_arrays(mesh))
    L = laplacian(mesh).stiffness
    assert abs(L + C).max() < 1e-10 * abs(L).max()
    f = np.random.default_rng(1).normal(size=mesh.n_vertices)
    for how in ROUTES:
        assert dirichlet_energy(mesh, f, how) == pytest.approx(-f @ (C @ f), rel=1e-11)


@pytest.mark.chapter("D10", "T3")
@pytest.mark.parametrize("name", IRREGULAR)
def test_masses(name):
    mesh = MESHES[name]()
    arrays = _arrays(mesh)
    kinds = {
        "barycentric": igl.MASSMATRIX_TYPE_BARYCENTRIC, "voronoi": igl.MASSMATRIX_TYPE_VORONOI
    }  # fmt: skip
    for kind, theirs in kinds.items():
        M = igl.massmatrix(*arrays, theirs)
        assert np.allclose(vertex_areas(mesh, kind), M.diagonal(), rtol=1e-8)
    full = igl.massmatrix(*arrays, igl.MASSMATRIX_TYPE_FULL)
    assert abs(consistent_mass(mesh) - full).max() < 1e-12


@pytest.mark.chapter("P3")
@pytest.mark.parametrize("name", IRREGULAR)
def test_angle_defects(name):
    """Theirs are 2π - Σ angles also on the boundary, where ours are turned by π."""
    mesh = MESHES[name]()
    found = curvature(mesh)
    theirs = np.array(igl.gaussian_curvature(*_arrays(mesh)))
    theirs[np.unique(mesh.topology.boundary_edges)] -= np.pi
    assert np.allclose(found.angle_defect + found.turning, theirs, atol=1e-11)
