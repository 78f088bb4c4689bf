"""Functions through the predictor: bit by bit, or within what was allowed, in fewer bytes."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import beltrami as bt
from beltrami.compression.contents import describe
from beltrami.compression.exact import (
    decode_beside,
    encode_beside,
    exponent_for,
    floats_at,
    moved,
    places_of,
    steps_of,
)
from beltrami.compression.functions import encode_array, write_label
from beltrami.compression.numbers import encode_numbers, surroundings
from beltrami.compression.predicted import decode_predicted, encode_exactly, encode_within
from beltrami.compression.varint import Reader, to_varints
from beltrami.compression.wedges import decode_uv, encode_uv
from beltrami.errors import FileFormatError, MeshError, NonFiniteError, UnknownNameError
from beltrami.mesh.mesh import Mesh

MESH = bt.shapes.icosphere(2)
N = MESH.n_vertices
NEAR = surroundings(MESH.faces, N)
X, Y, Z = MESH.vertices.T


def there_and_back(values, near=NEAR):
    data = encode_exactly("größe", values, near, "fast")
    name, back = decode_predicted(Reader(data, "x"), len(values), near)
    assert name == "größe"
    assert back.dtype == values.dtype.newbyteorder("=")
    assert back.shape == values.shape
    assert back.tobytes() == values.astype(back.dtype).tobytes()
    return len(data)


@given(
    st.sampled_from(["f2", "f4", "f8"]).flatmap(
        lambda kind: arrays.arrays(
            kind,
            st.sampled_from([(12,), (12, 2), (12, 4)]),
            elements=st.floats(
                allow_nan=False, allow_infinity=False, width=8 * np.dtype(kind).itemsize
            ),
        )
    )
)
@settings(max_examples=80)
def test_all_finite_floats_come_back_bit_by_bit(values):
    there_and_back(values, surroundings(bt.shapes.icosphere(0).faces, 12))


@pytest.mark.parametrize("kind", ["u1", "i1", "?", ">i2", "u4", "i8"])
@pytest.mark.parametrize("tail", [(), (3,), (5,)])
def test_integers_come_back(kind, tail):
    values = np.random.default_rng(0).integers(0, 2, (N, *tail)).astype(kind)
    there_and_back(values)
    if kind in ("i1", ">i2", "i8"):
        there_and_back(-100 * values)


@pytest.mark.parametrize(
    "values",
    [
        np.full(N, -0.0),
        np.full(N, 5e-324),
        np.where(X > 0, 1.7e308, -1.7e308),
        np.where(X > 0, 0.0, -0.0).astype("f4"),
        np.geomspace(1e-300, 1e300, N),
        np.full((N, 2), 1e-44, "f4"),
        X.astype("f4").astype("f8"),
    ],
)
def test_extremes(values):
    there_and_back(values)


def test_smooth_functions_take_fewer_bytes_than_deflated_ones():
    mesh = bt.shapes.blob(1200)
    near, x = surroundings(mesh.faces, mesh.n_vertices), mesh.vertices / abs(mesh.vertices).max()
    colours = np.rint(127 * (1 + x)).astype("u1")
    for values, share in [
        (colours, 0.6),
        (x[:, 0].astype("f4"), 0.97),
        (np.exp(x @ [0.7, 0.3, 0.2]), 0.97),
        (np.rint(100 * x) / 128, 0.4),
        (x[:, 2] > 0.1, 0.5),
    ]:
        short = len(encode_exactly("f", values, near, "best"))
        assert short < share * len(encode_array("f", values))


def test_the_shorter_way_is_taken_and_told():
    rng = np.random.default_rng(0)
    mesh = Mesh(MESH.vertices, MESH.faces, {"noise": rng.normal(size=N), "red": X > 0})
    contents = describe(bt.compress(mesh, bits=8))
    names = [name for name, _ in contents.sections]
    assert names[2:] == ["functions", "predicted functions"]
    assert contents.features == ("functions are predicted",)
    plain = describe(bt.compress(Mesh(MESH.vertices, MESH.faces, {"noise": rng.normal(size=N)})))
    assert plain.features == ()


def test_what_cannot_be_predicted_is_left_to_the_other_way():
    for values in (np.full(N, np.nan), np.full(N, 2**40), np.zeros((N, 0)), np.zeros((N, 300))):
        assert encode_exactly("f", values, NEAR, "fast") is None


def test_exponents_and_places():
    assert exponent_for(np.array([0.5, 3.0])) == -1
    assert exponent_for(np.array([0.0, -0.0])) == 0
    np.testing.assert_array_equal(steps_of(np.array([0.5, -3.0]), -1), [1, -6])
    for kind in ("<f2", "<f4", "<f8"):
        info = np.finfo(kind)
        values = np.array(
            [info.min, -1.0, -info.smallest_subnormal, -0.0, 0.0, 1.0, info.max], kind
        )
        places = places_of(values)
        assert (np.diff(places) > 0).all()
        assert floats_at(places, kind).tobytes() == values.tobytes()
        following = np.nextafter(values[1:-1], np.array(np.inf, kind))
        beside = places_of(following) - places[1:-1]
        np.testing.assert_array_equal(beside, [1, 1, 2, 1, 1])  # the zeros are two places
        assert moved(places, np.zeros(7, np.int64), kind) is not None
        assert moved(places[-1:], np.array([1]), kind) is None
        assert moved(places[:1], np.array([-1]), kind) is None
        assert moved(places[-1:], np.array([2**63 - 1]), kind) is None


def test_numbers_beside_come_back():
    rng = np.random.default_rng(0)
    beside = np.concatenate(
        [rng.integers(-5, 6, 50), 2 ** np.arange(62), -(2 ** np.arange(62)), [0]]
    )
    beside = np.append(beside, [2**63 - 1, -(2**63 - 1)])[:, None]
    steps = rng.integers(-1000, 1000, beside.shape)
    data = encode_beside(beside, steps)
    np.testing.assert_array_equal(decode_beside(Reader(data, "x"), steps), beside)
    with pytest.raises(FileFormatError, match="fewer values"):
        decode_beside(Reader(data[: len(data) // 2], "x"), steps)


def functions(**options):
    values = {"h": Z.copy(), "n": MESH.vertices.astype("f4"), "i": np.arange(N)}
    mesh = Mesh(MESH.vertices, MESH.faces, values)
    data = bt.compress(mesh, bits=8, **options)
    return bt.decompress(data), bt.vertex_order(mesh), data


@pytest.mark.parametrize("error", [1e-2, 1e-4])
def test_bounds_of_functions_are_kept(error):
    back, order, data = functions(function_errors={"h": error, "n": 2 * error})
    assert 0 < abs(back.vertex_data["h"] - Z[order]).max() <= error
    off = np.linalg.norm(back.vertex_data["n"] - MESH.vertices.astype("f4")[order], axis=1)
    assert 0 < off.max() <= 2 * error
    assert back.vertex_data["n"].dtype == np.float32
    np.testing.assert_array_equal(back.vertex_data["i"], order)
    assert len(data) < 0.8 * len(functions()[2])


@pytest.mark.parametrize(
    ("errors", "error", "message"),
    [
        ({"g": 0.1}, UnknownNameError, "unknown function 'g'"),
        ({"i": 0.1}, MeshError, "'i' has the type int64, which is kept exactly"),
        ({"h": 0.0}, MeshError, "largest error of 'h' must be positive"),
        ({"h": np.nan}, MeshError, "largest error of 'h' must be positive"),
        ({"n": 1e-8}, MeshError, "must be positive, not 0"),
    ],
)
def test_errors_that_cannot_be(errors, error, message):
    with pytest.raises(error, match=message):
        functions(function_errors=errors)


def test_a_bound_needs_numbers():
    mesh = Mesh(MESH.vertices, MESH.faces, {"f": np.full(N, np.nan)})
    with pytest.raises(NonFiniteError, match="function 'f'"):
        bt.compress(mesh, function_errors={"f": 0.1})


def charted():
    """A cylinder with coordinates that have a seam, and where that is."""
    mesh = bt.shapes.cylinder(12, 5)
    angle = np.arctan2(mesh.vertices[:, 1], mesh.vertices[:, 0])
    uv = np.stack([angle, mesh.vertices[:, 2]], axis=1)[mesh.faces]
    across = np.ptp(uv[:, :, 0], axis=1) > 3
    uv[across, :, 0] %= 2 * np.pi
    return mesh, uv


def test_texture_coordinates_come_back_with_their_seams():
    mesh, uv = charted()
    data, _ = encode_uv(mesh.faces, mesh.n_vertices, uv, None, "fast")
    back = decode_uv(Reader(data, "x"), mesh.faces, mesh.n_vertices)
    assert back.tobytes() == uv.tobytes()
    count = Reader(data, "x").varint()
    assert mesh.n_vertices < count < mesh.n_vertices + 3 * 5  # the seam is there twice
    assert len(data) < 0.8 * len(encode_array("uv", uv.reshape(-1, 6)))


@pytest.mark.parametrize("keep_order", [False, True])
@pytest.mark.parametrize("uv_error", [None, 1e-3])
def test_texture_coordinates_of_files(keep_order, uv_error):
    mesh, uv = charted()
    full = Mesh(mesh.vertices, mesh.faces, {}, uv)
    data = bt.compress(full, bits=9, keep_order=keep_order, uv_error=uv_error, effort="fast")
    assert "predicted texture coordinates" in dict(describe(data).sections)
    back = bt.decompress(data)
    order = np.arange(mesh.n_vertices) if keep_order else bt.vertex_order(mesh)
    old = {
        (*sorted(face), v): t
        for face, corner in zip(mesh.faces.tolist(), uv, strict=True)
        for v, t in zip(face, corner, strict=True)
    }
    for face, corner in zip(order[back.faces].tolist(), back.corner_uv, strict=True):
        for v, t in zip(face, corner, strict=True):
            off = np.linalg.norm(t - old[(*sorted(face), v)])
            assert off == 0 if uv_error is None else off <= uv_error


def test_a_fan_of_different_wedges_takes_no_square_time():
    """Each corner at the hub has another coordinate; beyond 64 wedges none is looked for."""
    fan = np.array([[0, i, i + 1] for i in range(1, 3000)])
    uv = np.random.default_rng(0).integers(0, 40_000, (len(fan), 3, 2)) / 2.0
    data, _ = encode_uv(fan, 3001, uv, None, "fast")
    assert decode_uv(Reader(data, "x"), fan, 3001).tobytes() == uv.tobytes()


def test_what_is_not_of_the_type_is_refused():
    def read(kind, way, body):
        label = write_label("f", np.zeros(N, kind)) + to_varints([1, way])
        decode_predicted(Reader(label + body, "x"), N, NEAR)

    large = encode_numbers(np.full((N, 1), 300), NEAR, "fast")
    with pytest.raises(FileFormatError, match="not of the type"):
        read("u1", 0, large)
    for kind, way in (("f8", 0), ("u1", 1), ("i8", 2)):
        with pytest.raises(FileFormatError, match="not written in this way"):
            read(kind, way, large)
    nothing = encode_beside(np.zeros((N, 1), np.int64), np.full((N, 1), 300))
    beyond = np.array([0.0, 1e308], "<f8").tobytes()
    with pytest.raises(FileFormatError, match="not finite"):
        read("f8", 2, beyond + large)
    with pytest.raises(FileFormatError, match="not of the type"):
        read("f4", 1, to_varints([2, 1074]) + large + nothing)
    with pytest.raises(FileFormatError, match="not of the type"):
        read("f8", 1, to_varints([2, 2148]) + large + nothing)
    data, _ = encode_within("f", Z, 0.1, NEAR, "fast")
    with pytest.raises(FileFormatError):
        decode_predicted(Reader(data[:-3], "x"), N, NEAR)
