"""Packed tables of the mesh laws that the compiled loops read: their columns and rows by name."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


class PackedMeshes(NamedTuple):
    """Tables of all meshes of a drivetrain; packed by ``dynamics.mesh.tables.pack_meshes``."""

    values: Array
    """(n_meshes, N_VALUES) plain numbers."""
    counts: Integers
    """(n_meshes, N_COUNTS) sizes and first rows in the tables below."""
    cells: Array
    """(n_cells, 8) cubic coefficients of stiffness and gap over the fraction of a path cell."""
    shifts: Array
    """Slice shifts of all meshes [m]."""
    deviations: Array
    """(n_cells, 4) cubic coefficients of the deviation of single teeth."""
    scales: Array
    """Stiffness scales of single teeth [-]."""
    phase_starts: Integers
    """(n_phase_cells + 1,) first contact of every phase cell, front and back of each mesh."""
    phase_least: Array
    """Lower bound of the gap of every contact within its phase cell, in increasing order."""
    phase_data: Array
    """Flat, cell after cell: N_PHASE rows over the contacts of the cell."""
    offsets: Array
    """(n_meshes,) imposed approach [m]."""


# columns of PackedMeshes.values
R1, R2, PITCH, PHASE, BACK_PHASE, BACKLASH, START, PER_STEP = 0, 1, 2, 3, 4, 5, 6, 7
DAMP_TIME, FRICTION, ROLL_1, ROLL_2, PER_REVERSAL, LEAST_GAP, DERIVATIVE, FLOOR = 8, 9, 10, 11, 12, 13, 14, 15
PER_PITCH, MU_1, MU_2, PHASE_STEP, PER_PHASE_STEP, DEPTH, PER_DEPTH, CLOSING = 16, 17, 18, 19, 20, 21, 22, 23
BODY, JAMMED = 24, 25
N_VALUES = 26
# columns of PackedMeshes.counts
N_SLICES, N_CELLS, CELLS_AT, SHIFTS_AT, INDIVIDUAL, TEETH_1, TEETH_2, OFFSET_2 = 0, 1, 2, 3, 4, 5, 6, 7
ROWS_1, DEVIATION_1_AT, ROWS_2, DEVIATION_2_AT = 8, 9, 10, 11
SCALES_1, SCALES_1_AT, SCALES_2, SCALES_2_AT, MOST = 12, 13, 14, 15, 16
N_PHASES, FRONT_AT, BACK_AT, BACK_DEVIATION_1_AT, BACK_DEVIATION_2_AT = 17, 18, 19, 20, 21
N_COUNTS = 22
# rows of a table of contacts: cubics of stiffness and gap over the place in the cell, path position at its start
ROW_K, ROW_E, ROW_S = 0, 4, 8
N_PHASE = 9
VECTOR = 8
"""Contacts in one turn of a compiled loop (two vector registers). More than one are filled up to whole turns with some
of no stiffness."""
POSITIVE = (
    1 << 40
) - 1  # masks a first index, so that the compiler knows that it and sums with it are positive
