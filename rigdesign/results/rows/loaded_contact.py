"""Loaded contact as a row of the result."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from dynamics.contact.mesh_cycle import ContactPattern
from dynamics.contact.root_course import RootCourse
from dynamics.gear.pair import GearPair
from rigdesign.results.loaded_contact import EdgeContact, LoadedContact
from rigdesign.results.rows.gauge_stress import gauge_stress_row
from rigdesign.results.units import MPA

Array = NDArray[np.float64]
MM, UM = 1e3, 1e6
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
