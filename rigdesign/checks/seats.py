"""Checks of shafts under torque and of the seats of gears: slip of press fits and splines, hot and at speed."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from rigdesign.checks.omissions import long_periods
from rigdesign.checks.registry import LOADS, REGISTRY, RigRule, Topic, Values
from rigdesign.results.check import SEAT_FRICTION, Check
from rigdesign.results.units import MEGAPASCAL, NUMBER

if TYPE_CHECKING:
    from rigdesign.postprocessing.solved_rig import SolvedRig
    from rigdesign.results.loads import SplineStressKind


def _slip(solved: SolvedRig) -> Values:
    """Slip torque over the torque of the seat at every stage and event."""
    for found in solved.press_fits:
        if found.safety is not None:
            yield (
                found.safety,
                f"{found.gear}, {found.where}: slips at {found.slip_torque:.0f} N m under "
                f"{1e-6 * found.pressure:.3g} MPa, carries {found.peak_torque:.0f} N m; "
                f"{1e6 * found.interference_hot:.3g} um of {1e6 * found.interference:.3g} um interference left warm",
            )


def _spline(solved: SolvedRig, *kinds: SplineStressKind) -> Values:
    """Allowable stress over stress of every spline, for some kinds of stress."""
    for found in solved.splines:
        if found.kind in kinds and found.safety is not None:
            yield (
                found.safety,
                f"{found.gear}, {found.where}: {found.kind} {1e-6 * found.stress:.3g} MPa of "
                f"{1e-6 * found.allowable:.3g} MPa under {found.torque:.0f} N m",
            )


def _shear(solved: SolvedRig) -> Values:
    """Nominal torsional stress of every shaft section at every stage and event."""
    for found in solved.part_torques:
        if found.shear_stress is not None:
            yield found.shear_stress, f"{found.place}, {found.where}: {found.torque:.0f} N m"


_RULE = partial(
    RigRule,
    unit=NUMBER,
    group="dynamics",
    comparison=">=",
    needs=LOADS,
    leaves_out=(long_periods,),
    moved_by=frozenset({"strength limits", "time run", "events", "housing", "gear seats"}),
)
TORQUE = (
    "largest torque of the seat itself in the periodic responses of the held stages, at the samples of the time run "
    "over the schedule and in the events"
)
_SPLINE = partial(
    _RULE,
    absent="no gear states spline.toothing with this allowable stress",
    source="limits.strength.spline_safety_minimum; Dudley 1957",
    limit_keys=("limits.strength.spline_safety_minimum",),
    limit=lambda limits: limits.strength.spline_safety_minimum,
)

PRESS_FIT = _RULE(
    key="strength.press_fit_slip",
    title="least safety of the press fits of gears against slip",
    procedure=(
        "Pressure of the least interference by thick rings after Lame, less the interference lost by thermal and "
        f"centrifugal expansion; slip torque at a friction coefficient of {SEAT_FRICTION:g} over the "
        f"{TORQUE}. The lowest governs. Stages that are not held have the temperatures of the governing held stage."
    ),
    source="limits.strength.press_fit_safety_minimum; DIN 7190-1:2017, elastic fit",
    limit_keys=("limits.strength.press_fit_safety_minimum",),
    absent="no gear states shaft_interference without spline.toothing",
    limit=lambda limits: limits.strength.press_fit_safety_minimum,
    values=_slip,
)
SHAFT_SHEAR = RigRule(
    key="strength.shaft_shear",
    title="largest nominal shear stress of a shaft section by its torque",
    procedure=(
        "Torque over the polar section modulus of the outer and inner diameter, at the largest torque of the section "
        "in the periodic responses of the held stages, at the samples of the time run over the schedule and in the "
        "events; bending and notch effects neglected."
    ),
    source="limits.strength.shaft_shear_maximum",
    unit=MEGAPASCAL,
    group="dynamics",
    needs=LOADS,
    leaves_out=(long_periods,),
    moved_by=frozenset({"strength limits", "time run", "events", "housing"}),
    limit=lambda limits: limits.strength.shaft_shear_maximum,
    values=_shear,
)
RULES = (
    SHAFT_SHEAR,
    PRESS_FIT,
    _SPLINE(
        key="strength.spline_pressure",
        title="least safety of the splines of gears against flank pressure",
        procedure=(
            f"Pressure on the flanks 2 T K_m / (D N F h) at the {TORQUE}; allowable_pressure of the spline over it. "
            "The lowest governs."
        ),
        values=lambda solved: _spline(solved, "flank pressure"),
    ),
    _SPLINE(
        key="strength.spline_shear",
        title="least safety of the splines of gears against shear",
        procedure=(
            f"Shear of the teeth on the pitch circle, half of them carrying, and of the shaft under its teeth, at the "
            f"{TORQUE}; allowable_shear of the spline over it. The lowest governs."
        ),
        values=lambda solved: _spline(solved, "shear of the teeth", "shear of the shaft"),
    ),
    _SPLINE(
        key="strength.spline_hub",
        title="least safety of the hubs of splines against bursting",
        procedure=(
            "Hoop stress of the gear at its spline by the radial part of the tooth forces, their bending, rotation and "
            f"a press fit, hot and at speed, at the {TORQUE}; of the press fit alone at rest and cold. "
            "allowable_tension of the spline over it. The lowest governs."
        ),
        values=lambda solved: _spline(solved, "tension of the hub"),
    ),
)


def checks(solved: SolvedRig) -> list[Check]:
    """All of them; the default limit of one that does not apply is no limit that the case states."""
    return [_asked(solved, rule, rule.check(solved)) for rule in RULES]


def _asked(solved: SolvedRig, rule: RigRule, check: Check) -> Check:
    stated = any(solved.case.origin.value_of.get(path) for path in rule.limit_keys)
    return check if check.value is not None or stated else replace(check, limit=None)


REGISTRY.register(Topic(order=21, families=RULES, checks=checks))
