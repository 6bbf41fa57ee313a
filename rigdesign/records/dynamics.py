"""Dynamic loads of the solved rig: modes, loads of the meshes, root stress, resonances, bracing."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from dynamics.contact.root_field import PairForces
from dynamics.drivetrain.bracing import BracingDrift, LoopBracing, drift
from dynamics.drivetrain.loop_crossings import loop_crossings
from dynamics.drivetrain.loop_load import LoopLoad
from dynamics.drivetrain.modes import LoopMode, damping_audit
from dynamics.drivetrain.static_loop import port_model, solve_static
from dynamics.response.time_response import TimeResponse
from rigdesign.coupling.braced_loop import shifted_gear, signed_torque
from rigdesign.coupling.initial_state import initial_state
from rigdesign.coupling.loop import PointResult, governing_point
from rigdesign.coupling.mesh_models import laws_of, mesh_models
from rigdesign.records import root
from rigdesign.records.curves import Curves, own_ratio
from rigdesign.records.loop_modes import held_modes
from rigdesign.records.resonances import HARMONICS, LEAST_GAIN, mesh_resonances
from rigdesign.records.time_run import contact_losses, stage_loads, torque_peak
from rigdesign.records.tooth_history import tooth_histories
from rigdesign.results.loads import (
    DynamicLoads,
    MeshLoads,
    ModeCrossing,
    RootStressPath,
    RootStressRatio,
    StageBracing,
    UnsolvedSpeed,
)
from rigdesign.rig.model import Rig

HIGHEST_MODE = 25e3
"""Natural frequencies are listed up to here [Hz]: the mesh frequency at 12,000 rpm and a quarter more."""


@dataclass(frozen=True)
class DynamicRun:
    """What the dynamic solvers returned."""

    points: tuple[PointResult, ...]
    curves: Curves
    ramp: TimeResponse

    @property
    def test(self) -> PointResult:
        """The held point that speaks for the rig."""
        return governing_point(self.points)


def dynamic_loads(rig: Rig, run: DynamicRun, *, checks_only: bool = False) -> DynamicLoads:
    """All of them as SI records.

    checks_only : without what no check asks for, the ratio of dynamic to quasi-static root stress over speed and the
        tooth histories of gears that are no idlers
    """
    assert rig.drivetrain is not None
    laws = laws_of(run.test.last.models)
    modes = held_modes(rig, run.test)
    return DynamicLoads(
        meshes={
            rig.mesh_labels[name]: mesh_loads(rig, run, mesh, modes, checks_only=checks_only)
            for mesh, name in enumerate(rig.mesh_names)
        },
        modes=tuple(modes),
        loop_crossings=tuple(mode_crossings(rig, modes, max(run.curves.response.speeds))),
        damping=tuple(damping_audit(rig.twisting.parts(run.test.point.speed), laws)),
        bracing=tuple(stage_bracing(rig, point) for point in run.points),
        teeth={found.gear: found for found in tooth_histories(rig, run.test, 2 if checks_only else 1)},
    )


def numbered(modes: Sequence[LoopMode]) -> list[tuple[int, LoopMode]]:
    """The listed modes with their numbers: 1 for the lowest that oscillates, 0 for rigid rotation."""
    rigid = sum(mode.frequency == 0.0 for mode in modes)
    listed = [mode for mode in modes if mode.frequency <= HIGHEST_MODE]
    return [(max(0, number), mode) for number, mode in enumerate(listed, start=1 - rigid)]


def mode_crossings(rig: Rig, modes: Sequence[LoopMode], top: float) -> Iterator[ModeCrossing]:
    """Crossings of the closed loop's modes with mesh and shaft orders, up to a speed of the first pinion [rad/s]."""
    assert rig.drivetrain is not None
    listed = dict(numbered(modes))
    highest = rig.drive_speed(1.0) / rig.pinion_speed(1.0) * top
    for crossing in loop_crossings(rig.drivetrain, list(listed.values()), highest, HARMONICS):
        yield ModeCrossing(
            kind=crossing.kind,
            order_of=rig.mesh_labels[crossing.source] if crossing.kind == "mesh" else crossing.source,
            mode=crossing.mode,
            shape=listed[crossing.mode].name,
            frequency=crossing.frequency,
            damping_ratio=crossing.damping_ratio,
            harmonic=crossing.harmonic,
            speed=crossing.own_speed,
            gain=crossing.gain,
            excited=crossing.gain >= LEAST_GAIN,
        )


def mesh_loads(
    rig: Rig, run: DynamicRun, mesh: int, modes: Sequence[LoopMode], *, checks_only: bool
) -> MeshLoads:
    """Loads of one mesh, by its number."""
    paths, ratios = root_stresses(rig, run, mesh, checks_only=checks_only)
    return MeshLoads(
        role=rig.mesh(rig.mesh_names[mesh])[0].role,
        torque_peak=max(
            torque_peak(run.ramp.windows, mesh),
            *(float(p.last.response.maximum[mesh]) for p in run.points if p.last.response is not None),
        ),
        stage_loads=tuple(stage_loads(rig, run.ramp, mesh)),
        contact_losses=tuple(contact_losses(rig, run.ramp, mesh)),
        resonances=tuple(mesh_resonances(rig, run.curves, mesh, modes)),
        unsolved=tuple(unsolved(rig, run, mesh)),
        root_stress=paths,
        root_stress_ratios=ratios,
    )


def root_stresses(
    rig: Rig, run: DynamicRun, mesh: int, *, checks_only: bool
) -> tuple[tuple[RootStressPath, ...], tuple[RootStressRatio, ...]]:
    """Root stress of pinion and wheel at the held stage that stresses them most, and its ratio over speed.

    The ratio of the highest dynamic to the highest quasi-static stress belongs to the governing held stage.
    """
    of_point = {point.point.stage: _stresses(rig, point, mesh) for point in run.points}
    names, radii = rig.mesh_gears(rig.mesh_names[mesh]), run.test.last.models[mesh].pair.base_radii
    paths = []
    for gear in (0, 1):
        stage = max(of_point, key=lambda held: root.peak(of_point[held].dynamic[gear]))
        found = of_point[stage]
        own = root.StressedGear(names[gear].split(".")[1], stage, radii[gear], found.roots.source)
        paths.append(root.over_path(own, found.dynamic[gear], found.static[gear]))
    test = of_point[run.test.point.stage]
    return tuple(paths), tuple(_over_speed(rig, run, mesh, test)) if not checks_only else ()


@dataclass(frozen=True)
class _HeldRoots:
    """Root stress of pinion and wheel at a held point, and the static forces behind it."""

    roots: root.MeshRoots
    dynamic: root.Pair
    static: root.Pair
    forces: PairForces


def _over_speed(rig: Rig, run: DynamicRun, mesh: int, test: _HeldRoots) -> Iterator[RootStressRatio]:
    """Highest dynamic over highest quasi-static root stress at every speed of the governing curve."""
    model, points = run.test.last.models[mesh], run.curves.response.points
    roots = test.roots.at_highest(test.forces)
    for response, forces in zip(points, root.dynamic_forces(model, points, mesh)):
        stresses = roots.highest(forces)
        pinion, wheel = (root.peak(stresses[gear]) / root.peak(test.static[gear]) for gear in (0, 1))
        speed = own_ratio(rig, mesh) * response.speed
        yield RootStressRatio(speed=speed, pinion=pinion, wheel=wheel)


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


def stage_bracing(rig: Rig, point: PointResult) -> StageBracing:
    """Bracing of one held stage."""
    return StageBracing(stage=point.point.stage, drift=bracing_drift(rig, point))


def bracing_drift(rig: Rig, point: PointResult) -> BracingDrift:
    """The bracing of one held point, as set and then warmed up."""
    system, power = point.last.system, rig.case.drivetrain
    assert system is not None and power is not None
    initial = laws_of(mesh_models(rig, point.point, initial_state(rig, point.point)))
    gear = shifted_gear(rig)
    mode = power.bracing.mode
    if mode == "torque_controlled" and gear is None:
        mode = "twist_held"
    return drift(
        system,
        initial,
        laws_of(point.last.models),
        signed_torque(rig, point.point),
        LoopBracing(mode=mode, gear=gear),
    )
