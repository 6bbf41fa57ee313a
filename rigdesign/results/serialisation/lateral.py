"""Lateral vibration as rows of the result."""

import math
from typing import Any

from dynamics.rotor.damped_modes import RigMode
from rigdesign.results.lateral import BearingWhirl, LateralVibration, Separation, StageLateral
from rigdesign.results.units import RPM, UM

PER_UM = 1e-6
"""N/um in a N/m."""


def lateral_row(found: LateralVibration) -> dict[str, Any]:
    """All stages and the whirl over speed; what has no end is None."""
    return {
        "stages": [_stage(stage) for stage in found.stages],
        "seats": [
            {
                "bearing": seat.bearing,
                "lateral_N_um": seat.lateral * PER_UM,
                "vertical_N_um": seat.vertical * PER_UM,
                "axial_N_um": None if seat.axial is None else seat.axial * PER_UM,
            }
            for seat in found.seats
        ],
        "curve": {
            "speed_rpm": [RPM * at.speed for at in found.curve],
            "bearings": [
                {
                    "bearing": first.bearing,
                    "orbit_um": [UM * at.bearings[i].amplitude for at in found.curve],
                    "clearance_um": None if first.clearance is None else UM * first.clearance,
                }
                for i, first in enumerate(found.curve[0].bearings if found.curve else ())
            ],
        },
    }


def _stage(stage: StageLateral) -> dict[str, Any]:
    margins = {id(one.mode): one for one in stage.separations}
    for one in reversed(stage.torsional):
        margins[id(one.mode)] = one
    return {
        "stage": stage.stage,
        "torque": stage.torque,
        "speed_rpm": RPM * stage.speed,
        "meshes": [
            {
                "mesh": mesh.mesh,
                "line": line,
                "force_N": force,
                "share": force / mesh.mean if mesh.mean else None,
            }
            for mesh in stage.meshes
            for line, force in mesh.forces.items()
        ],
        "modes": [
            _mode(mode, margins.get(id(mode))) | {"rigid_body": stage.as_rigid_body(mode)}
            for mode in stage.modes
        ],
        "bearings": [_bearing(bearing) for bearing in stage.bearings],
        "seals": [
            {"seal": seal.seal, "shaft": seal.shaft, "orbit_um": UM * seal.amplitude} for seal in stage.seals
        ],
    }


def _mode(mode: RigMode, against: Separation | None) -> dict[str, Any]:
    finite = math.isfinite(mode.amplification)
    return {
        "mode": mode.name,
        "family": mode.family,
        "shaft": mode.shaft,
        "frequency_Hz": mode.frequency,
        "logarithmic_decrement": mode.logarithmic_decrement,
        "amplification": mode.amplification if finite else None,
        "whirl": mode.whirl,
        "margin": None if against is None else against.margin,
        "required_margin": None if against is None else against.required,
    }


def _bearing(bearing: BearingWhirl) -> dict[str, Any]:
    return {
        "bearing": bearing.bearing,
        "shaft": bearing.shaft,
        "orbit_um": UM * bearing.amplitude,
        "minor_um": UM * bearing.minor,
        "clearance_um": None if bearing.clearance is None else UM * bearing.clearance,
        "share": bearing.clearance_share,
        "force_N": bearing.force,
        "static_load_N": bearing.static_load,
    }
