"""Wrong means, norms and averages that easy meshes let pass, and those that tell (E12 to E20, E73).

Each check is a function of the formula: the true one passes, and every wrong one fails.
"""

import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.diffusion.smooth_mesh import smooth_mesh
from beltrami.diffusion.smoothing import smooth
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import cube
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import IRREGULAR, MESHES

POSITIVE = ("combinatorial", "distance")
NORMS = {
    "degree": lambda pair: pair.degrees,
    "plain": lambda pair: np.ones(pair.n),
    "inverse": lambda pair: 1 / pair.degrees,
    "squared": lambda pair: pair.degrees**2,
    "root": lambda pair: np.sqrt(pair.degrees),
}


def _check_self_adjoint(pair, norm):
    """<Af, g> = <f, Ag>, and A increases no norm."""
    A, b = pair.averaging.toarray(), NORMS[norm](pair)
    f, g = np.random.default_rng(1380650).normal(size=(2, pair.n))
    size = np.sqrt((b @ f**2) * (b @ g**2))
    assert abs((A @ f) @ (b * g) - f @ (b * (A @ g))) < 1e-12 * size
    root = np.sqrt(b)
    assert np.linalg.norm(root[:, None] * A / root, 2) < 1 + 1e-12


@pytest.mark.chapter("D6", "D9")
@pytest.mark.parametrize("kind", POSITIVE)
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_norm_of_averaging_is_that_of_the_degrees(name, kind):
    pair = laplacian(MESHES[name](), kind)
    _check_self_adjoint(pair, "degree")
    for wrong in ("plain", "inverse", "squared", "root"):
        with pytest.raises(AssertionError):
            _check_self_adjoint(pair, wrong)
    f, g = oracle.rough_functions(MESHES[name](), 2).T
    assert pair.inner(f, g) == pytest.approx(f @ (pair.degrees * g))
    assert pair.norm(f) ** 2 == pytest.approx(pair.inner(f, f))


@pytest.mark.chapter("D6")
def test_on_a_regular_mesh_every_norm_passes():
    pair = laplacian(MESHES["tor"](), "combinatorial")
    for norm in NORMS:
        _check_self_adjoint(pair, norm)


def _check_average(mesh, kind, averaging):
    """Constants stay, each row uses its own weights, and nothing leaves the range."""
    W = oracle.weights(mesh, kind)
    A = averaging(W)
    assert np.allclose(A.sum(axis=1), 1, atol=1e-13)
    assert (A >= 0).all()
    i, j = np.nonzero(W)
    assert np.allclose(A[i, j] / A[j, i], W.sum(axis=1)[j] / W.sum(axis=1)[i], rtol=1e-9)


WRONG_AVERAGES = {
    "not divided (E16)": lambda W: W,
    "by the sum over E (E14)": lambda W: W / W.sum(),
    "by columns": lambda W: W / W.sum(axis=0),
    "by both roots": lambda W: W / np.sqrt(np.outer(W.sum(axis=1), W.sum(axis=1))),
    "with itself": lambda W: (W + np.eye(len(W))) / (1 + W.sum(axis=1)[:, None]),
    "by the number": lambda W: W / (W > 0).sum(axis=1)[:, None],
}


@pytest.mark.chapter("D9", "P18")
@pytest.mark.parametrize("name", IRREGULAR)
def test_averages_divide_by_the_sum_of_their_own_row(name):
    mesh = MESHES[name]()
    library = laplacian(mesh, "distance").averaging.toarray()
    _check_average(mesh, "distance", lambda W: library)
    _check_average(mesh, "distance", lambda W: W / W.sum(axis=1)[:, None])
    for what, wrong in WRONG_AVERAGES.items():
        if what != "with itself":
            with pytest.raises(AssertionError):
                _check_average(mesh, "distance", wrong)
    assert np.abs(library.diagonal()).max() == 0
    with pytest.raises(AssertionError):
        _check_average(mesh, "combinatorial", WRONG_AVERAGES["with itself"])


def _check_limit(mesh, kind, mean):
    pair = laplacian(mesh, kind, "degree")
    f = mesh.vertices[:, 0] + oracle.rough_functions(mesh, 1)[:, 0]
    assert np.allclose(smooth(pair, f, 30_000), mean(pair, f), atol=1e-4)


MEANS = {
    "degrees": lambda pair, f: pair.degrees @ f / pair.degrees.sum(),
    "plain": lambda pair, f: f.mean(),
    "inverse": lambda pair, f: (f / pair.degrees).sum() / (1 / pair.degrees).sum(),
    "roots": lambda pair, f: np.sqrt(pair.degrees) @ f / np.sqrt(pair.degrees).sum(),
    "areas": lambda pair, f: laplacian(pair.domain).mean(f),
}


@pytest.mark.chapter("T14")
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_limit_of_averaging_is_the_mean_of_the_degrees(name):
    mesh = MESHES[name]()
    _check_limit(mesh, "combinatorial", MEANS["degrees"])
    for wrong in ("plain", "inverse", "roots", "areas"):
        with pytest.raises(AssertionError):
            _check_limit(mesh, "combinatorial", MEANS[wrong])


@pytest.mark.chapter("T14")
def test_on_a_regular_mesh_all_these_means_but_that_of_the_areas_pass():
    for mean in ("degrees", "plain", "inverse", "roots"):
        _check_limit(MESHES["tor"](), "combinatorial", MEANS[mean])


@pytest.mark.chapter("P19")
@pytest.mark.parametrize("kind", POSITIVE)
@pytest.mark.parametrize("name", IRREGULAR)
def test_rounds_of_averaging_are_powers_and_the_energy_falls(name, kind):
    mesh = MESHES[name]()
    pair = laplacian(mesh, kind)
    f, A = oracle.rough_functions(mesh), pair.averaging.toarray()
    energies = [pair.dirichlet_energy(f)]
    for k in range(1, 8):
        after = smooth(pair, f, k)
        assert np.allclose(after, np.linalg.matrix_power(A, k) @ f, atol=1e-11)
        energies.append(pair.dirichlet_energy(after))
    assert (np.diff(energies) < 0).all()


@pytest.mark.chapter("P19")
def test_with_negative_weights_the_energy_would_grow():
    """Why ``smooth`` refuses them (E20): on ``bad`` the energy of noise grows without bound."""
    pair = laplacian(MESHES["bad"](), mass="degree")
    A = pair.weights.toarray() / pair.degrees[:, None]
    f = oracle.rough_functions(MESHES["bad"](), 1)[:, 0]
    after = np.linalg.matrix_power(A, 60) @ f
    assert pair.dirichlet_energy(after) > 1e6 * pair.dirichlet_energy(f)


def _sharpest(mesh: Mesh) -> float:
    """Largest angle, in degrees, between the normals of two neighbouring faces."""
    inner = mesh.topology.edge_faces[mesh.topology.edge_face_count == 2]
    one, two = mesh.face_normals[inner.indices.reshape(-1, 2)].transpose(1, 0, 2)
    return float(np.degrees(np.arccos(np.clip((one * two).sum(axis=1), -1, 1)).max()))


@pytest.mark.chapter("P20")
def test_the_edges_of_a_cube_disappear():
    box = cube(6)
    assert _sharpest(box) == pytest.approx(90)
    angles = [_sharpest(smooth_mesh(box, steps=k)) for k in (1, 3, 8, 20)]
    assert (np.diff([90, *angles]) < 0).all()
    assert angles[-1] < 40
    angles = [_sharpest(smooth_mesh(box, "implicit", time=t)) for t in (0.003, 0.01, 0.03, 0.1)]
    assert (np.diff([90, *angles]) < 0).all()


@pytest.mark.chapter("X6")
@pytest.mark.parametrize("name", ["closed", "obt", "cur"])
def test_smoothing_a_mesh_keeps_the_mean_of_its_mass(name):
    """The D-mean of the positions for averaging, that of B for heat; the plain mean moves."""
    mesh = MESHES[name]()
    pair = laplacian(mesh, "combinatorial")
    after = smooth_mesh(mesh, steps=9).vertices
    assert np.allclose(pair.mean(after), pair.mean(mesh.vertices), atol=1e-12)
    assert np.abs(after.mean(axis=0) - mesh.vertices.mean(axis=0)).max() > 1e-4
    area = laplacian(mesh)
    after = smooth_mesh(mesh, "implicit", time=0.01).vertices
    assert np.allclose(area.mean(after), area.mean(mesh.vertices), atol=1e-11)
    assert np.abs(pair.mean(after) - pair.mean(mesh.vertices)).max() > 1e-5
    if mesh.is_closed:
        assert smooth_mesh(mesh, steps=9).volume < mesh.volume


@pytest.mark.chapter("X6")
@pytest.mark.parametrize("keep", ["volume", "centroid"])
@pytest.mark.parametrize("name", ["closed", "obt"])
def test_what_smoothing_takes_can_be_given_back(name, keep):
    """A scale about the centroid, far from the origin: the cube root of the ratio of volumes."""
    mesh = MESHES[name]()
    mesh = mesh.with_vertices(mesh.vertices + np.array([5, -7, 11]))
    plain = smooth_mesh(mesh, steps=6)
    kept = smooth_mesh(mesh, steps=6, keep=keep)
    scale = np.cbrt(mesh.volume / plain.volume) if keep == "volume" else 1.0
    assert np.allclose(_surface_mean(kept), _surface_mean(mesh), atol=1e-11)
    expected = (plain.vertices - _surface_mean(plain)) * scale + _surface_mean(mesh)
    assert np.allclose(kept.vertices, expected, atol=1e-11)
    assert plain.volume < 0.99 * mesh.volume
    assert (kept.volume == pytest.approx(mesh.volume)) == (keep == "volume")


def _surface_mean(mesh):
    areas = oracle.double_areas(mesh)
    return areas @ mesh.vertices[mesh.faces].mean(axis=1) / areas.sum()


@pytest.mark.chapter("P19", "R4")
@pytest.mark.parametrize("columns", [1, 3, 4])
@pytest.mark.parametrize("kind", POSITIVE)
@pytest.mark.parametrize("mass", ["voronoi", "unit", "degree"])
def test_averaging_uses_the_degrees_whatever_the_mass(mass, kind, columns):
    mesh = MESHES["bad"]()
    W = oracle.weights(mesh, kind)
    step = 0.7 * W / W.sum(axis=1)[:, None] + 0.3 * np.eye(len(W))
    f = oracle.rough_functions(mesh, columns)
    after = smooth(laplacian(mesh, kind, mass), f, 3, 0.7)
    assert np.allclose(after, np.linalg.matrix_power(step, 3) @ f, atol=1e-12)
