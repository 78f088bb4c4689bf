"""Files of row blocks, for solvers that live in another Python or on other machines."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import as_function
from beltrami._kinds import checked
from beltrami.io.npz import write_arrays
from beltrami.operators.partition import RowBlock

ROWS: Final = "rows of a Laplacian"  # the kind, in the header of the files
VERSION: Final = 1


@checked
def write_rows(
    folder: str | os.PathLike[str],
    blocks: Sequence[RowBlock],
    functions: Mapping[str, ArrayLike] | None = None,
) -> list[Path]:
    """Write a file for each block, ``rows-0.npz`` and so on, that ``numpy.load`` reads anywhere.

    Parameters
    ----------
    folder
        It must be there.
    blocks
        As ``partition_rows`` returns them.
    functions
        By name, functions on all n vertices; each file gets the values of its rows.

    Returns
    -------
    The files, in the order of the blocks.

    Raises
    ------
    OSError
        If the folder is not there or cannot be written.
    DimensionError, NonFiniteError
        If a function has not n values, or some that are not finite.

    Notes
    -----
    The members: ``start``, ``n``, ``owned``, ``ghosts``, ``ghost_vertices``, ``columns``;
    ``stiffness_indptr``, ``stiffness_indices`` (local columns), ``stiffness_data`` and the same
    of ``mass``; ``f_<name>`` for each function. ``examples/petsc`` solves with them.
    """
    given = {
        name: as_function(f, blocks[0].n, name) for name, f in (functions or {}).items() if blocks
    }
    paths = [Path(folder, f"rows-{rank}.npz") for rank in range(len(blocks))]
    for path, block in zip(paths, blocks, strict=True):
        arrays = {
            "start": np.array(block.start),
            "n": np.array(block.n),
            "owned": block.owned,
            "ghosts": block.ghosts,
            "ghost_vertices": block.ghost_vertices,
            "columns": block.columns,
        }
        for name, matrix in (("stiffness", block.stiffness), ("mass", block.mass)):
            for part in ("indptr", "indices", "data"):
                arrays[f"{name}_{part}"] = getattr(matrix, part)
        for name, values in given.items():
            arrays[f"f_{name}"] = values[block.owned]
        write_arrays(path, ROWS, VERSION, arrays)
    return paths
