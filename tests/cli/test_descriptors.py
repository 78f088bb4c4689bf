import numpy as np
import pytest

from beltrami.io.registry import read_mesh
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.heat_kernel import heat_kernel_signature
from beltrami.spectrum.shape_dna import shape_dna
from beltrami.spectrum.wave_kernel import wave_kernel_signature


@pytest.mark.parametrize(
    ("kind", "words", "expected"),
    [
        ("hks", ("--count", 5), lambda b: heat_kernel_signature(b, count=5)),
        ("hks", ("--time", 0.1, "--time", 2), lambda b: heat_kernel_signature(b, [0.1, 2.0])),
        ("hks", ("--scale-invariant",), lambda b: heat_kernel_signature(b, scale_invariant=True)),
        ("wks", (), wave_kernel_signature),
        ("wks", ("--count", 7, "--scale-invariant"),
         lambda b: wave_kernel_signature(b, count=7, scale_invariant=True)),
        ("shape-dna", (), shape_dna),
        ("shape-dna", ("--normalization", "first"), lambda b: shape_dna(b, "first")),
    ],
)  # fmt: skip
def test_values_are_those_of_the_functions(beltrami, sphere, tmp_path, kind, words, expected):
    basis = fourier_basis(laplacian(read_mesh(sphere)), 20)
    for suffix in ("npy", "csv"):
        output = tmp_path / f"d.{suffix}"
        done = beltrami("descriptors", sphere, "-k", 20, "--kind", kind, "-o", output, *words)
        assert done.exit_code == 0, done.stderr
        assert "of 20 eigenpairs" in done.stdout
        found = np.load(output) if suffix == "npy" else np.loadtxt(output, delimiter=",")
        np.testing.assert_array_equal(found, np.asarray(expected(basis)))


def test_weights_and_mass(beltrami, sphere, tmp_path):
    output = tmp_path / "d.npy"
    words = ("--weights", "combinatorial", "--mass", "unit", "--normalization", "none")
    done = beltrami("descriptors", sphere, "-k", 5, "--kind", "shape-dna", "-o", output, *words)
    assert done.exit_code == 0, done.stderr
    pair = laplacian(read_mesh(sphere), "combinatorial", "unit")
    np.testing.assert_array_equal(np.load(output), shape_dna(fourier_basis(pair, 5), "none"))
    assert "(normalization none), 1 zero, of 5 eigenpairs" in done.stdout


@pytest.mark.parametrize("times", [[1.0], [0.1, 0.2, 0.5, 1.0, 2.0]])
def test_with_the_mesh(beltrami, sphere, tmp_path, times):
    words = [word for time in times for word in ("--time", time)]
    done = beltrami("descriptors", sphere, "-k", 9, *words, "-o", tmp_path / "d.ply")
    assert done.exit_code == 0, done.stderr
    values = read_mesh(tmp_path / "d.ply").vertex_data["hks"]
    basis = fourier_basis(laplacian(read_mesh(sphere)), 9)
    expected = heat_kernel_signature(basis, times).values
    np.testing.assert_array_equal(values.reshape(expected.shape), expected)


def test_what_more_eigenpairs_would_change_is_told(beltrami, sphere, tmp_path):
    done = beltrami("descriptors", sphere, "-k", 9, "--count", 6, "-o", tmp_path / "d.npy")
    basis = fourier_basis(laplacian(read_mesh(sphere)), 9)
    certain = (heat_kernel_signature(basis, count=6).truncation < 0.01).sum()
    assert 0 < certain < 6
    assert f"would change {certain} of them by less than 1%" in done.stdout


@pytest.mark.parametrize(
    ("words", "code", "text"),
    [
        (("--kind", "hsk"), 1, "Did you mean 'hks'?"),
        (("--kind", "wks", "--time", 1), 2, "--time belongs to --kind hks"),
        (("--time", 1, "--count", 3), 2, "either --time or --count"),
        (("--normalization", "area"), 2, "--normalization belongs to"),
        (("--kind", "shape-dna", "--normalization", "aera"), 1, "Did you mean 'area'?"),
        (("--kind", "shape-dna", "--count", 3), 2, "--count and --scale-invariant belong"),
        (("--kind", "shape-dna", "--scale-invariant"), 2, "--count and --scale-invariant belong"),
        (("--time", -1), 1, "times must be >= 0"),
        (("-k", 0), 2, "-k"),
        (("-k", 1), 1, "all zero"),
    ],
)
def test_options_that_do_not_fit(beltrami, sphere, tmp_path, words, code, text):
    done = beltrami("descriptors", sphere, "-o", tmp_path / "d.npy", "-k", 9, *words)
    assert done.exit_code == code
    assert text in done.stderr
    assert not (tmp_path / "d.npy").exists()


def test_outputs_that_do_not_fit(beltrami, sphere, tmp_path):
    words = ("descriptors", sphere, "--kind", "shape-dna", "-o")
    assert "no function on the mesh" in beltrami(*words, tmp_path / "d.ply").stderr
    assert beltrami(*words, tmp_path / "d.xyz").exit_code == 1


def test_a_stray_vertex_is_named(beltrami, stray, tmp_path):
    done = beltrami("descriptors", stray, "-k", 2, "-o", tmp_path / "d.npy")
    assert done.exit_code == 1
    assert "`beltrami repair --remove-" in done.stderr
