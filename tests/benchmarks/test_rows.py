"""The rows: their goals name contenders that exist, and their comparisons see a difference."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest
from benchmarks.cases import Case
from benchmarks.claims import BEST_PEER, Row
from benchmarks.rows import ROWS, adjacency, assembly, eigenpairs, factorizing, reading, smoothing
from scipy.sparse import csc_array, csr_array, diags_array

import beltrami as bt

V = np.array([[0.0, 0, 0], [1.25, 0, 0], [0, -1.5, 0], [0, 0, 1e-3]])
F = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


def tetrahedron(folder: Path) -> Case:
    return Case("tetrahedron", folder, lambda: (V, F))


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.name)
def test_goals_name_contenders(row: Row, tmp_path: Path) -> None:
    contenders = row.contenders(tetrahedron(tmp_path))
    names = [one.name for one in contenders]
    assert len(set(names)) == len(names)
    ours = [one.name for one in contenders if one.ours]
    for goal in row.goals:
        assert goal.of in ours
        assert goal.against in (None, BEST_PEER, *names)


def test_names_of_rows_are_unique() -> None:
    names = [row.name for row in ROWS]
    assert len(set(names)) == len(names)


def test_assembly_compares_whatever_the_sign_and_the_format() -> None:
    L = csr_array([[2.0, -2.0], [-2.0, 2.0]])
    B = np.array([3.0, 4.0])
    ours = assembly.positive((L, diags_array(B)))
    assert assembly.difference(ours, assembly.positive((-csc_array(L), B))) == 0
    wrong = L.copy()
    wrong.data[1] = -1.0
    assert assembly.difference(ours, assembly.positive((wrong, B))) == 0.5
    assert assembly.difference(ours, assembly.positive((L, B * [1, 1.25]))) == 0.25


def test_adjacency_compares_edges_as_sets() -> None:
    edges = np.array([[0, 1], [0, 2], [1, 2]])
    turned = adjacency.sorted_pairs(np.array([[2, 1], [1, 0], [2, 0]]))
    assert adjacency.difference(edges, turned) == 0
    assert adjacency.difference(edges, np.array([[0, 1], [0, 3], [1, 2]])) == 1
    assert adjacency.difference(edges, edges[:2]) == np.inf


def test_smoothing_averages_over_the_neighbours() -> None:
    pyramids = np.array([[0, 1, 3], [1, 2, 3], [2, 0, 3], [1, 0, 4], [2, 1, 4], [0, 2, 4]])
    A = 1 - np.eye(5)
    A[3, 4] = A[4, 3] = 0  # the two tips, of degree 3; the others have degree 4
    W = smoothing.averaging(pyramids, 5)
    np.testing.assert_allclose(W.toarray(), A / A.sum(axis=1, keepdims=True))
    assert smoothing.difference(V, V) == 0
    assert smoothing.difference(V, V + np.array([0, 0.15, 0])) == pytest.approx(0.1)  # of 1.5


def test_smoothing_floor_grows_with_the_mesh(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ticks = iter([0.0, 3.0])  # three copies of twice 128 MiB in three seconds
    monkeypatch.setattr(time, "process_time", lambda: next(ticks))
    moved = 50 * (4 * 12 + 4 * 4 + 2 * 96)
    assert smoothing.floor_seconds(tetrahedron(tmp_path)) == pytest.approx(moved / 2**28)


def test_text_files_say_what_the_arrays_say(tmp_path: Path) -> None:
    reading.write_obj(tmp_path / "a.obj", V, F)
    lines = (tmp_path / "a.obj").read_text().splitlines()
    assert lines[1] == "v 1.25 0 0"
    assert lines[4:6] == ["f 1 3 2", "f 1 2 4"]
    reading.write_off(tmp_path / "a.off", V, F)
    lines = (tmp_path / "a.off").read_text().splitlines()
    assert lines[:3] == ["OFF", "4 4 0", "0 0 0"]
    assert lines[5:] == ["0 0 0.001", "3 0 2 1", "3 0 1 3", "3 1 2 3", "3 2 0 3"]


def test_ply_file_says_what_the_arrays_say(tmp_path: Path) -> None:
    reading.write_ply(tmp_path / "a.ply", V, F)
    head, _, body = (tmp_path / "a.ply").read_bytes().partition(b"end_header\n")
    assert b"element vertex 4\n" in head
    assert b"element face 4\n" in head
    assert len(body) == 4 * 12 + 4 * 13
    np.testing.assert_array_equal(np.frombuffer(body, "<f4", 12).reshape(4, 3), V.astype("f4"))
    assert body[48:61] == b"\x03" + np.array([0, 2, 1], "<i4").tobytes()


def test_reading_sees_a_wrong_number_and_a_wrong_face() -> None:
    assert reading.difference((V, F), (V.astype(np.float32), F.astype(np.int32))) < 1e-7
    assert reading.difference((V, F), (V + np.array([0.15, 0, 0]), F)) == pytest.approx(
        0.1
    )  # of 1.5
    assert reading.difference((V, F), (V, F[::-1])) == np.inf
    assert reading.difference((V, F), (V[:3], F)) == np.inf


def test_factorizing_solves_a_step_of_heat(tmp_path: Path) -> None:
    A = factorizing.step_of_heat(V, F).toarray()
    h = np.mean([np.linalg.norm(V[i] - V[j]) for i in range(4) for j in range(i)])
    L, B = (getattr(bt.laplacian(bt.Mesh(V, F)), name).toarray() for name in ("stiffness", "mass"))
    np.testing.assert_allclose(A, B + 100 * h**2 * L)
    for count, make in ((3, factorizing.solving(3)), (64, factorizing.solving(64))):
        b = factorizing.right_hand_sides(4, count)
        for one in make(tetrahedron(tmp_path))[:2]:  # the others need not be installed
            np.testing.assert_allclose(A @ one.run(one.prepare()), b, atol=1e-8)
    assert factorizing.difference(V, V + np.array([0, 0.15, 0])) == pytest.approx(0.1)


def test_a_peer_is_timed_for_each_right_hand_side_at_its_best(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By this clock a call takes 2 s, and 1 s more for each column beyond eight."""
    clock, columns = [0.0], []

    def solve(b: np.ndarray) -> np.ndarray:
        columns.append(b.shape[1])
        clock[0] += 2 + max(0, b.shape[1] - 8)
        return b

    monkeypatch.setattr(time, "process_time", lambda: clock[0])
    assert factorizing.seconds_each(solve, tetrahedron(tmp_path)) == 2 / 8
    assert sum(columns) == 64 * len(factorizing.BATCHES)


def test_superlu_is_not_asked_to_factorise_a_large_mesh(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    names = [one.name for one in factorizing.factorizing(tetrahedron(tmp_path))]
    monkeypatch.setattr(factorizing, "LARGE", 4)
    left = [one.name for one in factorizing.factorizing(tetrahedron(tmp_path))]
    assert [name for name in names if name not in left] == ["SuperLU, as we call it"]


def test_factorizing_sees_a_wrong_solution(tmp_path: Path) -> None:
    A = factorizing.step_of_heat(V, F)
    b = factorizing.right_hand_sides(4, 3)
    x = np.linalg.solve(A.toarray(), b)
    assert factorizing.backward_error(tetrahedron(tmp_path), x, b) < 1e-14
    assert factorizing.backward_error(tetrahedron(tmp_path), 1.5 * x, b) > 0.01


def test_eigenpairs_are_judged_by_their_own_residuals() -> None:
    L, B = np.diag([0.0, 2.0, 6.0]), np.diag([1.0, 2.0, 3.0])
    found = np.array([0.0, 1.0, 2.0]), np.eye(3)
    assert eigenpairs.residual(L, B, found) == 0
    wrong = np.array([0.0, 1.0, 2.5]), np.eye(3)
    assert eigenpairs.residual(L, B, wrong) == pytest.approx(0.2)
    assert eigenpairs.difference(found, wrong) == pytest.approx(0.25)
