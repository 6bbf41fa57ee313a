"""K_V over speed: simulated, under variants of the mesh law, and by ISO 6336-1 beside it."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from dynamics.iso_rating import RatingOptions, dynamic_factor
from dynamics.response_curve import ResponseCurve, periodic_response
from dynamics.standards.iso6336_1_2006 import DynamicFactor
from rigdesign.loads import MeshModel, laws_of, mesh_models, signed_torque
from rigdesign.passes import PassResult
from rigdesign.results import DynamicFactorPoint
from rigdesign.rig.model import Rig

QUICK_SPEEDS = 24
"""Speeds of the curve at quick fidelity."""
HARDNESS = ("case_hardened", "nitrided", "through_hardened")
"""Treatments of flanks from hard to soft: the softer gear of a mesh runs in."""
DEFAULT = RatingOptions()
VARIANT = "weber_banaschek_0.8"
"""The other reading of the mesh stiffness, shown beside the shipped one."""


@dataclass(frozen=True)
class Curves:
    """Response over speed at the test torque, warm."""

    speeds: tuple[float, ...]
    """Of the first pinion [rad/s]."""
    response: ResponseCurve
    variants: Mapping[str, ResponseCurve]


def solve_curves(rig: Rig, warm: PassResult) -> Curves:
    """Periodic response from the first to the last speed of the case, warm gears of ``warm``."""
    numerics = rig.case.numerics
    count = QUICK_SPEEDS if rig.fidelity == "quick" else numerics.curve_speeds
    first, last = rig.pinion_speed(numerics.curve_speed_start), rig.pinion_speed(numerics.curve_speed_end)
    speeds = tuple(float(speed) for speed in np.linspace(first, last, count))
    own = rig.case.drivetrain.mesh_stiffness if rig.case.drivetrain else ""
    other = "iso_6336_scaled" if own == VARIANT else VARIANT
    variants = {}
    if rig.fidelity != "quick":
        variants[other] = _curve(rig, warm, mesh_models(rig, warm.point, warm.feedback, other), speeds)
    return Curves(speeds, _curve(rig, warm, warm.models, speeds), variants)


def _curve(rig: Rig, warm: PassResult, models: Sequence[MeshModel], speeds: Sequence[float]) -> ResponseCurve:
    assert rig.system is not None
    return periodic_response(
        rig.system, laws_of(models), speeds, signed_torque(rig, warm.point), drag_torques=warm.drags
    )


def rating_options(rig: Rig, name: str) -> RatingOptions:
    """What ISO 6336-1 needs of a mesh beside its geometry; profile crowning counts as tip relief C_a."""
    box, mesh = rig.mesh(name)
    entry = box.meshes[mesh]
    gears = box.gears[entry.pinion], box.gears[entry.wheel]
    relief = min(gear.flank.tip_relief or gear.flank.profile_crowning for gear in gears)
    solid = [rig.materials[gear.material] for gear in gears]
    first, second = (material.flank_strength or DEFAULT.sigma_hlim[0] for material in solid)
    softest = max((material.treatment for material in solid), key=HARDNESS.index)
    return RatingOptions(
        grade=max(gear.quality_grade for gear in gears),
        tip_relief=relief if relief > 0.0 else None,
        sigma_hlim=(first, second),
        run_in=softest,
        application_factor=entry.application_factor,
        low_load_factor=entry.low_load_factor,
    )


def iso_factor(rig: Rig, name: str, torque: float, speed: float) -> DynamicFactor:
    """K_V of one mesh by ISO 6336-1 method B; torque [N m] and speed [rad/s] of its pinion, cold gears."""
    return dynamic_factor(rig.pairs[name], abs(torque), speed, rating_options(rig, name))


def factor_points(rig: Rig, mesh: int, curve: ResponseCurve) -> list[DynamicFactorPoint]:
    """The K_V(n) curve of one mesh with ISO beside it, over the speed of its own pinion."""
    name = rig.mesh_names[mesh]
    box, own = rig.mesh(name)
    ratio = rig.speed_ratios[box.gears[box.meshes[own].pinion].shaft] / rig.pinion_speed(1.0)
    points = []
    for point in curve.points:
        speed = point.speed * ratio
        iso = iso_factor(rig, name, float(point.mean[mesh]), speed)
        points.append(
            DynamicFactorPoint(
                speed_rpm=speed * 30.0 / math.pi,
                simulated=float(point.dynamic_factor[mesh]),
                simulated_half_peak_to_peak=float(point.dynamic_factor_half_peak_to_peak[mesh]),
                iso_6336_1_method_b=iso.K_V,
                method=point.method,
            )
        )
    return points
