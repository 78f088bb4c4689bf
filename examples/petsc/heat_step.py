"""One implicit step of heat, (B + t L) u = B f, by PETSc, each process with its own rows.

    mpiexec -n 2 python3 heat_step.py FOLDER TIME

reads ``FOLDER/rows-<rank>.npz``, which ``bt.partition_rows`` and ``RowBlock.save`` have written
with a function ``f``, and writes ``FOLDER/result-<rank>.npy``. It needs petsc4py and numpy, not
beltrami: PETSc may live in another Python, or on another machine.
"""

import sys

import numpy as np
import petsc4py

petsc4py.init(sys.argv[:1])
from petsc4py import PETSc  # noqa: E402 - after its initialisation

INDEX = PETSc.IntType


def matrix(rows, name):
    """Return a parallel matrix of which this process has given its rows."""
    owned, n = len(rows["owned"]), int(rows["n"])
    columns = rows["columns"][rows[f"{name}_indices"]]  # from local to global numbers
    made = PETSc.Mat().createAIJ(
        ((owned, n), (owned, n)),
        csr=(rows[f"{name}_indptr"].astype(INDEX), columns.astype(INDEX), rows[f"{name}_data"]),
        comm=PETSc.COMM_WORLD,
    )
    made.assemble()
    return made


def main(folder, time):
    """Solve, and write the values that this process owns."""
    rank = PETSc.COMM_WORLD.rank
    rows = np.load(f"{folder}/rows-{rank}.npz", allow_pickle=False)
    L, B = matrix(rows, "stiffness"), matrix(rows, "mass")
    if L.getOwnershipRange()[0] != rows["start"]:
        raise RuntimeError("the files are of another number of processes")
    f = L.createVecRight()
    f.setArray(rows["f_heat"])
    load, u = L.createVecLeft(), L.createVecRight()
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
    np.save(f"{folder}/result-{rank}.npy", u.getArray())


if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]))
