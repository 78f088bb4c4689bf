import numpy as np
import pytest
from PIL import Image

from beltrami.io.registry import read_mesh, write_mesh
from beltrami.mesh.shapes import grid
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.load_basis import load_basis


@pytest.mark.parametrize(
    ("words", "options", "pair"),
    [
        ((), {"k": 100}, {}),
        (("-k", 7, "--near", 6, "--tolerance", 1e-8), {"k": 7, "near": 6, "tol": 1e-8}, {}),
        (("-k", 5, "--weights", "combinatorial"), {"k": 5}, {"weights": "combinatorial"}),
        (("-k", 5, "--mass", "consistent"), {"k": 5}, {"mass": "consistent"}),
    ],
)
def test_the_basis_is_that_of_the_function(beltrami, sphere, tmp_path, words, options, pair):
    done = beltrami("spectrum", sphere, "-o", tmp_path / "b.npz", *words)
    assert done.exit_code == 0, done.stderr
    made = laplacian(read_mesh(sphere), **pair)
    expected = fourier_basis(made, **options)
    found = load_basis(tmp_path / "b.npz", made)
    np.testing.assert_array_equal(found.eigenvectors, expected.eigenvectors)
    assert f"{expected.k} eigenpairs from" in done.stdout


def test_the_boundary_is_held(beltrami, tmp_path):
    mesh = grid(12, 12)
    write_mesh(tmp_path / "g.ply", mesh)
    words = ("-k", 3, "--hold-boundary", "--certify", "--png", tmp_path / "modes.png", "--up", "z")
    done = beltrami("spectrum", tmp_path / "g.ply", "-o", tmp_path / "b.npz", *words)
    assert done.exit_code == 0, done.stderr
    found = load_basis(tmp_path / "b.npz")
    assert found.eigenvalues[0] == pytest.approx(2 * np.pi**2, rel=0.03)
    assert not found.eigenvectors[mesh.topology.on_boundary].any()
    assert "none is missing nearer than" in done.stdout
    with Image.open(tmp_path / "modes.png") as picture:
        assert picture.size[0] >= 3 * 320


@pytest.mark.parametrize(
    ("words", "code", "text"),
    [
        (("-o", "b.npy"), 1, "format for a basis"),
        (("-o", "b.npz", "-k", 0), 2, "-k"),
        (("-o", "b.npz", "-k", 999), 1, "k must be from 1 to 162"),
        (("-o", "b.npz", "--png", "b.tiff"), 1, "suffix of a picture"),
        (("-o", "b.npz", "--tolerance", -1), 1, "tol must be"),
    ],
)
def test_options_that_do_not_fit(beltrami, sphere, tmp_path, monkeypatch, words, code, text):
    monkeypatch.chdir(tmp_path)
    done = beltrami("spectrum", sphere, *words)
    assert done.exit_code == code
    assert text in done.stderr
    assert not (tmp_path / "b.npz").exists()
