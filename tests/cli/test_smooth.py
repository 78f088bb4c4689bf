import numpy as np
import pytest

from beltrami.diffusion.smooth_mesh import smooth_mesh
from beltrami.diffusion.smoothing import smooth
from beltrami.io.registry import read_mesh
from beltrami.operators.laplacian import laplacian

CASES = {
    "default": ((), {}),
    "rounds": (("--steps", 3, "--step", 0.5), {"steps": 3, "step": 0.5}),
    "weights": (("--weights", "distance"), {"weights": "distance"}),
    "implicit": (("--method", "implicit", "--time", 0.01), {"method": "implicit", "time": 0.01}),
    "mass": (
        ("--method", "implicit", "--time", 0.01, "--mass", "consistent"),
        {"method": "implicit", "time": 0.01, "mass": "consistent"},
    ),
    "taubin": (("--method", "taubin", "--pass-band", 0.2), {"method": "taubin", "pass_band": 0.2}),
    "features": (("--features", 40), {"features": 40.0}),
    "guided": (
        ("--method", "guided_normals", "--contrast", 0.2),
        {"method": "guided_normals", "contrast": 0.2},
    ),
    "tv": (
        ("--method", "tv_normals", "--fidelity", 3),
        {"method": "tv_normals", "fidelity": 3.0},
    ),
    "volume": (("--keep", "volume"), {"keep": "volume"}),
}


@pytest.mark.parametrize(("arguments", "options"), CASES.values(), ids=CASES)
def test_it_writes_what_smooth_mesh_returns(beltrami, sphere, tmp_path, arguments, options):
    output = tmp_path / "out.ply"
    done = beltrami("smooth", sphere, "-o", output, *arguments)
    assert done.exit_code == 0, done.stderr
    expected = smooth_mesh(read_mesh(sphere), **options)
    np.testing.assert_array_equal(read_mesh(output).vertices, expected.vertices)


def test_a_function_is_smoothed_on_its_mesh(beltrami, sphere, tmp_path):
    mesh = read_mesh(sphere)
    np.save(tmp_path / "f.npy", mesh.vertices[:, 0])
    output = tmp_path / "g.npy"
    done = beltrami("smooth", sphere, "--data", tmp_path / "f.npy", "-o", output, "--steps", 2)
    assert done.exit_code == 0, done.stderr
    expected = smooth(laplacian(mesh, "combinatorial"), mesh.vertices[:, 0], 2)
    np.testing.assert_array_equal(np.load(output), expected)


@pytest.mark.parametrize(
    ("arguments", "code", "text"),
    [
        (("--time", 1), 1, "'averaging' has no time; it has steps"),
        (("--method", "implicit", "--step", 1, "--time", 1), 1, "'implicit' has no step"),
        (("--method", "taubin", "--step", 1), 1, "the longest allowed is"),
        (("--method", "averging"), 1, "Did you mean 'averaging'?"),
        (("--weights", "cotangens"), 1, "Did you mean 'cotangent'?"),
        (("--step", 9), 1, "the longest allowed is"),
        (("--steps", -1), 2, "--steps"),
        (("--data", "f.npy", "--keep", "volume"), 2, "--data takes"),
        (("--data", "f.npy", "--features", 30), 2, "--data takes"),
        (("--data", "f.npy", "--method", "implicit"), 2, "beltrami heat"),
    ],
)
def test_options_that_do_not_fit(beltrami, sphere, tmp_path, arguments, code, text):
    done = beltrami("smooth", sphere, "-o", tmp_path / "out.ply", *arguments)
    assert done.exit_code == code
    assert text in done.stderr
    assert not (tmp_path / "out.ply").exists()


def test_negative_weights_name_the_option(beltrami, tmp_path):
    path = tmp_path / "flat.off"
    path.write_text("OFF\n4 2 0\n0 0 0\n4 0 0\n2 .3 0\n2 -.3 0\n3 0 1 2\n3 1 0 3\n")
    done = beltrami("smooth", path, "-o", tmp_path / "out.off", "--weights", "cotangent")
    assert done.exit_code == 1
    assert "Use --weights combinatorial or distance" in done.stderr


def test_an_open_surface_has_no_volume_to_keep(beltrami, tmp_path):
    path = tmp_path / "flat.off"
    path.write_text("OFF\n4 2 0\n0 0 0\n4 0 0\n2 .3 0\n2 -.3 0\n3 0 1 2\n3 1 0 3\n")
    done = beltrami("smooth", path, "-o", tmp_path / "out.off", "--keep", "volume")
    assert done.exit_code == 1
    assert "Take --keep centroid, or --hold-boundary, which" in done.stderr
