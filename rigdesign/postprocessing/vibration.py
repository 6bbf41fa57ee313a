"""Modes over speed and dynamic torques of the warm loop."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from operator import is_

import numpy as np

from dynamics.rotor.bearing import BearingState
from dynamics.rotor.bearing_state import RowSpring, RunningState
from dynamics.rotor.damped_modes import (
    LineLoads,
    LineWhirl,
    RigMode,
    bearing_forces,
    line_whirls,
    reduced_line_loads,
    rig_modes,
    whirl_at,
)
from dynamics.rotor.parts import speed_ratios
from dynamics.standards.api617_2014 import TORSIONAL_SEPARATION, separation_above, separation_below
from dynamics.vibration.response_curve import CurvePoint
from rigdesign.coupling.bearing_loads import bearing_loads, solve_bearings
from rigdesign.coupling.loop import PointResult, governing_point
from rigdesign.coupling.loop_system import running_state
from rigdesign.coupling.mesh_models import MeshModel
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.postprocessing.campbell import campbell
from rigdesign.postprocessing.curves import LoopState, dense, loop_states, response_solver
from rigdesign.postprocessing.dynamics import DynamicRun
from rigdesign.postprocessing.nearest_resonance import NearDwell, near_dwells
from rigdesign.postprocessing.run_torques import LoopOverSpeed, Solve, held_torques, torques_over_speed
from rigdesign.postprocessing.start_torque import StartResponse, start_response
from rigdesign.results.lateral import (
    BearingOrbit,
    BearingWhirl,
    LateralVibration,
    MeshWhirl,
    SealWhirl,
    SeatStiffness,
    Separation,
    StageLateral,
    Torque,
    WhirlCurve,
)
from rigdesign.results.loads import DynamicLoads
from rigdesign.results.vibration import CampbellRecord, HeldTorque, TorqueOverSpeed
from rigdesign.rig.model import Rig
from rigdesign.rig.shaft_motion import axis_rows


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


# Lateral vibration of the solved rig: modes, whirl and bearing forces with the bearings as they run.

HIGHEST, LEAST_HIGHEST = 3.0, 2000.0
"""Modes are listed up to this times the frequency of the fastest shaft, beyond twice a turn; at least to here [Hz]."""
BACKWARD = -0.8
"""Whirl below which unbalance does not excite a mode."""
SPEEDS = tuple(np.round(np.linspace(0.1, 1.3, 25), 3).tolist())
"""Of the curve, as shares of the highest held speed: 30 % beyond it, more than any separation margin."""


def lateral_vibration(rig: Rig, points: Sequence[PointResult]) -> LateralVibration | None:
    """Lateral vibration at the held stages and over speed; None for shafts that only twist."""
    if rig.shaft_model == "torsional" or not points:
        return None
    whirls = _Whirls(rig)
    stages = []
    for point in points:
        state = point.last.coupling_state
        stages.append(whirls.stage(point, state, point.last.bearings, "held"))
        idle = replace(state, mesh_torque=dict.fromkeys(state.mesh_torque, 0.0))
        stages.append(whirls.stage(point, idle, solve_bearings(rig, point.point, idle), "lost"))
    return LateralVibration(
        stages=tuple(stages), curve=whirls.curve(points), seats=tuple(seat_stiffnesses(rig))
    )


def seat_stiffnesses(rig: Rig) -> Iterator[SeatStiffness]:
    """Static stiffness of every elastic seat."""
    for support in rig.elastic.rig.supports:
        alone = 1.0 / np.diag(np.linalg.inv(support.stiffness)).reshape(-1, support.directions)
        for name, (lateral, vertical, *axial) in zip(support.bearings, alone.tolist(), strict=True):
            yield SeatStiffness(
                bearing=name, lateral=lateral, vertical=vertical, axial=axial[0] if axial else None
            )


def seal_whirls(rig: Rig, point: PointResult) -> tuple[SealWhirl, ...]:
    """Motion once a turn in every seal without contact at a held stage; none for shafts that only twist."""
    if rig.shaft_model == "torsional":
        return ()
    whirls = _Whirls(rig)
    last = point.last
    running = whirls.running(point.point, last.coupling_state, last.bearings, last.models)
    return tuple(whirls.seal_whirls(point, line_whirls(rig.elastic.slow, running, whirls.loads)))


@dataclass(frozen=True)
class _Whirls:
    """The rig whose whirl is asked, with what does not change from state to state."""

    rig: Rig

    def stage(
        self,
        point: PointResult,
        state: CouplingState,
        bearings: Mapping[str, BearingState],
        torque: Torque,
    ) -> StageLateral:
        """Modes of one stage; with its torque also whirl and separations."""
        rig = self.rig
        meshes = point.last.models if torque == "held" else ()
        running = self.running(point.point, state, bearings, meshes)
        turn = max(abs(ratio) for ratio in rig.speed_ratios.values()) * point.point.speed / (2.0 * np.pi)
        modes = rig_modes(rig.elastic.slow, running, max(HIGHEST * turn, LEAST_HIGHEST))
        found = StageLateral(
            stage=point.point.stage, torque=torque, speed=point.point.speed, modes=modes, highest_turn=turn
        )
        if torque == "lost":
            return found
        whirls = line_whirls(rig.elastic.slow, running, self.loads)
        return replace(
            found,
            bearings=tuple(self.bearing_whirls(running, state, whirls)),
            seals=tuple(self.seal_whirls(point, whirls)),
            meshes=tuple(self.mesh_whirls(point, whirls)),
            separations=tuple(_lateral_separations(rig, modes, point.point.speed)),
            torsional=tuple(_torsional_separations(rig, modes, point.point.speed)),
        )

    def curve(self, points: Sequence[PointResult]) -> WhirlCurve:
        """Bearings over speed under torque and temperatures of the governing stage."""
        rig, held = self.rig, governing_point(points)
        state, top = held.last.coupling_state, max(point.point.speed for point in points)
        speeds, found = [], []
        for share in SPEEDS:
            at = replace(held.point, speed=share * top)
            running = self.running(at, state, solve_bearings(rig, at, state), held.last.models)
            whirls = line_whirls(rig.elastic.slow, running, self.loads)
            speeds.append(at.speed)
            found.append(list(self.bearing_whirls(running, state, whirls)))
        return WhirlCurve(
            speed=tuple(speeds),
            bearings=tuple(
                BearingOrbit(
                    bearing=over_speed[0].bearing,
                    orbit=tuple(whirl.amplitude for whirl in over_speed),
                    clearance=over_speed[0].clearance,
                )
                for over_speed in zip(*found, strict=True)
            ),
        )

    def running(
        self,
        point: OperatingPoint,
        state: CouplingState,
        bearings: Mapping[str, BearingState],
        meshes: Sequence[MeshModel],
    ) -> RunningState:
        """The elastic rig with its bearings, meshes at their mean stiffness."""
        springs = tuple(self.mesh_spring(model) for model in meshes)
        return replace(running_state(self.rig, point, state, bearings), springs=springs)

    def mesh_spring(self, model: MeshModel) -> RowSpring:
        """Mean spring and damper of a mesh on the flanks that carry."""
        pinion, wheel = self.rig.elastic.port_rows[model.name]
        first, second = model.pair.base_radii
        return RowSpring(
            row=first * pinion - second * wheel,
            stiffness=model.whole.mean_stiffness,
            damping=model.whole.damping,
        )

    def bearing_whirls(
        self, running: RunningState, state: CouplingState, whirls: tuple[LineWhirl, ...]
    ) -> Iterator[BearingWhirl]:
        """Orbit of every journal against its seat, and the force that turns in the bearing."""
        reduced, loads = self.rig.elastic.slow, bearing_loads(self.rig, state)
        for name, _, entry in self.rig.bearings():
            orbits = whirl_at(whirls, reduced.ports[name][:2], self.sense(entry.shaft))
            forces = bearing_forces(reduced, running, whirls, name)
            largest = max(orbits.values(), key=lambda one: one.major, default=None)
            yield BearingWhirl(
                bearing=name,
                shaft=entry.shaft,
                orbits={line: one.major for line, one in orbits.items()},
                minor=0.0 if largest is None else largest.minor,
                clearance=state.bearing_clearance[name] if entry.has_film else None,
                force=sum(one.major for one in forces.values()),
                static_load=loads[name].radial,
            )

    def mesh_whirls(self, point: PointResult, whirls: tuple[LineWhirl, ...]) -> Iterator[MeshWhirl]:
        """Force once a turn in every mesh."""
        for model in point.last.models:
            spring = self.mesh_spring(model)
            row = self.rig.elastic.slow.rows(spring.row)
            yield MeshWhirl(
                mesh=model.name,
                forces={
                    whirl.line: float(
                        abs((spring.stiffness + 1j * whirl.frequency * spring.damping) * (row @ whirl.motion))
                    )
                    for whirl in whirls
                },
                mean=abs(point.last.coupling_state.mesh_torque[model.name]) / model.pair.base_radii[0],
            )

    def seal_whirls(self, point: PointResult, whirls: tuple[LineWhirl, ...]) -> Iterator[SealWhirl]:
        """Orbit of the shaft in every seal without contact; without a housing the larger one at its bearings."""
        reduced = self.rig.elastic.slow
        for box_name, box in self.rig.case.gearboxes.items():
            placed = self.seal_positions(box_name) if box_name in point.last.expansion else {}
            for seal, (shaft, position) in placed.items():
                rows = reduced.rows(axis_rows(self.rig, shaft, position)[1:])
                yield SealWhirl(
                    seal=seal, shaft=shaft, amplitude=_sum(whirl_at(whirls, rows, self.sense(shaft)))
                )
            if placed:
                continue
            for part, seals in box.seals.items():
                if not seals.end.touches:
                    at_bearings = [
                        _sum(whirl_at(whirls, reduced.ports[f"{box_name}.{name}"][:2], self.sense(b.shaft)))
                        for name, b in box.bearings.items()
                        if b.shaft == seals.shaft
                    ]
                    yield SealWhirl(
                        seal=f"{box_name}.{part}", shaft=seals.shaft, amplitude=max(at_bearings, default=0.0)
                    )

    def seal_positions(self, box: str) -> dict[str, tuple[str, float]]:
        """Shaft and place on it [m] of every seal of a housing, by the places of two bearings on shaft and housing."""
        model, entries = self.rig.models[box], self.rig.case.gearboxes[box].bearings.values()
        found = {}
        for seal in model.seals:
            pairs = sorted(
                (station.centre[0], entry.position)
                for entry in entries
                for station in model.bearings
                if entry.shaft == seal.shaft
                and station.bore_surface == f"bearing_bore_{entry.shaft}_{entry.side}"
                and entry.position is not None
            )
            if not pairs:
                continue
            (x, at), (far, beyond) = pairs[0], pairs[-1]
            slope = (beyond - at) / (far - x) if far > x else 1.0
            found[seal.name] = seal.shaft, at + slope * (seal.centre[0] - x)
        return found

    def sense(self, shaft: str) -> float:
        """1 where a shaft turns about +x, -1 the other way."""
        return float(np.sign(self.rig.elastic.model.spins[shaft]))

    @cached_property
    def loads(self) -> LineLoads:
        """What turns with every line."""
        return reduced_line_loads(self.rig.elastic.slow)


def _sum(orbits: Mapping[str, object]) -> float:
    return float(sum(one.major for one in orbits.values()))  # type: ignore[attr-defined]


def _lateral_separations(rig: Rig, modes: Sequence[RigMode], speed: float) -> Iterator[Separation]:
    """Lateral modes that unbalance excites, against the speed of the shaft that moves most."""
    for number, mode in enumerate(modes):
        if mode.family != "lateral" or mode.whirl < BACKWARD:
            continue
        own = rig.shaft_speed(mode.shaft, speed)
        margin = 2.0 * np.pi * mode.frequency / own - 1.0
        rule = separation_above if margin > 0.0 else separation_below
        yield Separation(
            mode=number, speed=own, harmonic=1, margin=float(margin), required=rule(mode.amplification)
        )


def _torsional_separations(rig: Rig, modes: Sequence[RigMode], speed: float) -> list[Separation]:
    """Torsional modes against once and twice a turn of every shaft, the nearest first."""
    found = []
    for own in {round(abs(rig.shaft_speed(shaft, speed)), 9) for shaft in speed_ratios(rig.drivetrain)}:
        for harmonic in (1, 2):
            for number, mode in enumerate(modes):
                if mode.family == "torsion":
                    margin = 2.0 * np.pi * mode.frequency / (harmonic * own) - 1.0
                    found.append(
                        Separation(
                            mode=number,
                            speed=own,
                            harmonic=harmonic,
                            margin=float(margin),
                            required=TORSIONAL_SEPARATION,
                        )
                    )
    return sorted(found, key=lambda one: abs(one.margin))
