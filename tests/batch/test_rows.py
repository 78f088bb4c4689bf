"""Row blocks in files; and PETSc, in its own Python, that solves with them."""

import glob
import os
import shutil
import subprocess

import numpy as np
import pytest

import beltrami as bt
from beltrami.errors import DimensionError
from beltrami.io.npz import read_arrays


def test_a_file_has_everything(tmp_path):
    pair = bt.laplacian(bt.shapes.icosphere(1))
    f = np.arange(float(pair.n))
    blocks = bt.partition_rows(pair, 3)
    paths = bt.write_rows(tmp_path, blocks, {"heat": f, "two": np.stack([f, -f], axis=1)})
    assert [path.name for path in paths] == ["rows-0.npz", "rows-1.npz", "rows-2.npz"]
    block, read = blocks[1], read_arrays(paths[1], "rows of a Laplacian", 1)
    assert np.array_equal(read["columns"], block.columns)
    assert np.array_equal(read["f_heat"], f[block.owned])
    assert read["f_two"].shape == (len(block.owned), 2)
    assert np.array_equal(read["stiffness_data"], block.stiffness.data)
    assert (int(read["start"]), int(read["n"])) == (block.start, pair.n)
    with np.load(paths[1], allow_pickle=False) as plain:
        assert np.array_equal(plain["owned"], block.owned)


def test_functions_are_checked(tmp_path):
    blocks = bt.partition_rows(bt.laplacian(bt.shapes.icosphere(0)), 2)
    with pytest.raises(DimensionError):
        bt.write_rows(tmp_path, blocks, {"heat": [1.0]})
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(FileNotFoundError):
        bt.write_rows(tmp_path / "missing", blocks)


def parallel_python(package):
    """Return the command and the environment in which a package of PETSc is found, or None."""
    python, mpi = "/usr/bin/python3", shutil.which("mpiexec.openmpi") or shutil.which("mpiexec")
    if mpi is None or not os.path.exists(python):
        return None
    environment = {name: v for name, v in os.environ.items() if not name.startswith("PYTHON")}
    for place in sorted(glob.glob("/usr/lib/petscdir/*/*-real")):  # of Debian
        environment["PETSC_DIR"] = place
    paths = sorted(glob.glob("/usr/lib/slepcdir/*/*-real/lib/python3/dist-packages"))
    environment["PYTHONPATH"] = os.pathsep.join(paths)
    done = subprocess.run(
        [python, "-c", f"import {package}; {package}.init([])"],
        env=environment,
        capture_output=True,
        check=False,
    )
    flags = ["--allow-run-as-root", "--oversubscribe"] if "openmpi" in mpi else []
    return ([mpi, *flags, "-n", "2", python], environment) if done.returncode == 0 else None


def run_on_two_ranks(package, script, *arguments):
    """Run an example on two ranks, or skip the test."""
    found = parallel_python(package)
    if found is None:
        pytest.skip(
            f"needs mpiexec and /usr/bin/python3 with {package} (Debian: python3-{package})"
        )
    command, environment = found
    place = os.path.join(os.path.dirname(__file__), "..", "..", "examples", "petsc", script)
    words = [*command, place, *map(str, arguments)]
    done = subprocess.run(
        words, env=environment, check=False, timeout=300, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.heavy
@pytest.mark.parametrize("mass", ["voronoi", "consistent"])
def test_petsc_on_two_ranks_makes_the_same_step_of_heat(tmp_path, mass):
    pair, time = bt.laplacian(bt.shapes.blob(3_000), mass=mass), 0.01
    f = np.random.default_rng(5).normal(size=pair.n)
    blocks = bt.partition_rows(pair, 2)
    bt.write_rows(tmp_path, blocks, {"f": f})
    run_on_two_ranks("petsc4py", "heat_step.py", tmp_path, time)
    results = [np.load(tmp_path / f"result-{rank}.npy") for rank in range(2)]
    assert [len(part) for part in results] == [len(block.owned) for block in blocks]
    u = bt.gather_rows(blocks, results)
    expected = bt.heat(pair, f, time, steps=1)
    assert np.abs(u - expected).max() < 1e-8 * np.abs(expected).max()


@pytest.mark.heavy
def test_slepc_on_two_ranks_finds_the_same_spectrum(tmp_path):
    pair = bt.laplacian(bt.shapes.blob(3_000))
    blocks = bt.partition_rows(pair, 2)
    bt.write_rows(tmp_path, blocks)
    run_on_two_ranks("slepc4py", "spectrum.py", tmp_path, 8)
    values = np.load(tmp_path / "eigenvalues.npy")
    vectors = bt.gather_rows(blocks, [np.load(tmp_path / f"result-{r}.npy") for r in range(2)])
    expected = bt.fourier_basis(pair, 8).eigenvalues
    assert np.abs(values - expected).max() < 1e-8 * expected[-1]
    residual = pair.stiffness @ vectors - (pair.mass @ vectors) * values
    assert np.abs(residual).max() < 1e-6 * np.abs(pair.mass @ vectors).max() * values[-1]
