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


def petsc():
    """Return the command and the environment in which petsc4py is found; None without it."""
    python, mpi = "/usr/bin/python3", shutil.which("mpiexec.openmpi") or shutil.which("mpiexec")
    places = ["", *sorted(glob.glob("/usr/lib/petscdir/*/*-real"))]
    if mpi is None or not os.path.exists(python):
        return None
    clean = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    for place in places:
        environment = clean | ({"PETSC_DIR": place} if place else {})
        code = "import petsc4py; petsc4py.init([]); from petsc4py import PETSc"
        done = subprocess.run(
            [python, "-c", code], env=environment, capture_output=True, check=False
        )
        if done.returncode == 0:
            return mpi, python, environment
    return None


@pytest.mark.heavy
@pytest.mark.parametrize("mass", ["voronoi", "consistent"])
def test_petsc_on_two_ranks_makes_the_same_step_of_heat(tmp_path, mass):
    found = petsc()
    if found is None:
        pytest.skip("needs mpiexec and petsc4py: apt-get install python3-petsc4py openmpi-bin")
    mpi, python, environment = found
    flags = ["--allow-run-as-root", "--oversubscribe"] if "openmpi" in mpi else []
    script = os.path.join(os.path.dirname(__file__), "../../examples/petsc/heat_step.py")
    mesh = bt.shapes.blob(3_000)
    pair, time = bt.laplacian(mesh, mass=mass), 0.01
    f = np.random.default_rng(5).normal(size=pair.n)
    blocks = bt.partition_rows(pair, 2)
    bt.write_rows(tmp_path, blocks, {"heat": f})
    subprocess.run(
        [mpi, *flags, "-n", "2", python, script, str(tmp_path), str(time)],
        env=environment,
        check=True,
        timeout=300,
    )
    results = [np.load(tmp_path / f"result-{rank}.npy") for rank in range(2)]
    assert [len(part) for part in results] == [len(block.owned) for block in blocks]
    u = bt.gather_rows(blocks, results)
    expected = bt.heat(pair, f, time, steps=1)
    assert np.abs(u - expected).max() < 1e-8 * np.abs(expected).max()
