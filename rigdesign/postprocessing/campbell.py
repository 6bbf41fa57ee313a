"""Campbell diagram of the closed loop: modes that meshes or shafts drive, over speed, with their bearings as they run.

Of a mode that a mesh drives, gain says how much (`LoopMode.mesh_gain`); a mode within reach of the shaft orders is
shown whatever drives it, as unbalance and misalignment act on all shafts.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.damped_modes import mode_character
from dynamics.rotor.torsional_modes import (
    LoopMode,
    ModeShape,
    ShapedModes,
    TrackedMode,
    shaped_modes,
    tracked,
)
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.mesh_models import laws_of
from rigdesign.postprocessing.curves import HARMONICS, LEAST_GAIN, LoopState, own_ratio
from rigdesign.postprocessing.dynamics import HIGHEST_MODE
from rigdesign.results.vibration import (
    CampbellCrossing,
    CampbellMode,
    CampbellRecord,
    ExcitationOrder,
    OrderKind,
)
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]
Driver = Literal["mesh", "shaft"]

MOST_MESH_MODES, MOST_SHAFT_MODES = 10, 6
"""Modes in the diagram; of more, those that are driven most, and the lowest."""
SHAFT_ORDERS, COUPLING_ORDERS = (1.0,), (2.0,)
"""Unbalance and run-out turn once with a shaft, a misaligned coupling pulls twice a turn."""
ABOVE = 1.25
"""Frequency above the highest shaft order up to which its modes are shown, as a share of that order."""
PEAKED = 0.35
"""Damping ratio from which a mode has hardly a peak: journals in their films."""
LATERAL = 0.5
"""Share of lateral motion in the kinetic energy from which a mode has a sense of whirl."""


def campbell(
    rig: Rig, held: PointResult, states: Sequence[LoopState], names: Sequence[LoopMode]
) -> CampbellRecord:
    """The diagram over the speeds of some states, one of which is that of the held point.

    names : modes at the held point, which give theirs
    """
    laws = laws_of(held.last.models)
    found = [shaped_modes(at.system, laws, _nameless, at.speed, HIGHEST_MODE) for at in states]
    modes = tracked(found, states[0].system.inertia)
    at_held = next(i for i, state in enumerate(states) if state.speed == held.point.speed)
    speeds = np.array([rig.pinion_speed(state.speed) for state in states])
    orders = tuple(excitation_orders(rig))
    oscillating = [mode.name for mode in names if mode.frequency > 0.0]
    numbers = {id(mode): number for number, mode in enumerate(found[at_held].modes)}
    whirls = _whirls(rig, states, found)
    shown = [
        _record(rig, mode, driver, whirls, numbers[id(here)] + 1, oscillating[numbers[id(here)]])
        for mode, driver in _chosen(modes, orders, float(speeds[-1]))
        if (here := mode.modes[at_held]) is not None
    ]
    shown.sort(key=lambda mode: mode.number)
    return CampbellRecord(
        speeds=tuple(speeds.tolist()),
        modes=tuple(shown),
        orders=orders,
        crossings=tuple(_crossings(speeds, shown, orders)),
        left_out=len(modes) - len(shown),
    )


def _nameless(shape: object, mesh_energy: object) -> ModeShape:
    """No description: names are those of the held point."""
    return ModeShape(largest="", name="", energy={})


def excitation_orders(rig: Rig) -> Iterator[ExcitationOrder]:
    """Mesh orders, shaft orders and those of couplings and motor ripple; those of one frequency are one."""
    labels: dict[tuple[OrderKind, float, float], list[str]] = {}
    for mesh, name in enumerate(rig.mesh_names):
        cycles = own_ratio(rig, mesh) * rig.pairs[name].teeth[0]
        for harmonic in range(1, HARMONICS + 1):
            _add(labels, ("mesh", float(harmonic), harmonic * cycles), rig.mesh_labels[name])
    for shaft in rig.drivetrain.shafts:
        for order in SHAFT_ORDERS:
            _add(labels, ("shaft", order, order * _turns(rig, shaft.name)), shaft.name)
    for coupling in rig.drivetrain.couplings:
        stated = (part.order for part in coupling.excitation)
        for order in dict.fromkeys((*COUPLING_ORDERS, *stated)):
            _add(labels, ("coupling", order, order * _turns(rig, coupling.shafts[0])), coupling.name)
    motor = rig.drivetrain.motor
    for part in motor.ripple:
        _add(labels, ("shaft", part.order, part.order * _turns(rig, motor.shaft)), "motor")
    for (kind, of_turn, cycles), of in labels.items():
        yield ExcitationOrder(kind=kind, of=tuple(of), harmonic=of_turn, cycles=cycles)


def _add(
    labels: dict[tuple[OrderKind, float, float], list[str]], line: tuple[OrderKind, float, float], name: str
) -> None:
    kind, harmonic, cycles = line
    labels.setdefault((kind, harmonic, round(cycles, 9)), []).append(name)


def _turns(rig: Rig, shaft: str) -> float:
    """Turns of a shaft per turn of the first pinion."""
    return rig.shaft_speed(shaft, 1.0) / rig.pinion_speed(1.0)


def _chosen(
    modes: Sequence[TrackedMode], orders: Sequence[ExcitationOrder], top: float
) -> Iterator[tuple[TrackedMode, Driver]]:
    """Modes of the diagram and what drives them, up to a speed of the first pinion [rad/s]."""
    turning = top / (2.0 * np.pi)
    shaft_reach = turning * max((order.cycles for order in orders if order.kind != "mesh"), default=0.0)
    mesh_reach = turning * max((order.cycles for order in orders if order.kind == "mesh"), default=0.0)
    low = [mode for mode in modes if _lowest(mode) <= ABOVE * shaft_reach and _peaked(mode)]
    low = low[:MOST_SHAFT_MODES]
    strong = [
        mode
        for mode in modes
        if mode not in low and _gain(mode) >= LEAST_GAIN and _lowest(mode) <= mesh_reach and _peaked(mode)
    ]
    strong = sorted(strong, key=_gain, reverse=True)[:MOST_MESH_MODES]
    yield from ((mode, "shaft") for mode in low)
    yield from ((mode, "mesh") for mode in strong)


def _lowest(mode: TrackedMode) -> float:
    return min(at.frequency for at in mode.modes if at)


def _peaked(mode: TrackedMode) -> bool:
    return min(at.damping_ratio for at in mode.modes if at) < PEAKED


def _gain(mode: TrackedMode) -> float:
    return float(mode.strongest.mesh_gain.max(initial=0.0))


def _whirls(rig: Rig, states: Sequence[LoopState], found: Sequence[ShapedModes]) -> dict[int, float | None]:
    """Whirl of every mode of every state, by its identity; empty for shafts that only twist."""
    whirls: dict[int, float | None] = {}
    for state, at in zip(states, found):
        if state.state is None:
            continue
        seen = rig.elastic.seen
        character = mode_character(seen.reduced, seen.on_coordinates(np.asarray(at.shapes, complex)))
        whirls.update(zip((id(mode) for mode in at.modes), character.lateral_whirl(LATERAL)))
    return whirls


def _record(
    rig: Rig,
    mode: TrackedMode,
    driver: Driver,
    whirls: Mapping[int, float | None],
    number: int,
    name: str,
) -> CampbellMode:
    gains = np.max([at.mesh_gain for at in mode.modes if at], axis=0)
    return CampbellMode(
        number=number,
        name=name,
        frequency=tuple(at.frequency if at else None for at in mode.modes),
        damping_ratio=tuple(at.damping_ratio if at else None for at in mode.modes),
        whirl=tuple(whirls.get(id(at)) for at in mode.modes),
        gain={rig.mesh_labels[mesh]: float(gain) for mesh, gain in zip(rig.mesh_names, gains)},
        driven_by=driver,
    )


def _crossings(
    speeds: Array, modes: Sequence[CampbellMode], orders: Sequence[ExcitationOrder]
) -> Iterator[CampbellCrossing]:
    """By order, then by speed."""
    for order in orders:
        found = []
        for mode in modes:
            gain = max((mode.gain[mesh] for mesh in order.of), default=0.0) if order.kind == "mesh" else 0.0
            driven = gain >= LEAST_GAIN if order.kind == "mesh" else mode.driven_by == "shaft"
            if driven:
                found += [
                    CampbellCrossing(
                        mode=mode.number,
                        kind=order.kind,
                        of=order.of,
                        harmonic=order.harmonic,
                        speed=speed,
                        frequency=order.cycles * speed / (2.0 * math.pi),
                        damping_ratio=damping,
                        gain=gain,
                    )
                    for speed, damping in _meetings(speeds, mode, order.cycles / (2.0 * math.pi))
                ]
        yield from sorted(found, key=lambda crossing: crossing.speed)


def _meetings(speeds: Array, mode: CampbellMode, slope: float) -> Iterator[tuple[float, float]]:
    """Speed [rad/s] and damping ratio where a line of this slope [Hz s/rad] meets a mode.

    Linear between the speeds; below the lowest one the mode stays as it is there.
    """
    first = mode.frequency[0], mode.damping_ratio[0]
    if first[0] is not None and first[1] is not None and first[0] < slope * speeds[0]:
        yield first[0] / slope, first[1]
    places = list(zip(speeds.tolist(), mode.frequency, mode.damping_ratio))
    for (n_a, f_a, d_a), (n_b, f_b, d_b) in pairwise(places):
        if f_a is None or f_b is None or d_a is None or d_b is None:
            continue
        gap_a, gap_b = slope * n_a - f_a, slope * n_b - f_b
        if gap_a < 0.0 <= gap_b or gap_b < 0.0 <= gap_a:
            share = gap_a / (gap_a - gap_b)
            yield n_a + share * (n_b - n_a), d_a + share * (d_b - d_a)
