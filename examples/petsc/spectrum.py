"""The first eigenpairs, L x = λ B x, by SLEPc and a factor of MUMPS, each process with its rows.

    mpiexec -n 2 python3 spectrum.py FOLDER K

reads ``FOLDER/rows-<rank>.npz``, which ``bt.write_rows`` has written, and writes the eigenvectors
as ``FOLDER/result-<rank>.npy`` (owned rows, K columns) and ``FOLDER/eigenvalues.npy``.
"""

import sys

import numpy as np
import slepc4py

slepc4py.init(sys.argv[:1])
from petsc4py import PETSc  # noqa: E402 - after its initialisation
from slepc4py import SLEPc  # noqa: E402

from rows import matrix, read_rows  # noqa: E402


def main(folder, k):
    """Shift a little below zero, where the matrix is positive definite, and invert."""
    rows = read_rows(folder)
    L, B = matrix(rows, "stiffness"), matrix(rows, "mass")
    ones = B.createVecRight()
    ones.set(1.0)
    area = ones.dot(B * ones)
    solver = SLEPc.EPS().create(PETSc.COMM_WORLD)
    solver.setOperators(L, B)
    solver.setProblemType(SLEPc.EPS.ProblemType.GHEP)
    solver.setDimensions(nev=k)
    solver.setTarget(-1 / area)
    solver.setWhichEigenpairs(SLEPc.EPS.Which.TARGET_MAGNITUDE)
    solver.setTolerances(1e-10, 1000)
    transform = solver.getST()
    transform.setType("sinvert")
    transform.setShift(-1 / area)
    inner = transform.getKSP()
    inner.setType("preonly")
    inner.getPC().setType("cholesky")
    inner.getPC().setFactorSolverType("mumps")
    solver.solve()
    if solver.getConverged() < k:
        raise RuntimeError(f"SLEPc found {solver.getConverged()} of {k} eigenpairs")
    values, vectors, x = np.empty(k), np.empty((len(rows["owned"]), k)), L.createVecRight()
    for i in range(k):
        values[i] = solver.getEigenpair(i, x).real
        vectors[:, i] = x.getArray()
    np.save(f"{folder}/result-{PETSc.COMM_WORLD.rank}.npy", vectors)
    if PETSc.COMM_WORLD.rank == 0:
        np.save(f"{folder}/eigenvalues.npy", values)


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
