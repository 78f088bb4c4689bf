"""The same bytes decode to the same bits: for ever, on every processor, in every process."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import beltrami as bt
from beltrami.compression.container import VERSION
from golden_files import FOLDER, digest, examples

DIGESTS = json.loads((FOLDER / "digests.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", sorted(DIGESTS))
def test_golden_files_decode_to_the_same_bits(name):
    assert digest(bt.decompress(FOLDER / f"{name}.btm")) == DIGESTS[name]


def test_the_encoder_has_not_changed():
    """Where it may write other bytes for the same decoder, make this follow; else the version."""
    mesh, options = examples()["cube"]  # its positions are made without sines
    assert bt.compress(mesh, **options) == (FOLDER / "cube.btm").read_bytes()
    assert VERSION == 1


PROGRAM = """
import sys
from golden_files import FOLDER, digest
import beltrami as bt
for name in sys.argv[1:]:
    print(name, digest(bt.decompress(FOLDER / f"{name}.btm")))
"""

ASSEMBLY = """
from beltrami.compression import block_basis, coefficients, conquest, positions
from beltrami.compression import smoothing, transform
from golden_files import FOLDER
import beltrami as bt
bt.decompress(FOLDER / "smooth.btm")
bt.decompress(FOLDER / "spectral_torus.btm")
for kernel in (
    positions.code_positions,
    conquest.conquer,
    coefficients.code_coefficients,
    transform.add_up,
    block_basis.tridiagonalise,
    block_basis.lowest_eigenvalues,
    block_basis.tridiagonal_vectors,
    block_basis.turn_back,
    smoothing._solve,
):
    print("".join(kernel.inspect_asm().values()))
"""


def run(program, arguments, **environment):
    done = subprocess.run(
        [sys.executable, "-c", program, *arguments],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "PYTHONPATH": python_path(), **environment},
    )
    return done.stdout


def python_path():
    source = Path(bt.__file__).parents[1]
    return os.pathsep.join([str(source), str(Path(__file__).parents[1])])


def test_another_process_with_other_threads():
    names = ["blob", "spectral_blob"]
    out = run(PROGRAM, names, OMP_NUM_THREADS="3", NUMBA_NUM_THREADS="1", PYTHONHASHSEED="7")
    assert dict(line.split() for line in out.splitlines()) == {n: DIGESTS[n] for n in names}


@pytest.mark.heavy
def test_a_plain_processor_decodes_the_same(tmp_path):
    """Compiled anew for a processor without AVX, and without fused multiply-add."""
    plain = {
        "NUMBA_CPU_NAME": "generic",
        "NUMBA_CPU_FEATURES": "",
        "NUMBA_CACHE_DIR": str(tmp_path),
    }
    lines = run(PROGRAM, sorted(DIGESTS), **plain).splitlines()
    assert dict(line.split() for line in lines) == DIGESTS


@pytest.mark.heavy
def test_no_product_is_fused_with_a_sum(tmp_path):
    """For this processor, whatever it could: vfmadd (x86), fmadd and fmla (ARM)."""
    assembly = run(ASSEMBLY, [], NUMBA_CACHE_DIR=str(tmp_path))
    assert re.search(r"\b(v?addsd|fadd)\b", assembly)  # arithmetic is to be seen
    assert not re.search(r"\bv?fn?m(add|sub|la|ls)\w*", assembly)
