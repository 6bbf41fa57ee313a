"""Dynamic torque in shafts, joints and meshes over speed: the forces of the meshes drive the linear loop between them.

The loop has the matrices of the nearest of a few speeds (`loop_states`), around a dwell speed those at it; the forces
are those of every speed. Torsional resonances of the shafts are far narrower than what they do to the meshes, by which
the speeds of a curve were chosen: around their peaks the response is solved at more speeds.
"""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dynamics.rating.dynamic_factor import parabola_apex
from dynamics.tooth.law import MeshLaw
from dynamics.vibration.response_curve import CurvePoint, ResponseCurve
from dynamics.vibration.section_torque import SectionTorques, section_torques
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.loop_system import twist_rows_of
from rigdesign.coupling.mesh_models import laws_of
from rigdesign.coupling.preloaded_loop import periodic_laws
from rigdesign.postprocessing.loop_states import LoopState, dwell_speeds, is_around, nearest
from rigdesign.postprocessing.run_torques import section_swings
from rigdesign.results.vibration import TorqueOverSpeed, TorquePlace, TorqueSwing
from rigdesign.rig.model import Rig

ROUNDS = 3
"""Times at which the response is solved where peaks are expected, each nearer to them."""
FINE = 3e-4
"""Share of a speed within which a peak is not looked for again: less than half the bandwidth of steel that damps
itself. The highest peaks of the prototype's sections are within 0.2 % of those with steps halved nine times."""
LEAST_SHARE = 0.1
"""Half peak-to-peak torque of a peak that is looked at more closely, per mean torque of the first mesh."""
FLAT = 0.03
"""Share of a peak by which it stands above the lower of the speeds beside it, below which it is found."""

Array = NDArray[np.float64]
Swings = Mapping[TorquePlace, TorqueSwing]
Solve = Callable[[Sequence[float]], ResponseCurve]
"""Periodic responses at speeds of the first pinion [rad/s], rising."""


@dataclass(frozen=True)
class LoopOverSpeed:
    """Finds the torque of every section, joint and mesh at points of curves, with the gears of ``warm``."""

    rig: Rig
    warm: IterationResult
    states: Sequence[LoopState]
    _loops: dict[int, SectionTorques] = field(default_factory=dict, repr=False)

    def swings(self, point: CurvePoint) -> Swings:
        """Of every place."""
        stated = point.speed / self.rig.pinion_speed(1.0)
        near = (dwell for dwell in self._dwells if is_around(stated, dwell))
        around = min(near, key=lambda dwell: abs(dwell - stated), default=stated)
        system = nearest(self.states, around).system
        rows = twist_rows_of(self.rig) if not self._loops else self._any.rows
        if id(system) not in self._loops:
            self._loops[id(system)] = section_torques(system, self._laws(), rows)
        torque = self._loops[id(system)].over_period(point, self.warm.drags)
        found = {place: swing for place, _, swing in section_swings(rows, torque)}
        for mesh, name in enumerate(self.rig.mesh_names):
            found[TorquePlace(kind="mesh", part=self.rig.mesh_labels[name])] = mesh_swing(point, mesh)
        return found

    @cached_property
    def _dwells(self) -> tuple[float, ...]:
        return dwell_speeds(self.rig)

    @property
    def shear_per_torque(self) -> Mapping[str, float]:
        """Nominal torsional stress at the surface per torque by the name of a section [Pa/(N m)]."""
        return {one.name: one.shear_per_torque for one in self._any.rows.sections if one.kind == "shaft"}

    @property
    def _any(self) -> SectionTorques:
        return next(iter(self._loops.values()))

    def _laws(self) -> Sequence[MeshLaw]:
        return periodic_laws(self.rig, laws_of(self.warm.models))


def torques_over_speed(
    loop: LoopOverSpeed, points: Sequence[CurvePoint], solve: Solve | None
) -> tuple[tuple[CurvePoint, ...], tuple[TorqueOverSpeed, ...]]:
    """Points by rising speed, those of narrow peaks among them, and the torque of every place at each.

    solve : finds the response at more speeds, or none at some; None where the points are all there is
    """
    if not points:
        return (), ()
    found = {point.speed: (point, loop.swings(point)) for point in points}
    asked: set[float] = set()
    for _ in range(ROUNDS if solve is not None else 0):
        speeds = _expected_peaks(found, asked)
        if not speeds or solve is None:
            break
        asked.update(speeds)
        found |= {point.speed: (point, loop.swings(point)) for point in solve(speeds).points}
    kept = sorted({point.speed for point in points} | set(_peaks(found)))
    listed = [found[speed] for speed in kept]
    stress = loop.shear_per_torque
    return tuple(point for point, _ in listed), tuple(
        TorqueOverSpeed(
            place=place,
            swings=tuple(swings[place] for _, swings in listed),
            shear_per_torque=stress.get(place.name, 0.0),
        )
        for place in listed[0][1]
    )


Found = Mapping[float, tuple[CurvePoint, Swings]]


def _peaks(found: Found) -> Iterator[float]:
    """Speeds at which the alternating torque of a place has a peak that counts."""
    speeds, _, inner = _table(found)
    return (speeds[i] for i in np.flatnonzero(inner.any(axis=1)))


def _expected_peaks(found: Found, asked: Collection[float]) -> list[float]:
    """Rising speeds, not known yet, where peaks that are not flat are expected: near a resonance the inverse square of
    an amplitude is a parabola over speed, whatever the damping."""
    speeds, swing, peaks = _table(found, FLAT)
    known = np.array(sorted({*speeds, *asked}))
    new: list[float] = []
    for i, place in zip(*np.nonzero(peaks), strict=True):
        relative = np.maximum(swing[i - 1 : i + 2, place] / swing[i, place], 1e-3)
        peak = parabola_apex(np.array(speeds[i - 1 : i + 2]), relative**-2.0)
        if np.abs(np.append(known, new) - peak).min() > FINE * peak:
            new.append(peak)
    return sorted(new)


def _table(found: Found, above: float = 0.0) -> tuple[list[float], Array, NDArray[np.bool_]]:
    """Rising speeds (n,), half peak-to-peak of each place, and whether it peaks there (n, n_places); ends are no peaks.

    above : share of a peak by which it stands above one of the speeds beside it at least
    """
    speeds = sorted(found)
    swing = np.array([[one.half_peak_to_peak for one in found[speed][1].values()] for speed in speeds])
    least = LEAST_SHARE * np.array([abs(float(found[speed][0].mean[0])) for speed in speeds])
    peaks = np.zeros(swing.shape, bool)
    middle = swing[1:-1]
    peaks[1:-1] = (middle >= swing[:-2]) & (middle > swing[2:]) & (middle > least[1:-1, None])
    peaks[1:-1] &= middle - np.minimum(swing[:-2], swing[2:]) >= above * middle
    return speeds, swing, peaks


def mesh_swing(point: CurvePoint, mesh: int) -> TorqueSwing:
    """Torque of a mesh at its pinion."""
    high, low = float(point.maximum[mesh]), float(point.minimum[mesh])
    return TorqueSwing(
        mean=abs(float(point.mean[mesh])), half_peak_to_peak=0.5 * (high - low), peak=max(abs(high), abs(low))
    )
