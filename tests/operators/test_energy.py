import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import dense_oracles as oracle
from beltrami.errors import DegenerateFaceError, DimensionError, NonFiniteError, UnknownNameError
from beltrami.mesh.mesh import Mesh
from beltrami.operators.edge_areas import edge_areas
from beltrami.operators.energy import ROUTES, dirichlet_energy
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import MESHES, flipped, triangle

pytestmark = pytest.mark.chapter("Q3.4", "Q3.5", "P23")


@pytest.mark.parametrize("name", MESHES)
def test_three_routes_agree_and_none_is_as_printed(name):
    mesh = MESHES[name]()
    f = oracle.rough_functions(mesh, 3)
    exact = sum(oracle.dirichlet_energy(mesh, column) for column in f.T)
    found = {how: dirichlet_energy(mesh, f, how) for how in ROUTES}
    assert found["faces"] == pytest.approx(exact, rel=1e-9)
    for how in ("edges", "cotangent"):
        assert found[how] == pytest.approx(found["faces"], rel=2e-13)
    assert laplacian(mesh).dirichlet_energy(f) == pytest.approx(found["faces"], rel=2e-13)
    i, j = mesh.edges.T
    slopes = ((f[i] - f[j]) ** 2).sum(axis=1) / mesh.edge_lengths**2
    assert edge_areas(mesh) @ slopes == pytest.approx(exact / 2, rel=1e-9)  # without the 2 (E26)
    wrong_cell = 2 * edge_areas(mesh, "incenter") @ slopes  # the other cell of E21
    assert abs(wrong_cell / exact - 1) > (1e-3 if name != "leaves" else 0)


@given(st.integers(0, 2**40), st.floats(0.1, 1.0))
def test_on_any_planar_mesh(seed, aspect):
    mesh = flipped(seed, n=15, aspect=aspect)
    f = np.random.default_rng(seed).normal(size=mesh.n_vertices)
    faces, edges, cotangent = (dirichlet_energy(mesh, f, how) for how in ROUTES)
    assert edges == pytest.approx(faces, rel=1e-10)
    assert cotangent == pytest.approx(faces, rel=1e-10)
    x = mesh.vertices[:, 1]
    assert dirichlet_energy(mesh, x) == pytest.approx(mesh.area, rel=1e-9)


@pytest.mark.parametrize("how", ROUTES)
def test_errors(how):
    mesh = triangle(50, 60)
    with pytest.raises(DimensionError):
        dirichlet_energy(mesh, np.ones(4), how)
    with pytest.raises(NonFiniteError) as bad:
        dirichlet_energy(mesh, [0, 1, np.inf], how)
    assert bad.value.vertices.tolist() == [2]
    with pytest.raises(DegenerateFaceError):
        dirichlet_energy(Mesh([[0, 0], [1, 0], [2, 0]], [[0, 1, 2]]), np.ones(3), how)


def test_misspelt():
    with pytest.raises(UnknownNameError, match="Did you mean 'cotangent'") as caught:
        dirichlet_energy(triangle(50, 60), np.ones(3), "cotan")
    assert caught.value.choices == ("faces", "edges", "cotangent")
