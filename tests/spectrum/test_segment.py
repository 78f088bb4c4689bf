"""Segments: k-means against its definition, and parts that anyone would name."""

import numpy as np
import pytest

import spectra
from beltrami.errors import BeltramiError, MeshError, UnknownNameError
from beltrami.mesh.connectivity import component_labels
from beltrami.mesh.shapes import cylinder, icosphere
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.distances import spectral_embedding
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.k_means import in_order_of_appearance, k_means
from beltrami.spectrum.segment import segment


def pieces(labels, edges):
    inner = edges[labels[edges[:, 0]] == labels[edges[:, 1]]]
    return component_labels(inner, len(labels)).max() + 1


def same_partition(one, two):
    return np.array_equal(in_order_of_appearance(one), in_order_of_appearance(two))


def dumbbells():
    """Three balls on a stick: a surface of revolution with two necks."""
    tube = cylinder(16, 60, 1.0, 6.0, caps=True)
    x, y, z = tube.vertices.T
    r = 0.25 + 0.75 * np.abs(np.cos(np.pi * z / 2))
    return tube.with_vertices(np.column_stack([r * x, r * y, z]))


def test_balls_are_told_from_each_other():
    mesh = dumbbells()
    basis = fourier_basis(laplacian(mesh), 10)
    parts = segment(basis, 3, edges=mesh.edges)
    assert parts.count == 3
    ball = np.digitize(mesh.vertices[:, 2], [-1, 1])
    wrong = (parts.labels != in_order_of_appearance(ball)).mean()
    assert wrong < 0.05
    for label in range(3):
        assert parts.masses[label] == pytest.approx(
            basis.mass.diagonal()[parts.labels == label].sum()
        )


@pytest.mark.parametrize("kind", ["commute_time", "biharmonic", "diffusion"])
def test_labels_are_those_of_the_nearest_centre(kind):
    basis = spectra.basis_of("creature", 40)
    time = 1 / basis.eigenvalues[3] if kind == "diffusion" else None
    parts = segment(basis, 5, kind=kind, time=time)
    points = spectral_embedding(basis, kind, time=time)[:, :6]
    weights = basis.mass.diagonal()
    centres = np.array(
        [np.average(points[parts.labels == c], axis=0, weights=weights[parts.labels == c])
         for c in range(5)]
    )  # fmt: skip
    squares = ((points[:, None] - centres[None]) ** 2).sum(axis=2)
    assert np.array_equal(squares.argmin(axis=1), parts.labels)
    assert parts.spread == pytest.approx(np.average(squares.min(axis=1), weights=weights))
    single = segment(basis, 1, kind=kind, time=time)
    assert parts.spread < 0.5 * single.spread


def test_the_creature_has_limbs():
    mesh = spectra.mesh_of("creature")
    parts = segment(spectra.basis_of("creature", 20), 8, edges=mesh.edges)
    assert parts.count == 8
    tips = [mesh.vertices[:, 0].argmin(), mesh.vertices[:, 0].argmax()]
    tips += [mesh.vertices[:, 1].argmin(), mesh.vertices[:, 1].argmax()]
    assert len(set(parts.labels[tips])) == 4


def test_what_must_not_matter():
    mesh = spectra.mesh_of("creature")
    basis = spectra.basis_of("creature", 20)
    labels = segment(basis, 6).labels
    assert np.array_equal(labels, segment(basis, 6).labels)
    assert np.array_equal(labels, segment(spectra.turned(basis), 6).labels)
    other, order = spectra.permuted(mesh)
    again = segment(fourier_basis(laplacian(other), 20), 6).labels
    assert same_partition(again, labels[order])
    for unit in (1e-9, 1e9):
        large = fourier_basis(laplacian(mesh.with_vertices(unit * mesh.vertices)), 20)
        assert np.array_equal(segment(large, 6).labels, labels)
    spreads = {segment(basis, 6, seed=s).spread for s in range(4)}
    assert max(spreads) < 1.1 * min(spreads)


@pytest.mark.parametrize("kind", ["commute_time", "biharmonic"])
def test_pieces_hang_together_if_edges_are_given(kind):
    mesh = spectra.mesh_of("two")
    basis = spectra.basis_of("two", 20)
    loose = segment(basis, 2, kind=kind)
    for count in (1, 2, 4):
        parts = segment(basis, count, kind=kind, edges=mesh.edges)
        assert pieces(parts.labels, mesh.edges) == parts.count == max(count, 2)
        assert set(parts.labels) == set(range(parts.count))
        assert parts.labels[0] == 0
    assert same_partition(loose.labels, np.arange(basis.n) >= 162)  # zeros tell components


def test_as_many_segments_as_vertices():
    basis = spectra.basis_of("pl")
    assert segment(basis, 56).count == 56
    assert segment(basis, 56).spread == pytest.approx(0, abs=1e-20)


def test_k_means_weighs_points():
    points = np.array([[0.0], [1.0], [10.0], [11.0]])
    labels, total = k_means(points, np.array([1.0, 3.0, 1.0, 1.0]), 2, 0)
    assert labels.tolist() == [0, 0, 1, 1]
    assert total == pytest.approx(1 * 0.75**2 + 3 * 0.25**2 + 2 * 0.5**2)
    heavy, _ = k_means(np.array([[0.0], [3.0], [7.0]]), np.array([1.0, 1.0, 100.0]), 2, 0)
    assert heavy.tolist() == [0, 0, 1]
    doubled, _ = k_means(np.zeros((4, 2)), np.ones(4), 3, 0)
    assert doubled.tolist() == [0, 0, 0, 0]


def test_k_means_finds_what_one_start_misses():
    """The best of its starts is never above any of 200 random ones, within a hair."""
    rng = np.random.default_rng(1)
    points = rng.normal(size=(60, 2)) + 4 * rng.integers(0, 3, size=(60, 2))
    _, total = k_means(points, np.ones(60), 6, 0)
    best = np.inf
    for _ in range(200):
        centres = points[rng.choice(60, 6, replace=False)]
        for _ in range(20):
            nearest = ((points[:, None] - centres) ** 2).sum(axis=2).argmin(axis=1)
            centres = np.array(
                [points[nearest == c].mean(axis=0) if (nearest == c).any() else centres[c]
                 for c in range(6)]
            )  # fmt: skip
        best = min(best, ((points - centres[nearest]) ** 2).sum())
    assert total < 1.1 * best


def test_wrong_input():
    basis = spectra.basis_of("pl", 10)
    for count in (0, 57, 2.5):
        with pytest.raises(BeltramiError):
            segment(basis, count)
    with pytest.raises(UnknownNameError):
        segment(basis, 3, kind="commute")
    with pytest.raises(BeltramiError, match="time belongs to"):
        segment(basis, 3, kind="diffusion")
    for edges in ([0, 1], [[0, 56]], [[0, 1, 2]], [[0.5, 1]]):
        with pytest.raises(MeshError):
            segment(basis, 3, edges=edges)
    with pytest.raises(MeshError, match="all zero"):
        segment(fourier_basis(laplacian(icosphere(1)), 1), 2)
    parts = segment(basis, 3)
    assert repr(parts) == "<Segmentation: 56 vertices in 3 segments>"
    with pytest.raises(ValueError, match="read-only"):
        parts.labels[0] = 1
