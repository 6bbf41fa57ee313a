"""The dynamic section of the result: loads, K_V(n), root stress, modes, resonances, bracing, ramp."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from dynamics.drivetrain.bracing import BracingDrift, LoopBracing, drift
from dynamics.drivetrain.loop_crossings import loop_crossings
from dynamics.drivetrain.loop_load import LoopLoad
from dynamics.drivetrain.modes import (
    LoopMode,
    damping_audit,
    loop_modes,
    order_crossings,
    sampling_audit,
    shaft_frequencies,
)
from dynamics.drivetrain.static_loop import port_model, solve_static
from dynamics.response.modal_model import DEFAULT_CUTOFF
from dynamics.response.time_response import TimeResponse
from rigdesign.coupling.initial_state import initial_state
from rigdesign.coupling.loads import laws_of, mesh_models, shifted_gear, signed_torque
from rigdesign.coupling.loop import PointResult, governing_point
from rigdesign.records import root
from rigdesign.records.curves import Curves, factor_points, iso_factor, own_ratio
from rigdesign.records.resonances import HARMONICS, LEAST_GAIN, resonance_rows
from rigdesign.records.time_run import lift_off, ramp_history, stage_loads, torque_peak
from rigdesign.results.result import (
    DynamicsResult,
    GearboxDynamics,
    RootStressHistory,
)
from rigdesign.rig.model import Rig

HIGHEST_MODE = 25e3
"""Natural frequencies are listed up to here [Hz]: the mesh frequency at 12,000 rpm and a quarter more."""
RPM = 30.0 / math.pi


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


def dynamics_result(rig: Rig, run: DynamicRun) -> DynamicsResult:
    """All of it as records."""
    drivetrain, system = rig.drivetrain, rig.system
    assert drivetrain is not None and system is not None
    models = run.test.last.models
    laws = laws_of(models)
    modes = loop_modes(drivetrain, laws, DEFAULT_CUTOFF)
    frequencies = shaft_frequencies(drivetrain)
    top = max(run.curves.response.speeds) * max(own_ratio(rig, m) for m in range(len(laws)))
    sampling = sampling_audit(
        drivetrain, rig.drive_speed(run.test.point.speed), rig.case.numerics.sample_rate
    )[0]
    return DynamicsResult(
        gearboxes={
            rig.mesh_labels[name]: gearbox_dynamics(rig, run, mesh, modes)
            for mesh, name in enumerate(rig.mesh_names)
        },
        natural_frequencies=[
            {
                "mode": number,
                "frequency_Hz": mode.frequency,
                "damping_ratio": mode.damping_ratio,
                "shape": mode.name,
                "largest_at": mode.largest,
            }
            for number, mode in _numbered(modes)
        ],
        shaft_frequencies={name: [float(f) for f in values] for name, values in frequencies.items()},
        crossings=[
            {
                "gearbox": rig.mesh_labels[crossing.mesh],
                "shaft": crossing.shaft,
                "mode": crossing.mode,
                "frequency_Hz": crossing.frequency,
                "harmonic": crossing.harmonic,
                "speed_rpm": crossing.speed * RPM,
            }
            for crossing in order_crossings(drivetrain, frequencies, top, HARMONICS)
        ],
        damping_audit=[
            {
                "joint": record.name,
                "kind": record.kind,
                "damping_ratio": record.damping_ratio,
                "corner_frequency_Hz": record.corner_frequency
                if math.isfinite(record.corner_frequency)
                else None,
                "own_frequency_Hz": record.own_frequency,
                "warning": record.warning,
            }
            for record in damping_audit(drivetrain, laws)
        ],
        sampling={
            "sample_rate_Hz": rig.case.numerics.sample_rate,
            "mesh_frequency_Hz": sampling.mesh_frequency,
            "samples_per_mesh": sampling.samples_per_mesh,
            "internal_steps_per_mesh": sampling.samples_per_mesh * rig.case.numerics.internal_steps,
        },
        bracing=[bracing_record(rig, point) for point in run.points],
        ramp=ramp_history(rig, run.ramp),
        torque_balance=[torque_balance(rig, point) for point in run.points],
        loop_crossings=list(loop_crossing_rows(rig, modes, max(run.curves.response.speeds))),
    )


def _numbered(modes: Sequence[LoopMode]) -> list[tuple[int, LoopMode]]:
    """The listed modes with their numbers: 1 for the lowest that swings, 0 for what turns without swinging."""
    rigid = sum(mode.frequency == 0.0 for mode in modes)
    listed = [mode for mode in modes if mode.frequency <= HIGHEST_MODE]
    return [(max(0, number), mode) for number, mode in enumerate(listed, start=1 - rigid)]


def loop_crossing_rows(rig: Rig, modes: Sequence[LoopMode], top: float) -> Iterator[dict[str, Any]]:
    """Crossings of the closed loop's modes with mesh and shaft orders, up to a speed of the first pinion [rad/s]."""
    assert rig.drivetrain is not None
    numbered = dict(_numbered(modes))
    highest = rig.drive_speed(1.0) / rig.pinion_speed(1.0) * top
    for crossing in loop_crossings(rig.drivetrain, list(numbered.values()), highest, HARMONICS):
        yield {
            "kind": crossing.kind,
            "order_of": rig.mesh_labels[crossing.source] if crossing.kind == "mesh" else crossing.source,
            "mode": crossing.mode,
            "shape": numbered[crossing.mode].name,
            "frequency_Hz": crossing.frequency,
            "damping_ratio": crossing.damping_ratio,
            "harmonic": crossing.harmonic,
            "speed_rpm": crossing.own_speed * RPM,
            "gain": crossing.gain,
            "excited": crossing.gain >= LEAST_GAIN,
        }


def gearbox_dynamics(rig: Rig, run: DynamicRun, mesh: int, modes: Sequence[LoopMode]) -> GearboxDynamics:
    """Loads of one mesh."""
    name = rig.mesh_names[mesh]
    response = run.test.last.response
    assert response is not None
    speed = rig.shaft_speed(rig.mesh(name)[0].gears[_pinion(rig, name)].shaft, run.test.point.speed)
    iso = iso_factor(rig, name, float(response.mean[mesh]), speed)
    histories, factors = root_stresses(rig, run, mesh)
    main = next(iter(run.curves.named))
    return GearboxDynamics(
        role=rig.mesh(name)[0].role,
        torque=main,
        dynamic_factor=factor_points(rig, mesh, run.curves.response),
        dynamic_factor_variants={
            kind: factor_points(rig, mesh, curve) for kind, curve in run.curves.variants.items()
        },
        dynamic_factor_at={
            other: factor_points(rig, mesh, curve)
            for other, (_, curve) in run.curves.named.items()
            if other != main
        },
        stage_loads=stage_loads(rig, run.ramp, mesh),
        dynamic_torque_peak_Nm=max(
            torque_peak(run.ramp.windows, mesh),
            *(float(p.last.response.maximum[mesh]) for p in run.points if p.last.response is not None),
        ),
        iso_factors=_flat(asdict(iso)),
        lift_off=lift_off(rig, run.ramp, mesh),
        resonances=resonance_rows(rig, run.curves, mesh, modes),
        unsolved=unsolved(rig, run, mesh),
        root_stress=histories,
        root_stress_factor=factors,
        geometry=geometry(rig, run.test, mesh),
    )


def _pinion(rig: Rig, name: str) -> str:
    box, mesh = rig.mesh(name)
    return box.meshes[mesh].pinion


def _flat(record: Mapping[str, Any]) -> dict[str, float | str]:
    """Every factor by its printed symbol; nested stiffness factors side by side."""
    flat: dict[str, float | str] = {}
    for key, value in record.items():
        if isinstance(value, Mapping):
            flat |= _flat(value)
        elif isinstance(value, int | float | str):
            flat[key] = value
    return flat


def root_stresses(
    rig: Rig, run: DynamicRun, mesh: int
) -> tuple[list[RootStressHistory], list[dict[str, float]]]:
    """Histories of pinion and wheel at the held stage that stresses them most, and the ratio over speed.

    The ratio of the highest dynamic to the highest quasi-static stress belongs to the governing held stage.
    """
    model = run.test.last.models[mesh]
    of_point = {point.point.stage: _stresses(rig, point, mesh) for point in run.points}
    names = rig.mesh_gears(rig.mesh_names[mesh])
    histories = []
    for gear in (0, 1):
        stage = max(of_point, key=lambda held: root.peak(of_point[held][0][gear]))
        dynamic, static = of_point[stage]
        own = names[gear].split(".")[1]
        histories.append(root.history(own, stage, model.pair.base_radii[gear], dynamic[gear], static[gear]))
    static = of_point[run.test.point.stage][1]
    factors = []
    points = run.curves.response.points
    for response, stresses in zip(points, root.dynamic_stresses(model, points, mesh)):
        row = {"speed_rpm": own_ratio(rig, mesh) * response.speed * RPM}
        row |= {key: root.peak(stresses[i]) / root.peak(static[i]) for i, key in enumerate(root.GEARS)}
        factors.append(row)
    return histories, factors


def _stresses(rig: Rig, point: PointResult, mesh: int) -> tuple[root.Pair, root.Pair]:
    """Dynamic and quasi-static root stress of pinion and wheel at a held point."""
    assert rig.system is not None and point.last.response is not None
    ports = port_model(rig.system, laws_of(point.last.models))
    state = solve_static(ports, LoopLoad(torque=signed_torque(rig, point.point)))
    model = point.last.models[mesh]
    return root.dynamic_stress(model, point.last.response, mesh), root.static_stress(
        model, state, ports, mesh
    )


def unsolved(rig: Rig, run: DynamicRun, mesh: int) -> list[dict[str, Any]]:
    """Speeds at which a curve has no point, each with what the solvers said."""
    curves = {name: curve for name, (_, curve) in run.curves.named.items()} | dict(run.curves.variants)
    return [
        {"curve": name, "speed_rpm": own_ratio(rig, mesh) * speed * RPM, "reason": reason}
        for name, curve in curves.items()
        for speed, reason in curve.failed
    ]


def geometry(rig: Rig, test: PointResult, mesh: int) -> dict[str, float | str]:
    """Gear data cold and warm."""
    cold, warm = rig.pairs[rig.mesh_names[mesh]], test.last.models[mesh].pair
    return {
        "teeth": f"{cold.teeth[0]} / {cold.teeth[1]}",
        "normal_module_mm": 1e3 * cold.normal_module,
        "helix_angle_deg": math.degrees(cold.helix_angle),
        "profile_shifts": f"{cold.profile_shifts[0]:.4f} / {cold.profile_shifts[1]:.4f}",
        "transverse_contact_ratio": cold.transverse_contact_ratio,
        "total_contact_ratio": cold.total_contact_ratio,
        "centre_distance_cold_mm": 1e3 * cold.centre_distance,
        "centre_distance_hot_mm": 1e3 * warm.centre_distance,
        "transverse_contact_ratio_hot": warm.transverse_contact_ratio,
        "mean_mesh_stiffness_N_um": 1e-6 * test.last.models[mesh].law.mean_stiffness,
        "friction_coefficient": test.last.models[mesh].friction.value,
    }


def bracing_record(rig: Rig, point: PointResult) -> dict[str, Any]:
    """Setting of one held stage, cold and hot."""
    change = bracing_drift(rig, point)
    hot, cold = change.warm, change.initial
    return {
        "stage": point.point.stage,
        "mode": hot.mode,
        "torque_Nm": float(hot.torque[0]),
        "twist_deg": math.degrees(hot.twist),
        "axial_shift_mm": 1e3 * hot.shift,
        "half_gear_rotation_deg": math.degrees(hot.rotation),
        "actuator_force_N": hot.actuator_force,
        "spline_friction_N": hot.friction_force,
        "loop_stiffness_kNm_rad": 1e-3 * hot.loop_stiffness,
        "torque_cold_Nm": float(cold.torque[0]),
        "torque_hot_Nm": float(hot.torque[0]),
        "axial_shift_cold_mm": 1e3 * cold.shift,
    }


def bracing_drift(rig: Rig, point: PointResult) -> BracingDrift:
    """The bracing of one held point, set cold and then warmed up."""
    system, power = rig.system, rig.case.drivetrain
    assert system is not None and power is not None
    cold = laws_of(mesh_models(rig, point.point, initial_state(rig, point.point)))
    gear = shifted_gear(rig)
    mode = power.bracing.mode
    if mode == "torque_controlled" and gear is None:
        mode = "twist_held"
    return drift(
        system,
        cold,
        laws_of(point.last.models),
        signed_torque(rig, point.point),
        LoopBracing(mode=mode, gear=gear),
    )


def torque_balance(rig: Rig, point: PointResult) -> dict[str, Any]:
    """Motor power against the losses of one held point [W]."""
    response = point.last.response
    assert response is not None
    drive = response.drive_torque * rig.drive_speed(point.point.speed)
    losses = math.fsum(placed.loss.power for placed in point.last.losses)
    return {
        "stage": point.point.stage,
        "drive_torque_Nm": response.drive_torque,
        "drive_power_W": drive,
        "losses_W": losses,
        "joints_W": drive - losses,
    }
