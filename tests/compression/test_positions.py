"""Guesses against plain linear algebra, and numbers that come back."""

import numpy as np
import pytest

from beltrami.compression.geometry import decode_positions, encode_positions
from beltrami.compression.grid import PositionGrid
from beltrami.compression.guesses import BEST, FAST, frame, guess
from beltrami.compression.neighbourhood import coding_order, look_around
from beltrami.compression.numbers import decode_offsets, encode_offsets, surroundings
from beltrami.compression.patches import new_patch, solve
from beltrami.compression.positions import DEAD_ZONE, level
from beltrami.compression.residuals import LAPLACE, LOGISTIC, between, ln, new_opinions, set_edge
from beltrami.compression.tables import WHOLE
from beltrami.compression.varint import Reader, to_varints
from beltrami.errors import FileFormatError
from beltrami.mesh import shapes


def dense_solve(v, rings, laplacian, parallelogram, edge, mesh, known, x):
    """Minimise the same sum of squares over the unknowns of a patch, by least squares."""
    topology = mesh.topology
    patch = np.union1d(v, topology.ring(v, rings, kind="ball"))
    inside = np.zeros(mesh.n_vertices, bool)
    inside[patch] = True
    inner = np.union1d(v, topology.ring(v, rings - 1, kind="ball"))
    rows, neighbours = [], {}
    n = mesh.n_vertices
    for w in patch:
        neighbours[w] = topology.ring(w, 1)
    if laplacian:
        for w in inner:
            row = np.zeros(n)
            row[w] = 1
            row[neighbours[w]] = -1 / len(neighbours[w])
            rows.append(np.sqrt(laplacian) * row)
    if parallelogram:
        twins = topology.twins.ravel()
        for h, t in enumerate(twins):
            quad = [*mesh.faces[h // 3, (h + np.arange(3)) % 3], mesh.faces[t // 3, t % 3]]
            if t > h and inside[quad].all():
                row = np.zeros(n)
                row[[quad[0], quad[3]]] += 1
                row[[quad[1], quad[2]]] -= 1
                rows.append(np.sqrt(parallelogram) * row)
    unknown = inside & ~known
    A = np.array(rows).reshape(-1, n)
    normal = A.T @ A
    for w in np.flatnonzero(unknown):
        for u in neighbours[w]:
            if inside[u]:  # half of the square of an edge from each unknown end
                normal[w, w] += edge
                normal[w, u] -= edge
    columns = np.flatnonzero(unknown)
    others = np.flatnonzero(known)
    right = -normal[np.ix_(columns, others)] @ x[others]
    return np.linalg.solve(normal[np.ix_(columns, columns)], right)[columns == v][0]


@pytest.mark.parametrize("setting", [*BEST, *FAST])
@pytest.mark.parametrize("mesh", [shapes.icosphere(2), shapes.disk(5)], ids=["sphere", "disk"])
def test_solves_minimise_what_they_say(setting, mesh):
    rng = np.random.default_rng(1)
    n = mesh.n_vertices
    x = rng.normal(size=(n, 3))
    near, patch = look_around(mesh.faces, n), new_patch(n)
    known = rng.random(n) < 0.6
    for v in np.flatnonzero(~known)[:8]:
        out = np.full(3, np.nan)
        rings, a, b, c = int(setting[0]), *setting[1:]
        solve(v, rings, a, b, c, near, known, patch, x, out)
        expected = dense_solve(v, rings, a, b, c, mesh, known, x)
        np.testing.assert_allclose(out, expected, rtol=1e-7, atol=1e-7)


def test_an_affine_lattice_is_guessed_exactly():
    mesh = shapes.grid(9, 9)
    x = np.column_stack([mesh.vertices, mesh.vertices @ [2.0, -1.0] + 3])
    near, n = look_around(mesh.faces, mesh.n_vertices), mesh.n_vertices
    known = np.ones(n, bool)
    v = int(abs(mesh.vertices - mesh.vertices.mean(axis=0)).max(axis=1).argmin())
    known[v] = False
    out, mean = np.zeros((2 + len(BEST), 3)), np.zeros(3)
    count = guess(v, 0, BEST, near, known, new_patch(n), x, np.zeros(n), mean, out)
    assert count == len(mesh.topology.face_ring(v))
    np.testing.assert_allclose(out, np.tile(x[v], (len(out), 1)), atol=1e-9)


def test_frames_are_orthonormal_and_along_the_normal():
    mesh = shapes.icosphere(2)
    near, known = look_around(mesh.faces, mesh.n_vertices), np.ones(mesh.n_vertices, bool)
    for v in (0, 20, 100):
        axes = np.zeros((3, 3))
        mean = mesh.vertices[mesh.topology.ring(v, 1)].mean(axis=0) + np.array([0.01, 0.02, 0])
        frame(v, near, known, mesh.vertices, mesh.vertices[v], mean, axes)
        np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
        assert abs(axes[0] @ mesh.vertices[v]) > 0.999


def test_the_order_meets_every_vertex_once_and_stays_on_the_surface():
    mesh = shapes.icosphere(3)
    near = look_around(mesh.faces, mesh.n_vertices)
    order = coding_order(near)
    assert sorted(order.tolist()) == list(range(mesh.n_vertices))
    place = np.argsort(order)
    earlier = [(place[mesh.topology.ring(v, 1)] < place[v]).sum() for v in order[3:]]
    assert min(earlier) >= 2  # a face of two known vertices


def test_neighbourhoods():
    mesh = shapes.disk(3)
    near = look_around(mesh.faces, mesh.n_vertices)
    for v in range(mesh.n_vertices):
        around = near.around[near.starts[v] : near.starts[v + 1]]
        np.testing.assert_array_equal(around, mesh.topology.ring(v, 1))
        corners = near.corner_list[near.corner_starts[v] : near.corner_starts[v + 1]]
        np.testing.assert_array_equal(np.unique(corners // 3), mesh.topology.face_ring(v))
    np.testing.assert_array_equal(near.opposite, mesh.topology.twins.ravel())


def test_levels_masses_and_logarithms():
    xs = [0.0, 0.1, 0.25, 1.0, 3.3, 17.0, 1e9]
    assert [level(x) for x in xs] == [min(15, int(2 * np.log2(1 + 4 * x))) for x in xs]
    opinions = new_opinions()
    opinions.shape[:2] = LOGISTIC, LAPLACE
    opinions.middle[:2], opinions.sharpness[:2] = 10.0, 0.5
    for low, high in [(-3, -1), (-0.5, 2), (0, 4), (1.37, 1.4)]:
        logistic = 1 / (1 + np.exp(-high)) - 1 / (1 + np.exp(-low))
        set_edge(2, 10 + 2 * low, opinions)
        set_edge(3, 10 + 2 * high, opinions)
        assert between(2, 3, 0, opinions) / WHOLE == pytest.approx(logistic, rel=1e-3)
    set_edge(2, 10.0, opinions)
    set_edge(3, 12.0, opinions)
    assert between(2, 3, 1, opinions) / WHOLE == pytest.approx(0.5 - 0.5 / np.e, rel=1e-4)
    for x in (1, 2, 3, 1000, 12345678, 1 << 40):
        assert ln(x) / 65536 == pytest.approx(np.log(x), abs=2e-3)


@pytest.mark.parametrize("effort", ["best", "fast"])
@pytest.mark.parametrize("d", [2, 3, 5])
def test_offsets_come_back_bit_by_bit_and_near(effort, d):
    """Whole steps from a prediction: within half a step, or 0.6 where the prediction is taken."""
    mesh = shapes.icosphere(2)
    near = surroundings(mesh.faces, mesh.n_vertices)
    for spread in (2.0, 1000.0):
        x = np.tile(mesh.vertices, 2)[:, :d] * spread
        data, placed = encode_offsets(x, near, effort)
        found = decode_offsets(Reader(data, "x"), x.shape, near, effort)
        assert found.tobytes() == placed.tobytes()
        off = abs(placed - x)
        assert 0.5 < off.max() <= DEAD_ZONE if spread < 10 else off.max() <= DEAD_ZONE
        assert (off > 0.5).mean() < 0.2
    with pytest.raises(FileFormatError, match="fewer numbers"):
        decode_offsets(Reader(to_varints([3]) + data[2:5], "x"), (x.shape[0], 3), near, effort)


@pytest.mark.parametrize("effort", ["best", "fast"])
@pytest.mark.parametrize("spread", [1, 30, 10_000, 2**30])
def test_numbers_come_back_even_where_nothing_can_be_guessed(effort, spread):
    mesh = shapes.icosphere(1)
    numbers = np.random.default_rng(spread).integers(-spread, spread + 1, (mesh.n_vertices, 3))
    grid = PositionGrid(np.zeros(3), 1.0)
    near = look_around(mesh.faces, mesh.n_vertices)
    data = encode_positions(numbers.astype(float), near, grid, effort)
    decoded = decode_positions(Reader(data, "x"), mesh.faces, mesh.n_vertices)
    np.testing.assert_array_equal(decoded, numbers)
    random = 3 * np.log2(2 * spread + 1) * mesh.n_vertices / 8
    assert len(data) < 1.15 * random + 40  # noise costs its entropy, hardly more
