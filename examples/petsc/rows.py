"""Parallel matrices of PETSc from the files of ``bt.write_rows``: each process reads its own.

It needs petsc4py and numpy, not beltrami: PETSc may live in another Python, or on other machines.
"""

import numpy as np
from petsc4py import PETSc


def read_rows(folder):
    """Return the arrays of the rows that this process owns."""
    with np.load(f"{folder}/rows-{PETSc.COMM_WORLD.rank}.npz", allow_pickle=False) as file:
        return dict(file)


def matrix(rows, name):
    """Return the stiffness or the mass, of which every process gives its rows."""
    owned, n = len(rows["owned"]), int(rows["n"])
    columns = rows["columns"][rows[f"{name}_indices"]]  # from local to global numbers
    index = PETSc.IntType
    made = PETSc.Mat().createAIJ(
        ((owned, n), (owned, n)),
        csr=(rows[f"{name}_indptr"].astype(index), columns.astype(index), rows[f"{name}_data"]),
        comm=PETSc.COMM_WORLD,
    )
    made.assemble()
    if made.getOwnershipRange()[0] != rows["start"]:
        raise RuntimeError("the files are of another number of processes")
    return made
