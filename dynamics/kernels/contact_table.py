"""Contact tables: sums over the slices of tooth pairs at their nodes, and how they are laid out."""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]


SUMS = 9
"""Sums at a node before those of friction."""
FRICTION = 4
"""Sums of friction for each sharpness of its reversal."""
MOST_SETS = 64
"""Sets of closed contacts that are tried behind a shared body; four are many."""


class SliceSprings(NamedTuple):
    """All slices that can touch at each place on the path, every array (n_places, n_slices)."""

    stiffness: Array
    """0 where a slice is off the path [N/m]."""
    gap: Array
    """[m]"""
    slope: Array
    """Of the gap over the path [-]."""
    path: Array
    """Path position of the slice [m]."""
    face: Array
    """(n_slices,) face position [m]."""


class NodeLaw(NamedTuple):
    """What else the sums need of a mesh law."""

    damping_depth: float
    """[m]"""
    body: float
    """Compliance that all slices share [m/N]."""
    rolling_radii: tuple[float, float]
    """T1C and T2C [m]."""
    reversal: float
    """Path position where sliding reverses [m]."""
    damp_time: float
    """Damping of a contact over its stiffness [s]."""
    path_speed: float
    """Speed of the flank along its path at which its dampers act on the closing rate [m/s]; 0: on the rotation."""
    sharpness: Array
    """(n_sharpness,) of the reversals to sum for [1/m]."""


@njit(cache=True)
def _behind_body(
    stiffness: Array, gap: Array, body: float, approach: float, start: float
) -> tuple[float, float]:
    """Return the approach behind the body, and the share of a change that the teeth take; see ``reactions``."""
    y, before = start, -1.0
    share = 1.0
    for _ in range(MOST_SETS):
        total, force = 0.0, 0.0
        for i in range(stiffness.shape[0]):
            if y > gap[i]:
                total += stiffness[i]
                force += stiffness[i] * (y - gap[i])
        share = 1.0 / (1.0 + body * total)
        if total == before:
            break
        before = total
        y -= (y + body * force - approach) * share
    return y, share


@njit(cache=True)
def slice_sums(springs: SliceSprings, law: NodeLaw, approach: Array, sums: Array) -> None:
    """Fill ``sums`` (n_places, n_depths, SUMS + FRICTION n_sharpness) at ``approach`` (n_places, n_depths), rising [m].

    Elastic energy, force, damper weight; tilting moment and its derivative over the approach. Of dampers on the closing
    rate, at no rate of the approach: force and its derivative over that rate, torque on the slope of the gap and its
    derivative; contacts do not pull. Then for each sharpness the force times direction of sliding, that times path
    position, and what both lose per advance of the reversal.
    """
    stiffness, gap, slope, path = springs.stiffness, springs.gap, springs.slope, springs.path
    face, sharpness = springs.face, law.sharpness
    n_slices, n_depths = stiffness.shape[1], approach.shape[1]
    direction, turning = np.empty((n_slices, sharpness.shape[0])), np.empty((n_slices, sharpness.shape[0]))
    sums[:] = 0.0
    for a in range(stiffness.shape[0]):
        for i in range(n_slices):
            for q in range(sharpness.shape[0]):
                ratio = min(1.0, max(-1.0, sharpness[q] * (path[a, i] - law.reversal)))
                direction[i, q] = ratio * (1.5 - 0.5 * ratio * ratio)
                turning[i, q] = 1.5 * sharpness[q] * (1.0 - ratio * ratio)
        y = approach[a, 0]
        for j in range(n_depths):
            share = 1.0
            if law.body > 0.0:
                y, share = _behind_body(stiffness[a], gap[a], law.body, approach[a, j], y)
            else:
                y = approach[a, j]
            at = sums[a, j]
            for i in range(n_slices):
                k, depth = stiffness[a, i], y - gap[a, i]
                if depth <= 0.0 or k == 0.0:
                    continue
                force = k * depth
                weight = k * min(1.0, depth / law.damping_depth)
                at[0] += 0.5 * force * depth
                at[1] += force
                at[2] += weight
                at[3] += force * face[i]
                at[4] += share * k * face[i]
                if law.path_speed != 0.0:
                    damping = law.damp_time * weight
                    closing = -damping * slope[a, i] * law.path_speed
                    if force + closing > 0.0:
                        at[5] += closing
                        at[6] += damping
                        at[7] -= closing * slope[a, i]
                        at[8] -= damping * slope[a, i]
                    else:
                        at[5] -= force
                        at[7] += force * slope[a, i]
                for q in range(sharpness.shape[0]):
                    first = SUMS + FRICTION * q
                    at[first] += force * direction[i, q]
                    at[first + 1] += force * direction[i, q] * path[a, i]
                    at[first + 2] -= force * turning[i, q]
                    at[first + 3] -= force * turning[i, q] * path[a, i]
            at[0] += 0.5 * law.body * at[1] * at[1]


# Layout of contact tables: smooth potentials of a tooth pair or of a whole mesh, that mesh forces come from.
#
# A table holds ``W(u, s)``: ``s`` is the path position (of a pair, or the phase of the mesh within its base pitch) and
# ``u = y - G(s)`` the depth of the approach ``y`` of the teeth below the least gap ``G``, so that the first touch
# stands on a node. Over the depth W is a cubic in each cell, over the path the coefficients of these cubics are uniform
# cubic B-splines: force ``dW/dy`` and derivative torque ``r_b1 dW/ds`` are continuous and come from one potential, so
# that the interpolation neither makes nor takes energy (``dynamics.tooth.law``).
#
# Where the faces tilt against each other, W is tabulated at some tilts with the tilting moment ``dW/dtilt`` and a cubic
# over the tilt by both (Hermite), again one potential.
#
# ``kernels.table_lookup`` contracts the splines of every pair that can touch to one row of numbers, a cubic in y, at a
# place on the path; ``kernels.contact_force`` sums the rows. Built by ``dynamics.tooth.contact_table``.

Integers = NDArray[np.int64]

CELL = 8
"""Numbers of a cell: W at its start, then F = dW/du there, slope and square term of F; damper weight and its slope;
what the recorded force has beyond F, and its slope."""
LINES = 4
"""Value and slope over the depth in a cell of two quantities; or four numbers of a moment, as of W."""
# columns of ContactTables.values; SPUR is 1 where all slices of a pair stand at one place and friction needs no table
(
    V_R1, V_R2, V_PER_PITCH, V_ORIGIN, V_BACK_ORIGIN, V_BACKLASH, V_DAMP_TIME, V_BODY, V_PER_FINEST, V_LOWEST,
    V_LEAST_GAP, V_PER_KNOT, V_FRICTION, V_ROLL_1, V_ROLL_2, V_PER_REVERSAL, V_CLOSING, V_DERIVATIVE, V_FLOOR, V_TILT,
    V_PER_TILT, V_TABULATED_BODY, V_REVERSAL, V_MU_1, V_MU_2, V_HALF_PITCH, V_START,
    V_BACK_START, V_SPUR,
) = range(29)  # fmt: skip
N_TABLE_VALUES = 29
# columns of ContactTables.counts; a flank of its own on the back stands behind the front's if BACK is 1; GENERAL is 0
# where all teeth are alike and do not tilt
(
    C_PER_PITCH, C_PAIRS, C_KNOTS, C_CELLS, C_FINEST, C_BACK, C_GAPS_AT, C_CELLS_AT, C_MOMENTS_AT, C_DEPTHS_AT,
    C_CELL_OF_AT, C_FRICTION_AT, C_CLOSING_AT, C_INDIVIDUAL, C_OFFSET_2, C_DEVIATIONS_AT, C_TEETH_1, C_TEETH_2,
    C_PER_TOOTH, C_SCALES_AT, C_SCALED_1, C_SCALED_2, C_PLANES, C_LEVELS, C_LEVELS_AT,
    C_GENERAL,
) = range(26)  # fmt: skip
N_TABLE_COUNTS = 26
# places in a row: a cell (CELL), its slopes over the path (CELL), closing dampers (2 LINES), tilting moment, second
# derivative of W over the path; levers of friction and what they gain by the reversal; the approach at the start of
# the cell, slope and second derivative of the gap
R_SLOPES, R_CLOSING, R_MOMENT, R_CURVES, R_FRICTION, R_GAIN, R_START, R_GAP_SLOPE, R_GAP_CURVE = (
    8, 16, 24, 28, 32, 36, 40, 41, 42,
)  # fmt: skip
N_SCALED, N_ROW = 32, 44
SCRATCH = 2 * CELL + 4 * LINES
"""Numbers behind the rows that tilt needs."""


class ContactTables(NamedTuple):
    """Tables of all meshes of a drivetrain; see ``dynamics.tooth.contact_table.contact_tables``."""

    values: Array
    """(n_meshes, N_TABLE_VALUES) plain numbers."""
    counts: Integers
    """(n_meshes, N_TABLE_COUNTS) sizes and first entries in the arrays below."""
    gaps: Array
    """Per flank (n_knots,) spline coefficients of the least gap [m]."""
    cells: Array
    """Flat, per flank (n_planes, n_cells, n_knots, CELL): those of the cubics over the depth at every tilt."""
    moments: Array
    """Flat, per flank (n_planes, n_cells, n_knots, LINES): those of the tilting moment, as of W; empty without tilt."""
    depths: Array
    """Per mesh (n_cells + 1,) first depth of each cell [m]."""
    cell_of: Integers
    """Per mesh (n_finest,) cell at each multiple of the finest depth step."""
    friction: Array
    """Flat, per flank (n_planes, n_levels, n_cells, n_knots, 2 LINES): levers of friction on pinion and wheel, with the
    direction of sliding, then what they gain per advance of its reversal [m]."""
    levels: Array
    """Flat, per mesh (n_levels,) sharpness of the reversal over the path at which they hold [1/m]."""
    closing: Array
    """Flat, per flank (n_planes, n_cells, n_knots, 2 LINES): of dampers on the closing rate at no rate of the approach,
    force and its derivative over that rate, torque on the slope of the gap and its derivative; empty for others."""
    deviations: Array
    """Per flank, gear and tooth: spline coefficients over the path of the gap it adds, or one number [m]."""
    scales: Array
    """Per gear and tooth: stiffness scale [-]."""
    offsets: Array
    """(n_meshes,) imposed approach [m]."""
