"""Clearances and alignment of the warm gearboxes as rows of the result."""

import math
from typing import Any

from rigdesign.coupling.losses import bearing_ratings
from rigdesign.results.thermal import ExpansionResult
from rigdesign.results.units import MM, MRAD, UM, ZERO
from rigdesign.results.warm_gearbox import (
    AxisAlignment,
    BearingClearance,
    BoreAlignment,
    CouplingAlignment,
    MeshClearance,
    SealClearance,
    WarmGearbox,
    WarmShaft,
)


def expansion_row(warm: WarmGearbox) -> ExpansionResult:
    """Clearances and alignment of one gearbox at one held stage, as drawn and warm."""
    return ExpansionResult(
        gearbox=warm.gearbox,
        stage=warm.stage,
        seal_gaps=[_seal_row(seal) for seal in warm.seals],
        shafts=[_shaft_row(shaft) for shaft in warm.shafts],
        gears=[_mesh_row(mesh) for mesh in warm.meshes],
        bearings=[_bearing_row(bearing) for bearing in warm.bearings],
        bores=[_bore_row(bore) for bore in warm.bores],
        axes=[_axis_row(axes) for axes in warm.axes],
        couplings=[_coupling_row(coupling) for coupling in warm.couplings],
    )


def _seal_row(seal: SealClearance) -> dict[str, Any]:
    return {
        "seal": seal.name,
        "shaft": seal.shaft,
        "cold_mm": MM * seal.as_drawn,
        "hot_min_mm": MM * seal.minimum,
        "hot_mean_mm": MM * seal.mean,
        "angle_of_min_deg": math.degrees(seal.angle_of_minimum),
        "by_hand_mm": MM * seal.by_hand,
        "axial_shift_mm": MM * seal.axial_shift,
        "angle_deg": [math.degrees(angle) for angle in seal.angles],
        "hot_mm": [MM * gap for gap in seal.gaps],
    }


def _shaft_row(shaft: WarmShaft) -> dict[str, Any]:
    return {
        "shaft": shaft.name,
        "growth_mm": MM * shaft.total,
        "growth_front_mm": MM * shaft.front,
        "growth_rear_mm": MM * shaft.rear,
        "free_expansion_mm": MM * shaft.free,
        "axial_play_cold_mm": MM * shaft.play_as_drawn,
        "axial_play_hot_mm": MM * shaft.play,
    }


def _mesh_row(mesh: MeshClearance) -> dict[str, Any]:
    pinion, wheel = mesh.bulk_temperatures
    return {
        "gear_pair": mesh.name,
        "centre_distance_cold_mm": MM * mesh.centre_distance_as_drawn,
        "centre_distance_hot_mm": MM * mesh.centre_distance,
        "backlash_cold_mm": MM * mesh.backlash_as_drawn,
        "backlash_hot_mm": MM * mesh.backlash,
        "tip_clearance_cold_mm": MM * mesh.tip_clearance_as_drawn,
        "tip_clearance_hot_mm": MM * mesh.tip_clearance,
        "inclination_mrad": MRAD * mesh.inclination,
        "skew_mrad": MRAD * mesh.skew,
        "bulk_pinion_degC": pinion - ZERO,
        "bulk_wheel_degC": wheel - ZERO,
    }


def _bearing_row(bearing: BearingClearance) -> dict[str, Any]:
    return {
        "bearing": bearing.name,
        "diametral_clearance_cold_um": UM * bearing.clearance_as_drawn,
        "diametral_clearance_hot_um": UM * bearing.clearance,
        "bore_ovality_um": UM * bearing.bore_ovality,
        "film_temperature_degC": bearing.film_temperature - ZERO,
        **bearing_ratings(bearing),
    }


def _bore_row(bore: BoreAlignment) -> dict[str, Any]:
    return {
        "bearing": bore.bearing,
        "tilt_mrad": MRAD * bore.tilt,
        "tilt_lateral_mrad": MRAD * bore.tilt_lateral,
        "tilt_vertical_mrad": MRAD * bore.tilt_vertical,
        "tilt_over_width_um": UM * bore.tilt * bore.width,
        "out_of_round_um": UM * bore.out_of_round,
        "second_harmonic_um": UM * bore.second_harmonic,
        "long_axis_deg": math.degrees(bore.long_axis),
        "out_of_round_share": bore.out_of_round_share,
    }


def _axis_row(axes: AxisAlignment) -> dict[str, Any]:
    return {
        "gear_pair": axes.mesh,
        "centre_distance_change_um": UM * axes.centre_distance_change,
        "face_width_mm": MM * axes.face_width,
        "inclination_um": UM * axes.inclination,
        "recommended_inclination_um": UM * axes.recommended_inclination,
        "skew_um": UM * axes.skew,
        "recommended_skew_um": UM * axes.recommended_skew,
    }


def _coupling_row(coupling: CouplingAlignment) -> dict[str, Any]:
    as_set, warm = coupling.as_set, coupling.warm
    lateral, vertical = coupling.moved
    return {
        "coupling": coupling.coupling,
        "first": coupling.shown(0),
        "second": coupling.shown(1),
        "offset_cold_mm": MM * as_set.radial_offset,
        "offset_hot_mm": MM * warm.radial_offset,
        "lateral_hot_mm": MM * warm.lateral,
        "vertical_hot_mm": MM * warm.vertical,
        "angle_cold_mrad": MRAD * as_set.angle,
        "angle_hot_mrad": MRAD * warm.angle,
        "ends_nearer_mm": MM * coupling.ends_nearer,
        "recommended_cold_lateral_mm": -MM * lateral,
        "recommended_cold_vertical_mm": -MM * vertical,
    }
