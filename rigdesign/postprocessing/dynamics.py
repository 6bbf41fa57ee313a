"""Dynamic loads of the solved rig: modes, loads of the meshes, root stress, resonances, bracing."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.bracing import BracingDrift, LoopBracing, drift
from dynamics.rotor.static_loop import LoopLoad, port_model, solve_static
from dynamics.rotor.torsional_modes import DampingRecord, LoopMode, damping_audit, loop_crossings
from dynamics.tooth.root_field import PairForces
from dynamics.vibration.time_response import EnvelopeWindows, TimeResponse, split_lift_off
from rigdesign.base.part_name import MeshName
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.loop import PointResult, governing_point
from rigdesign.coupling.mesh_models import laws_of, mesh_models
from rigdesign.coupling.preloaded_loop import shifted_gear, signed_torque
from rigdesign.coupling.time_run import LEAST_TORQUE, schedule_of, stage_names
from rigdesign.postprocessing import root
from rigdesign.postprocessing.curves import (
    HARMONICS,
    LEAST_GAIN,
    Curves,
    chosen,
    dwell_speeds,
    held_modes,
    own_ratio,
)
from rigdesign.postprocessing.resonances import mesh_resonances
from rigdesign.postprocessing.tooth_history import tooth_histories
from rigdesign.results.check import Role
from rigdesign.results.dynamics import RampHistory
from rigdesign.results.loads import (
    ContactLoss,
    MeshLoads,
    MeshResonance,
    ModeCrossing,
    RootStressPath,
    RootStressRatio,
    StageBracing,
    StageLoad,
    UnsolvedSpeed,
)
from rigdesign.results.teeth import ToothHistory
from rigdesign.results.units import RPM
from rigdesign.rig.model import Rig

EVERY = 2
"""Instants of the periodic responses at which root stress over speed is taken: of 512 in a mesh period every second one
leaves the ratio within 0.0006."""
MOST_SPEEDS = 60
"""Speeds at which root stress is taken, as of `chosen`: a figure shows it, around dwells a check asks for it."""
HIGHEST_MODE = 25e3
"""Natural frequencies are listed up to here [Hz]: the mesh frequency at 12,000 rpm and a quarter more."""


@dataclass(frozen=True)
class DynamicRun:
    """What the dynamic solvers returned."""

    points: tuple[PointResult, ...]
    curves: Curves
    time_run: TimeResponse | Callable[[], TimeResponse]
    """Over the whole schedule, or what waits for it."""

    @cached_property
    def ramp(self) -> TimeResponse:
        """The time run."""
        return self.time_run() if callable(self.time_run) else self.time_run

    @property
    def test(self) -> PointResult:
        """The held point that speaks for the rig."""
        return governing_point(self.points)


@dataclass(frozen=True)
class SolvedLoads:
    """Dynamic loads of a run as SI records, each solved when it is first asked for; see `DynamicLoads`."""

    rig: Rig
    run: DynamicRun

    @cached_property
    def meshes(self) -> Mapping[str, MeshLoads]:
        """By the label of the mesh."""
        names = enumerate(self.rig.mesh_names)
        return {self.rig.mesh_labels[name]: _SolvedMesh(self, mesh) for mesh, name in names}

    @cached_property
    def modes(self) -> tuple[LoopMode, ...]:
        """Of the closed loop, meshes at their mean stiffness."""
        return tuple(held_modes(self.rig, self.run.test))

    @cached_property
    def loop_crossings(self) -> tuple[ModeCrossing, ...]:
        """Up to the highest speed of the curves."""
        return tuple(mode_crossings(self.rig, self.modes, max(self.run.curves.response.speeds)))

    @cached_property
    def damping(self) -> tuple[DampingRecord, ...]:
        """Of springs and dampers at the governing held stage."""
        test = self.run.test
        return tuple(damping_audit(self.rig.twisting.parts(test.point.speed), laws_of(test.last.models)))

    @cached_property
    def bracing(self) -> tuple[StageBracing, ...]:
        """Of every held stage."""
        return tuple(
            StageBracing(stage=point.point.stage, drift=bracing_drift(self.rig, point))
            for point in self.run.points
        )

    @cached_property
    def teeth(self) -> Mapping[str, ToothHistory]:
        """Of every loaded gear ``gearbox.gear``."""
        return {found.gear: found for found in tooth_histories(self.rig, self.run.test)}


@dataclass(frozen=True)
class _SolvedMesh:
    """Loads of one mesh, by its number; see `MeshLoads`."""

    loads: SolvedLoads
    mesh: int

    @property
    def role(self) -> Role:
        rig = self.loads.rig
        return rig.mesh(rig.mesh_names[self.mesh])[0].role

    @cached_property
    def torque_peak(self) -> float:
        run = self.loads.run
        return max(
            torque_peak(run.ramp.windows, self.mesh),
            *(float(p.last.response.maximum[self.mesh]) for p in run.points if p.last.response is not None),
        )

    @cached_property
    def stage_loads(self) -> tuple[StageLoad, ...]:
        return tuple(stage_loads(self.loads.rig, self.loads.run.ramp, self.mesh))

    @cached_property
    def contact_losses(self) -> tuple[ContactLoss, ...]:
        return tuple(contact_losses(self.loads.rig, self.loads.run.ramp, self.mesh))

    @cached_property
    def resonances(self) -> tuple[MeshResonance, ...]:
        return tuple(mesh_resonances(self.loads.rig, self.loads.run.curves, self.mesh, self.loads.modes))

    @cached_property
    def unsolved(self) -> tuple[UnsolvedSpeed, ...]:
        return tuple(unsolved(self.loads.rig, self.loads.run, self.mesh))

    @cached_property
    def root_stress(self) -> tuple[RootStressPath, ...]:
        rig, mesh = self.loads.rig, self.mesh
        names = rig.mesh_gears(rig.mesh_names[mesh])
        radii = self.loads.run.test.last.models[mesh].pair.base_radii
        paths = []
        for gear in (0, 1):
            stage = max(self._held, key=lambda held: root.peak(self._held[held].dynamic[gear]))
            found = self._held[stage]
            own = root.StressedGear(names[gear].part, stage, radii[gear], found.roots.source)
            paths.append(root.over_path(own, found.dynamic[gear], found.static[gear]))
        return tuple(paths)

    @cached_property
    def root_stress_ratios(self) -> tuple[RootStressRatio, ...]:
        """Over the governing curve (`chosen`); none where the roots carry nothing at the held stage."""
        rig, run, mesh = self.loads.rig, self.loads.run, self.mesh
        test = self._held[run.test.point.stage]
        dwells = [rig.pinion_speed(speed) for speed in dwell_speeds(rig)]
        model, points = run.test.last.models[mesh], chosen(run.curves.response.points, MOST_SPEEDS, dwells)
        roots, ratios = test.roots.at_highest(test.forces), []
        if not all(root.peak(test.static[gear]) for gear in (0, 1)):
            return ()
        for response, forces in zip(points, root.dynamic_forces(model, points, mesh, EVERY)):
            stresses = roots.highest(forces)
            pinion, wheel = (root.peak(stresses[gear]) / root.peak(test.static[gear]) for gear in (0, 1))
            speed = own_ratio(rig, mesh) * response.speed
            ratios.append(RootStressRatio(speed=speed, pinion=pinion, wheel=wheel))
        return tuple(ratios)

    @cached_property
    def _held(self) -> "Mapping[str, _HeldRoots]":
        """Root stress at every held stage."""
        return {p.point.stage: _stresses(self.loads.rig, p, self.mesh) for p in self.loads.run.points}


def numbered(modes: Sequence[LoopMode]) -> list[tuple[int, LoopMode]]:
    """The listed modes with their numbers: 1 for the lowest that oscillates, 0 for rigid rotation."""
    rigid = sum(mode.frequency == 0.0 for mode in modes)
    listed = [mode for mode in modes if mode.frequency <= HIGHEST_MODE]
    return [(max(0, number), mode) for number, mode in enumerate(listed, start=1 - rigid)]


def mode_crossings(rig: Rig, modes: Sequence[LoopMode], top: float) -> Iterator[ModeCrossing]:
    """Crossings of the closed loop's modes with orders of meshes that excite them and of shafts, up to a speed of the
    first pinion [rad/s]."""
    listed = dict(numbered(modes))
    highest = rig.drive_speed(1.0) / rig.pinion_speed(1.0) * top
    for crossing in loop_crossings(rig.drivetrain, list(listed.values()), highest, HARMONICS):
        if crossing.kind == "mesh" and crossing.gain < LEAST_GAIN:
            continue
        yield ModeCrossing(
            kind=crossing.kind,
            order_of=rig.mesh_labels[MeshName.read(crossing.source)]
            if crossing.kind == "mesh"
            else crossing.source,
            mode=crossing.mode,
            shape=listed[crossing.mode].name,
            frequency=crossing.frequency,
            damping_ratio=crossing.damping_ratio,
            harmonic=crossing.harmonic,
            speed=crossing.own_speed,
            gain=crossing.gain,
        )


@dataclass(frozen=True)
class _HeldRoots:
    """Root stress of pinion and wheel at a held point, and the static forces behind it."""

    roots: root.MeshRoots
    dynamic: root.Pair
    static: root.Pair
    forces: PairForces


def _stresses(rig: Rig, point: PointResult, mesh: int) -> _HeldRoots:
    assert point.last.system is not None and point.last.response is not None
    ports = port_model(point.last.system, laws_of(point.last.models))
    state = solve_static(ports, LoopLoad(torque=signed_torque(rig, point.point)))
    model = point.last.models[mesh]
    roots = root.mesh_roots(rig, model)
    (acting,) = root.dynamic_forces(model, [point.last.response], mesh)
    still = root.static_forces(model, state, ports, mesh)
    return _HeldRoots(roots, roots.highest(acting), roots.highest(still), still)


def unsolved(rig: Rig, run: DynamicRun, mesh: int) -> Iterator[UnsolvedSpeed]:
    """Speeds at which a curve has no point, each with what the solvers said."""
    for name, (_, curve) in run.curves.named.items():
        for speed, reason in curve.failed:
            yield UnsolvedSpeed(curve=name, speed=own_ratio(rig, mesh) * speed, reason=reason)


def bracing_drift(rig: Rig, point: PointResult) -> BracingDrift:
    """The bracing of one held point, as set and then warmed up."""
    system = point.last.system
    assert system is not None
    initial = laws_of(mesh_models(rig, point.point, initial_state(rig, point.point)))
    gear = shifted_gear(rig)
    mode = rig.case.power_circuit.bracing.mode
    if mode == "torque_controlled" and gear is None:
        mode = "twist_held"
    return drift(
        system,
        initial,
        laws_of(point.last.models),
        signed_torque(rig, point.point),
        LoopBracing(mode=mode, gear=gear),
    )


# The time run over the schedule as records: envelopes, loads of every stage, loss of contact by stage.

Array = NDArray[np.float64]


def bounds(windows: EnvelopeWindows, mesh: int) -> tuple[Array, Array, Array]:
    """Lowest, mean and highest torque of a mesh in every window [N m], positive on the flank that carries the run."""
    sign = -1.0 if windows.mean[mesh].sum() < 0.0 else 1.0
    edges = sign * windows.least[mesh], sign * windows.greatest[mesh]
    return np.minimum(*edges), sign * windows.mean[mesh], np.maximum(*edges)


def torque_peak(windows: EnvelopeWindows, mesh: int) -> float:
    """Highest dynamic torque of the run [N m], whichever flank carries."""
    return float(max(np.abs(windows.least[mesh]).max(), np.abs(windows.greatest[mesh]).max()))


def stage_loads(rig: Rig, ramp: TimeResponse, mesh: int) -> Iterator[StageLoad]:
    """Load of one mesh in every stage that turns under torque, by the envelopes of the time run."""
    low, mean, high = bounds(ramp.windows, mesh)
    speed = own_ratio(rig, mesh) * ramp.windows.speed
    stages = np.array(_window_stages(rig, ramp))
    for stage in schedule_of(rig).stages:
        own = np.flatnonzero((stages == stage.name) & (mean > LEAST_TORQUE) & (speed > 0.0))
        if own.size == 0 or max(stage.speed) <= 0.0:
            continue
        worst, loosest = own[np.argmax(high[own] / mean[own])], own[np.argmin(low[own] / mean[own])]
        yield StageLoad(
            stage=stage.name,
            dynamic_factor=float(high[worst] / mean[worst]),
            speed=float(speed[worst]),
            mean=float(mean[worst]),
            peak=float(high[own].max()),
            least=float(low[own].min()),
            least_share=float(low[loosest] / mean[loosest]),
            least_share_speed=float(speed[loosest]),
            least_share_mean=float(mean[loosest]),
        )


def contact_losses(rig: Rig, ramp: TimeResponse, mesh: int) -> Iterator[ContactLoss]:
    """Intervals of the run in which a mesh kept losing contact, cut at the ends of the stages."""
    schedule = schedule_of(rig)
    own = [interval for interval in ramp.lift_off if interval.mesh == mesh]
    pieces = split_lift_off(ramp.windows, own, schedule.starts[1:-1])
    middles = np.array([0.5 * (piece.start + piece.end) for piece in pieces])
    for piece, name in zip(pieces, stage_names(schedule, middles) if pieces else []):
        yield ContactLoss(
            stage=name,
            start=piece.start,
            end=piece.end,
            share=piece.out_of_contact,
            longest_gap=piece.longest_gap,
        )


def ramp_history(rig: Rig, ramp: TimeResponse) -> RampHistory:
    """Envelopes of the time run in windows."""
    windows = ramp.windows
    command = schedule_of(rig).at(_middles(ramp))
    drive = np.interp(windows.time, ramp.time, ramp.drive_torque)
    torque = {}
    for mesh, name in enumerate(rig.mesh_names):
        low, mean, high = bounds(windows, mesh)
        torque[rig.mesh_labels[name]] = {
            "mean": mean.tolist(),
            "maximum": high.tolist(),
            "minimum": low.tolist(),
        }
    return RampHistory(
        time_s=windows.time.tolist(),
        speed_rpm=(windows.speed * RPM).tolist(),
        stage=_window_stages(rig, ramp),
        target_torque_Nm=command.torque.tolist(),
        drive_torque_Nm=drive.tolist(),
        torque=torque,
    )


def _middles(ramp: TimeResponse) -> Array:
    return np.asarray(ramp.windows.time - 0.5 * ramp.windows.duration)


def _window_stages(rig: Rig, ramp: TimeResponse) -> list[str]:
    """Stage of every window, by its middle."""
    return stage_names(schedule_of(rig), _middles(ramp))
