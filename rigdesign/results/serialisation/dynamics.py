"""Dynamic loads as rows of the result."""

import math
from typing import Any

from dynamics.gear.pair import GearPair
from dynamics.rotor.torsional_modes import DampingRecord, LoopMode
from rigdesign.coupling.mesh_models import MeshModel
from rigdesign.results.dynamics import RootStressHistory
from rigdesign.results.loads import ModeCrossing, RootStressPath, StageBracing
from rigdesign.results.units import MM, MPA, RPM


def root_stress_row(path: RootStressPath) -> RootStressHistory:
    """Root stress of one gear over its rolling angle."""
    return RootStressHistory(
        gear=path.gear,
        stage=path.stage,
        rolling_angle_deg=[math.degrees(angle) for angle in path.rolling_angle],
        dynamic_MPa=[stress * MPA for stress in path.dynamic],
        quasi_static_MPa=[stress * MPA for stress in path.quasi_static],
        source=path.source,
    )


def mode_row(number: int, mode: LoopMode) -> dict[str, Any]:
    """A mode of the closed loop."""
    return {
        "mode": number,
        "frequency_Hz": mode.frequency,
        "damping_ratio": mode.damping_ratio,
        "shape": mode.name,
        "largest_at": mode.largest,
    }


def mode_crossing_row(crossing: ModeCrossing) -> dict[str, Any]:
    """An order that meets a mode of the closed loop."""
    return {
        "kind": crossing.kind,
        "order_of": crossing.order_of,
        "mode": crossing.mode,
        "shape": crossing.shape,
        "frequency_Hz": crossing.frequency,
        "damping_ratio": crossing.damping_ratio,
        "harmonic": crossing.harmonic,
        "speed_rpm": crossing.speed * RPM,
        "gain": crossing.gain,
    }


def damping_row(record: DampingRecord) -> dict[str, Any]:
    """Damping of one joint or mesh; a joint without damping has no corner frequency."""
    corner = record.corner_frequency
    return {
        "joint": record.name,
        "kind": record.kind,
        "damping_ratio": record.damping_ratio,
        "corner_frequency_Hz": corner if math.isfinite(corner) else None,
        "own_frequency_Hz": record.own_frequency,
        "warning": record.warning,
    }


def bracing_row(bracing: StageBracing) -> dict[str, Any]:
    """Bracing of one held stage, as set and warm."""
    warm, as_set = bracing.drift.warm, bracing.drift.initial
    return {
        "stage": bracing.stage,
        "mode": warm.mode,
        "torque_Nm": float(warm.torque[0]),
        "twist_deg": math.degrees(warm.twist),
        "axial_shift_mm": MM * warm.shift,
        "half_gear_rotation_deg": math.degrees(warm.rotation),
        "actuator_force_N": warm.actuator_force,
        "spline_friction_N": warm.friction_force,
        "loop_stiffness_kNm_rad": 1e-3 * warm.loop_stiffness,
        "torque_cold_Nm": float(as_set.torque[0]),
        "torque_hot_Nm": float(warm.torque[0]),
        "axial_shift_cold_mm": MM * as_set.shift,
    }


def _diameters(radii: tuple[float, float]) -> str:
    """Of pinion and wheel [mm], to the micrometre."""
    return f"{2.0 * MM * radii[0]:.3f} / {2.0 * MM * radii[1]:.3f}"


def geometry_row(drawn: GearPair, model: MeshModel) -> dict[str, float | str]:
    """Gear data of one mesh as drawn, with those of the warm ``model`` that differ."""
    warm = model.pair
    return {
        "teeth": f"{drawn.teeth[0]} / {drawn.teeth[1]}",
        "normal_module_mm": MM * drawn.normal_module,
        "pressure_angle_deg": math.degrees(drawn.pressure_angle),
        "helix_angle_deg": math.degrees(drawn.helix_angle),
        "profile_shifts": f"{drawn.profile_shifts[0]:.4f} / {drawn.profile_shifts[1]:.4f}",
        "reference_diameters_mm": _diameters(drawn.reference_radii),
        "tip_diameters_cold_mm": _diameters(drawn.tip_radii),
        "tip_diameters_hot_mm": _diameters(warm.tip_radii),
        "root_diameters_mm": _diameters(drawn.root_radii),
        "transverse_contact_ratio": drawn.transverse_contact_ratio,
        "total_contact_ratio": drawn.total_contact_ratio,
        "centre_distance_cold_mm": MM * drawn.centre_distance,
        "centre_distance_hot_mm": MM * warm.centre_distance,
        "transverse_contact_ratio_hot": warm.transverse_contact_ratio,
        "mean_mesh_stiffness_N_um": 1e-6 * model.whole.mean_stiffness,
        "friction_coefficient": model.friction.value,
    }
