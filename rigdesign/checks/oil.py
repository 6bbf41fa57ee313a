"""Checks of the oil plant and the room: flow, cooler, heaters, heat to the room."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from rigdesign.case.gearbox import Gearbox
from rigdesign.checks.omissions import HEAT, of_gearboxes, warming, without_housing
from rigdesign.checks.registry import REGISTRY, RigRule, Topic, Values
from rigdesign.checks.temperatures import OIL_EXCHANGE
from rigdesign.results.check import Check
from rigdesign.results.units import KILOWATT, LITRE_PER_MINUTE

if TYPE_CHECKING:
    from rigdesign.postprocessing.solved_rig import SolvedRig
    from rigdesign.results.housing import StageBalance

GROUP = "oil"
FLOWS = ("gearboxes.*.oil.flow", "gearboxes.*.bearing_oil.flow")
"""Inputs behind the flow of the oils."""


def _warm_oil(solved: SolvedRig, name: str, box: Gearbox) -> bool:
    """A gearbox without a housing whose oil is warmer than the room."""
    warmest = max(box.stated_oil_temperatures, default=0.0)
    return box.housing is None and warmest > solved.case.ambient.temperature


ROOM_HEAT = of_gearboxes("heat that gearbox {box} gives to the room: it has no housing", without_housing)
WALL_HEAT = of_gearboxes(
    "heat that warm oil gives to the walls of gearbox {box}: it has no housing", _warm_oil
)


def _of_stages(value: Callable[[StageBalance], float]) -> Callable[[SolvedRig], Values]:
    """A quantity of the heat balance at every held stage."""
    return lambda solved: ((value(balance), f"stage {balance.cooling.stage}") for balance in solved.balances)


RULES = (
    RigRule(
        key="oil.flow",
        title="oil flow of the rig",
        procedure="Flow per mesh times meshes plus flow per bearing times bearings, of all gearboxes.",
        unit=LITRE_PER_MINUTE,
        group=GROUP,
        source="limits.oil.flow_maximum",
        limit=lambda limits: limits.oil.flow_maximum,
        values=_of_stages(lambda balance: balance.cooling.flow),
        only_inputs=FLOWS,
    ),
    RigRule(
        key="oil.cooler",
        title="power the cooler carries",
        procedure=(
            "Heat that the oils bring back above their inlet temperatures at the held stages, summed over "
            "circuits of one oil and inlet temperature; circuits that come back colder do not count "
            "against it. With the heat that machines give to these oils."
        ),
        unit=KILOWATT,
        group=GROUP,
        source="limits.oil.cooler_power_maximum",
        limit=lambda limits: limits.oil.cooler_power_maximum,
        values=_of_stages(lambda balance: balance.cooling.cooler),
        leaves_out=(OIL_EXCHANGE, *HEAT),
        moved_by=frozenset({"housing", "rig heat"}),
    ),
    RigRule(
        key="oil.heater",
        title="power the heaters of the warm circuits give",
        procedure=(
            "Heat that circuits lack whose oil comes back colder than it went, at the held stages, "
            "summed; warmer circuits do not count against it."
        ),
        unit=KILOWATT,
        group=GROUP,
        source="limits.oil.heater_power_maximum",
        limit=lambda limits: limits.oil.heater_power_maximum,
        values=_of_stages(lambda balance: balance.cooling.heater),
        leaves_out=(WALL_HEAT, warming),
        moved_by=frozenset({"housing"}),
    ),
    RigRule(
        key="oil.room",
        title="heat to the room",
        procedure=(
            "Heat from the surfaces of all housings and their clamping fields to the room at the held "
            "stages, from the temperature fields; with tanks, pipes and pumps of the oil circuits, couplings and "
            "machines."
        ),
        unit=KILOWATT,
        group=GROUP,
        source="limits.oil.room_heat_maximum",
        limit=lambda limits: limits.oil.room_heat_maximum,
        values=_of_stages(lambda balance: balance.heat.into("room")),
        leaves_out=(ROOM_HEAT, *HEAT),
        moved_by=frozenset({"housing", "rig heat"}),
    ),
)


def checks(solved: SolvedRig) -> list[Check]:
    """One for every limit of the oil plant."""
    return [rule.check(solved) for rule in RULES]


REGISTRY.register(Topic(order=36, families=RULES, checks=checks, of_housing_mesh=True))
