"""Contact of one gear mesh, flank by flank, on the packed tables ``PackedMeshes``.

With ``sign`` +1 in front and -1 on the back, ``play`` 0 in front and the backlash behind, the penetration is
``d = sign x - play - e(s)`` and the path position moves with ``ds/dt = sign r_b1 omega_1``. From the
potential ``k(s) d^2 / 2`` and a damper on the rate ``v = sign dx/dt - q e' ds/dt``

    tau_1 = -sign r_b1 [ F (1 - e') + D e' (1 - q) + k' d^2 / 2 ],   tau_2 = sign r_b2 F,
    F = max(0, k d + c g v),   D = F - k d

where ``q`` is 0 with the damper on the relative rotation (``v`` is the approach rate, whose lever on the pinion is
``r_b1``) and 1 with it on the closing rate of the contact (``v = (d/dt) d``), so that ``D v`` is what the damper
takes in either case. The damping grows with ``g = min(1, d / damping depth)``, and friction adds
``-mu F sgn(v_g) rho_1`` and ``+mu F sgn(v_g) rho_2`` with the sliding speed ``v_g = omega_1 rho_1 - omega_2
rho_2``, ``rho_1 = T1C + s``, ``rho_2 = T2C - s``.

All contacts of a flank are columns of a table with N_PHASE rows, so that the compiler makes vector
instructions of a loop over them. Equal teeth are tabulated over the phase within one base pitch; with
individual teeth every contact is looked up on the path and such a table is written for each step.
"""

from collections.abc import Callable
from typing import Any, NamedTuple, NoReturn, TypeVar

import numpy as np
from numba import njit
from numba.core.registry import CPUDispatcher
from numpy.typing import NDArray

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


# NaN and infinity keep their meaning; only the order of sums is free
LOOSE = {"reassoc", "contract", "nsz", "arcp"}
Function = TypeVar("Function", bound=Callable[..., Any])


class _Inlined(CPUDispatcher):
    """A compiled function without a wrapper for Python, a call from which would end the process."""

    def __call__(self, *_: object) -> NoReturn:
        raise TypeError(
            f"{self.py_func.__name__} has no wrapper for Python: call it from a compiled function"
        )


def inlined(function: Function) -> Function:
    """Compile what becomes part of its compiled caller, and is called from nowhere else.

    Arrays are neither made nor counted in it; no wrappers, which take a tenth of the time and serve calls from Python.

    Raises
    ------
    TypeError
        When Python calls it.
    """
    compiled: Function = njit(  # type: ignore[call-overload]
        cache=True, fastmath=LOOSE, error_model="numpy", forceinline=True, _nrt=False,
        no_cpython_wrapper=True, no_cfunc_wrapper=True,
    )(function)  # fmt: skip
    compiled.__class__ = _Inlined  # type: ignore[assignment]
    return compiled


class Flank(NamedTuple):
    """Contacts of one flank in a table, and the position of the flank: what a sum over them needs besides the law."""

    first: int
    """First number of the table."""
    stride: int
    """Contacts in a row of the table."""
    n: int
    """Contacts to look at."""
    place: float
    """Place within the cell, 0 to 1."""
    per_metre: float
    """Cells per metre of path."""
    roll_1: float
    """Rolling radii of a contact at path position 0 of the table [m]."""
    roll_2: float
    omega_1: float
    """Speeds that decide on the direction of sliding [rad/s]."""
    omega_2: float


class Pressing(NamedTuple):
    """How the gears press a flank, seen from this flank."""

    sign: float
    """+1 in front, -1 on the back."""
    reach: float
    """Approach less the play [m]."""
    rate: float
    """Rate of the approach [m/s]."""
    omega_1: float
    """Speed of the pinion [rad/s]."""


@inlined
def sliding_direction(ratio: float) -> float:
    """Return the smooth sign of ``ratio``: a cubic inside +-1, exactly +-1 outside."""
    ratio = ratio if ratio < 1.0 else 1.0
    ratio = ratio if ratio > -1.0 else -1.0
    return ratio * (1.5 - 0.5 * ratio * ratio)


class Pressed(NamedTuple):
    """What the contacts of one flank do together, and how far that is from linear."""

    force: float
    a_1: float
    """sum F m_1 + k' d^2 / 2: torque on the pinion per base radius"""
    a_2: float
    """sum F m_2"""
    force_x: float
    """Derivatives over the reach"""
    a_1_x: float
    a_2_x: float
    force_v: float
    """Derivatives over the rate"""
    a_1_v: float
    a_2_v: float
    kinked: float
    """Stiffness that could switch on, off or to full damping within ``guard`` of depth"""
    curved: float
    """Mixed second derivative of the force over reach and rate"""


class _Pass(NamedTuple):
    """What is the same for all contacts of a flank."""

    f: float
    f_2: float
    f_3: float
    reach: float
    from_rate: float
    from_slope: float
    derivative: float
    rotation: float
    """Part of ``derivative`` that the damper does not follow"""
    slip: float
    slip_slope: float
    mu_1: float
    mu_2: float
    roll_1: float
    roll_2: float
    per_depth: float
    full_depth: float
    guard: float


@inlined
def _press_contact(table: Array, c: int, stride: int, same: _Pass) -> Pressed:
    """Return what the contact in column ``c`` does; derivatives over the rate per damping time.

    The lever factors ``m_1 = 1 - e' +- mu rho_1 / r_b1`` and ``m_2 = 1 +- mu rho_2 / r_b2`` carry the slope of the
    gap and the friction.
    """
    f, f_2, f_3 = same.f, same.f_2, same.f_3
    k_1, k_2, k_3 = table[c + stride], table[c + 2 * stride], table[c + 3 * stride]
    e_1, e_2, e_3 = table[c + 5 * stride], table[c + 6 * stride], table[c + 7 * stride]
    s = table[c + ROW_S * stride]
    stiffness = table[c] + f * (k_1 + f * (k_2 + f * k_3))
    over = same.reach - (table[c + ROW_E * stride] + f * (e_1 + f * (e_2 + f * e_3)))
    slope = e_1 + f_2 * e_2 + f_3 * e_3
    direction = sliding_direction(same.slip + same.slip_slope * s)
    m_1 = 1.0 - slope * same.derivative + (same.mu_1 * direction) * (same.roll_1 + s)
    m_2 = 1.0 + (same.mu_2 * direction) * (same.roll_2 - s)
    closing = same.from_rate - slope * same.from_slope
    depth = over if over > 0.0 else 0.0
    grown = depth * same.per_depth
    per = same.per_depth if grown < 1.0 else 0.0
    grown = grown if grown < 1.0 else 1.0
    pressed = depth + grown * closing
    k = stiffness if pressed > 0.0 else 0.0  # never where depth = 0
    bent = 0.5 * same.derivative * (k_1 + f_2 * k_2 + f_3 * k_3) * depth
    force, k_x, k_v = k * pressed, k * (1.0 + per * closing), k * grown
    turned = slope * same.rotation
    elastic = stiffness if over > 0.0 else 0.0
    damped = force - elastic * depth
    margin = abs(pressed) if abs(pressed) < abs(over - same.full_depth) else abs(over - same.full_depth)
    margin = margin if margin < abs(over) else abs(over)
    margin = margin if over > -same.guard else same.guard
    return Pressed(
        force, force * m_1 + damped * turned + bent * depth, force * m_2, k_x,
        k_x * m_1 + (k_x - elastic) * turned + 2.0 * bent, k_x * m_2, k_v, k_v * (m_1 + turned), k_v * m_2,
        stiffness if margin < same.guard else 0.0, k * per,
    )  # fmt: skip


@inlined
def press_flank(
    table: Array, flank: Flank, space: Array, at: int, pressing: Pressing, guard: float
) -> Pressed:
    """Sum the contacts of one flank; kinks are looked for within ``guard`` of depth [m]."""
    sign, reach, rate, omega_1 = pressing.sign, pressing.reach, pressing.rate, pressing.omega_1
    damp_time, per_reversal, closes = space[at + DAMP_TIME], space[at + PER_REVERSAL], space[at + CLOSING]
    same = _Pass(
        flank.place, 2.0 * flank.place, 3.0 * flank.place * flank.place, reach, damp_time * rate,
        damp_time * closes * sign * space[at + R1] * omega_1 * flank.per_metre,
        space[at + DERIVATIVE] * flank.per_metre, (1.0 - closes) * space[at + DERIVATIVE] * flank.per_metre,
        (flank.omega_1 * flank.roll_1 - flank.omega_2 * flank.roll_2) * per_reversal,
        (flank.omega_1 + flank.omega_2) * per_reversal, sign * space[at + MU_1], sign * space[at + MU_2], flank.roll_1,
        flank.roll_2, space[at + PER_DEPTH], space[at + DEPTH], guard,
    )  # fmt: skip
    first, stride = flank.first & POSITIVE, flank.stride & POSITIVE
    force, a_1, a_2 = 0.0, 0.0, 0.0
    force_x, a_1_x, a_2_x = 0.0, 0.0, 0.0
    force_v, a_1_v, a_2_v = 0.0, 0.0, 0.0
    kinked, curved = 0.0, 0.0
    if flank.n == 1:
        one = _press_contact(table, first, stride, same)
        force, a_1, a_2 = one.force, one.a_1, one.a_2
        force_x, a_1_x, a_2_x = one.force_x, one.a_1_x, one.a_2_x
        force_v, a_1_v, a_2_v = one.force_v, one.a_1_v, one.a_2_v
        kinked, curved = one.kinked, one.curved
    else:
        for i in range(flank.n // VECTOR * VECTOR):
            more = _press_contact(table, first + i, stride, same)
            force += more.force
            a_1 += more.a_1
            a_2 += more.a_2
            force_x += more.force_x
            a_1_x += more.a_1_x
            a_2_x += more.a_2_x
            force_v += more.force_v
            a_1_v += more.a_1_v
            a_2_v += more.a_2_v
            kinked += more.kinked
            curved += more.curved
    return Pressed(
        force, a_1, a_2, force_x, a_1_x, a_2_x, force_v * damp_time, a_1_v * damp_time, a_2_v * damp_time,
        kinked, curved * damp_time,
    )  # fmt: skip


class MeshContact(NamedTuple):
    """One column of a phase table at the place of its flank; derivatives over the fraction of a cell."""

    position: float
    stiffness: float
    stiffness_slope: float
    gap: float
    gap_slope: float


@inlined
def contact_at(table: Array, c: int, stride: int, f: float) -> MeshContact:
    """Return the contact in column ``c`` at the fraction ``f`` of its cell."""
    k_1, k_2, k_3 = table[c + stride], table[c + 2 * stride], table[c + 3 * stride]
    e_1, e_2, e_3 = table[c + 5 * stride], table[c + 6 * stride], table[c + 7 * stride]
    return MeshContact(
        table[c + ROW_S * stride],
        table[c] + f * (k_1 + f * (k_2 + f * k_3)),
        k_1 + f * (2.0 * k_2 + 3.0 * f * k_3),
        table[c + ROW_E * stride] + f * (e_1 + f * (e_2 + f * e_3)),
        e_1 + f * (2.0 * e_2 + 3.0 * f * e_3),
    )


@inlined
def curvatures_at(table: Array, c: int, stride: int, f: float) -> tuple[float, float]:
    """Return the second derivatives of stiffness and gap over the fraction of a cell, as of `contact_at`."""
    return (
        2.0 * table[c + 2 * stride] + 6.0 * f * table[c + 3 * stride],
        2.0 * table[c + 6 * stride] + 6.0 * f * table[c + 7 * stride],
    )


@inlined
def flank_powers(
    table: Array, flank: Flank, space: Array, at: int, pressing: Pressing
) -> tuple[float, float, float]:
    """Return friction power, damping power and damping force of one flank, arguments as in ``press_flank``."""
    sign, reach, rate, omega_1 = pressing.sign, pressing.reach, pressing.rate, pressing.omega_1
    friction_power, damping_power, damping_force = 0.0, 0.0, 0.0
    f = flank.place
    damp_time, per_depth = space[at + DAMP_TIME], space[at + PER_DEPTH]
    path_speed = space[at + CLOSING] * sign * space[at + R1] * omega_1 * flank.per_metre
    first, stride = flank.first & POSITIVE, flank.stride & POSITIVE
    for i in range(flank.n):
        s, k, _, gap, gap_slope = contact_at(table, first + i, stride, f)
        depth = reach - gap
        depth = depth if depth > 0.0 else 0.0
        closing = rate - gap_slope * path_speed
        grown = depth * per_depth
        grown = grown if grown < 1.0 else 1.0
        force = k * (depth + damp_time * grown * closing)
        force = force if (depth > 0.0 and force > 0.0) else 0.0
        damped = force - k * depth
        sliding = flank.omega_1 * (flank.roll_1 + s) - flank.omega_2 * (flank.roll_2 - s)
        friction_power += force * sliding_direction(sliding * space[at + PER_REVERSAL]) * sliding
        damping_power += damped * closing
        damping_force += damped
    return friction_power * space[at + FRICTION], damping_power, damping_force


# Packed tables of the mesh laws that the compiled loops read: their columns and rows by name.


class PackedMeshes(NamedTuple):
    """Tables of all meshes of a drivetrain; packed by ``dynamics.tooth.packed_laws.pack_meshes``."""

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
