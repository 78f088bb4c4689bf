"""ZoomOut sharpens a coarse start, measured along the surface against the truth."""

from functools import cache

import numpy as np
import pytest
from scipy.sparse.csgraph import dijkstra

import spectra
from beltrami.errors import BeltramiError
from beltrami.mesh.edge_matrix import symmetric_matrix
from beltrami.mesh.mesh import Mesh
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.correspondence import functional_map_from_points, unit_vectors
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.functional_map import functional_map
from beltrami.spectrum.zoomout import zoomout


def bent(mesh: Mesh, curvature: float = 0.6) -> Mesh:
    """Bend the x-axis into a circle upwards: lengths change by a few per cent."""
    x, y, z = mesh.vertices.T
    r = 1 / curvature + z
    turn = curvature * x
    return mesh.with_vertices(
        np.column_stack([r * np.sin(turn), y, r * np.cos(turn) - 1 / curvature])
    )


@cache
def bent_creature():
    """Bases of the creature and of its bent copy, whose vertex i was order[i]; all distances."""
    mesh = spectra.mesh_of("creature")
    other, order = spectra.permuted(bent(mesh))
    strain = bent(mesh).edge_lengths / mesh.edge_lengths - 1
    assert 0.02 < np.abs(strain).mean() < 0.08  # near to an isometry, and none
    lengths = symmetric_matrix(mesh.edges, mesh.edge_lengths, mesh.n_vertices)
    D = dijkstra(lengths) / np.sqrt(mesh.area)
    return spectra.basis_of("creature", 80), fourier_basis(laplacian(other), 80), order, D


def noisy_start(k=20):
    """Twenty landmarks, far from each other, each displaced by 0.07 on the average."""
    source, target, order, D = bent_creature()
    rng = np.random.default_rng(11)
    chosen = [0]
    while len(chosen) < 20:
        chosen.append(int(D[chosen].min(axis=0).argmax()))
    wrong = [rng.choice(np.flatnonzero(D[v] < 0.1)) for v in chosen]
    places = np.argsort(order)[chosen]
    assert 0.04 < D[wrong, chosen].mean() < 0.08
    return functional_map(source, target, landmarks=np.column_stack([wrong, places]), k=k)


@pytest.mark.parametrize("step", [1, 4])
def test_it_sharpens_a_noisy_start_of_twenty_landmarks(step):
    _, _, order, D = bent_creature()
    start = noisy_start()
    fine = zoomout(start, step=step)
    before, after = (D[found.point_map, order].mean() for found in (start, fine))
    assert before > 0.04
    assert after < 0.65 * before
    exact = (fine.point_map == order).mean()
    assert exact > 2 * (start.point_map == order).mean()
    assert fine.matrix.shape == (80, 80)
    assert fine.descriptor_residual is None


def test_steps_are_those_of_the_paper():
    """C of each size from the points of the one before; the last step may be shorter."""
    source, target, _, _ = bent_creature()
    start = noisy_start()
    C, psi, phi = start.matrix, unit_vectors(target, 29), unit_vectors(source, 29)
    for k in (24, 28, 29):
        x, y = phi[:, : len(C)] @ C.T, psi[:, : len(C)]
        squares = (x**2).sum(axis=1) - 2 * y @ x.T
        points = squares.argmin(axis=1)
        C = psi[:, :k].T @ target.mass @ phi[points, :k] / target.mass.sum()
    calls = []
    found = zoomout(start, 29, step=4, progress=lambda *at: calls.append(at))
    np.testing.assert_allclose(found.matrix, C, atol=1e-12)
    assert calls == [(4, 9), (8, 9), (9, 9)]


def test_samples_are_enough():
    source, target, order, D = bent_creature()
    start = noisy_start()
    few = zoomout(start, step=2, samples=300)
    before, after = (D[found.point_map, order].mean() for found in (start, few))
    assert after < 0.65 * before
    C = np.linalg.lstsq(unit_vectors(target, 24), unit_vectors(source, 24)[start.point_map])[0]
    one = zoomout(start, 24, step=4, samples=target.n)
    np.testing.assert_allclose(one.matrix, C, atol=1e-8)
    for samples in (79, target.n + 1, 100.5):
        with pytest.raises(BeltramiError, match="samples"):
            zoomout(start, samples=samples)


def test_a_permutation_is_a_fixed_point():
    mesh = spectra.mesh_of("creature")
    other, order = spectra.permuted(mesh)
    source, target = spectra.basis_of("creature", 80), fourier_basis(laplacian(other), 80)
    start = functional_map_from_points(source, target, order, k=15)
    fine = zoomout(start)
    assert np.array_equal(fine.point_map, order)
    assert fine.orthogonality < 1e-6
    few = functional_map(
        source, target, landmarks=np.column_stack([order[::35], np.arange(target.n)[::35]]), k=12
    )
    assert np.array_equal(zoomout(few, step=4).point_map, order)


def test_sizes():
    _, target, _, _ = bent_creature()
    start = noisy_start()
    assert np.array_equal(zoomout(start, 20).matrix, start.matrix)
    pairs = [[i, i] for i in range(0, 60, 3)]
    small = fourier_basis(spectra.pair_of("creature"), 9)
    oblong = functional_map(small, target, landmarks=pairs)
    assert oblong.matrix.shape == (80, 9)
    for k in (19, 81, 2.5):
        with pytest.raises(BeltramiError):
            zoomout(start, k)
    with pytest.raises(BeltramiError, match="below the 80"):
        zoomout(oblong)
    for step in (0, 1.5):
        with pytest.raises(BeltramiError, match="step must be"):
            zoomout(start, step=step)
