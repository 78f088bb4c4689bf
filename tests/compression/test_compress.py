"""Meshes come back: faces exactly, positions within the bound, functions bit by bit."""

import numpy as np
import pytest
from hypothesis import given, settings

import beltrami as bt
from beltrami.compression import geometry
from beltrami.compression.contents import describe
from beltrami.errors import (
    BeltramiError,
    FileFormatError,
    MeshError,
    NonFiniteError,
    UnknownNameError,
)
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.topology import Topology
from strategies import any_meshes


def cycles(faces):
    """Faces as a sorted list of triples that begin with their smallest vertex."""
    return sorted(min((a, b, c), (b, c, a), (c, a, b)) for a, b, c in np.asarray(faces).tolist())


def check(mesh, **options):
    """Compress and decompress; faces exact, positions within the stated bound; return bytes."""
    data = bt.compress(mesh, **options)
    back = bt.decompress(data)
    keep = options.get("keep_order", False)
    order = np.arange(mesh.n_vertices) if keep else bt.vertex_order(mesh)
    assert cycles(order[back.faces]) == cycles(mesh.faces)
    if mesh.n_vertices:
        error = np.linalg.norm(back.vertices - mesh.vertices[order], axis=1).max()
        slack = 1e-15 * abs(mesh.vertices).max()
        assert error <= options.get("max_error", np.inf)
        assert error <= describe(data).max_error + slack
    for name, values in mesh.vertex_data.items():
        np.testing.assert_array_equal(back.vertex_data[name], values[order])
    return data


@given(any_meshes())
@settings(max_examples=60)
def test_any_mesh_comes_back(mesh):
    check(mesh, bits=9)
    check(mesh, max_error=0.01, keep_order=True, effort="fast")


@pytest.mark.parametrize("bits", [1, 4, 8, 12, 20, 30])
def test_more_bits_less_error_more_bytes(bits):
    mesh = bt.shapes.icosphere(3)
    coarse, fine = (check(mesh, bits=b) for b in (bits, min(bits + 2, 30)))
    extent = np.ptp(mesh.vertices, axis=0).max()
    step = describe(coarse).step
    assert step == pytest.approx(extent / (2**bits - 1), rel=1e-6)
    assert bits == 30 or len(fine) > len(coarse)


@pytest.mark.parametrize("unit", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("shift", [0.0, 100.0])
def test_units_and_origins_do_not_matter(unit, shift):
    sphere = bt.shapes.icosphere(2)
    mesh = sphere.with_vertices((sphere.vertices + shift) * unit)
    data = check(mesh, max_error=1e-3 * unit)
    plain = check(sphere, max_error=1e-3)
    assert len(data) <= len(plain) + 40  # perhaps an origin in double precision


def test_the_decoder_rebuilds_order_and_faces_from_the_topology_alone():
    """Other positions, the same faces: the same first section, the same order."""
    mesh = bt.shapes.cylinder(15, 8)
    other = mesh.with_vertices(np.random.default_rng(0).normal(size=mesh.vertices.shape))
    a, b = bt.decompress(bt.compress(mesh)), bt.decompress(bt.compress(other))
    np.testing.assert_array_equal(a.faces, b.faces)
    np.testing.assert_array_equal(bt.vertex_order(mesh), bt.vertex_order(mesh.topology))
    assert abs(b.vertices - other.vertices[bt.vertex_order(mesh)]).max() < 1e-3


def rms(mesh, data):
    x = mesh.vertices[bt.vertex_order(mesh)]
    return np.sqrt(((bt.decompress(data).vertices - x) ** 2).mean())


@pytest.mark.parametrize("bits", [4, 6, 8])
def test_smooth_positions_are_nearer_for_the_same_bytes(bits):
    mesh = bt.shapes.blob(2000)
    plain, smooth = check(mesh, bits=bits), check(mesh, bits=bits, mode="smooth")
    assert len(smooth) < (0.9 if bits < 7 else 1.0) * len(plain)
    assert rms(mesh, smooth) < rms(mesh, plain)
    assert describe(smooth).max_error <= 2 * describe(plain).max_error
    assert (describe(plain).mode, describe(smooth).mode) == ("grid", "smooth")


@pytest.mark.parametrize("max_error", [0.1, 0.02, 1e-4])
def test_smooth_positions_keep_a_bound(max_error):
    for mesh in (bt.shapes.blob(1000), bt.shapes.cube(4)):
        data = check(mesh, max_error=max_error, mode="smooth")
        assert 0.5 * max_error < describe(data).max_error <= max_error * (1 + 1e-9)


@pytest.mark.parametrize("d", [2, 3, 5])
@pytest.mark.parametrize("max_error", [2.0, 0.3, 0.01])
def test_smooth_positions_keep_the_bound_at_the_step_of_the_grid(d, max_error):
    """Noise, of which nothing can be guessed: every residual is as far from whole as can be."""
    mesh = bt.shapes.grid(12, 12)
    x = np.random.default_rng(d).normal(size=(mesh.n_vertices, d))
    for effort in ("best", "fast"):
        options = {"max_error": max_error, "effort": effort, "verify": False}
        smooth = check(Mesh(x, mesh.faces), mode="smooth", **options)
        plain = check(Mesh(x, mesh.faces), mode="grid", **options)
        assert describe(smooth).step == describe(plain).step


def test_where_everything_is_smoothed_a_bound_is_no_excuse_not_to(monkeypatch):
    """Of the smoothings the nearest in the mean that keeps the bound is told, not just none."""
    mesh = bt.shapes.blob(3000)
    data = bt.compress(mesh, max_error=0.1, mode="smooth", effort="fast")
    monkeypatch.setattr(geometry, "best_choice", lambda *rest: 0)
    plain = bt.compress(mesh, max_error=0.1, mode="smooth", effort="fast")
    assert len(data) == len(plain)
    assert rms(mesh, data) < 0.9 * rms(mesh, plain)


@pytest.mark.parametrize("seed", range(3))
def test_spikes_on_a_very_fine_grid_come_back(seed):
    """Guesses go wild beside them, far beyond all numbers; what is coded is found all the same."""
    mesh = bt.shapes.grid(20, 20)
    rng = np.random.default_rng(seed)
    x = np.column_stack([mesh.vertices, np.zeros(mesh.n_vertices)])
    x[rng.integers(0, len(x), 9)] += rng.choice([-50, 50, 1000], (9, 1)) * np.array([1, 1, 0.0])
    for mode in ("grid", "smooth"):
        check(Mesh(x, mesh.faces), bits=30, mode=mode)


def test_smooth_surfaces_cost_less_than_noise():
    mesh = bt.shapes.icosphere(4)
    noise = mesh.with_vertices(np.random.default_rng(1).uniform(-1, 1, mesh.vertices.shape))
    assert len(check(mesh, bits=10)) < 0.35 * len(check(noise, bits=10))


@pytest.mark.parametrize("d", [2, 3, 4, 7])
def test_other_dimensions(d):
    mesh = bt.shapes.disk(6)
    x = np.random.default_rng(d).normal(size=(mesh.n_vertices, d))
    assert bt.decompress(check(Mesh(x, mesh.faces), bits=12)).dimension == d


@pytest.mark.parametrize("faces", [[], [[0, 1, 2]]])
@pytest.mark.parametrize("x", [np.zeros((3, 3)), np.full((3, 3), 7.5), np.eye(3) * 1e-300])
def test_tiny_and_flat_meshes(faces, x):
    if np.ptp(x) > 0:
        with pytest.raises(MeshError, match="too small"):
            bt.compress(Mesh(x * 1e-10, faces))
    check(Mesh(x, faces))


def test_empty_mesh():
    check(Mesh(np.zeros((0, 3)), np.zeros((0, 3), int)))


def test_functions_and_texture_coordinates_come_back_exactly():
    mesh = bt.shapes.cylinder(9, 5)
    rng = np.random.default_rng(0)
    faces = np.concatenate([mesh.faces, [[0, 0, 1]]])
    data = {
        "height": rng.normal(size=mesh.n_vertices),
        "colour": rng.integers(0, 256, (mesh.n_vertices, 3), dtype=np.uint8),
        "big": np.arange(mesh.n_vertices).astype(">i4"),
        "inside": rng.random(mesh.n_vertices) < 0.5,
        "missing": np.full(mesh.n_vertices, np.nan),
    }
    uv = rng.normal(size=(len(faces), 3, 2))
    full = Mesh(mesh.vertices, faces, data, uv)
    for keep in (False, True):
        back = bt.decompress(check(full, keep_order=keep))
        order = np.arange(full.n_vertices) if keep else bt.vertex_order(full)
        old = {}
        for face, corner in zip(faces.tolist(), uv.tolist(), strict=True):
            for v, t in zip(face, corner, strict=True):
                old.setdefault((v, *sorted(face)), []).append(t)
        for face, corner in zip(order[back.faces].tolist(), back.corner_uv.tolist(), strict=True):
            for v, t in zip(face, corner, strict=True):
                assert t in old[(v, *sorted(face))]


def test_keeping_the_order_costs_at_most_log2_n_bits():
    mesh = bt.shapes.icosphere(3)
    shuffle = np.random.default_rng(0).permutation(mesh.n_vertices)
    mixed = Mesh(mesh.vertices[shuffle], np.argsort(shuffle)[mesh.faces])
    more = len(check(mixed, keep_order=True)) - len(check(mixed))
    assert 8 * more <= mixed.n_vertices * np.log2(mixed.n_vertices) + 64


def test_writing_is_whole_or_not_at_all(tmp_path):
    mesh = bt.shapes.icosphere(1)
    place = tmp_path / "a.btm"
    data = bt.compress(mesh, place)
    assert place.read_bytes() == data
    assert bt.decompress(place).n_vertices == 42
    with pytest.raises(NonFiniteError):
        bt.compress(mesh.with_vertices(mesh.vertices * np.nan), place)
    assert place.read_bytes() == data
    assert [p.name for p in tmp_path.iterdir()] == ["a.btm"]


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"mode": "wavelets"}, UnknownNameError, "choose one of 'auto', 'grid', 'smooth', 'spec"),
        ({"effort": "most"}, UnknownNameError, "choose one of 'best', 'fast'"),
        ({"bits": 0}, MeshError, "bits must be 1 to 30, not 0"),
        ({"bits": 31}, MeshError, "bits must be 1 to 30, not 31"),
        ({"bits": 7.5}, MeshError, "bits is 7.5 where a whole number is needed"),
        ({"uv_error": 0.1}, MeshError, "texture coordinates, and the mesh has none"),
        ({"bits": 9, "max_error": 1.0}, MeshError, "give one of them"),
        ({"max_error": 0.0}, MeshError, "must be positive"),
        ({"max_error": np.nan}, MeshError, "must be positive"),
        ({"max_error": 1e-12}, MeshError, r"below 2 / 2\^31"),
    ],
)
def test_what_cannot_be_is_refused(options, error, message):
    with pytest.raises(error, match=message):
        bt.compress(bt.shapes.icosphere(1), **options)


def test_a_bound_below_the_rounding_of_the_coordinates_is_refused():
    mesh = bt.shapes.icosphere(2)
    far = mesh.with_vertices(np.random.default_rng(0).random(mesh.vertices.shape) + 1e12)
    with pytest.raises(MeshError, match="coordinates themselves are rounded"):
        bt.compress(far, max_error=1.9e-4)  # doubles are 1.2e-4 apart there


def test_verification_finds_what_decodes_to_something_else(monkeypatch):
    """Were the decoder to see other positions, nothing would be returned."""
    from beltrami.compression import compress as module

    mesh = bt.shapes.icosphere(1)
    honest = module.decompress

    def wrong(data, **options):
        back = honest(data, **options)
        x = back.vertices.copy()
        x[3, 1] += 1.0
        return back.with_vertices(x)

    monkeypatch.setattr(module, "decompress", wrong)
    with pytest.raises(BeltramiError, match="does not give the mesh back"):
        module.compress(mesh)
    module.compress(mesh, verify=False)


def test_what_is_not_a_compressed_mesh_is_refused(tmp_path):
    place = tmp_path / "a.btm"
    place.write_bytes(b"ply\nformat ascii 1.0\n")
    with pytest.raises(FileFormatError, match=r"a\.btm, byte 0: not a \.btm file"):
        bt.decompress(place)
    data = bt.compress(bt.shapes.icosphere(1))
    with pytest.raises(FileFormatError, match="max_vertices can be raised"):
        bt.decompress(data, max_vertices=41)
    with pytest.raises(MeshError, match="max_vertices is nan where a whole number is needed"):
        bt.decompress(data, max_vertices=np.nan)


def test_progress_is_told():
    told = []
    bt.compress(bt.shapes.icosphere(1), progress=lambda *a: told.append(a), verify=False)
    assert told == [(42, 42)]


def test_vertex_order_of_a_topology():
    order = bt.vertex_order(Topology([[3, 1, 2]], 5))
    assert sorted(order.tolist()) == [0, 1, 2, 3, 4]
    assert order[3:].tolist() == [0, 4]  # vertices of no face come last
