from itertools import product

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from beltrami.mesh.connectivity import component_labels, parity_colouring

graphs = st.integers(1, 8).flatmap(
    lambda n: st.tuples(
        st.just(n),
        st.lists(st.tuples(st.integers(0, n - 1), st.integers(0, n - 1), st.booleans())),
    )
)


def as_arrays(edges):
    pairs = np.array([edge[:2] for edge in edges], dtype=np.int64).reshape(-1, 2)
    return pairs, np.array([edge[2] for edge in edges], dtype=bool)


def labels_by_growing(edges, n):
    """Give each node the smallest node it reaches, then number these in order."""
    least = list(range(n))
    for _ in range(n):
        for a, b, *_ in edges:
            least[a] = least[b] = min(least[a], least[b])
    order = sorted(set(least))
    return [order.index(v) for v in least]


@settings(max_examples=200)
@given(graphs)
def test_components_are_numbered_by_their_first_nodes(graph):
    n, edges = graph
    assert component_labels(as_arrays(edges)[0], n).tolist() == labels_by_growing(edges, n)


@settings(max_examples=200)
@given(graphs)
def test_colourings_against_all_colourings(graph):
    n, edges = graph
    colour = parity_colouring(*as_arrays(edges), n)
    fitting = [
        c
        for c in product([False, True], repeat=n)
        if all((c[a] != c[b]) == differ for a, b, differ in edges)
    ]
    if not fitting:
        assert colour is None
        return
    assert colour is not None
    assert tuple(colour.tolist()) in fitting
    labels = labels_by_growing(edges, n)
    for label in set(labels):  # the first node of each component is False
        assert not colour[labels.index(label)]


def test_definition_18_even_cycles_have_two_colours_and_odd_ones_not():
    for n in range(3, 12):
        cycle = np.stack([np.arange(n), np.roll(np.arange(n), -1)], axis=1)
        colour = parity_colouring(cycle, np.ones(n, bool), n)
        if n % 2:
            assert colour is None
        else:
            assert colour is not None
            assert colour.tolist() == [bool(i % 2) for i in range(n)]


def test_long_paths_in_any_order():
    n = 2000
    rng = np.random.default_rng(7719283746)
    path = np.stack([np.arange(n - 1), np.arange(1, n)], axis=1)[rng.permutation(n - 1)]
    assert component_labels(path, n).max() == 0
    colour = parity_colouring(path, np.ones(n - 1, bool), n)
    assert colour is not None
    assert np.array_equal(colour, np.arange(n) % 2 == 1)


def test_inputs_are_left_alone():
    pairs, differ = np.array([[2, 1], [0, 2]]), np.array([True, False])
    parity_colouring(pairs, differ, 3)
    assert (pairs.tolist(), differ.tolist()) == ([[2, 1], [0, 2]], [True, False])


def test_nothing_to_join():
    none = np.zeros((0, 2), np.int64)
    assert component_labels(none, 3).tolist() == [0, 1, 2]
    assert component_labels(none, 0).tolist() == []
    assert parity_colouring(none, np.zeros(0, bool), 0) is not None
