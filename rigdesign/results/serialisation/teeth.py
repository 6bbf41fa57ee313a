"""Contact, flanks and root stress of the teeth as rows of the result."""

import math
from typing import Any

import numpy as np

from dynamics.gear.pair import GearPair
from dynamics.tooth.mesh_cycle import ContactPattern
from dynamics.tooth.root_field import RootCourse
from rigdesign.results.dynamics import ToothTurnHistory
from rigdesign.results.teeth import (
    DynamicRootCurve,
    DynamicRootRecord,
    EdgeContact,
    FlankRating,
    GaugeStress,
    LoadedContact,
    ToothHistory,
)
from rigdesign.results.units import MM, MPA, RPM, UM, ZERO

MICRO, MILLI = 1e6, 1e3
GEARS = ("pinion", "wheel")


def loaded_contact_row(contact: LoadedContact) -> dict[str, Any]:
    """Figures of the contact, pattern on the pinion flank, root stress of both gears over the rolling angle."""
    cycle = contact.cycle
    pair = cycle.points.pair
    # the back flanks run along the path the other way
    early, late = (cycle.early, cycle.late) if contact.flank == "front" else (cycle.late, cycle.early)
    return {
        "stage": contact.stage,
        "torque_Nm": contact.torque,
        "flank": contact.flank,
        "misalignment_um": UM * _misalignment(contact),
        "contact_ratio_geometric": pair.total_contact_ratio,
        "contact_ratio_no_load": contact.unloaded_contact_ratio,
        "contact_ratio": cycle.contact_ratio,
        "largest_share": float(cycle.load_share.max()),
        "early_contact": bool(early.any()),
        "late_contact": bool(late.any()),
        "transmission_error_um": UM * cycle.peak_to_peak,
        "approach_um": UM * float(cycle.approach.mean()),
        "mesh_stiffness_N_um": 1e-6 * float(cycle.tangent_stiffness.mean()),
        "K_H_beta": cycle.face_load_factor,
        "line_load_N_mm": 1e-3 * float(cycle.line_load.max()),
        "flank_pressure_MPa": MPA * cycle.flank_pressure,
        "edge_pressure_MPa": MPA * contact.edges.tip_pressure,
        "edge_contact": _edges(contact.edges),
        "pattern": _pattern(cycle.pattern(0), pair, contact.face_sense),
        "root_stress": {
            gear: _root(course, pair.base_radii[index], -1.0 if index else 1.0, contact.face_sense)
            for index, (gear, course) in enumerate(zip(GEARS, contact.roots, strict=True))
        },
        "root_stress_30_deg_tangent": _at_tangent(contact),
        "strain_gauges": [gauge_stress_row(gauge) for gauge in contact.gauges],
    }


def _misalignment(contact: LoadedContact) -> float:
    """Gap that the axes open over the common face width on the loaded flanks, positive at z > 0 [m]."""
    pair = contact.cycle.points.pair
    return contact.axes.gap_slope(pair)[0 if contact.flank == "front" else 1] * pair.face_width


def _edges(edges: EdgeContact) -> dict[str, Any]:
    """Where a flank carries at its ends, how high the pressure is and what it shares."""
    ends = edges.end_pressures
    return {
        "where": edges.where,
        "tip_pressure_pinion_MPa": MPA * edges.tip_pressures[0],
        "tip_pressure_wheel_MPa": MPA * edges.tip_pressures[1],
        "tip_share": edges.tip_share,
        "face_end_pressure_MPa": None if ends is None else [MPA * pressure for pressure in ends],
        "face_end_over_middle": edges.end_ratio,
    }


def _pattern(pattern: ContactPattern, pair: GearPair, sense: float) -> dict[str, Any]:
    """Pressure on the pinion over face and rolling angle from the pitch point, where the flank is touched.

    sense : face position z per face position of the contact
    """
    path = pattern.path_at(pair.base_helix_angle)
    touched = np.flatnonzero(pattern.touched.any(axis=1))
    rows, over = slice(touched[0], touched[-1] + 1), slice(None, None, int(sense))
    return {
        "rolling_angle_deg": np.degrees(path[rows, over] / pair.base_radii[0]).tolist(),
        "face_mm": (sense * MM * pattern.face[over]).tolist(),
        "pressure_MPa": (MPA * np.where(pattern.edge, 0.0, pattern.pressure))[rows, over].tolist(),
        "edge": pattern.edge[rows, over].tolist(),
    }


def _at_tangent(contact: LoadedContact) -> dict[str, Any]:
    """Highest stress of pinion and wheel at the 30 deg tangent, over the face."""
    if contact.at_tangent is None:
        return {}
    over = slice(None, None, int(contact.face_sense))
    return {
        gear: {
            "face_mm": (contact.face_sense * MM * course.face[over]).tolist(),
            "highest_MPa": (MPA * stress[over]).tolist(),
        }
        for gear, course, stress in zip(GEARS, contact.roots, contact.at_tangent, strict=True)
    }


def _root(course: RootCourse, base: float, turn: float, sense: float) -> dict[str, Any]:
    """Highest stress of the fillet over the face, by the rolling angle of the gear from the pitch point.

    turn : of the gear with growing path, 1 or -1; sense : face position z per face position of the contact
    """
    over_fillet = course.stress.max(axis=1)
    angle = turn * np.degrees(course.path / base)
    order = np.argsort(angle)
    face = course.highest_at[2]
    return {
        "rolling_angle_deg": angle[order].tolist(),
        "highest_MPa": (MPA * over_fillet.max(axis=1))[order].tolist(),
        "mid_face_MPa": (MPA * over_fillet[:, len(course.face) // 2])[order].tolist(),
        "largest_MPa": MPA * course.highest,
        "at_face_mm": sense * MM * float(course.face[face]),
        "stress_ratio": course.stress_ratio,
    }


def flank_rating_row(rating: FlankRating) -> dict[str, Any]:
    """Rating of one mesh at one held stage; None for what is not rated."""
    pinion, wheel = rating.pitting or (None, None)
    contact, films = rating.contact, rating.films
    return {
        "stage": rating.stage,
        "K_H_beta": rating.factors.face_load,
        "K_H_alpha": rating.factors.transverse,
        "K_H_basis": rating.sharing_basis,
        "sigma_H_pinion_MPa": None if pinion is None else MPA * pinion.stress,
        "S_H_pinion": None if pinion is None else pinion.safety,
        "sigma_H_wheel_MPa": None if wheel is None else MPA * wheel.stress,
        "S_H_wheel": None if wheel is None else wheel.safety,
        "bulk_degC": rating.bulk_temperature - ZERO,
        "bulk_basis": rating.bulk_basis,
        "contact_degC": None if contact is None else contact.highest - ZERO,
        "contact_friction": None if contact is None else contact.friction,
        "scuffing_degC": None if rating.scuffing_temperature is None else rating.scuffing_temperature - ZERO,
        "S_B": rating.scuffing_safety,
        "film_ratio_least": None if films is None else films.least,
        "film_ratio_at": None if films is None else films.thinnest,
        "film_ratio": {}
        if films is None
        else {point: float(ratio) for point, ratio in zip(films.points, films.ratio, strict=True)},
    }


def tooth_history_row(history: ToothHistory, *, rated: bool) -> ToothTurnHistory:
    """Curves of both fillets with what the root holds all the time.

    rated : whether the root safety of the gear takes R and mean stress
    """
    mean = history.mean
    return ToothTurnHistory(
        gear=history.gear,
        stage=history.stage,
        meshes=list(history.meshes),
        rotation_deg=[math.degrees(angle) for angle in history.turn.angle],
        leading_MPa=[MPA * (stress + mean.total) for stress in history.turn.leading.tolist()],
        trailing_MPa=[MPA * (stress + mean.total) for stress in history.turn.trailing.tolist()],
        mean_MPa={
            "centrifugal": MPA * mean.centrifugal,
            "press_fit": MPA * mean.press_fit,
            "total": MPA * mean.total,
        },
        fillet=history.fillet,
        highest_MPa=MPA * history.highest,
        lowest_MPa=MPA * history.lowest,
        R=history.stress_ratio,
        Y_M=history.mean_stress_factor,
        rated=rated,
        source=history.source,
    )


def gauge_stress_row(found: GaugeStress) -> dict[str, Any]:
    """Place, peak with strain and bridge output there, curve over the rolling angle of the gear."""
    point, curve = found.point, found.curve
    bridge, placed = point.bridge, point.placement
    highest = int(curve.stress.argmax())
    return {
        "name": found.name,
        "gear": found.gear,
        "tooth": found.tooth,
        "fillet": "front" if found.front else "back",
        "face_position_mm": MM * placed.face_position,
        "fillet_position_mm": MM * placed.fillet_position,
        "grid_mm": [MM * bridge.gauge.grid_length, MM * bridge.gauge.grid_width],
        "stress_state": point.surface.state,
        "peak_MPa": MPA * curve.peak,
        "peak_at_deg": float(np.degrees(curve.peak_angle)),
        "lowest_MPa": MPA * curve.lowest,
        "strain_um_m": MICRO * float(point.surface.strain(curve.peak)),
        "bridge": {
            "kind": bridge.kind,
            "supply_V": bridge.supply_voltage,
            "output_mV_V": MILLI * float(found.output[highest]),
            "output_mV": MILLI * float(found.output[highest]) * bridge.supply_voltage,
        },
        "rolling_angle_deg": np.degrees(curve.angle).tolist(),
        "stress_MPa": (MPA * curve.stress).tolist(),
    }


def dynamic_root_rows(record: DynamicRootRecord) -> dict[str, Any]:
    """Curves over the rolling angle and the speeds without one."""
    return {
        "curves": [_curve(curve) for curve in record.curves],
        "missing": [{"speed_rpm": one.speed * RPM, "reason": one.reason} for one in record.missing],
    }


def _curve(curve: DynamicRootCurve) -> dict[str, Any]:
    return {
        "gearbox": curve.mesh,
        "gear": curve.gear,
        "gauge": curve.gauge,
        "stage": curve.stage,
        "in_motion": curve.in_motion,
        "pinion_speed_rpm": curve.pinion_speed * RPM,
        "highest_MPa": max(curve.dynamic) * MPA,
        "highest_quasi_static_MPa": max(curve.quasi_static) * MPA,
        "ratio": curve.ratio,
        "highest_strain_um_m": max(curve.strain) * MICRO,
        "highest_strain_rate_per_s": curve.highest_rate,
        "rolling_angle_deg": np.degrees(curve.angle).tolist(),
        "dynamic_MPa": [stress * MPA for stress in curve.dynamic],
        "quasi_static_MPa": [stress * MPA for stress in curve.quasi_static],
        "strain_um_m": [strain * MICRO for strain in curve.strain],
        "strain_rate_per_s": list(curve.strain_rate),
        "source": curve.source,
    }
