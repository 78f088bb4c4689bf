"""How long a user waits: for the import, and for the first call that is compiled."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from tempfile import mkdtemp

from benchmarks.cases import Case
from benchmarks.claims import Contender, Goal, Row

BARE = "bare Python"
LIBRARIES = {
    "numpy": "numpy",
    "LaPy": "lapy",
    "libigl": "igl",
    "PyVista": "pyvista",
    "trimesh": "trimesh",
}
IMPORTS = "import numba, scipy.sparse"
FIRST = """
import time, beltrami
{before}
start = time.perf_counter()
mesh = beltrami.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
                     [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
laplacian = beltrami.laplacian(mesh)
laplacian.stiffness, laplacian.mass
print(time.perf_counter() - start)
"""


def python(code: str, numba_cache: Path | None = None) -> str:
    """Run code in a fresh process, and return what it prints."""
    environment = dict(os.environ)
    environment.pop("PYTHONDONTWRITEBYTECODE", None)  # an installed package has its bytecode
    if numba_cache is not None:
        environment["NUMBA_CACHE_DIR"] = str(numba_cache)
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise RuntimeError((done.stderr.strip().splitlines() or ["no message"])[-1])
    return done.stdout


def import_of(module: str) -> Callable[[None], str]:
    """Bind the name of a module to a fresh process that imports it."""
    return lambda _: python(f"import {module}")


def importing(case: Case) -> Sequence[Contender]:
    del case
    return [
        Contender("beltrami", import_of("beltrami"), ours=True),
        Contender(BARE, lambda _: python("pass"), counts=False),
        *(Contender(name, import_of(module)) for name, module in LIBRARIES.items()),
    ]


def first_call(case: Case) -> Sequence[Contender]:
    warm = case.folder / "warm_numba_cache"
    warm.mkdir(exist_ok=True)

    def empty() -> Path:
        return Path(mkdtemp(prefix="cold_", dir=case.folder))

    def contender(name: str, before: str, cache: Callable[[], Path]) -> Contender:
        code = FIRST.format(before=before)
        return Contender(
            name, lambda given: float(python(code, given)), cache, ours=True, times_itself=True
        )

    imports = f"start = time.perf_counter()\n{IMPORTS}\nprint(time.perf_counter() - start)"
    return [
        contender("beltrami, cold", "", empty),
        contender("beltrami, warm", "", lambda: warm),
        contender("beltrami, cold, numba imported before", IMPORTS, empty),
        contender("beltrami, warm, numba imported before", IMPORTS, lambda: warm),
        Contender(
            IMPORTS,
            lambda _: float(python(f"import time\n{imports}")),
            counts=False,
            times_itself=True,
        ),
    ]


IMPORT = Row(
    name="import",
    work="`import` in a fresh process, wall time",
    contenders=importing,
    goals=(Goal(0.3, against=BARE, less=True),),
    size=0,
    runs=10,
    clock=time.perf_counter,
    memory=False,
)
FIRST_CALL = Row(
    name="first-call",
    work="first Mesh and Laplacian after `import beltrami`, wall time",
    contenders=first_call,
    goals=(
        Goal(3.0, of="beltrami, cold", against=None),
        Goal(0.5, of="beltrami, warm", against=None),
        Goal(0.5, of="beltrami, warm, numba imported before", against=None),
    ),
    size=0,
    runs=5,
    clock=time.perf_counter,
    memory=False,
)
