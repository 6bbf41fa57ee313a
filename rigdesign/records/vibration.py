"""Modes over speed and dynamic torques of the warm loop."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import is_

from dynamics.response.response_curve import CurvePoint
from rigdesign.coupling.loop import PointResult
from rigdesign.records.campbell import campbell
from rigdesign.records.curves import dense, response_solver
from rigdesign.records.dynamics import DynamicRun
from rigdesign.records.lateral import lateral_vibration, seal_whirls
from rigdesign.records.loop_states import LoopState, loop_states
from rigdesign.records.near_dwell import NearDwell, near_dwells
from rigdesign.records.run_torques import held_torques
from rigdesign.records.start_torque import StartResponse, start_response
from rigdesign.records.torques_over_speed import LoopOverSpeed, Solve, torques_over_speed
from rigdesign.results.lateral import LateralVibration
from rigdesign.results.loads import DynamicLoads
from rigdesign.results.vibration import CampbellRecord, HeldTorque, TorqueOverSpeed
from rigdesign.rig.model import Rig


@dataclass(frozen=True)
class LoopVibration:
    """What the warm loop does at its held stages and over speed, each part solved when it is first asked for.

    None of it needs the time run. run, loads : None where losses are given
    """

    rig: Rig
    points: tuple[PointResult, ...]
    run: DynamicRun | None
    loads: DynamicLoads | None

    def is_of(self, other: "LoopVibration") -> bool:
        """Whether it is that of the same rig, points and run."""
        same = self.rig is other.rig and self.run is other.run and self.loads is other.loads
        return same and all(map(is_, self.points, other.points)) and len(self.points) == len(other.points)

    def before_time_run(self) -> None:
        """Solve all that takes long, while another core is at the time run."""
        _ = self.lateral, self.seal_amplitudes, self.held_torques
        if self.run is not None:
            _ = self.near_dwells, self.torques, self.campbell, self.start

    @cached_property
    def lateral(self) -> LateralVibration | None:
        """Lateral vibration; None for shafts that only twist."""
        return lateral_vibration(self.rig, self.points)

    @cached_property
    def seal_amplitudes(self) -> Mapping[tuple[str, str], float]:
        """As `SolvedRig.seal_amplitudes`."""
        return {
            (point.point.stage, seal.seal): seal.amplitude
            for point in self.points
            for seal in seal_whirls(self.rig, point)
        }

    @cached_property
    def held_torques(self) -> tuple[HeldTorque, ...]:
        """With the teeth that the periodic responses were found with: those of ``points`` are warmed on the final mesh
        and stand at another approach."""
        points = self.points if self.run is None else self.run.points
        return tuple(torque for point in points for torque in held_torques(self.rig, point))

    @cached_property
    def near_dwells(self) -> Mapping[float, NearDwell]:
        """As `SolvedRig.near_dwells`."""
        return {} if self.run is None or self.loads is None else near_dwells(self.rig, self.run, self.loads)

    @cached_property
    def campbell(self) -> CampbellRecord:
        """Campbell diagram of a rig with a run."""
        assert self.loads is not None
        return campbell(self.rig, self._run.test, self._states, self.loads.modes)

    @cached_property
    def start(self) -> StartResponse | None:
        """Response of a rig with a run under the start torque; None where narrow resonances are not resolved."""
        return start_response(self.rig, self._run)

    @cached_property
    def torques(self) -> tuple[tuple[CurvePoint, ...], tuple[TorqueOverSpeed, ...]]:
        """Points of the governing curve, and the torque of every section and joint at each, of a rig with a run."""
        return torques_over_speed(
            LoopOverSpeed(self.rig, self._run.test.last, self._states),
            self._run.curves.response.points,
            more_speeds(self.rig, self._run),
        )

    @property
    def _run(self) -> DynamicRun:
        assert self.run is not None
        return self.run

    @cached_property
    def _states(self) -> Sequence[LoopState]:
        top = max(self._run.curves.response.speeds) / self.rig.pinion_speed(1.0)
        return loop_states(self.rig, self._run.test, float(top))


def more_speeds(rig: Rig, run: DynamicRun) -> Solve | None:
    """Finds stable responses of the governing curve at more speeds, where the curves are to show every resonance.

    Where only a march finds the motion, meshes lose contact and no resonance of a shaft is narrow.
    """
    if not dense(rig):
        return None
    speeds = run.curves.response.speeds
    limits = (float(min(speeds)), float(max(speeds)))
    return response_solver(rig, run.test.last, run.curves.torque, limits, stable_only=True)
