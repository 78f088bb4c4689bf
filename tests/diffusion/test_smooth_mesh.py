import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.diffusion.heat import heat
from beltrami.diffusion.smooth_mesh import smooth_mesh
from beltrami.diffusion.smoothing_methods import SMOOTHING_METHODS
from beltrami.errors import (
    BeltramiError,
    NegativeWeightError,
    NotClosedError,
    StepTooLongError,
    UnknownNameError,
)
from beltrami.mesh import shapes
from beltrami.mesh.mesh import Mesh
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import IRREGULAR, MESHES

CASES = {
    "averaging": {"steps": 5, "step": 0.6},
    "implicit": {"method": "implicit", "time": 0.01},
    "explicit": {"method": "explicit", "time": 3.0, "mass": "degree"},
    "kept": {"steps": 3, "keep": "centroid"},
    "distance": {"weights": "distance", "steps": 4},
    "taubin": {"method": "taubin", "steps": 6, "step": 0.4, "pass_band": 0.2},
    "windowed_sinc": {"method": "windowed_sinc", "steps": 9, "weights": "distance"},
    "features": {"steps": 3, "features": 40.0},
    "curvature_flow": {"method": "curvature_flow", "time": 0.004, "steps": 2},
    "conformal_flow": {"method": "conformal_flow", "time": 0.004, "steps": 2},
}


@pytest.mark.chapter("X6")
def test_averaging_against_the_matrix():
    mesh = MESHES["bad"]()
    W = oracle.weights(mesh, "combinatorial")
    S = 0.4 * np.eye(len(W)) + 0.6 * W / W.sum(axis=1)[:, None]
    expected = np.linalg.matrix_power(S, 5) @ mesh.vertices
    assert np.allclose(smooth_mesh(mesh, steps=5, step=0.6).vertices, expected, atol=1e-13)
    ten = np.linalg.matrix_power(W / W.sum(axis=1)[:, None], 10) @ mesh.vertices
    assert np.allclose(smooth_mesh(mesh).vertices, ten, atol=1e-13)  # the defaults


@pytest.mark.chapter("X6")
def test_heat_of_the_coordinates():
    mesh = MESHES["obt"]()
    pair = laplacian(mesh)
    expected = heat(pair, mesh.vertices, 0.02, steps=10)
    assert np.allclose(smooth_mesh(mesh, "implicit", time=0.02).vertices, expected)
    degree = laplacian(mesh, "combinatorial", "degree")
    expected = heat(degree, mesh.vertices, 2.0, "explicit", 9)
    got = smooth_mesh(mesh, "explicit", time=2.0, steps=9, weights="combinatorial", mass="degree")
    assert np.allclose(got.vertices, expected)


@pytest.mark.chapter("X6")
@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("name", IRREGULAR)
def test_translation_rotation_unit_and_numbering_do_not_matter(name, case):
    mesh = MESHES[name]()
    d, n = mesh.dimension, mesh.n_vertices
    rng = np.random.default_rng(8314462)
    options = CASES[case]
    expected = smooth_mesh(mesh, **options).vertices
    size = np.ptp(mesh.vertices, axis=0).max()
    moved = smooth_mesh(mesh.with_vertices(mesh.vertices + 3.7), **options).vertices
    assert np.allclose(moved - 3.7, expected, atol=1e-9 * size)
    rotation = np.linalg.qr(rng.normal(size=(d, d)))[0]
    turned = smooth_mesh(mesh.with_vertices(mesh.vertices @ rotation), **options).vertices
    assert np.allclose(turned, expected @ rotation, atol=1e-9 * size)
    unit = 1e-3
    other = dict(options)
    if "time" in options and options.get("mass") != "degree":
        other["time"] = options["time"] * unit**2
    scaled = smooth_mesh(mesh.with_vertices(unit * mesh.vertices), **other).vertices
    assert np.allclose(scaled / unit, expected, atol=1e-9 * size)
    order = rng.permutation(n)
    place = np.argsort(order)
    faces = np.roll(place[mesh.faces], 1, axis=1)[rng.permutation(mesh.n_faces)]
    renumbered = smooth_mesh(Mesh(mesh.vertices[order], faces), **options).vertices
    assert np.allclose(renumbered, expected[order], atol=1e-9 * size)


@pytest.mark.chapter("X6")
@pytest.mark.parametrize("method", [{"steps": 8}, {"method": "implicit", "time": 0.02}])
@pytest.mark.parametrize("name", ["closed", "obt"])
def test_keep(name, method):
    mesh = MESHES[name]()
    mesh = mesh.with_vertices(mesh.vertices + np.arange(1, 4))
    plain = smooth_mesh(mesh, **method)
    assert plain.volume < 0.99 * mesh.volume
    kept = smooth_mesh(mesh, keep="volume", **method)
    assert kept.volume == pytest.approx(mesh.volume, rel=1e-12)
    assert np.allclose(_centroid(kept), _centroid(mesh), atol=1e-12)
    centred = smooth_mesh(mesh, keep="centroid", **method)
    assert centred.volume == pytest.approx(plain.volume, rel=1e-12)
    assert np.allclose(_centroid(centred), _centroid(mesh), atol=1e-12)
    assert not np.allclose(_centroid(plain), _centroid(mesh), atol=1e-6)
    for other in (kept, centred):  # the same shape, but for scale and place
        a = other.vertices - other.vertices.mean(axis=0)
        b = plain.vertices - plain.vertices.mean(axis=0)
        assert np.allclose(a / np.linalg.norm(a), b / np.linalg.norm(b), atol=1e-12)


def _centroid(mesh):
    x = mesh.vertices[mesh.faces]
    area = oracle.double_areas(mesh)
    return area @ x.mean(axis=1) / area.sum()


def test_keep_the_centroid_of_an_open_mesh():
    mesh = MESHES["cur"]()
    assert np.allclose(_centroid(smooth_mesh(mesh, keep="centroid")), _centroid(mesh), atol=1e-12)
    with pytest.raises(NotClosedError, match=r"keep=\"centroid\", or hold_boundary=True"):
        smooth_mesh(mesh, keep="volume")


@pytest.mark.parametrize("method", [{"steps": 8}, {"method": "implicit", "time": 0.02}])
def test_hold(method):
    mesh = MESHES["cur"]()
    boundary = np.unique(mesh.topology.boundary_edges)
    assert len(boundary) == 32
    moved = ~np.isclose(smooth_mesh(mesh, hold_boundary=True, **method).vertices, mesh.vertices)
    assert not moved[boundary].any()
    assert moved.any(axis=1).sum() == mesh.n_vertices - 32
    both = smooth_mesh(mesh, hold_boundary=True, hold=[100, 150], **method).vertices
    assert np.array_equal(both[[100, 150]], mesh.vertices[[100, 150]])
    assert np.array_equal(both[boundary], mesh.vertices[boundary])
    mask = np.zeros(mesh.n_vertices, bool)
    mask[[100, 150]] = True
    one = smooth_mesh(mesh, hold=mask, **method).vertices
    assert np.array_equal(one[mask], mesh.vertices[mask])
    assert not np.allclose(one[boundary], mesh.vertices[boundary])


def test_a_planar_mesh_with_held_boundary_and_cotangents_stays_as_it_is():
    """Linear precision: the coordinates are harmonic, so heat does not move them (E17)."""
    mesh = MESHES["bad"]()
    options = {"method": "implicit", "time": 0.1, "hold_boundary": True}
    still = smooth_mesh(mesh, **options)
    assert np.allclose(still.vertices, mesh.vertices, atol=1e-10)
    other = smooth_mesh(mesh, weights="combinatorial", mass="voronoi", **options)
    assert np.abs(other.vertices - mesh.vertices).max() > 0.01


def test_topology_data_and_texture_stay():
    base = MESHES["closed"]()
    uv = np.random.default_rng(5670374).uniform(size=(base.n_faces, 3, 2))
    data = {"thickness": np.arange(300.0), "normal": base.vertices}
    mesh = Mesh(base.vertices, base.faces, data, uv)
    result = smooth_mesh(mesh, steps=2, keep="volume")
    assert result.topology is mesh.topology
    assert np.array_equal(result.vertex_data["thickness"], data["thickness"])
    assert "normal" not in result.vertex_data  # it would no longer be true
    assert np.array_equal(result.corner_uv, uv)
    assert np.array_equal(mesh.vertices, base.vertices)


def test_what_is_refused():
    mesh = MESHES["bad"]()
    with pytest.raises(UnknownNameError) as caught:
        smooth_mesh(mesh, "average")
    assert caught.value.choices == tuple(SMOOTHING_METHODS)
    with pytest.raises(UnknownNameError) as keep:
        smooth_mesh(MESHES["closed"](), keep="volumes")
    assert keep.value.choices == ("volume", "centroid")
    for method in ("implicit", "explicit", "bilaplacian", "curvature_flow", "conformal_flow"):
        with pytest.raises(BeltramiError, match="flows need a time"):
            smooth_mesh(mesh, method)
    for held in ({"hold": [1]}, {"hold_boundary": True}):
        with pytest.raises(BeltramiError, match="would move the vertices that are held"):
            smooth_mesh(mesh, keep="centroid", **held)
    with pytest.raises(NegativeWeightError):
        smooth_mesh(mesh, weights="cotangent")
    for method in ("averaging", "taubin"):  # there are no steps in time to take more of
        with pytest.raises(StepTooLongError, match="Take a shorter one"):
            smooth_mesh(mesh, method, step=1.9)
    with pytest.raises(StepTooLongError, match="Take more steps"):
        smooth_mesh(mesh, "explicit", time=1.0, steps=1)
    with pytest.raises(UnknownNameError):
        smooth_mesh(mesh, weights="cotan")


def test_options_of_another_method_are_not_ignored():
    """Nothing silent: a time for averaging, or a step for heat, does nothing and says so."""
    mesh = MESHES["closed"]()
    with pytest.raises(BeltramiError, match="it has steps, step, weights, features"):
        smooth_mesh(mesh, "averaging", time=0.1)
    with pytest.raises(BeltramiError):
        smooth_mesh(mesh, "averaging", mass="voronoi")
    with pytest.raises(BeltramiError):
        smooth_mesh(mesh, "implicit", time=0.1, step=0.5)


def test_what_has_collapsed_is_not_kept():
    octahedron = shapes.octahedron()
    for keep in ("volume", "centroid"):
        with pytest.raises(BeltramiError, match=r"collapsed|shrunk"):
            smooth_mesh(octahedron, steps=1, keep=keep)
