"""One implicit step of heat, (B + t L) u = B f, by PETSc, each process with its own rows.

    mpiexec -n 2 python3 heat_step.py FOLDER TIME

reads ``FOLDER/rows-<rank>.npz``, which ``bt.write_rows`` has written with a function "f", and
writes ``FOLDER/result-<rank>.npy``: the values that the process owns, for ``bt.gather_rows``.
"""

import sys

import numpy as np
import petsc4py

petsc4py.init(sys.argv[:1])
from petsc4py import PETSc  # noqa: E402 - after its initialisation

from rows import matrix, read_rows  # noqa: E402


def main(folder, time):
    """Solve by conjugate gradients."""
    rows = read_rows(folder)
    L, B = matrix(rows, "stiffness"), matrix(rows, "mass")
    f, load, u = L.createVecRight(), L.createVecLeft(), L.createVecRight()
    f.setArray(rows["f_f"])
    B.mult(f, load)
    B.axpy(time, L)
    solver = PETSc.KSP().create(PETSc.COMM_WORLD)
    solver.setOperators(B)
    solver.setType("cg")
    solver.getPC().setType("jacobi")
    solver.setTolerances(rtol=1e-13, max_it=10_000)
    solver.solve(load, u)
    if solver.getConvergedReason() <= 0:
        raise RuntimeError(f"PETSc did not converge: reason {solver.getConvergedReason()}")
    np.save(f"{folder}/result-{PETSc.COMM_WORLD.rank}.npy", u.getArray())


if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]))
