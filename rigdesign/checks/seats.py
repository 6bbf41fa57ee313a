"""Checks of the seats of the gears on their shafts: press fits against slip, hot and at speed."""

from rigdesign.checks.omissions import long_periods
from rigdesign.checks.registry import LOADS, REGISTRY, RigRule, Topic, Values
from rigdesign.records.press_fits import FRICTION, press_fits
from rigdesign.records.solved_rig import SolvedRig
from rigdesign.results.check import Check
from rigdesign.results.units import NUMBER


def _slip(solved: SolvedRig) -> Values:
    """Slip torque over the torque of the seat at every stage and event."""
    for found in press_fits(solved.rig, solved.seat_torques):
        if found.safety is not None:
            yield (
                found.safety,
                f"{found.gear}, {found.where}: slips at {found.slip_torque:.0f} N m under "
                f"{1e-6 * found.pressure:.3g} MPa, carries {found.peak_torque:.0f} N m; "
                f"{1e6 * found.interference_hot:.3g} um of {1e6 * found.interference:.3g} um interference left warm",
            )


PRESS_FIT = RigRule(
    key="strength.press_fit_slip",
    title="least safety of the press fits of gears against slip",
    procedure=(
        "Pressure of the least interference by thick rings after Lame, less what the gear grows over its shaft by heat "
        f"and centrifugal load; slip torque at a friction coefficient of {FRICTION:g} over the largest torque of the "
        "seat in the periodic responses of the held stages, in the time run over the schedule and in the events. The "
        "least counts. Stages that are not held have the temperatures of the governing held stage."
    ),
    unit=NUMBER,
    group="dynamics",
    source="limits.strength.press_fit_safety_minimum; DIN 7190-1:2017, elastic fit",
    comparison=">=",
    needs=LOADS,
    leaves_out=(long_periods,),
    absent="no gear states shaft_interference: there is no press fit that could slip",
    moved_by=frozenset({"strength limits", "time run", "events", "housing"}),
    limit=lambda limits: limits.strength.press_fit_safety_minimum,
    values=_slip,
)
RULES = (PRESS_FIT,)


def checks(solved: SolvedRig) -> list[Check]:
    """All of them."""
    return [rule.check(solved) for rule in RULES]


REGISTRY.register(Topic(order=21, families=RULES, checks=checks))
