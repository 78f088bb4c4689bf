import numpy as np
import pytest

import beltrami as bt
from beltrami.errors import DimensionError, FileFormatError, MeshError
from beltrami.io.npz import read_arrays, write_arrays
from beltrami.operators.pair import MASSES
from beltrami.spectrum.basis_file import KIND, VERSION
from meshes_of_the_errata import IRREGULAR, MESHES


@pytest.fixture
def place(tmp_path):
    return tmp_path / "basis.npz"


def _saved(place, pair, k=12):
    basis = bt.fourier_basis(pair, k)
    basis.save(place)
    return basis


@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("mass", MASSES)
def test_round_trip(place, name, mass):
    for kind in ("cotangent", "combinatorial"):
        pair = bt.laplacian(MESHES[name](), kind, mass)
        basis = _saved(place, pair)
        again = bt.load_basis(place, pair)
        for one, other in (
            (again.eigenvalues, basis.eigenvalues),
            (again.eigenvectors, basis.eigenvectors),
            (again.residuals, basis.residuals),
            (again.mass.toarray(), basis.mass.toarray()),
        ):
            assert np.array_equal(one, other)
            assert one.dtype == np.float64
        assert again.computation == basis.computation
        f = MESHES[name]().vertices
        assert np.array_equal(again.forward(f), basis.forward(f))
        again.save(place.with_name("again.npz"))
        assert place.with_name("again.npz").read_bytes() == place.read_bytes()
        with pytest.raises(ValueError, match="read-only"):
            again.eigenvectors[0, 0] = 1
        with pytest.raises(ValueError, match="read-only"):
            again.mass.data[0] = 1


def test_the_whole_basis_and_one_vector(place):
    pair = bt.laplacian(bt.shapes.icosphere(1))
    for k in (1, 42):
        _saved(place, pair, k)
        assert bt.load_basis(str(place), pair).k == k


@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_units_do_not_count(place, unit):
    mesh = bt.shapes.torus(12, 8)
    pair = bt.laplacian(mesh.with_vertices(mesh.vertices * unit))
    _saved(place, pair)
    bt.load_basis(place, pair)
    with pytest.raises(MeshError):
        bt.load_basis(place, bt.laplacian(mesh))


def test_rounding_of_another_machine_is_no_other_mesh(place):
    mesh = MESHES["cur"]()
    _saved(place, bt.laplacian(mesh))
    noise = 1 + 1e-15 * np.random.default_rng(4).normal(size=mesh.vertices.shape)
    bt.load_basis(place, bt.laplacian(mesh.with_vertices(mesh.vertices * noise)))


def test_the_wrong_pair(place):
    mesh = MESHES["cur"]()
    pair = bt.laplacian(mesh)
    _saved(place, pair)
    with pytest.raises(DimensionError, match=r"192 vertices, and the pair has 42"):
        bt.load_basis(place, bt.laplacian(bt.shapes.icosphere(1)))
    moved = mesh.vertices.copy()
    moved[17] += 1e-3
    with pytest.raises(MeshError, match="other masses") as caught:
        bt.load_basis(place, bt.laplacian(mesh.with_vertices(moved)))
    near = np.unique(mesh.faces[(mesh.faces == 17).any(axis=1)])
    assert set(caught.value.vertices) <= set(near)
    with pytest.raises(MeshError, match="other masses"):
        bt.load_basis(place, bt.laplacian(mesh, mass="barycentric"))
    order = np.random.default_rng(3).permutation(mesh.n_vertices)
    with pytest.raises(MeshError, match="other masses"):
        bt.load_basis(
            place, bt.laplacian(bt.Mesh(mesh.vertices[order], np.argsort(order)[mesh.faces]))
        )


@pytest.mark.parametrize("mass", ["unit", "voronoi"])
def test_the_wrong_weights_with_the_same_masses(place, mass):
    """What no look at the masses can tell: the eigenvectors themselves do."""
    mesh = MESHES["closed"]()
    _saved(place, bt.laplacian(mesh, "cotangent", mass))
    for kind in ("combinatorial", "clamped", "distance"):
        other = bt.laplacian(mesh, kind, mass)
        if abs(other.stiffness - bt.laplacian(mesh).stiffness).max() == 0:
            continue  # no cotangent is clamped here
        with pytest.raises(MeshError, match="no eigenvectors of this stiffness"):
            bt.load_basis(place, other)
    nearly = bt.laplacian(
        mesh,
        lambda m: bt.laplacian(m).edge_weight * (1 + 1e-4 * (np.arange(len(m.edges)) == 5)),
        mass,
    )
    with pytest.raises(MeshError, match="no eigenvectors of this stiffness"):
        bt.load_basis(place, nearly)


def _rewritten(place, **changes):
    arrays = dict(read_arrays(place, KIND, VERSION))
    for name, change in changes.items():
        arrays[name] = change(arrays[name])
    write_arrays(place, KIND, VERSION, {k: v for k, v in arrays.items() if v is not None})


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("eigenvalues", lambda x: x[::-1]),
        ("eigenvalues", lambda x: x[1:]),
        ("eigenvalues", lambda x: x + np.nan),
        ("eigenvalues", lambda x: x.astype(np.float32)),
        ("eigenvalues", lambda x: None),
        ("eigenvectors", lambda x: x[:-1]),
        ("eigenvectors", lambda x: x.ravel()),
        ("eigenvectors", lambda x: x * np.inf),
        ("residuals", lambda x: x[:, None]),
        ("mass", lambda x: x[1:]),
        ("mass", lambda x: x * np.inf),
        ("mass_columns", lambda x: x + 1),
        ("mass_columns", lambda x: x - 1),
        ("mass_columns", lambda x: x.astype(float)),
        ("mass_columns", lambda x: None),
        ("mass_starts", lambda x: x[::-1]),
        ("mass_starts", lambda x: x[1:]),
        ("mass_starts", lambda x: x * 2),
        ("mass_starts", lambda x: x.astype(np.uint8)),
        ("computation", lambda x: None),
        ("computation", lambda x: np.array("{}")),
        ("computation", lambda x: np.array("no json")),
        ("computation", lambda x: np.array("3")),
        ("computation", lambda x: np.array("[" * 100_000)),
        (
            "computation",
            lambda x: np.array(str(x).replace('"solves": ', '"solves": Infinity, "y": ')),
        ),
        ("computation", lambda x: np.zeros(0)),
        ("computation", lambda x: np.array(str(x).replace('"solves": ', '"solves": "x", "y": '))),
    ],
)
def test_arrays_that_do_not_belong_together(place, name, change):
    for mass in ("consistent", "voronoi"):
        _saved(place, bt.laplacian(bt.shapes.icosphere(1), mass=mass))
        with np.errstate(invalid="ignore"):
            _rewritten(place, **{name: change})
        with pytest.raises(FileFormatError, match="expected the arrays of a basis"):
            bt.load_basis(place)


def test_rows_of_the_mass_out_of_order(place):
    _saved(place, bt.laplacian(bt.shapes.icosphere(1), mass="consistent"))
    _rewritten(place, mass_columns=lambda x: np.r_[x[1], x[0], x[2:]])
    with pytest.raises(FileFormatError, match="columns of the mass"):
        bt.load_basis(place)


def test_vertices_that_were_held_do_not_count(place):
    mesh = bt.shapes.grid(6, 6)
    pair = bt.laplacian(mesh)
    rim = np.abs(mesh.vertices - 0.5).max(axis=1) > 0.49
    bt.fourier_basis(pair, 5, hold=rim).save(place)
    assert bt.load_basis(place, pair).k == 5


def test_a_large_basis_in_single_precision_is_still_one_of_its_pair(place):
    pair = bt.laplacian(bt.shapes.icosphere(4))
    basis = bt.fourier_basis(pair, 30)
    assert basis.computation.method == "lanczos"
    basis.save(place)
    assert bt.load_basis(place, pair).computation == basis.computation
    with pytest.raises(MeshError, match="no eigenvectors of this stiffness"):
        bt.load_basis(place, bt.laplacian(bt.shapes.icosphere(4), "combinatorial", "voronoi"))


def test_a_file_of_something_else(place):
    write_arrays(place, "picture", 1, {"eigenvalues": np.zeros(3)})
    with pytest.raises(FileFormatError, match="expected a Fourier basis, found 'picture'"):
        bt.load_basis(place)
    np.savez(place, eigenvalues=np.zeros(3))
    with pytest.raises(FileFormatError):
        bt.load_basis(place)
    with pytest.raises(FileNotFoundError):
        bt.load_basis(place.with_name("none.npz"))
