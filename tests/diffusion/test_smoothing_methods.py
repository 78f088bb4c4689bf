"""The methods of smooth_mesh against dense matrices, and what they are for."""

import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.diffusion.smooth_mesh import smooth_mesh
from beltrami.errors import BeltramiError, MeshError, NegativeWeightError, StepTooLongError
from beltrami.mesh import shapes
from beltrami.mesh.mesh import Mesh
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import IRREGULAR, MESHES

names = pytest.mark.parametrize("name", IRREGULAR)


def averaging(mesh, kind="combinatorial"):
    W = oracle.weights(mesh, kind)
    return W / W.sum(axis=1)[:, None]


@names
def test_taubin_is_a_product_of_matrices(name):
    mesh = MESHES[name]()
    K = np.eye(mesh.n_vertices) - averaging(mesh, "distance")
    down, up = 0.4, 1 / (0.3 - 1 / 0.4)
    one = (np.eye(len(K)) - up * K) @ (np.eye(len(K)) - down * K)
    expected = np.linalg.matrix_power(one, 4) @ mesh.vertices
    options = {"steps": 4, "step": 0.4, "pass_band": 0.3, "weights": "distance"}
    assert np.allclose(smooth_mesh(mesh, "taubin", **options).vertices, expected, atol=1e-12)


@names
def test_the_gain_of_taubin_is_1_at_both_ends_of_the_pass_band(name):
    """On the eigenvectors of W̃, with the printed sign of neither step taken for granted."""
    mesh = MESHES[name]()
    k, U = np.linalg.eig(np.eye(mesh.n_vertices) - averaging(mesh))
    k, U = k.real, U.real
    f = np.zeros((mesh.n_vertices, mesh.dimension))
    at = int(np.abs(k - 0.3).argmin())
    f[:, 0] = U[:, at]
    band = float(k[at])
    same = smooth_mesh(mesh.with_vertices(f), "taubin", pass_band=band, steps=7).vertices
    assert np.allclose(same, f, atol=1e-10)
    wider = smooth_mesh(mesh.with_vertices(f), "taubin", pass_band=0.8 * band, steps=7).vertices
    gain = (1 - 0.5 * band) * (1 - band / (0.8 * band - 2))
    assert np.allclose(wider, gain**7 * f, atol=1e-10)
    assert gain < 0.999


@names
@pytest.mark.parametrize("degree", [1, 2, 5, 12])
def test_windowed_sinc_is_the_polynomial(name, degree):
    mesh = MESHES[name]()
    k, U = np.linalg.eig(averaging(mesh, "distance"))
    edge = np.arccos(1 - 0.4)
    i = np.arange(1, degree + 1)
    window = 0.54 + 0.46 * np.cos(np.pi * i / (degree + 1))
    c = np.append(edge / 2, window * np.sin(i * edge) / i)
    gain = np.polynomial.chebyshev.chebval(k.real, c) / c.sum()
    expected = (U * gain) @ np.linalg.solve(U, mesh.vertices)
    options = {"steps": degree, "pass_band": 0.4, "weights": "distance"}
    found = smooth_mesh(mesh, "windowed_sinc", **options).vertices
    assert np.allclose(found, expected.real, atol=1e-9)


@pytest.mark.parametrize("d", [2, 3, 4, 7])
def test_windowed_sinc_takes_any_number_of_columns(d):
    mesh = MESHES["closed"]()
    x = np.random.default_rng(3).standard_normal((mesh.n_vertices, 8))
    found = smooth_mesh(Mesh(x[:, :d], mesh.faces), "windowed_sinc").vertices
    whole = smooth_mesh(Mesh(x, mesh.faces), "windowed_sinc").vertices
    assert np.array_equal(found, whole[:, :d])


def test_taubin_and_windowed_sinc_take_the_noise_and_leave_the_volume():
    sphere = shapes.icosphere(4)
    noise = np.random.default_rng(11).normal(0, 0.01, sphere.n_vertices)
    noisy = sphere.with_vertices(sphere.vertices * (1 + noise)[:, None])

    def roughness(mesh):
        return np.std(np.linalg.norm(mesh.vertices, axis=1))

    plain = smooth_mesh(noisy, steps=20)
    assert plain.volume < 0.93 * sphere.volume
    for method in ("taubin", "windowed_sinc"):
        smoothed = smooth_mesh(noisy, method, steps=20)
        assert smoothed.volume == pytest.approx(noisy.volume, rel=0.02)
        assert roughness(smoothed) < 0.4 * roughness(noisy)


@names
@pytest.mark.parametrize("steps", [1, 3])
def test_bilaplacian_against_the_matrix(name, steps):
    mesh = MESHES[name]()
    pair = laplacian(mesh)
    L, B = pair.stiffness.toarray(), pair.mass.toarray()
    A = B + 0.001 / steps * L @ np.linalg.inv(B) @ L
    held = np.zeros(mesh.n_vertices, bool)
    held[[3, 50]] = True
    expected = mesh.vertices.copy()
    for _ in range(steps):
        right = (B @ expected)[~held] - A[~held][:, held] @ expected[held]
        expected[~held] = np.linalg.solve(A[~held][:, ~held], right)
    found = smooth_mesh(mesh, "bilaplacian", time=0.001, steps=steps, hold=held)
    assert np.allclose(found.vertices, expected, atol=1e-9)
    with pytest.raises(MeshError, match="diagonal mass"):
        smooth_mesh(mesh, "bilaplacian", time=0.1, mass="consistent")


def test_the_radius_of_a_sphere_under_curvature_flow_is_of_first_order():
    """r² = 1 - 4t: the printed heat equation with the Laplacian of the start gives exp(-2t)."""
    sphere, time = shapes.icosphere(4), 0.1
    errors = []
    for steps in (4, 8, 16):
        moved = smooth_mesh(sphere, "curvature_flow", time=time, steps=steps).vertices
        errors.append(np.linalg.norm(moved, axis=1).mean() - np.sqrt(1 - 4 * time))
    rates = np.log2(np.divide(errors[:-1], errors[1:]))
    assert np.all((rates > 0.85) & (rates < 1.15))
    linear = smooth_mesh(sphere, "implicit", time=time, steps=16).vertices
    assert np.linalg.norm(linear, axis=1).mean() - np.sqrt(1 - 4 * time) > 5 * errors[-1]


def test_conformal_flow_makes_a_sphere_where_curvature_flow_pinches():
    blob, time = shapes.blob(2000), 1.0

    def ratio(mesh):  # 1 for a sphere
        return 36 * np.pi * mesh.volume**2 / mesh.area**3

    assert ratio(blob) < 0.1
    round_ = smooth_mesh(blob, "conformal_flow", time=time, steps=24)
    assert ratio(round_) > 0.98
    assert round_.area == pytest.approx(blob.area, rel=1e-12)
    with pytest.raises(BeltramiError, match=r'degenerates after \d+ of 24.*"conformal_flow"'):
        smooth_mesh(blob, "curvature_flow", time=time, steps=24)


class TestFeatures:
    def test_a_cube_keeps_its_edges_and_corners(self):
        cube = shapes.cube(6)
        rng = np.random.default_rng(8)
        noisy = cube.with_vertices(cube.vertices + rng.normal(0, 0.01, cube.vertices.shape))
        kept = smooth_mesh(noisy, steps=30, features=45.0).vertices
        lost = smooth_mesh(noisy, steps=30).vertices
        low, high = cube.vertices.min(axis=0), cube.vertices.max(axis=0)
        ends = (cube.vertices == low) | (cube.vertices == high)
        corners, ridges = ends.all(axis=1), ends.sum(axis=1) == 2
        assert np.array_equal(kept[corners], noisy.vertices[corners])
        for where in (ridges, ends.any(axis=1)):  # each stays on its line, on its face
            off = np.abs(kept - cube.vertices)[where][ends[where]]
            before = np.abs(noisy.vertices - cube.vertices)[where][ends[where]]
            assert off.mean() < 0.85 * before.mean()
        assert np.abs(lost - cube.vertices)[corners].max() > 0.1

    @names
    def test_against_the_matrix(self, name):
        mesh = MESHES[name]()
        edges, dimension = mesh.edges, mesh.dimension
        sides = {tuple(edge): [] for edge in edges.tolist()}
        for j, face in enumerate(mesh.faces.tolist()):
            for a, b in zip(face, [*face[1:], face[0]], strict=True):
                sides[min(a, b), max(a, b)].append(j)
        sharp = []
        for (a, b), faces in sides.items():
            if len(faces) != 2:
                sharp.append((a, b))
            elif dimension == 3:
                left, right = mesh.face_normals[faces]
                if np.degrees(np.arccos(np.clip(left @ right, -1, 1))) > 30:
                    sharp.append((a, b))
        n = mesh.n_vertices
        F = np.zeros((n, n))
        for a, b in sharp:
            F[a, b] = F[b, a] = 1
        W = oracle.weights(mesh, "combinatorial")
        number = F.sum(axis=1)
        W[number > 0] = F[number > 0]
        W[(number == 1) | (number > 2)] = np.eye(n)[(number == 1) | (number > 2)]
        S = W / W.sum(axis=1)[:, None]
        expected = np.linalg.matrix_power(0.3 * np.eye(n) + 0.7 * S, 4) @ mesh.vertices
        found = smooth_mesh(mesh, steps=4, step=0.7, features=30.0).vertices
        assert np.allclose(found, expected, atol=1e-12)
        for method in ("taubin", "windowed_sinc"):
            still = smooth_mesh(mesh, method, features=30.0).vertices
            stay = (number == 1) | (number > 2)
            assert np.allclose(still[stay], mesh.vertices[stay], atol=1e-12)
            assert not np.allclose(still[~stay], mesh.vertices[~stay])

    def test_faces_turned_round_make_no_feature(self):
        sphere = shapes.icosphere(3)
        faces = sphere.faces.copy()
        faces[::3] = faces[::3, ::-1]
        expected = smooth_mesh(sphere, features=40.0).vertices
        turned = smooth_mesh(Mesh(sphere.vertices, faces), features=40.0).vertices
        assert np.allclose(turned, expected, atol=1e-14)

    def test_what_is_refused(self):
        mesh = MESHES["closed"]()
        for angle in (0.0, 180.0, -3.0, np.nan):
            with pytest.raises(BeltramiError, match="angle of features"):
                smooth_mesh(mesh, features=angle)
        with pytest.raises(BeltramiError, match="has no features"):
            smooth_mesh(mesh, "implicit", time=0.1, features=30.0)
        with pytest.raises(BeltramiError, match="step must be from 0 to 1"):
            smooth_mesh(mesh, step=1.2, features=30.0)


def test_the_longest_step_of_taubin_is_the_longest():
    mesh = shapes.grid(8, 8)  # W̃ of its edges without diagonals would reach the frequency 2
    for band in (0.05, 0.1, 0.6):
        with pytest.raises(StepTooLongError) as caught:
            smooth_mesh(mesh, "taubin", step=0.99, pass_band=band)
        step = caught.value.longest
        other = 1 / (band - 1 / step)
        assert (1 - 2 * step) * (1 - 2 * other) == pytest.approx(-1, rel=1e-12)
        smooth_mesh(mesh, "taubin", step=step, pass_band=band)


@pytest.mark.parametrize(
    ("method", "options", "error"),
    [
        ("taubin", {"pass_band": 0.0}, "pass band"),
        ("taubin", {"pass_band": 1.0}, "pass band"),
        ("taubin", {"step": 0.0}, "the step must be"),
        ("taubin", {"steps": -1}, "whole number"),
        ("windowed_sinc", {"pass_band": 2.0}, "pass band"),
        ("windowed_sinc", {"steps": 0}, "whole number"),
        ("windowed_sinc", {"steps": 1.5}, "whole number"),
        ("bilaplacian", {"time": -1.0}, "time must be"),
        ("curvature_flow", {"time": np.inf}, "time must be"),
        ("curvature_flow", {"time": 1.0, "steps": 0}, "whole number"),
    ],
)
def test_numbers_that_are_refused(method, options, error):
    with pytest.raises(BeltramiError, match=error):
        smooth_mesh(MESHES["closed"](), method, **options)


def test_averaging_methods_refuse_negative_weights():
    for method in ("taubin", "windowed_sinc"):
        with pytest.raises(NegativeWeightError):
            smooth_mesh(MESHES["obt"](), method, weights="cotangent")


def test_no_time_is_no_change():
    mesh = MESHES["closed"]()
    for method in ("bilaplacian", "curvature_flow", "conformal_flow"):
        assert np.allclose(smooth_mesh(mesh, method, time=0.0).vertices, mesh.vertices, atol=1e-13)
    assert np.array_equal(smooth_mesh(mesh, "taubin", steps=0).vertices, mesh.vertices)
