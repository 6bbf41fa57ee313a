"""Checks of the rolling bearings: life, static safety, speed, least load, temperature, clearance as they run."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from dynamics.standards.skf_friction_2006 import STABILISED_TEMPERATURE
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.model import Case
from rigdesign.checks.omissions import HEAT, of_gearboxes
from rigdesign.checks.registry import REGISTRY, SPEEDS, RuleFamily, Topic, Values
from rigdesign.results.check import Check
from rigdesign.results.units import DEGREE_CELSIUS, HOUR, HOURS, MICROMETRE, NUMBER, DisplayUnit

if TYPE_CHECKING:
    from dynamics.rotor.rolling_state import RollingState
    from rigdesign.postprocessing.solved_rig import SolvedRig

GROUP = "bearings"
NEVER = "no rolling bearing turns under load at a held stage"


def rolling_rig(case: Case) -> tuple[str, ...]:
    """One rule of a rig with rolling bearings; none without."""
    found = any(not bearing.has_film for box in case.gearboxes.values() for bearing in box.bearings.values())
    return ("",) if found else ()


def _bare(solved: SolvedRig, name: str, box: Gearbox) -> bool:
    """A gearbox without a housing that has rolling bearings."""
    return box.housing is None and any(not bearing.has_film for bearing in box.bearings.values())


SEAT_HEAT = of_gearboxes(
    "heat through the seats of the rolling bearings of gearbox {box}: it has no housing", _bare
)


def _clearances(solved: SolvedRig) -> Values:
    return (
        (clearance, f"{name}, stage {point.point.stage}")
        for point in solved.points
        for name, clearance in point.last.coupling_state.bearing_clearance.items()
        if not solved.rig.bearing(name).has_film and not solved.rig.bearing(name).induced_axial_load(1.0)
    )


def _of_states(value: Callable[[RollingState], float]) -> Callable[[SolvedRig], Values]:
    """A number of every rolling bearing; one without end is left out."""
    return lambda solved: (
        (value(state), where) for where, state in solved.rolling_states() if math.isfinite(value(state))
    )


def _life(case: Case) -> tuple[float, str]:
    """Least life [s] and where it stands; the planned test time where no limit is stated."""
    limit = case.limits.bearing.rating_life_minimum
    return (
        (case.test_plan.time, "test_plan.time")
        if limit is None
        else (limit, "limits.bearing.rating_life_minimum")
    )


def _temperature(case: Case) -> tuple[float, str]:
    """Most temperature [K] and where it stands; that up to which rings keep their size where no limit is stated."""
    limit = case.limits.temperatures.rolling_bearing_maximum
    key = "limits.temperatures.rolling_bearing_maximum"
    return (
        (STABILISED_TEMPERATURE, "catalogue: rings keep their size up to it")
        if limit is None
        else (limit, key)
    )


def _stated(key: str) -> Callable[[Case], tuple[float | None, str]]:
    """A limit of the case under ``limits.bearing``."""
    return lambda case: (getattr(case.limits.bearing, key), f"limits.bearing.{key}")


def _one(source: str) -> Callable[[Case], tuple[float, str]]:
    """A share of one."""
    return lambda case: (1.0, source)


@dataclass(frozen=True, kw_only=True)
class RollingRule(RuleFamily):
    """One rule of all rolling bearings."""

    limit: Callable[[Case], tuple[float | None, str]]
    """Limit [SI] and where it stands."""
    values: Callable[[SolvedRig], Values]

    def check(self, solved: SolvedRig) -> Check:
        """The check of the rig."""
        limit, source = self.limit(solved.case)
        return self.worst(solved, replace(self.rule(limit), source=source), self.values(solved))


def _rule(
    key: str, title: str, unit: DisplayUnit, procedure: str, *, warm: bool = True, **more: object
) -> RollingRule:
    """warm : the value follows from the temperatures of the rig."""
    return RollingRule(
        key=f"bearing.{key}",
        title=title,
        unit=unit,
        procedure=procedure,
        group=GROUP,
        places=rolling_rig,
        absent=NEVER,
        leaves_out=(SEAT_HEAT, *HEAT) if warm else (),
        moved_by=frozenset({"housing", "test time"}),
        **more,  # type: ignore[arg-type]
    )


RULES = (
    _rule(
        "rating_life", "least modified rating life of a rolling bearing", HOURS,
        "Modified rating life L_nmh of every rolling bearing at the load, speed, temperature and cleanliness of the "
        "held stages (ISO 281); the least counts, as if the stage lasted.",
        source="limits.bearing.rating_life_minimum", comparison=">=", limit=_life,
        values=_of_states(lambda state: HOUR * state.life.modified_life),
    ),
    _rule(
        "static_safety", "least static safety of a rolling bearing", NUMBER,
        "Static rating C_0 over static equivalent load P_0 (ISO 76) at the held stages.",
        source="limits.bearing.static_safety_minimum", comparison=">=", limit=_stated("static_safety_minimum"),
        values=_of_states(lambda state: state.life.static_safety), warm=False,
    ),
    _rule(
        "speed", "speed of a rolling bearing over its limiting speed", NUMBER,
        "Speed of the shaft at the held stages over the mechanical limiting speed of the catalogue.",
        source="catalogue: limiting speed", limit=_one("catalogue: limiting speed"),
        values=_of_states(lambda state: state.speed_utilisation), warm=False,
        only_inputs=(
            *SPEEDS, *(f"gearboxes.*.bearings.*.{key}" for key in ("type", "shaft", "designation")),
            "gearboxes.*.bearings.*.catalogue.limiting_speed",
        ),
    ),
    _rule(
        "minimum_load", "radial load of a rolling bearing over its least load", NUMBER,
        "Radial load at the held stages over the load below which rolling elements may slide, by the catalogue.",
        source="catalogue: minimum load", comparison=">=", limit=_one("catalogue: minimum load"), advisory=True,
        values=_of_states(lambda state: state.load / state.minimum_load if state.minimum_load else math.inf),
        warm=False,
    ),
    _rule(
        "temperature", "hottest rolling bearing", DEGREE_CELSIUS,
        "Heat balance of every rolling bearing at the held stages: friction against what oil, shaft and housing carry "
        "off.",
        source="limits.temperatures.rolling_bearing_maximum", limit=_temperature,
        values=_of_states(lambda state: state.film_temperature),
    ),
    _rule(
        "operating_clearance", "least clearance of a rolling bearing as it runs", MICROMETRE,
        "Radial internal clearance less what fits and temperatures of rings, rolling elements and seats take, at the "
        "held stages; negative is preload. Bearings with a contact angle are adjusted axially and do not count.",
        source="limits.bearing.operating_clearance_minimum", comparison=">=",
        limit=_stated("operating_clearance_minimum"), values=_clearances,
    ),
    _rule(
        "largest_operating_clearance", "largest clearance of a rolling bearing as it runs", MICROMETRE,
        "Radial internal clearance less what fits and temperatures of rings, rolling elements and seats take, at the "
        "held stages.",
        source="limits.bearing.operating_clearance_maximum",
        limit=_stated("operating_clearance_maximum"), values=_clearances,
    ),
)  # fmt: skip


def checks(solved: SolvedRig) -> list[Check]:
    """All of a rig with rolling bearings; none without."""
    return [rule.check(solved) for rule in RULES if rolling_rig(solved.case)]


REGISTRY.register(Topic(order=35, families=RULES, checks=checks, of_housing_mesh=True))
