"""Theorem 22: the flattest coordinates are u2 and u3; what the text says else (E92-E94)."""

import numpy as np
import pytest
from scipy.linalg import eigh, null_space, subspace_angles

from beltrami.errors import NotManifoldError, NotOrientableError, UnknownNameError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import cylinder, disk, grid, icosphere
from beltrami.operators.laplacian import laplacian
from beltrami.parameterization.flatten import FORMS, flatten
from meshes_of_the_errata import cur, open_
from strategies import moebius


def degrees(angles):
    return np.degrees(np.max(angles))


def flattest(S, B, constraint):
    """The least energy of two B-orthonormal functions that are B-orthogonal to a constraint."""
    Q = null_space((B @ constraint)[None, :])
    values, vectors = eigh(Q.T @ S @ Q, Q.T @ B @ Q)
    return values[:2].sum(), Q @ vectors[:, :2]


def normalized(mesh, kind):
    pair = laplacian(mesh, kind, "degree")
    return pair, pair.normalized.toarray()


@pytest.mark.chapter("T22", "U40")
@pytest.mark.parametrize("kind", ["combinatorial", "cotangent", "distance"])
def test_the_minimum_under_the_corrected_constraint(kind):
    """E92: with ⟨ψ, D^½1⟩ = 0 the solution is u2, u3; with the printed ⟨ψ, 1⟩ = 0 it is not."""
    mesh = cur()
    pair, Lt = normalized(mesh, kind)
    one = np.eye(mesh.n_vertices)
    values = np.linalg.eigvalsh(Lt)
    psi = flatten(mesh, "printed", kind).uv

    def check(constraint):
        energy, truth = flattest(Lt, one, constraint)
        return degrees(subspace_angles(psi, truth)) < 1e-4, abs(energy - values[1:3].sum()) < 1e-12

    assert check(np.sqrt(pair.degrees)) == (True, True)
    assert check(np.ones(mesh.n_vertices)) == (False, False)


@pytest.mark.chapter("U40", "P75", "T22")
@pytest.mark.parametrize("form", FORMS)
def test_constraints_and_value(form):
    mesh = cur()
    pair = laplacian(mesh, "cotangent", "barycentric" if form == "areas" else "degree")
    phi = flatten(mesh, form).uv
    B = pair.mass.toarray()
    if form == "printed":
        phi = phi / np.sqrt(pair.degrees)[:, None] * np.sqrt(B.sum() / mesh.n_vertices)
    total = B.sum()
    np.testing.assert_allclose(phi.T @ B @ phi / total, np.eye(2), atol=1e-10)
    np.testing.assert_allclose(B.sum(axis=0) @ phi / total, 0, atol=1e-10)
    values = eigh(pair.stiffness.toarray(), B, eigvals_only=True)
    energy = np.trace(phi.T @ (pair.stiffness @ phi)) / total
    assert energy == pytest.approx(values[1:3].sum(), rel=1e-9)


@pytest.mark.chapter("P75")
def test_the_printed_norm_is_a_variance_of_one_nth():
    """E92: ‖ψ‖ = 1 is not unit variance; ours is."""
    mesh = cur()
    psi = flatten(mesh, "printed").uv
    assert (psi**2).mean(axis=0) == pytest.approx([1, 1])
    unit = psi / np.linalg.norm(psi, axis=0)
    assert (unit**2).mean(axis=0) == pytest.approx([1 / mesh.n_vertices] * 2)


@pytest.mark.chapter("T22", "P76")
def test_not_the_first_two_eigenvectors():
    """E93: u1 and u2 break the constraint, and draw what has no width."""
    mesh = cur()
    pair, Lt = normalized(mesh, "combinatorial")
    u = np.linalg.eigh(Lt)[1]
    psi = flatten(mesh, "printed", "combinatorial").uv
    assert degrees(subspace_angles(psi, u[:, 1:3])) < 1e-4
    assert degrees(subspace_angles(psi, u[:, 0:2])) > 89
    assert abs(u[:, 0] @ np.sqrt(pair.degrees)) / np.sqrt(pair.degrees.sum()) > 0.999


@pytest.mark.chapter("U40", "P76", "T22")
@pytest.mark.parametrize("make", [open_, cur], ids=lambda make: make.__name__)
def test_what_to_draw(make):
    """E94: u itself folds most, D^-½ u less, and the pair with areas only at the rim."""
    counts = [len(flatten(make(), form).flipped) for form in ("printed", "degree", "areas")]
    assert counts[0] > 80
    assert counts[1] < 30
    assert counts[2] < counts[1]
    rim = make().boundary_loops[0]  # where both slopes across it vanish
    folded = make().faces[flatten(make()).flipped]
    assert np.isin(folded, rim).any(axis=1).all()
    assert flatten(disk(8)).is_bijective


@pytest.mark.chapter("T22")
def test_a_square_is_drawn_with_cosines():
    """The eigenfunctions of a square with free sides; the span, as λ2 = λ3."""
    mesh = grid(20, 20)
    x, y = mesh.vertices[:, :2].T
    psi = flatten(mesh)
    assert len(psi.flipped) == 0
    cosines = np.stack([np.cos(np.pi * x), np.cos(np.pi * y)], axis=1)
    assert degrees(subspace_angles(psi.uv, cosines)) < 1.5
    assert (psi.uv**2).mean(axis=0) == pytest.approx([1, 1], abs=0.1)


@pytest.mark.chapter("P76")
def test_tall_shapes_and_closed_ones_fold_and_say_so():
    tall = flatten(cylinder(12, 30, height=20.0))
    assert len(tall.flipped) > 100
    assert not tall.is_bijective
    assert "NOT a bijection" in repr(tall)
    long = grid(40, 4, width=10.0)
    assert len(flatten(long).flipped) > 50  # u3 is a second wave along the strip
    sphere = flatten(icosphere(2))
    assert 0.3 < len(sphere.flipped) / 320 <= 0.5


def test_mirrored_and_scaled_surfaces():
    mesh = disk(5)
    turned = Mesh(mesh.vertices, mesh.faces[:, [0, 2, 1]])
    assert flatten(mesh).is_bijective
    assert flatten(turned).is_bijective
    for unit in (1e-9, 1e9):
        scaled = flatten(mesh.with_vertices(mesh.vertices * unit))
        assert scaled.is_bijective
        np.testing.assert_allclose((scaled.uv**2).mean(), 1, rtol=0.2)


def test_components_have_coordinates_of_their_own():
    one = disk(4)
    x = np.concatenate([one.vertices, 2 * one.vertices + 5])
    psi = flatten(Mesh(x, np.concatenate([one.faces, one.faces + one.n_vertices])))
    assert psi.is_bijective
    areas = psi.flat.face_areas.reshape(2, -1).sum(axis=1)
    assert areas[1] / areas[0] == pytest.approx(4)


def test_bad_input():
    with pytest.raises(UnknownNameError, match="degree"):
        flatten(disk(2), "degrees")
    with pytest.raises(NotOrientableError):
        flatten(Mesh(*moebius(np.random.default_rng(0), 8)))
    with pytest.raises(NotManifoldError):
        flatten(Mesh(np.eye(5, 3), [[0, 1, 2], [0, 1, 3], [1, 0, 4]]))
