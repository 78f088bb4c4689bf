"""The codec of the chapter: few terms, a stated bound, any beginning a coarser shape."""

import numpy as np
import pytest
from hypothesis import given, settings

import beltrami as bt
from beltrami.compression.container import SPECTRUM, unpack
from beltrami.compression.contents import describe
from beltrami.compression.spectral_head import read_spectral_head
from beltrami.errors import FileFormatError, MeshError
from beltrami.mesh.mesh import Mesh
from made_once import creature
from strategies import any_meshes


def spectral(mesh, **options):
    """Compress and decompress; faces exact, positions within the stated bound: (bytes, mesh)."""
    data = bt.compress(mesh, mode="spectral", **options)
    back = bt.decompress(data)
    keep = options.get("keep_order", False)
    order = np.arange(mesh.n_vertices) if keep else bt.vertex_order(mesh)
    assert np.array_equal(
        np.sort(np.sort(order[back.faces]), axis=0), np.sort(np.sort(mesh.faces), axis=0)
    )
    if mesh.n_vertices:
        worst = np.linalg.norm(back.vertices - mesh.vertices[order], axis=1).max()
        slack = 1e-14 * abs(mesh.vertices).max()
        assert worst <= describe(data).max_error + slack
        assert worst <= options.get("max_error", np.inf)
    return data, back


def rms(mesh, back):
    x = mesh.vertices[bt.vertex_order(mesh)]
    return np.sqrt(((back.vertices - x) ** 2).sum(axis=1).mean())


@given(any_meshes())
@settings(max_examples=40)
def test_any_mesh_comes_back(mesh):
    spectral(mesh, bits=7, effort="fast")
    spectral(mesh, max_error=0.01, keep_order=True, effort="fast")


@pytest.mark.parametrize("d", [2, 3, 5])
def test_other_dimensions(d):
    mesh = bt.shapes.disk(6)
    x = np.random.default_rng(d).normal(size=(mesh.n_vertices, d))
    _, back = spectral(Mesh(x, mesh.faces), bits=9)
    assert back.dimension == d


@pytest.mark.parametrize("unit", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("max_error", [0.05, 1e-3])
def test_a_bound_is_kept_in_every_unit(unit, max_error):
    mesh = creature(1200).with_vertices((creature(1200).vertices + 3.0) * unit)
    data, _ = spectral(mesh, max_error=max_error * unit, effort="fast")
    assert describe(data).max_error <= max_error * unit * (1 + 1e-9)


def test_empty_and_tiny_meshes():
    for n in range(4):
        spectral(Mesh(np.random.default_rng(n).normal(size=(n, 3)), np.zeros((0, 3), int)))
    spectral(Mesh(np.full((700, 3), 2.5), [[0, 1, 2]]))


@pytest.mark.chapter("P60", "P66")
def test_more_terms_more_bytes_less_error():
    sizes, errors = [], []
    for terms in (1, 4, 16, 64, 256):
        data, back = spectral(creature(1200), terms=terms, bits=9)
        assert describe(data).terms <= terms
        sizes.append(len(data))
        errors.append(rms(creature(1200), back))
    assert (np.diff(sizes) > 0).all()
    assert (np.diff(errors) < 0).all()
    assert errors[-1] < 0.02 * errors[0]


@pytest.mark.chapter("P58", "P60")
def test_few_terms_are_the_linear_approximation_of_definition_21():
    """Of one block, in the eigenvectors of L; wherever the mesh is (E78)."""
    mesh = bt.shapes.blob(500)
    pair = bt.laplacian(mesh, "combinatorial", mass="unit")
    basis = bt.fourier_basis(pair, 41)
    for terms in (15, 40):
        expected = np.linalg.norm(mesh.vertices - basis.truncate(mesh.vertices, terms))
        for move in (0.0, 10.0):
            moved = mesh.with_vertices(mesh.vertices + move)
            _, back = spectral(moved, terms=terms, bits=24)
            error = rms(moved, back) * np.sqrt(mesh.n_vertices)
            assert error == pytest.approx(expected, rel=2e-2)


@pytest.mark.chapter("P66", "P68")
@pytest.mark.parametrize("keep_order", [False, True])
def test_every_beginning_is_a_coarser_shape(keep_order):
    mesh = Mesh(
        creature(1200).vertices, creature(1200).faces, {"f": np.arange(creature(1200).n_vertices)}
    )
    data, whole = spectral(mesh, bits=8, keep_order=keep_order, effort="fast")
    x = mesh.vertices if keep_order else mesh.vertices[bt.vertex_order(mesh)]
    errors = []
    for size in range(0, len(data), len(data) // 25):
        try:
            back = bt.decompress(data[:size], partial=True)
        except FileFormatError:
            assert not errors  # only where the faces, or the means of the blocks, are not whole
            continue
        np.testing.assert_array_equal(back.faces, whole.faces)
        errors.append(np.linalg.norm(back.vertices - x))
        with pytest.raises(FileFormatError):
            bt.decompress(data[:size])
    assert len(errors) > 8
    assert errors[-1] < 0.1 * errors[0]
    assert (np.diff(errors) <= 0.05 * np.array(errors[:-1])).all()
    complete = bt.decompress(data, partial=True)
    np.testing.assert_array_equal(complete.vertices, whole.vertices)
    assert list(complete.vertex_data) == ["f"]
    assert not back.vertex_data


def test_a_beginning_without_the_mean_of_each_block_is_no_shape():
    data = bt.compress(creature(1200), mode="spectral", bits=12, effort="fast")
    section = next(s for s in unpack(data, "x")[1] if s.kind == SPECTRUM)
    reader = section.reader("x")
    read_spectral_head(reader, creature(1200).n_vertices)
    reader.varint()
    first = section.start + reader.position
    with pytest.raises(FileFormatError, match="before the first coefficient of each block"):
        bt.decompress(data[: first + 6], partial=True)
    assert bt.decompress(data[: first + 60], partial=True).n_vertices == creature(1200).n_vertices


def test_only_this_mode_can_be_read_in_part():
    data = bt.compress(creature(1200), bits=8)
    with pytest.raises(FileFormatError, match="'positions on a grid', or not the whole of it"):
        bt.decompress(data[: len(data) // 2], partial=True)


@pytest.mark.chapter("P58")
def test_another_basis_is_noticed(monkeypatch):
    """E87: were the decoder's eigenvectors others, nothing would be returned."""
    from beltrami.compression import block_basis

    data = bt.compress(creature(1200), mode="spectral", bits=7)
    honest = block_basis.BlockBasis.vectors

    def turned(self, vertices, count):
        U = honest(self, vertices, count).copy()
        U[:, 3:4] *= -1
        return U

    monkeypatch.setattr(block_basis.BlockBasis, "vectors", turned)
    with pytest.raises(FileFormatError, match="basis that the faces give is not the one"):
        bt.decompress(data)


def test_a_coarse_shape_takes_the_fewest_bytes_and_auto_finds_it():
    error = 0.02 * np.ptp(creature(1200).vertices)
    sizes = {
        mode: len(bt.compress(creature(1200), max_error=error, mode=mode, effort="fast"))
        for mode in ("grid", "smooth", "spectral")
    }
    assert sizes["spectral"] < 0.95 * min(sizes["grid"], sizes["smooth"])
    data = bt.compress(creature(1200), max_error=error, effort="fast")
    assert (len(data), describe(data).mode) == (sizes["spectral"], "spectral")
    fine = bt.compress(creature(1200), max_error=error / 300, effort="fast")
    assert describe(fine).mode == "grid"


@pytest.mark.parametrize(
    ("make", "part", "best"),
    [
        (creature, 0.05, "spectral"),
        (creature, 0.012, "spectral"),
        (creature, 0.007, "spectral"),
        (lambda _: bt.shapes.disk(8), 0.05, "spectral"),
        (creature, 0.004, "smooth"),
        (lambda _: bt.shapes.cube(8), 0.05, "grid"),
    ],
)
def test_auto_takes_the_fewest_bytes_of_all_modes(make, part, best):
    mesh = make(1200)
    options = {"max_error": part * np.ptp(mesh.vertices), "effort": "fast", "verify": False}
    modes = ("grid", "smooth", "spectral")
    sizes = {mode: len(bt.compress(mesh, mode=mode, **options)) for mode in modes}
    assert min(sizes, key=sizes.get) == best
    assert len(bt.compress(mesh, **options)) == sizes[best]


def test_terms_belong_to_the_spectrum():
    with pytest.raises(MeshError, match="the mode 'auto' has no terms"):
        bt.compress(creature(1200), terms=5)
    for terms in (0, 10_000, 2.5):
        with pytest.raises(MeshError, match="the number of terms is"):
            bt.compress(creature(1200), mode="spectral", terms=terms)
