"""The dynamic section of the result: loads, K_V(n), root stress, modes, resonances, bracing, ramp."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from dynamics.bracing import BracingDrift, drift
from dynamics.dynamic_factor import DynamicFactorCurve
from dynamics.dynamic_factor import resonances as find_resonances
from dynamics.modes import (
    LoopMode,
    damping_audit,
    loop_modes,
    order_crossings,
    sampling_audit,
    shaft_frequencies,
)
from dynamics.response import TimeResponse
from dynamics.static_loop import port_model, solve_static
from rigdesign.assemble import root
from rigdesign.assemble.curves import Curves, factor_points, iso_factor
from rigdesign.cold import cold_feedback
from rigdesign.coupling import PointResult, governing_point
from rigdesign.loads import laws_of, mesh_models, shifted_gear, signed_torque
from rigdesign.ramp_run import SLOT, schedule_of, stage_names
from rigdesign.results import (
    DynamicsResult,
    GearboxDynamics,
    RampHistory,
    RootStressHistory,
)
from rigdesign.rig.model import Rig

HIGHEST_MODE = 25e3
"""Natural frequencies are listed up to here [Hz]: the mesh frequency at 12,000 rpm and a quarter more."""
CROSSING_HARMONICS = 4
LEAST_PROMINENCE = 0.01
"""Prominence of a peak of the dynamic torque, as a share of the mean, from which it counts as a resonance."""
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
    modes = loop_modes(drivetrain, laws, HIGHEST_MODE)
    frequencies = shaft_frequencies(drivetrain)
    top = max(run.curves.speeds)
    sampling = sampling_audit(
        drivetrain, rig.drive_speed(run.test.point.speed), rig.case.numerics.sample_rate
    )[0]
    return DynamicsResult(
        gearboxes={
            box: gearbox_dynamics(rig, run, box, modes)
            for box in dict.fromkeys(n.split(".")[0] for n in rig.mesh_names)
        },
        natural_frequencies=[
            {"frequency_Hz": mode.frequency, "damping_ratio": mode.damping_ratio, "shape": mode.name}
            for mode in modes
        ],
        shaft_frequencies={name: [float(f) for f in values] for name, values in frequencies.items()},
        crossings=[
            {
                "gearbox": crossing.mesh.split(".")[0],
                "shaft": crossing.shaft,
                "mode": crossing.mode,
                "frequency_Hz": crossing.frequency,
                "harmonic": crossing.harmonic,
                "speed_rpm": crossing.speed * RPM,
            }
            for crossing in order_crossings(drivetrain, frequencies, top, CROSSING_HARMONICS)
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
    )


def gearbox_dynamics(rig: Rig, run: DynamicRun, box: str, modes: Sequence[LoopMode]) -> GearboxDynamics:
    """Loads of one gearbox: its first mesh speaks for it."""
    mesh = next(i for i, name in enumerate(rig.mesh_names) if name.split(".")[0] == box)
    name = rig.mesh_names[mesh]
    response = run.test.last.response
    assert response is not None
    speed = rig.shaft_speed(rig.mesh(name)[0].gears[_pinion(rig, name)].shaft, run.test.point.speed)
    iso = iso_factor(rig, name, float(response.mean[mesh]), speed)
    histories, factors = root_stresses(rig, run, mesh)
    return GearboxDynamics(
        role=rig.case.gearboxes[box].role,
        dynamic_factor=factor_points(rig, mesh, run.curves.response),
        dynamic_factor_variants={
            kind: factor_points(rig, mesh, curve) for kind, curve in run.curves.variants.items()
        },
        dynamic_torque_peak_Nm=float(
            max(response.maximum[mesh], np.abs(run.ramp.slots.greatest[mesh]).max())
        ),
        iso_factors=_flat(asdict(iso)),
        lift_off=lift_off(rig, run, mesh),
        resonances=resonances(rig, run, mesh, modes),
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
    """Histories of pinion and wheel at the test point, and dynamic over quasi-static peaks over speed."""
    system = rig.system
    assert system is not None
    last = run.test.last
    model = last.models[mesh]
    assert last.response is not None
    ports = port_model(system, laws_of(last.models))
    state = solve_static(ports, torque=signed_torque(rig, run.test.point))
    static = root.static_stress(model, state, ports, mesh)
    dynamic = root.dynamic_stress(model, last.response, mesh)
    names = rig.mesh_gears(rig.mesh_names[mesh])
    histories = [
        root.history(names[gear].split(".")[1], model.pair.base_radii[gear], dynamic[gear], static[gear])
        for gear in (0, 1)
    ]
    factors = []
    for point in run.curves.response.points:
        stresses = root.dynamic_stress(model, point, mesh)
        row = {"speed_rpm": point.speed * RPM}
        row |= {key: root.peak(stresses[i]) / root.peak(static[i]) for i, key in enumerate(root.GEARS)}
        factors.append(row)
    return histories, factors


def resonances(rig: Rig, run: DynamicRun, mesh: int, modes: Sequence[LoopMode]) -> list[dict[str, Any]]:
    """Peaks of the dynamic torque over speed, named by the mode and order that meet there.

    amplification is the peak over the level it stands on; dangerous means above a limit of the case.
    """
    points = run.curves.response.points
    if len(points) < 3:
        return []
    limits = rig.case.limits.dynamics
    curve = DynamicFactorCurve(
        speed=run.curves.response.speeds,
        factor=np.array([[p.dynamic_factor[mesh] for p in points]]),
        half_peak_to_peak=np.array([[p.dynamic_factor_half_peak_to_peak[mesh] for p in points]]),
        mean_torque=np.array([[p.mean[mesh] for p in points]]),
        amplitude=np.array([[0.5 * (p.maximum[mesh] - p.minimum[mesh]) for p in points]]),
        lift_off_share=np.array([[p.lift_off_share[mesh] for p in points]]),
    )
    teeth = rig.pairs[rig.mesh_names[mesh]].teeth[0]
    rows = []
    for peak in find_resonances(curve, least_prominence=LEAST_PROMINENCE):
        mode, harmonic = _nearest_mode(modes, peak.speed * teeth / (2.0 * math.pi))
        rows.append(
            {
                "mode": mode.name,
                "frequency_Hz": mode.frequency,
                "harmonic": harmonic,
                "speed_rpm": peak.speed * RPM,
                "force_share": peak.force_share,
                "amplification": peak.amplification,
                "dangerous": peak.amplification > limits.dangerous_amplification
                or peak.force_share > limits.dangerous_force_share,
            }
        )
    return rows


def _nearest_mode(modes: Sequence[LoopMode], mesh_frequency: float) -> tuple[LoopMode, int]:
    """The mode and mesh order whose frequencies lie closest."""
    moving = [mode for mode in modes if mode.frequency > 0.0]
    pairs = [(mode, harmonic) for mode in moving for harmonic in range(1, CROSSING_HARMONICS + 1)]
    return min(pairs, key=lambda pair: abs(math.log(pair[1] * mesh_frequency / pair[0].frequency)))


def lift_off(rig: Rig, run: DynamicRun, mesh: int) -> list[dict[str, Any]]:
    """Intervals of the run without tooth contact, by stage."""
    schedule = schedule_of(rig)
    return [
        {
            "stage": stage_names(schedule, np.array([interval.start]))[0],
            "start_s": interval.start,
            "end_s": interval.end,
            "share": interval.out_of_contact,
            "longest_gap_ms": 1e3 * interval.longest_gap,
        }
        for interval in run.ramp.lift_off
        if interval.mesh == mesh
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
    hot, cold = change.hot, change.cold
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
    cold = laws_of(mesh_models(rig, point.point, cold_feedback(rig, point.point)))
    gear = shifted_gear(rig)
    mode = power.bracing.mode
    if mode == "torque_controlled" and gear is None:
        mode = "twist_held"
    return drift(system, cold, laws_of(point.last.models), signed_torque(rig, point.point), mode, gear=gear)


def ramp_history(rig: Rig, ramp: TimeResponse) -> RampHistory:
    """Envelopes of the time run in slots."""
    schedule = schedule_of(rig)
    slots = ramp.slots
    middle = slots.time - 0.5 * SLOT
    command = schedule.at(middle)
    drive = np.interp(slots.time, ramp.time, ramp.drive_torque)
    signs = np.sign(slots.mean.sum(axis=1, keepdims=True))
    low, high = (
        np.minimum(signs * slots.least, signs * slots.greatest),
        np.maximum(signs * slots.least, signs * slots.greatest),
    )
    return RampHistory(
        time_s=[float(t) for t in slots.time],
        speed_rpm=[float(s) * RPM for s in slots.speed],
        stage=stage_names(schedule, middle),
        target_torque_Nm=[float(t) for t in command.torque],
        drive_torque_Nm=[float(t) for t in drive],
        torque={
            name.split(".")[0]: {
                "mean": [float(v) for v in signs[i, 0] * slots.mean[i]],
                "maximum": [float(v) for v in high[i]],
                "minimum": [float(v) for v in low[i]],
            }
            for i, name in enumerate(rig.mesh_names)
        },
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
