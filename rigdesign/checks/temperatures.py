"""Checks of temperatures: housing, bearing films, oil, gears."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rigdesign.base.part_name import GearName
from rigdesign.case.gearbox import Gearbox
from rigdesign.checks.films import SHAFT_HEAT, THRUST_TILT, films, no_film
from rigdesign.checks.omissions import HEAT, Omissions, of_gearboxes, without_housing
from rigdesign.checks.registry import REGISTRY, RigRule, Topic, Values
from rigdesign.checks.rules import Omission
from rigdesign.results.check import Check
from rigdesign.results.units import DEGREE_CELSIUS, KELVIN, ZERO

if TYPE_CHECKING:
    from rigdesign.postprocessing.solved_rig import SolvedRig

GROUP = "temperatures"
WALLS = of_gearboxes("walls of gearbox {box}: it has no housing", without_housing)


def _exchanges_heat(solved: SolvedRig, name: str, box: Gearbox) -> bool:
    """A gearbox without a housing that is fed oil of two temperatures."""
    return box.housing is None and len(set(box.stated_oil_temperatures)) > 1


OIL_EXCHANGE = of_gearboxes(
    "heat from the warmer oil of gearbox {box} to its colder one: it has no housing", _exchanges_heat
)


def _tempered(solved: SolvedRig, name: str, box: Gearbox) -> bool:
    """A gearbox without a housing, a gear of which states a tempering temperature."""
    return box.housing is None and any(
        solved.rig.materials[gear.material].tempering_temperature is not None for gear in box.gears.values()
    )


def _teeth_at_bulk(solved: SolvedRig, name: str, box: Gearbox) -> bool:
    """A gearbox with a temperature field whose teeth have no temperature of their own."""
    return box.housing is not None and box.heat_split.rule == "assumed"


def _untempered(solved: SolvedRig, check: Check) -> Omissions:
    """Gears whose material states no tempering temperature."""
    gears = [
        f"{name}.{gear}"
        for name, box in solved.case.gearboxes.items()
        for gear, entry in box.gears.items()
        if solved.rig.materials[entry.material].tempering_temperature is None
    ]
    if gears:
        yield Omission(f"{', '.join(gears)}: the material states no tempering_temperature")


def _housings(solved: SolvedRig) -> Values:
    return (
        (found.bodies["housing"].max, f"{found.gearbox}, stage {found.stage}")
        for found in solved.temperatures
    )


def _film_temperatures(solved: SolvedRig) -> Values:
    return ((state.film_temperature, where) for where, state in films(solved))


def _oil_outlets(solved: SolvedRig) -> Values:
    return (
        (stream.outlet, f"{stream.name}, stage {point.point.stage}")
        for point in solved.points
        for stream in point.last.streams
    )


def tempering_distances(solved: SolvedRig) -> Iterator[tuple[float, str]]:
    """Tempering temperature less the gear's own, of its teeth where a flank film gives them [K].

    A gear whose gearbox has no housing takes the temperature of its oil outlet; gears of a material without a
    tempering temperature are left out.
    """
    teeth = {
        (split.gear, found.stage): split.tooth
        for found in solved.temperatures
        for split in found.heat_split
        if split.tooth is not None
    }
    for point in solved.points:
        stage = point.point.stage
        for name, bulk in point.last.coupling_state.gear_temperature.items():
            gear = GearName.read(name)
            material = solved.rig.materials[solved.case.gearboxes[gear.gearbox].gears[gear.part].material]
            if material.tempering_temperature is None:
                continue
            hottest = max(bulk, teeth.get((name, stage), bulk))
            part = "teeth of " if hottest > bulk else ""
            basis = "" if gear.gearbox in solved.rig.models else ", its oil outlet"
            where = f"{part}{name} at {hottest - ZERO:.1f} degC{basis}, stage {stage}"
            yield material.tempering_temperature - hottest, where


RULES = (
    RigRule(
        key="temperature.housing",
        title="hottest place of the housing",
        procedure=(
            "Steady temperature field of every housing at the held stages (finite elements, losses of the "
            "coupled iteration as heat): highest temperature of the body of the housing."
        ),
        unit=DEGREE_CELSIUS,
        group=GROUP,
        source="limits.temperatures.housing_maximum",
        limit=lambda limits: limits.temperatures.housing_maximum,
        values=_housings,
        housed=True,
        leaves_out=(WALLS, *HEAT),
        moved_by=frozenset({"housing"}),
    ),
    RigRule(
        key="temperature.bearing_film",
        title="hottest bearing film",
        procedure=(
            "Heat balance of every bearing film at the held stages (ISO 7902-1): friction against the "
            "heat that oil, shaft and shell carry off."
        ),
        unit=DEGREE_CELSIUS,
        group=GROUP,
        source="limits.temperatures.bearing_film_maximum; ISO 7902-1 heat balance",
        limit=lambda limits: limits.temperatures.bearing_film_maximum,
        values=_film_temperatures,
        absent=no_film,
        leaves_out=(SHAFT_HEAT, THRUST_TILT, *HEAT),
        moved_by=frozenset({"housing"}),
    ),
    RigRule(
        key="temperature.oil_outlet",
        title="hottest oil outlet",
        procedure=(
            "Heat balance of every oil stream at the held stages: inlet temperature plus the heat it "
            "takes up over mass flow and heat capacity. The warmest outlet counts."
        ),
        unit=DEGREE_CELSIUS,
        group=GROUP,
        source="limits.temperatures.oil_outlet_maximum",
        limit=lambda limits: limits.temperatures.oil_outlet_maximum,
        values=_oil_outlets,
        leaves_out=(OIL_EXCHANGE, *HEAT),
        moved_by=frozenset({"housing"}),
    ),
    RigRule(
        key="temperature.gear_bulk",
        title="gear bulk temperature below tempering temperature",
        procedure=(
            "Tempering temperature of the material less the temperature of the gear at the held stages: "
            "that of its teeth where a flank film gives it, else of its body; of its oil outlet without a "
            "housing. The least counts."
        ),
        unit=KELVIN,
        group=GROUP,
        source="limits.temperatures.tempering_distance_minimum",
        comparison=">=",
        limit=lambda limits: limits.temperatures.tempering_distance_minimum,
        values=tempering_distances,
        leaves_out=(
            of_gearboxes(
                "friction heat in the gears of gearbox {box} above their oil outlet: it has no housing",
                _tempered,
            ),
            of_gearboxes(
                "teeth of gearbox {box} above the mean of their gear: heat_split.mesh = assumed",
                _teeth_at_bulk,
            ),
            _untempered,
            *HEAT,
        ),
        moved_by=frozenset({"housing"}),
    ),
)


def checks(solved: SolvedRig) -> list[Check]:
    """One for every limit of a temperature."""
    return [rule.check(solved) for rule in RULES]


REGISTRY.register(Topic(order=30, families=RULES, checks=checks, of_housing_mesh=True))
