import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltrami.mesh.duplicates import duplicate_faces, duplicate_vertices, merge_targets
from strategies import any_arrays, generators


@given(generators(), st.integers(1, 12), st.integers(1, 4))
def test_merge_targets_by_comparing_all_pairs(rng, n, d):
    x = rng.integers(0, 2, size=(n, d)) * rng.choice([-1.0, 1.0], size=(n, d))  # with -0.0
    x[rng.random((n, d)) < 0.1] = np.nan
    expected = [next((j for j in range(i) if (x[j] == x[i]).all()), i) for i in range(n)]
    assert merge_targets(x).tolist() == expected
    assert duplicate_vertices(x).tolist() == [i for i in range(n) if expected[i] != i]


@given(generators(), st.integers(2, 12))
def test_merging_within_a_tolerance_joins_chains(rng, n):
    x = rng.integers(0, 9, size=(n, 2)).astype(float)
    x[rng.random(n) < 0.2, 0] = np.inf
    finite = [i for i in range(n) if np.isfinite(x[i]).all()]
    if len(finite) < 2:
        return
    size = np.linalg.norm(np.ptp(x[finite], axis=0))
    first = list(range(n))
    for _ in range(n):
        for i in finite:
            for j in finite:
                if np.linalg.norm(x[i] - x[j]) <= 1.2:
                    first[i] = first[j] = min(first[i], first[j])
    if size > 0:
        assert merge_targets(x, 1.2 / size).tolist() == first


def test_near_is_a_fraction_of_the_diagonal():
    x = np.array([[0.0, 0], [3, 4], [0.0499, 0], [0.0501, 4]])
    for scale in (1e-9, 1.0, 1e9):
        assert merge_targets(x * scale, 0.01).tolist() == [0, 1, 0, 3]


def test_a_single_place_and_nothing_at_all():
    assert merge_targets(np.ones((3, 2)), 1e-6).tolist() == [0, 0, 0]
    assert merge_targets(np.zeros((0, 3))).tolist() == []
    assert merge_targets(np.full((2, 3), np.nan), 0.5).tolist() == [0, 1]


@pytest.mark.parametrize("tolerance", [0.0, 1e-9])
def test_very_large_coordinates_are_not_all_one_place(tolerance):
    x = np.array([[0.0, 0], [1e200, 0], [0, 1e200], [1e200, 0]])
    assert merge_targets(x, tolerance).tolist() == [0, 1, 2, 1]


@given(any_arrays())
def test_duplicate_faces_by_comparing_sorted_triples(pair):
    _, faces = pair
    seen, expected = set(), []
    for f, face in enumerate(faces.tolist()):
        key = tuple(sorted(face))
        if key in seen:
            expected.append(f)
        seen.add(key)
    assert duplicate_faces(faces).tolist() == expected


def test_inputs_are_left_alone():
    x = np.array([[-0.0, 1], [0.0, 1]])
    merge_targets(x)
    assert np.signbit(x[0, 0])
