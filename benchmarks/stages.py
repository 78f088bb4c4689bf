"""Where the time of the solver and of the eigenpairs goes, stage by stage.

python -m benchmarks.stages [--vertices 134000] [--modes 50]

The blob of so many vertices: the matrix B + 100 h² L is ordered, factorised and solved with; then
come the first eigenpairs. Seconds are CPU time, the best of three. Beside the numbers of the
factor stands how many operations they take a second, and how many a product of two dense matrices
takes, which no factorisation can pass.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from typing import Any

from benchmarks.threads import one_thread


def best(work: Callable[[], Any], times: int = 3) -> tuple[float, Any]:
    """Return the fewest CPU seconds, and the last result."""
    seconds = []
    for _ in range(times):
        start = time.process_time()
        result = work()
        seconds.append(time.process_time() - start)
    return min(seconds), result


def rows_of(vertices: int, modes: int) -> list[tuple[str, float, str]]:
    """Measure the stages: name, seconds, remark."""
    import numpy as np

    import beltrami as bt
    from beltrami.solvers.cholesky import factorize_cholesky
    from beltrami.solvers.many import enter_many, leave_many, lines_for
    from beltrami.solvers.ordering import order

    mesh = bt.shapes.blob(vertices)
    pair = bt.laplacian(mesh)
    step = 100 * float((mesh.edge_lengths**2).mean())
    matrix = (pair.mass + step * pair.stiffness).tocsc()
    ordering, elimination = best(lambda: order(matrix, mesh.vertices, "auto"))
    numbers, factor = best(lambda: factorize_cholesky(matrix, elimination))

    columns = np.diff(elimination.starts)
    height = columns + np.diff(elimination.row_starts)
    first = height - columns  # sum of squares of the heights of all columns of a panel
    operations = float(_squares(height).sum() - _squares(first).sum())
    a = np.random.default_rng(0).standard_normal((1000, 1000))
    dense = 2e9 / best(lambda: a @ a)[0]
    speed = f"{operations / numbers / 1e9:.0f} of {dense / 1e9:.0f} GF/s, {factor.fill / 1e6:.1f}M"
    found = [("order", ordering, ""), ("factor", numbers, f"{speed} entries")]

    b = np.random.default_rng(1).standard_normal((mesh.n_vertices, 64))
    room = lines_for(len(b), 64, b.dtype)
    enter = best(lambda: enter_many(b, 0, 64, elimination.order[:0], factor.scale, room))[0]
    inside = best(lambda: factor.substitute(room))[0]
    leave = best(lambda: leave_many(room, 64, elimination.order[:0], factor.scale, 0, room))[0]
    rate = f"{4 * 64 * factor.fill / inside / 1e9:.0f} GF/s"
    found += [
        ("64 right-hand sides: scale", enter, ""),
        ("64 right-hand sides: substitute", inside, rate),
        ("64 right-hand sides: scale back", leave, ""),
    ]
    bt.fourier_basis(bt.laplacian(bt.shapes.blob(10_000)), modes)  # loads what is compiled
    told = bt.fourier_basis(pair, modes).computation
    return found + [(f"{modes} eigenpairs: {name}", t, "wall") for name, t in told.seconds]


def _squares(height: Any) -> Any:
    """Return 1 + 4 + 9 + ... of each height."""
    h = height.astype(float)
    return h * (h + 1) * (2 * h + 1) / 6


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.stages", description=__doc__)
    parser.add_argument("--vertices", type=int, default=134_000)
    parser.add_argument("--modes", type=int, default=50)
    asked = parser.parse_args()
    print("| stage | s | |\n| --- | --- | --- |")
    for name, seconds, remark in rows_of(asked.vertices, asked.modes):
        print(f"| {name} | {seconds:.4f} | {remark} |")


if __name__ == "__main__":
    one_thread()
    main()
