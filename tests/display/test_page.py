import numpy as np
import pytest

from beltrami.diffusion.denoise import denoise
from beltrami.diffusion.heat import heat
from beltrami.display.page import page
from beltrami.errors import (
    BeltramiError,
    DimensionError,
    MeshError,
    NonFiniteError,
    UnknownNameError,
    UnreferencedVertexError,
)
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import blob, grid, icosphere
from beltrami.operators.laplacian import laplacian
from beltrami.parameterization.parameterize import parameterize
from beltrami.spectrum.fourier_basis import fourier_basis
from page_reader import faces_from, moebius, read_page, values_from


@pytest.fixture(scope="module")
def shape():
    return blob(600)


@pytest.fixture(scope="module")
def written(shape, tmp_path_factory):
    file = tmp_path_factory.mktemp("page") / "blob.html"
    told = []
    f = {"temperature": shape.vertices[:, 0] ** 2}
    done = page(
        shape, file, f, modes=20, up="z", unit="mm", progress=lambda *step: told.append(step)
    )
    text = file.read_text("utf-8")
    assert done.size == len(text.encode())
    assert not done.notes
    assert told == [(i + 1, 7) for i in range(7)]
    return read_page(text)


def turned(face):
    """Return a face with its smallest vertex first."""
    return tuple(np.roll(face, -int(np.argmin(face))).tolist())


def in_page(written, name):
    """Values of a section, in the order of the page."""
    _, sections = written
    return values_from(sections[name], faces_from(sections["faces"]))


def numbers(written):
    return np.cumsum(written[1]["numbers"])


@pytest.mark.chapter("F3.1")
def test_the_mesh_comes_back(shape, written):
    header, sections = written
    order = numbers(written)
    assert sorted(order) == list(range(shape.n_vertices))
    x = header["origin"] + header["step"] * in_page(written, "positions")
    assert np.abs(x - shape.vertices[order]).max() <= header["step"] / 2 * (1 + 1e-9)
    assert header["step"] == pytest.approx(0.005 * shape.edge_lengths.mean())
    faces = order[faces_from(sections["faces"])]
    assert set(map(turned, faces)) == set(map(turned, shape.faces))


@pytest.mark.chapter("F3.7")
@pytest.mark.parametrize("index", [0, 1, 2])
def test_eigenpairs_travel(shape, written, index):
    spectrum = written[0]["spectra"][index]
    pair = laplacian(shape, spectrum["kind"])
    basis = fourier_basis(pair, 20)
    np.testing.assert_allclose(spectrum["eigenvalues"], basis.eigenvalues, rtol=1e-6, atol=1e-9)
    steps = np.array(spectrum["steps"])
    phi = steps * in_page(written, spectrum["section"])
    away = np.abs(phi - basis.eigenvectors[numbers(written)])
    assert (away <= steps * 0.5001).all()
    assert (steps <= np.abs(basis.eigenvectors).max(axis=0) / 100).all()
    shape_hat = np.array(spectrum["shape"]).T
    x = spectrum["centre"] + phi @ shape_hat  # all terms: off by a small part of an edge
    truth = spectrum["centre"] + basis.eigenvectors[numbers(written)] @ shape_hat
    assert np.sqrt(((x - truth) ** 2).sum(axis=1).mean()) < 0.05 * written[0]["edge"]
    centred = shape.vertices - pair.mean(shape.vertices)
    decay = np.sqrt((basis.error_decay(centred) ** 2).sum(axis=1))
    np.testing.assert_allclose(spectrum["decay"], decay, rtol=1e-6, atol=1e-9)


def test_heat_of_the_page_is_that_of_the_library(shape, written):
    header, _ = written
    spectrum = header["spectra"][0]
    order = numbers(written)
    (index,) = [i for i, f in enumerate(header["functions"]) if f["name"] == "temperature"]
    f = shape.vertices[:, 0] ** 2
    levels = in_page(written, "functions")[:, index]
    entry = header["functions"][index]
    assert np.abs(entry["low"] + entry["step"] * levels - f[order]).max() <= entry["step"] * 0.5001
    pair = laplacian(shape)
    basis = fourier_basis(pair, 20)
    outside = spectrum["functions"][index]["outside"]
    assert outside == pytest.approx(pair.norm(f - basis.truncate(f, 20)), rel=1e-6)
    for t in (0.02, 0.1):
        truth = heat(pair, f, t, "spectral", basis=basis, tolerance=1.0)
        factors = np.exp(-t * np.array(spectrum["eigenvalues"]))
        weights = factors * spectrum["functions"][index]["coefficients"]
        phi = np.array(spectrum["steps"]) * in_page(written, spectrum["section"])
        bound = np.abs(weights) @ spectrum["steps"] / 2  # of the rounding of the modes
        assert np.abs(phi @ weights - truth[order]).max() <= bound * 1.001


def test_the_map_travels(shape, written):
    header, sections = written
    plane = header["plane"]
    assert plane["bijective"]
    faces = faces_from(sections["faces"])
    cut = faces.copy().ravel()
    cut[np.cumsum(sections["seam corners"])] = np.cumsum(sections["seam vertices"])
    copies = np.cumsum(sections["seam copies"])
    original = np.concatenate([np.arange(shape.n_vertices), copies])
    np.testing.assert_array_equal(original[cut], faces.ravel())
    uv = plane["step"] * values_from(sections["plane"], cut.reshape(-1, 3))
    a, b, c = uv[cut.reshape(-1, 3)].transpose(1, 0, 2)
    u, v = b - a, c - a
    areas = (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2
    assert areas.sum() == pytest.approx(np.pi, rel=0.02)  # all turn left, but for rounding
    assert (areas < 0).mean() < 0.02


def test_noise_and_its_end(shape, written):
    header, sections = written
    comparison = header["comparison"]
    for name in ("noisy", "denoised"):
        away = comparison["step"] * sections[name]
        distance = np.sqrt((away**2).sum(axis=1).mean())
        assert distance == pytest.approx(comparison["errors"][name], rel=0.02)
    assert comparison["errors"]["noisy"] == pytest.approx(comparison["sigma"], rel=0.1)
    noisy = shape.vertices.copy()
    noisy[numbers(written)] += comparison["step"] * sections["noisy"]
    found = denoise(shape.with_vertices(noisy)).sigma
    assert comparison["found"] != comparison["sigma"]
    assert comparison["found"] == pytest.approx(found, rel=0.02)


@pytest.mark.parametrize(
    ("mesh", "said"),
    [
        (moebius(16), "one side only"),
        (icosphere(1), None),
        (grid(5, 5), None),
        (icosphere(1).with_vertices(icosphere(1).vertices * 1e-9), None),
        (icosphere(1).with_vertices(icosphere(1).vertices * 1e9), None),
        (Mesh([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]]), None),
    ],
    ids=["one-sided", "sphere", "planar", "tiny", "huge", "triangle"],
)
def test_any_sound_mesh(mesh, said, tmp_path):
    done = page(mesh, tmp_path / "p.html", modes=5, noise=0)
    header, _ = read_page((tmp_path / "p.html").read_text("utf-8"))
    assert len(header["spectra"][0]["eigenvalues"]) == min(5, mesh.n_vertices)
    if said:
        assert said in header["plane"]["reason"]
        assert any(said in note for note in done.notes)
    else:
        assert header["plane"]["bijective"]


def test_planar_meshes_have_no_noise(tmp_path):
    done = page(Mesh([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]]), tmp_path / "p.html", plane=False)
    assert len(done.notes) == 2


@pytest.mark.parametrize(
    ("options", "error"),
    [
        ({"modes": 0}, MeshError),
        ({"modes": 2000}, MeshError),
        ({"laplacians": ()}, BeltramiError),
        ({"laplacians": ("cotan",)}, UnknownNameError),
        ({"noise": np.nan}, BeltramiError),
        ({"noise": -1}, BeltramiError),
        ({"noise": 1e12, "plane": False}, BeltramiError),
        ({"f": np.full(42, 1e20)}, BeltramiError),
        ({"f": np.linspace(0, 1e-40, 42)}, BeltramiError),
        ({"up": "w"}, UnknownNameError),
        ({"f": np.zeros(3)}, DimensionError),
        ({"f": np.zeros((42, 2))}, DimensionError),
        ({"f": {"bad": np.full(42, np.inf)}}, NonFiniteError),
    ],
)
def test_options_that_do_not_fit(options, error, tmp_path):
    with pytest.raises(error):
        page(icosphere(1), tmp_path / "p.html", **options)
    assert not list(tmp_path.iterdir())


def test_meshes_that_do_not_fit(tmp_path):
    for name in ("p.png", "p"):
        with pytest.raises(UnknownNameError):
            page(icosphere(1), tmp_path / name)
    with pytest.raises(UnreferencedVertexError):
        page(Mesh([[0, 0], [1, 0], [0, 1], [3, 3]], [[0, 1, 2]]), tmp_path / "p.html")
    with pytest.raises(DimensionError, match="Choose three"):
        page(Mesh(np.eye(4), [[0, 1, 2], [0, 2, 3]]), tmp_path / "p.html")
    with pytest.raises(DimensionError):
        page(icosphere(1).topology, tmp_path / "p.html")


@pytest.mark.parametrize("scale", [1e-20, 1e100])
def test_units_that_a_graphics_card_cannot_take(scale, tmp_path):
    mesh = icosphere(1)
    with pytest.raises(BeltramiError, match="another unit"):
        page(mesh.with_vertices(mesh.vertices * scale), tmp_path / "p.html", noise=0)


def test_parts_that_are_too_far_from_each_other(tmp_path):
    mesh, n = icosphere(1), icosphere(1).n_vertices
    x = np.concatenate([mesh.vertices, mesh.vertices + 1e9])
    far = Mesh(x, np.concatenate([mesh.faces, mesh.faces + n]))
    with pytest.raises(BeltramiError, match="positions of a page"):
        page(far, tmp_path / "p.html", noise=0, plane=False)


def test_the_same_mesh_gives_the_same_bytes(tmp_path):
    for name in ("a.html", "b.html"):
        page(icosphere(1), tmp_path / name, title="t", modes=8)
    assert (tmp_path / "a.html").read_bytes() == (tmp_path / "b.html").read_bytes()


@pytest.mark.heavy
def test_35_thousand_vertices_take_three_megabytes(tmp_path):
    """With all there may be: three Laplacians, two maps, and a picture that cannot be packed."""
    picture = np.random.default_rng(0).uniform(size=(1500, 1500, 3))
    mesh = parameterize(blob(35_000), "tutte").textured
    done = page(mesh, tmp_path / "p.html", modes=64, texture=picture)
    assert done.size <= 3_000_000
