"""How the torques of a mesh answer to what single teeth deviate: sensitivity of every contact along a known motion.

All teeth of the law are alike. Along a motion that repeats from mesh to mesh, a gap ``e_j(s)`` added to tooth j and a
relative change ``q_j`` of its stiffness change each torque ``a`` (pinion, wheel, normal force) in first order by

    sum over pairs p and slices i of  a_e e_j(s_pi) + a_e' e_j'(s_pi) + a_q q_j

The contacts are those of ``dynamics.kernels.contact``, whose formulas are differentiated here. Where the pairs share a
body, what a tooth deviates changes the force on it and so the approach that all pairs see.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from dynamics.kernels.mesh_tables import CELLS_AT, CLOSING, DAMP_TIME, LEAST_GAP, N_CELLS, PackedMeshes
from dynamics.mesh.force import evaluate_mesh
from dynamics.mesh.law import MeshLaw

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Integers = NDArray[np.int64]

OUTPUTS = 3
"""Torque on the pinion, torque on the wheel [N m], front less back force times the pinion's base radius [N m]."""


class Motion(NamedTuple):
    """Motion of one mesh, each (n,): pinion angle [rad], approach with its offset [m], speeds [rad/s]."""

    angle: Array
    approach: Array
    omega_1: Array
    omega_2: Array


class PairSensitivity(NamedTuple):
    """Answer of each output to what one tooth pair deviates on one flank, at n places of a motion.

    first : number of the first pair in the tables
    pairs : pairs in the tables
    gap : OUTPUTS tables (pairs n, n_path): per gap at the points of the path [N m/m]
    gap_slope : the same per slope of the gap along the path [N m]
    scale : (OUTPUTS, pairs, n) per relative change of stiffness [N m]
    """

    first: int
    pairs: int
    gap: tuple[csr_array, ...]
    gap_slope: tuple[csr_array, ...]
    scale: Array


def pair_sensitivity(
    law: MeshLaw, packed: PackedMeshes, motion: Motion, *, back: bool = False
) -> PairSensitivity | None:
    """Return the sensitivities of all pairs that touch along a motion, front or back; None if none touches.

    law : with all teeth alike (``alike_teeth``); packed : the same, ``pack_meshes([law])``
    """
    sign = -1.0 if back else 1.0
    if law.body_compliance > 0.0:
        motion = motion._replace(approach=evaluate_mesh(packed, *motion).tooth_approach)
    found = _contacts(law, packed, motion, sign)
    if found is None or not found.pair.size:
        return None
    if law.body_compliance > 0.0:
        found = _through_body(law, found, _contacts(law, packed, motion, -sign), sign)
    n, n_path = motion.angle.size, law.stiffness.shape[1]
    first = int(found.pair.min())
    pairs = int(found.pair.max()) - first + 1
    row, share = (found.pair - first) * n + found.at, found.fraction
    rows, columns = np.concatenate([row, row]), np.concatenate([found.cell, found.cell + 1])
    weight = np.concatenate([1.0 - share, share])

    def spread(values: Array) -> tuple[csr_array, ...]:
        return tuple(
            csr_array((np.tile(value, 2) * weight, (rows, columns)), shape=(pairs * n, n_path))
            for value in values
        )

    scale = np.array([np.bincount(row, value, pairs * n) for value in found.per_scale]).reshape(
        OUTPUTS, pairs, n
    )
    return PairSensitivity(first, pairs, spread(found.per_gap), spread(found.per_gap_slope), scale)


class ToothPattern(NamedTuple):
    """What the teeth of one gear deviate from their mean on one flank, as waves over the teeth.

    waves : (n_waves,) number of each wave, 0 to teeth - 1: tooth j has the factor exp(2 pi i wave j / teeth)
    gap : (n_waves, n_path) [m]; scale : (n_waves,) [-]
    """

    teeth: int
    waves: Integers
    gap: Complex
    scale: Complex


def tooth_pattern(deviation: Array, scale: Array, teeth: int, waves: Integers) -> ToothPattern:
    """Return waves of the tables ``deviation_1``, ``scale_1`` (2, back) of a law, the mean over all teeth left out."""
    waves = np.asarray(waves, np.int64) % teeth
    phase_shift = np.exp(-2j * np.pi / teeth * np.outer(waves, np.arange(teeth))) / teeth
    phase_shift[waves == 0] = 0.0
    gap = (
        phase_shift @ deviation
        if len(deviation) == teeth
        else np.zeros((waves.size, deviation.shape[1]), complex)
    )
    relative = scale / scale.mean() - 1.0
    part = phase_shift @ relative if len(scale) == teeth else np.zeros(waves.size, complex)
    return ToothPattern(teeth, waves, np.asarray(gap, complex), np.asarray(part, complex))


def excitation(
    sensitivity: PairSensitivity, law: MeshLaw, pattern: ToothPattern, first_tooth: int
) -> Complex:
    """Return the outputs (OUTPUTS, n_waves, n) that each wave over the teeth adds along the motion.

    first_tooth : tooth of this gear in pair 0 (of the wheel ``tooth_offset_2`` in front, the next one on the back)
    """
    n = sensitivity.scale.shape[2]
    pair = sensitivity.first + np.arange(sensitivity.pairs) + first_tooth
    phase_shift = np.exp(2j * np.pi / pattern.teeth * np.outer(pattern.waves, pair))
    gap_slope = np.gradient(pattern.gap, law.path_step, axis=1)
    out = np.empty((OUTPUTS, pattern.waves.size, n), complex)
    for output in range(OUTPUTS):
        along = np.asarray(
            sensitivity.gap[output] @ pattern.gap.T + sensitivity.gap_slope[output] @ gap_slope.T
        )
        wave = along.reshape(sensitivity.pairs, n, pattern.waves.size)
        wave = wave + sensitivity.scale[output][:, :, None] * pattern.scale
        out[output] = np.einsum("wp,pnw->wn", phase_shift, wave)
    return out


class _Contacts(NamedTuple):
    """Touching contacts of one flank: sample, pair, cell of the path and place in it, and their sensitivities."""

    at: Integers
    pair: Integers
    cell: Integers
    fraction: Array
    stiffness: Array
    depth: Array
    per_gap: Array
    per_gap_slope: Array
    per_scale: Array


def _through_body(law: MeshLaw, own: _Contacts, other: _Contacts | None, sign: float) -> _Contacts:
    """The contacts of one flank with what their deviations do to all others by way of the shared body."""
    n = int(max(one.at.max(initial=-1) for one in (own, other) if one is not None)) + 1
    per_approach, stiffness = np.zeros((OUTPUTS, n)), np.zeros(n)
    for flank, side in ((own, sign), (other, -sign)):
        if flank is not None:
            stiffness += np.bincount(flank.at, flank.stiffness, n)
            per_approach -= side * np.array([np.bincount(flank.at, one, n) for one in flank.per_gap])
    given = law.body_compliance * per_approach / (1.0 + law.body_compliance * stiffness)
    moved = sign * given[:, own.at] * own.stiffness
    return own._replace(per_gap=own.per_gap + moved, per_scale=own.per_scale - moved * own.depth)


def _contacts(law: MeshLaw, packed: PackedMeshes, motion: Motion, sign: float) -> _Contacts | None:
    """Contacts of one flank (sign +1 front, -1 back); None if none touches."""
    within = sign * motion.approach - (law.backlash if sign < 0.0 else 0.0)
    if not np.any(within > packed.values[0, LEAST_GAP]):
        return None
    n_cells = int(packed.counts[0, N_CELLS])
    pitch = law.base_pitch / law.path_step
    origin = (law.phase if sign > 0.0 else law.back_phase) - law.path_start
    travel = origin + sign * law.base_radius_1 * motion.angle[:, None] - sign * law.slice_shift
    whole = travel / law.path_step
    turn = np.floor(whole / pitch)
    later = np.arange(int(np.ceil(n_cells / pitch)))[:, None, None]
    place = whole - turn * pitch + later * pitch
    listed, at, piece = np.nonzero(place < n_cells)
    place = place[listed, at, piece]
    pair = (sign * (turn[at, piece] - listed)).astype(np.int64)
    cell = np.minimum(place.astype(np.int64), n_cells - 1)
    f = place - cell
    c = packed.cells[packed.counts[0, CELLS_AT] + piece * n_cells + cell].T
    gap = c[4] + f * (c[5] + f * (c[6] + f * c[7]))
    reach = within[at]
    near = reach > gap
    at, pair, cell, f, c, reach, gap = (
        at[near],
        pair[near],
        cell[near],
        f[near],
        c[:, near],
        reach[near],
        gap[near],
    )
    stiffness = c[0] + f * (c[1] + f * (c[2] + f * c[3]))
    stiffness_slope = (c[1] + f * (2.0 * c[2] + 3.0 * f * c[3])) / law.path_step
    gap_slope = (c[5] + f * (2.0 * c[6] + 3.0 * f * c[7])) / law.path_step
    s = law.path_start + (cell + f) * law.path_step
    omega_1, omega_2 = motion.omega_1[at], motion.omega_2[at]
    damp_time = packed.values[0, DAMP_TIME]
    closes = packed.values[0, CLOSING]
    path_speed = closes * sign * law.base_radius_1 * omega_1
    closing = damp_time * (
        sign * (law.base_radius_1 * omega_1 - law.base_radius_2 * omega_2) - gap_slope * path_speed
    )
    depth = reach - gap
    partly = depth < law.damping_depth
    grown = np.where(partly, depth / law.damping_depth, 1.0)
    grown_slope = np.where(partly, 1.0 / law.damping_depth, 0.0)
    pressed = depth + grown * closing
    k = np.where(pressed > 0.0, stiffness, 0.0)
    rho_1, rho_2 = law.rolling_radius_1 + s, law.rolling_radius_2 - s
    ratio = np.clip((omega_1 * rho_1 - omega_2 * rho_2) / max(law.friction_reversal_speed, 1e-9), -1.0, 1.0)
    rub = sign * law.friction * ratio * (1.5 - 0.5 * ratio**2)
    lever_1 = 1.0 - gap_slope + rub * rho_1 / law.base_radius_1
    lever_2 = 1.0 + rub * rho_2 / law.base_radius_2
    force, force_gap = k * pressed, -k * (1.0 + grown_slope * closing)
    force_slope = -k * grown * damp_time * path_speed
    damped, damped_gap, rotation = force - stiffness * depth, force_gap + stiffness, 1.0 - closes
    lever = rotation * gap_slope
    r_1, r_2 = -sign * law.base_radius_1, sign * law.base_radius_2
    none = np.zeros_like(force)
    return _Contacts(
        at, pair, cell, f, stiffness, depth,
        np.array([
            r_1 * (force_gap * lever_1 + damped_gap * lever - stiffness_slope * depth), r_2 * force_gap * lever_2,
            -r_1 * force_gap,
        ]),
        np.array([
            r_1 * (force_slope * (lever_1 + lever) - force + damped * rotation), r_2 * force_slope * lever_2,
            -r_1 * force_slope,
        ]),
        np.array([
            r_1 * (force * lever_1 + damped * lever + 0.5 * stiffness_slope * depth**2), r_2 * force * lever_2,
            -r_1 * force,
        ]) + none,
    )  # fmt: skip
