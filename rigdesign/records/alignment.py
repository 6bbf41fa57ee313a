"""Alignment of the hot gearbox as records of the result: bores, axes of the gears, couplings."""

import math
from typing import Any

from rigdesign.coupling.alignment import (
    CouplingEnd,
    axial_closing,
    axis_deviation,
    clearance_share,
    coupled_ends,
    coupling_places,
)
from rigdesign.coupling.expansion import axes_of, bearing_expansion
from rigdesign.coupling.loop import PointResult
from rigdesign.rig.model import Rig
from thermal.expansion.expansion import Expansion

MM, UM, MRAD = 1e3, 1e6, 1e3


def bore_rows(rig: Rig, result: PointResult, name: str, shape: Expansion) -> list[dict[str, Any]]:
    """Tilt of every shaft in its bores and how far these are out of round."""
    rows = []
    for part, entry in rig.case.gearboxes[name].bearings.items():
        full = f"{name}.{part}"
        expansion = bearing_expansion(rig, name, shape, entry)
        found = expansion.bore_roundness
        share = clearance_share(found.peak_to_valley, result.last.coupling_state.bearing_clearance[full])
        rows.append(
            {
                "bearing": full,
                "tilt_mrad": MRAD * expansion.tilt,
                "tilt_lateral_mrad": MRAD * expansion.misalignment[0],
                "tilt_vertical_mrad": MRAD * expansion.misalignment[1],
                "tilt_over_width_um": UM * expansion.tilt * entry.width,
                "out_of_round_um": UM * found.peak_to_valley,
                "second_harmonic_um": UM * found.second_harmonic,
                "long_axis_deg": math.degrees(found.long_axis),
                "out_of_round_share": share,
            }
        )
    return rows


def axis_rows(rig: Rig, name: str, shape: Expansion) -> list[dict[str, Any]]:
    """Deviation of the axes of every mesh over its face width, beside what is recommended for its gears."""
    rows = []
    box = rig.case.gearboxes[name]
    for own, mesh in box.meshes.items():
        found = axis_deviation(rig, name, own, shape)
        axes = axes_of(rig, name, shape, (box.gears[mesh.pinion].shaft, box.gears[mesh.wheel].shaft))
        rows.append(
            {
                "gear_pair": f"{name}.{own}",
                "centre_distance_change_um": UM * axes.change,
                "face_width_mm": MM * found.face_width,
                "inclination_um": UM * found.inclination,
                "recommended_inclination_um": UM * found.recommended_inclination,
                "skew_um": UM * found.skew,
                "recommended_skew_um": UM * found.recommended_skew,
            }
        )
    return rows


def coupling_rows(rig: Rig, result: PointResult, name: str) -> list[dict[str, Any]]:
    """Alignment of every coupling that gearbox ``name`` tells of, cold and hot."""
    shapes = {box: expansion.deformed for box, expansion in result.last.expansion.items()}
    axes = {box: shape.axes for box, shape in shapes.items()}
    rows = []
    for place in (place for place in coupling_places(rig) if place.gearbox == name):
        cold, hot = coupled_ends(place, {}), coupled_ends(place, axes)
        moved = hot.offset[0] - cold.offset[0], hot.offset[1] - cold.offset[1]
        rows.append(
            {
                "coupling": place.name,
                "first": _told(place.first),
                "second": _told(place.second),
                "offset_cold_mm": MM * cold.radial_offset,
                "offset_hot_mm": MM * hot.radial_offset,
                "lateral_hot_mm": MM * hot.offset[0],
                "vertical_hot_mm": MM * hot.offset[1],
                "angle_cold_mrad": MRAD * cold.bend,
                "angle_hot_mrad": MRAD * hot.bend,
                "ends_nearer_mm": MM * axial_closing(place, shapes),
                "recommended_cold_lateral_mm": -MM * moved[0],
                "recommended_cold_vertical_mm": -MM * moved[1],
            }
        )
    return rows


def _told(end: CouplingEnd) -> str:
    """A shaft end with what is known of it."""
    return end.shaft if end.gearbox is not None else f"{end.shaft} (cold)"
