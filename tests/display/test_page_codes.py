import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltrami.display.page_codes import (
    Sections,
    face_residuals,
    guesses_of,
    planes_of,
    quantized,
)
from beltrami.display.page_order import order_of
from beltrami.mesh.shapes import icosphere
from made_once import MadeOnce, creature
from page_reader import faces_from, moebius, values_from

MESHES = MadeOnce(
    {
        "closed": icosphere(2).faces,
        "limbs": lambda: creature(500).faces,
        "one-sided": moebius(9).faces,
        "apart": np.array([[5, 3, 4], [0, 1, 2], [2, 1, 6]]),
        "three at an edge": np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4], [4, 1, 5]]),
    }
)


@pytest.fixture(params=MESHES, ids=str)
def faces(request):
    return np.asarray(MESHES[request.param], np.int64)


def test_faces_come_back(faces):
    n = int(faces.max()) + 1
    order = order_of(faces, n)
    np.testing.assert_array_equal(faces_from(face_residuals(order.faces)), order.faces)
    back = order.vertices[order.faces]
    np.testing.assert_array_equal(back.ravel(), faces.ravel()[order.corners.ravel()])

    def turned(face):
        start = int(np.argmin(face))
        return tuple(np.roll(face, -start).tolist())

    assert sorted(map(turned, back)) == sorted(map(turned, faces))  # none lost, none turned over


def test_values_come_back_by_the_definition(faces):
    n = int(faces.max()) + 1
    order = order_of(faces, n)
    values = np.random.default_rng(3).integers(-500, 500, (n, 4))
    residuals = guesses_of(order.faces, n).residuals(values)
    np.testing.assert_array_equal(values_from(residuals, order.faces), values)


def test_linear_functions_leave_nothing_on_parallelograms():
    side = 12
    at = np.arange(side * side).reshape(side, side)
    a, b, c, d = at[:-1, :-1], at[:-1, 1:], at[1:, :-1], at[1:, 1:]
    faces = np.concatenate(
        [np.stack([a, b, c], -1).reshape(-1, 3), np.stack([b, d, c], -1).reshape(-1, 3)]
    )
    order = order_of(faces, side * side)
    x, y = np.divmod(order.vertices, side)
    left = guesses_of(order.faces, side * side).residuals((7 * x - 4 * y)[:, None])
    assert (left != 0).sum() <= 3  # the first triangle


def test_smooth_functions_leave_little():
    faces = icosphere(4).faces
    z = icosphere(4).vertices[:, 2:]
    order = order_of(faces, len(z))
    levels = quantized(z[order.vertices], np.array([1 / 1000]))
    left = guesses_of(order.faces, len(z)).residuals(levels)
    assert np.abs(left).mean() < 0.02 * np.abs(np.diff(levels, axis=0)).mean() * 10


@given(st.lists(st.integers(-(2**40), 2**40), min_size=1, max_size=30))
def test_planes_come_back(numbers):
    data, planes = planes_of(np.array(numbers)[:, None])
    folded = np.frombuffer(data, np.uint8).reshape(planes, -1).astype(np.uint64)
    for row, number in enumerate(numbers):
        value = sum(int(folded[p, row]) << (8 * p) for p in range(planes))
        assert (value // 2 if value % 2 == 0 else -(value + 1) // 2) == number
    if planes > 1:
        assert folded[-1].any()  # no plane for nothing


def test_sections_follow_each_other():
    sections = Sections()
    sections.add("a", np.array([[1, 2]]))
    sections.add("b", np.array([[300], [0]]))
    assert [entry["planes"] for entry in sections.entries] == [1, 2]
    assert zlib.decompress(sections.packed(), -15) == bytes([2, 4, 88, 0, 2, 0])


def test_each_plane_is_packed_by_what_suits_it():
    sections = Sections()
    rng = np.random.default_rng(5)
    noise = rng.integers(-3, 4, (20_000, 1))  # log2(7) = 2.8 bits each
    sections.add("noise", noise)
    sections.add("nothing", np.zeros((100_000, 1), np.int64))
    sections.add("repeated", np.tile(rng.integers(-60, 60, 500), 100)[:, None])
    packed = sections.packed()
    assert len(packed) < 20_000 * 2.95 / 8 + 100 + 2500
    whole = b"".join(sections.parts)
    assert zlib.decompress(packed, -15) == whole
    assert len(packed) < len(zlib.compress(whole, 9))


def test_a_constant_has_no_steps():
    np.testing.assert_array_equal(quantized(np.zeros((3, 1)), np.zeros(1)), np.zeros((3, 1)))
