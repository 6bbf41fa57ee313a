"""Mesh laws packed into the tables of the compiled loops.

The tables of a law become monotone cubics (Fritsch and Carlson, SIAM J. Numer. Anal. 17, 1980): the
stiffness stays between its points and never turns negative, force and derivative torque are continuous, and
both come from the same polynomial, hence from one potential. With straight pieces instead the energy error
of a march no longer falls at second order, because the derivative torques jump at every table point.

If all teeth are alike the contacts of every slice and pair are tabulated over the phase within one base
pitch.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from dynamics import kernels
from dynamics.kernels import PackedMeshes
from dynamics.kernels.contact import DAMP_TIME
from dynamics.tooth.law import MeshLaw, back_deviations, check_mesh_law, law_content
from thermal.fe.kept_results import kept_as

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


def pack_meshes(
    laws: Sequence[MeshLaw], *, derivative_torques: bool = True, over_phase: bool = True
) -> PackedMeshes:
    """Return the packed tables of all ``laws``.

    With ``derivative_torques=False`` the torques ``F de/dtheta`` and ``d^2 dk/dtheta / 2`` are left out: the
    negative control of the energy test, of no other use. With ``over_phase=False`` the tables over the phase are
    left out, which the force of single tooth pairs does not need.

    Tables of laws met before are handed out again: nobody may write into them.

    Raises
    ------
    ValueError
        If a law is impossible (see ``check_mesh_law``).
    """
    key = (_tables, tuple(map(law_content, laws)), derivative_torques, over_phase)
    return kept_as(key, lambda: _tables(laws, derivative_torques, over_phase))


def _tables(laws: Sequence[MeshLaw], derivative_torques: bool, over_phase: bool) -> PackedMeshes:
    for law in laws:
        check_mesh_law(law)
    values = np.array([_values(law, derivative_torques) for law in laws])
    counts = np.zeros((len(laws), kernels.N_COUNTS), np.int64)
    cells: list[Array] = []
    shifts: list[Array] = []
    deviations: list[Array] = []
    scales: list[Array] = []
    sizes: list[Integers] = []
    data: list[Array] = []
    least: list[Array] = []
    for mesh, law in enumerate(laws):
        n_slices, n_path = law.stiffness.shape
        deviation_cells, places = _deviation_tables(law, sum(map(len, deviations)))
        scale_at = sum(map(len, scales))
        individual = has_individual_teeth(law)
        n_phases = phase_count(law) if over_phase and not individual else 0
        front_at = sum(map(len, sizes))
        stiffness, gap = _cubic(law.stiffness), _cubic(law.gap)
        for sign in (1.0, -1.0) if n_phases else ():
            size, bounds, rows = _phase_contacts(law, stiffness, gap, sign, n_phases)
            sizes.append(size)
            least.append(bounds)
            data.append(rows)
        counts[mesh] = (
            n_slices, n_path - 1, sum(map(len, cells)), sum(map(len, shifts)), individual,
            law.teeth_1, law.teeth_2, law.tooth_offset_2,
            len(law.deviation_1), places[0], len(law.deviation_2), places[1],
            len(law.scale_1), scale_at, len(law.scale_2), scale_at + len(law.scale_1),
            most_contacts(law),
            n_phases, front_at, front_at + n_phases, places[2], places[3],
        )  # fmt: skip
        cells.append(np.hstack((_cells(stiffness), _cells(gap))))
        shifts.append(np.asarray(law.slice_shift, float))
        deviations.append(deviation_cells)
        scales.append(np.concatenate((law.scale_1, law.scale_2)).astype(float))
    return PackedMeshes(
        values=values,
        counts=counts,
        cells=np.vstack(cells),
        shifts=np.concatenate(shifts),
        deviations=np.vstack(deviations),
        scales=np.concatenate(scales),
        phase_starts=np.concatenate(([0], np.cumsum(np.concatenate([np.zeros(0, np.int64), *sizes])))),
        phase_least=np.concatenate([np.zeros(0), *least]),
        phase_data=np.concatenate([np.zeros(0), *data]),
        offsets=np.array([law.offset for law in laws], float),
    )


def undamped(packed: PackedMeshes) -> PackedMeshes:
    """Return the tables of the same laws without mesh damping."""
    values = packed.values.copy()
    values[:, DAMP_TIME] = 0.0
    return packed._replace(values=values)


def has_individual_teeth(law: MeshLaw) -> bool:
    """Return whether a tooth of the law differs from the others by deviation or stiffness."""
    tables = (
        law.deviation_1, law.deviation_2, *back_deviations(law), law.scale_1 - 1.0, law.scale_2 - 1.0
    )  # fmt: skip
    return any(bool(np.any(table)) for table in tables)


def phase_count(law: MeshLaw) -> int:
    """Return into how many cells a base pitch is divided: as fine as the path."""
    return max(8, int(np.ceil(law.base_pitch / law.path_step - 1e-9)))


def most_contacts(law: MeshLaw) -> int:
    """Return how many contacts one flank can have on the path at once, filled up to whole turns of a loop."""
    n_slices, n_path = law.stiffness.shape
    contacts = int(n_slices) * (int(law.path_step * (n_path - 1) / law.base_pitch) + 2)
    return kernels.VECTOR * -(-contacts // kernels.VECTOR)


def _values(law: MeshLaw, derivative_torques: bool) -> tuple[float, ...]:
    front, back = (law.deviation_1, law.deviation_2), back_deviations(law)
    least_gap = float(law.gap.min()) + min(float(p.min() + w.min()) for p, w in (front, back))
    reversal = max(law.friction_reversal_speed, 1e-9)
    teeth = law.mean_stiffness / (1.0 - law.body_compliance * law.mean_stiffness)
    # both flanks pressed at once: the body can bring one into contact that the gears alone would not
    jammed = law.body_compliance > 0.0 and law.backlash + 2.0 * least_gap < 0.0
    return (
        law.base_radius_1, law.base_radius_2, law.base_pitch, law.phase, law.back_phase, law.backlash,
        law.path_start, 1.0 / law.path_step, law.damping / teeth, law.friction,
        law.rolling_radius_1, law.rolling_radius_2, 1.0 / reversal, least_gap, float(derivative_torques),
        1e-12 * law.mean_stiffness * law.base_radius_1, 1.0 / law.base_pitch,
        law.friction / law.base_radius_1, law.friction / law.base_radius_2, law.base_pitch / phase_count(law),
        phase_count(law) / law.base_pitch, law.damping_depth, 1.0 / law.damping_depth,
        float(law.damping_acts_on == "contact_closing_rate"), law.body_compliance, np.inf if jammed else 0.0,
    )  # fmt: skip


def _cubic(table: Array) -> PchipInterpolator:
    """Return the monotone cubic of (rows, n_path) over the index of the path point."""
    return PchipInterpolator(np.arange(table.shape[1]), table, axis=1)


def _cells(cubic: PchipInterpolator) -> Array:
    """Return (rows * cells, 4): coefficients of the monotone cubic over the fraction of each cell."""
    coefficients: Array = np.moveaxis(cubic.c[::-1], 0, -1)  # (n_cells, rows, 4)
    return np.ascontiguousarray(coefficients.swapaxes(0, 1).reshape(-1, 4))


def _deviation_cells(table: Array) -> Array:
    """Return the same of a table of deviations, which mostly has none."""
    rows, points = table.shape
    return _cells(_cubic(table)) if np.any(table) else np.zeros((rows * (points - 1), 4))


def _deviation_tables(law: MeshLaw, next_row: int) -> tuple[Array, tuple[int, int, int, int]]:
    """Return cells of pinion and wheel, front and back, and where each begins in a table that goes on at a row."""
    tables = [_deviation_cells(law.deviation_1), _deviation_cells(law.deviation_2)]
    places = [next_row, next_row + len(tables[0])]
    for index, table in enumerate((law.back_deviation_1, law.back_deviation_2)):
        places.append(places[index] if table is None else next_row + sum(map(len, tables)))
        if table is not None:
            tables.append(_deviation_cells(table))
    return np.vstack(tables), (places[0], places[1], places[2], places[3])


def _phase_contacts(
    law: MeshLaw, stiffness: PchipInterpolator, gap: PchipInterpolator, sign: float, n_phases: int
) -> tuple[Integers, Array, Array]:
    """Return the contacts on the path of one flank, phase cell after phase cell, from the cubics of the tables.

    Their number in each cell (n_phases,); the lower bounds (n,) of their gaps, in increasing order within a cell; and
    N_PHASE rows over the contacts of each cell, flat. More than one in a cell are filled up to whole turns of a
    compiled loop with some of no stiffness.

    The cubics are carried from the path to the phase by value and derivative at both ends of the phase cell.
    """
    n_path = law.stiffness.shape[1]
    width = law.base_pitch / n_phases
    # path position of each (cell, slice, pair) at the start of the phase cell, in path steps
    reach = n_path * law.path_step + law.base_pitch
    lag = sign * law.slice_shift
    lowest = int(np.floor((-lag.max() - law.path_start - reach) / law.base_pitch)) - 1
    highest = int(np.ceil((law.base_pitch - lag.min() - law.path_start) / law.base_pitch)) + 1
    turns = np.arange(lowest, highest + 1)
    begin = np.arange(n_phases)[:, None, None] * width
    place = (begin - lag[:, None] - turns * law.base_pitch - law.path_start) / law.path_step
    middle = place + 0.5 * width / law.path_step
    on_path = (middle >= 0.0) & (middle <= n_path - 1)
    cells, slices, pairs = np.nonzero(on_path)
    position, steps = place[cells, slices, pairs], width / law.path_step
    lanes = np.vstack(
        (
            *_hermite(stiffness, position, slices, steps),
            *_hermite(gap, position, slices, steps),
            law.path_start + position * law.path_step,
        )
    )
    # the control points of the gap bound it from below; contacts that open last come first
    g_0, g_1, g_2, g_3 = lanes[4:8]
    bound = np.minimum.reduce([g_0, g_0 + g_1 / 3.0, g_0 + (2.0 * g_1 + g_2) / 3.0, g_0 + g_1 + g_2 + g_3])
    order = np.lexsort((bound, cells))
    lanes, bound = lanes[:, order], bound[order]
    counts = np.bincount(cells, minlength=n_phases)
    sizes = np.where(counts > 1, kernels.VECTOR * -(-counts // kernels.VECTOR), counts)
    starts = np.cumsum(sizes) - sizes
    within = np.arange(len(cells)) - (np.cumsum(counts) - counts)[cells]
    least = np.full(int(sizes.sum()), np.inf)
    least[starts[cells] + within] = bound
    data = np.zeros(kernels.N_PHASE * len(least))
    rows = np.arange(kernels.N_PHASE)[:, None] * sizes[cells]
    data[kernels.N_PHASE * starts[cells] + rows + within] = lanes
    return sizes, least, data


def _hermite(cubic: PchipInterpolator, start: Array, rows: Integers, width: float) -> tuple[Array, ...]:
    """Cubic coefficients over the fraction of [start, start + width] from values and derivatives at both ends."""
    (v_0, s_0), (v_1, s_1) = (_value_and_derivative(cubic, start + shift, rows) for shift in (0.0, width))
    d_0, d_1 = s_0 * width, s_1 * width
    return v_0, d_0, 3.0 * (v_1 - v_0) - 2.0 * d_0 - d_1, 2.0 * (v_0 - v_1) + d_0 + d_1


def _value_and_derivative(cubic: PchipInterpolator, position: Array, rows: Integers) -> tuple[Array, Array]:
    """Return value and derivative of row ``rows[i]`` at ``position[i]``, held within the table."""
    inside = np.clip(position, 0.0, cubic.x[-1])
    index = np.minimum(inside.astype(np.int64), len(cubic.x) - 2)
    f = inside - index
    c_3, c_2, c_1, c_0 = cubic.c[:, index, rows]
    return ((c_3 * f + c_2) * f + c_1) * f + c_0, (3.0 * c_3 * f + 2.0 * c_2) * f + c_1
