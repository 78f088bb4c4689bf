"""The rows: one claim per file. A new row is a file here and its name in ``ROWS``."""

from __future__ import annotations

from benchmarks.claims import Row
from benchmarks.rows.adjacency import ADJACENCY
from benchmarks.rows.assembly import ASSEMBLY
from benchmarks.rows.convolving import CONVOLUTIONS
from benchmarks.rows.eigenpairs import EIGENPAIRS
from benchmarks.rows.factorizing import FACTORIZATIONS, SOLVES
from benchmarks.rows.filtering import FILTERING
from benchmarks.rows.geodesics import GEODESICS, GEODESICS_PREPARED
from benchmarks.rows.intrinsic import INTRINSIC
from benchmarks.rows.iterating import CONJUGATE_GRADIENTS
from benchmarks.rows.mapping import HARMONIC
from benchmarks.rows.reading import READ_OBJ, READ_OFF, READ_PLY
from benchmarks.rows.smoothing import SMOOTHING
from benchmarks.rows.starting import FIRST_CALL, IMPORT

ROWS: tuple[Row, ...] = (
    ASSEMBLY,
    INTRINSIC,
    GEODESICS,
    GEODESICS_PREPARED,
    SMOOTHING,
    FILTERING,
    ADJACENCY,
    *FACTORIZATIONS,
    *SOLVES,
    *EIGENPAIRS,
    CONJUGATE_GRADIENTS,
    HARMONIC,
    READ_OBJ,
    READ_OFF,
    READ_PLY,
    *CONVOLUTIONS,
    IMPORT,
    FIRST_CALL,
)
