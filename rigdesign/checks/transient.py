"""Checks of the thermal history: what is left or needed at the worst moment, and the soak."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from rigdesign.case.fields import Influence
from rigdesign.checks.clearances import NOT_EXPANDED, PLAY_NOT_EXPANDED, SEALS_NOT_EXPANDED
from rigdesign.checks.omissions import constant_drag, coupled_shafts, given_losses
from rigdesign.checks.places import couplings, housings
from rigdesign.checks.registry import REGISTRY, Finder, RuleFamily, Topic
from rigdesign.checks.rules import Comparison, hold, not_evaluated
from rigdesign.checks.temperatures import WALLS
from rigdesign.results.check import Check
from rigdesign.results.serialisation.events import EXTREME_UNITS
from rigdesign.results.thermal import Extreme
from rigdesign.results.units import HOUR, HOURS

if TYPE_CHECKING:
    from rigdesign.postprocessing.solved_rig import SolvedRig
    from rigdesign.transient.soak import Soak

GROUP = "transient"
MOVED_BY: frozenset[Influence] = frozenset({"housing", "test time", "thermal history"})
OIL_BASIS = "thermal history, every oil fed at its inlet temperature"


def _family(
    quantity: str,
    title: str,
    source: str,
    *,
    comparison: Comparison = "<=",
    leaves_out: tuple[Finder, ...] = (),
) -> RuleFamily:
    extreme = "least" if comparison == ">=" else "largest"
    return RuleFamily(
        key=f"transient.{quantity}",
        title=title,
        procedure="Thermal history over warm-up, schedule, stops and soak-back (check --transient): the "
        f"{extreme} value at all places and moments of the planned course.",
        unit=EXTREME_UNITS[quantity],
        group=GROUP,
        source=source,
        comparison=comparison,
        leaves_out=(*leaves_out, constant_drag, given_losses),
        moved_by=MOVED_BY,
    )


def _clearance(quantity: str, title: str, *leaves_out: Finder) -> RuleFamily:
    """Smallest clearance of a kind over time."""
    source = f"limits.clearances.{quantity}_minimum; thermal history"
    return _family(quantity, title, source, comparison=">=", leaves_out=leaves_out)


def _alignment(quantity: str, title: str) -> RuleFamily:
    """Largest misalignment of a kind over time."""
    source = f"limits.alignment.{quantity}_maximum; thermal history"
    return _family(quantity, title, source, leaves_out=(NOT_EXPANDED,))


def _coupling(quantity: str, title: str, limit: str) -> RuleFamily:
    """Largest misalignment of every coupling over time."""
    source = f"drivetrain.couplings.{{place}}.{limit}; thermal history"
    family = _family(quantity, title, source, leaves_out=(coupled_shafts,))
    return replace(family, moved_by=MOVED_BY | {"coupling offset"}, places=couplings)


EXTREMES = (
    _clearance("seal_gap", "smallest radial gap of a seal over time", SEALS_NOT_EXPANDED),
    replace(
        _clearance("axial_play", "smallest axial play of a shaft over time", PLAY_NOT_EXPANDED),
        moved_by=MOVED_BY | {"axial play"},
    ),
    _clearance("bearing_clearance", "smallest diametral bearing clearance over time", NOT_EXPANDED),
    _clearance("backlash", "smallest backlash over time", NOT_EXPANDED),
    _clearance("tip_clearance", "smallest tip clearance over time", NOT_EXPANDED),
    _family(
        "housing_temperature",
        "hottest place of the housing over time",
        "limits.temperatures.housing_maximum; thermal history",
        leaves_out=(WALLS,),
    ),
    _alignment("bearing_tilt", "largest tilt of a shaft in a bearing bore over time"),
    _alignment("bore_out_of_round", "bearing bore out of round over time, share of the radial clearance"),
    _alignment("axis_inclination", "in-plane deviation of the axes of a mesh over time"),
    _alignment("axis_skew", "out-of-plane deviation of the axes of a mesh over time"),
    _coupling(
        "coupling_offset",
        "radial offset between the shafts over time, coupling {place}",
        "radial_offset_maximum",
    ),
    _coupling("coupling_angle", "angle between the shafts over time, coupling {place}", "angle_maximum"),
    _family(
        "heater_power",
        "power the heaters of the warm circuits give over time",
        f"limits.oil.heater_power_maximum; {OIL_BASIS}",
    ),
    _family("cooler_power", "power the cooler carries over time", f"limits.oil.cooler_power_maximum; {OIL_BASIS}"),
)  # fmt: skip
SOAK = RuleFamily(
    key="transient.soak",
    title="warm-up needed before full torque, {place} gearbox",
    unit=HOURS,
    group=GROUP,
    procedure="Thermal history (check --transient): shortest warm-up after which every clearance limit holds up to the "
    "end of the dwell.",
    places=housings,
    source="transient.warm_up; shortest warm-up with which all clearance limits hold",
    leaves_out=(constant_drag, given_losses),
    moved_by=MOVED_BY,
)
BY_QUANTITY = {family.key.partition(".")[2]: family for family in EXTREMES}


def checks(solved: SolvedRig) -> Iterator[Check]:
    """One check for every limited quantity, one for the warm-up of every gearbox; none without a thermal history."""
    if solved.history is None:
        return
    for extreme in solved.history.extremes:
        if extreme.planned and extreme.quantity in BY_QUANTITY:
            yield _held(solved, extreme)
    for soak in solved.history.soak:
        yield _soak(solved, soak)


def _held(solved: SolvedRig, extreme: Extreme) -> Check:
    family = BY_QUANTITY[extreme.quantity]
    rule = family.rule(extreme.limit, extreme.place if extreme.quantity.startswith("coupling_") else "")
    where = f"{extreme.place}, {extreme.branch}, phase {extreme.phase}, {extreme.time / HOUR:.2f} h after the start"
    return family.worst(solved, rule, [(extreme.value, where)])


def _soak(solved: SolvedRig, soak: Soak) -> Check:
    """The warm-up the case plans against the one it needs."""
    rule = replace(SOAK.rule(None, soak.gearbox), limit=solved.case.transient.warm_up / HOUR)
    if soak.soak_time_s is None:
        return not_evaluated(rule, soak.reason)
    return hold(rule, soak.soak_time_s / HOUR, soak.reason)


REGISTRY.register(Topic(order=70, families=(*EXTREMES, SOAK), checks=checks))
