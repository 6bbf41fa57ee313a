"""Check of the room that takes the heat of the rig: its temperature at the held stages."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rigdesign.case.model import Case
from rigdesign.checks.oil import GROUP, ROOM_HEAT
from rigdesign.checks.omissions import HEAT, Omissions
from rigdesign.checks.registry import REGISTRY, RuleFamily, Topic
from rigdesign.checks.rules import Omission
from rigdesign.results.check import Check
from rigdesign.results.units import DEGREE_CELSIUS

if TYPE_CHECKING:
    from rigdesign.postprocessing.solved_rig import SolvedRig


def _rooms(case: Case) -> tuple[str, ...]:
    """The room of the rig, where the case states one with a limit."""
    room = case.rig_heat.room
    return () if room is None or room.temperature_maximum is None else ("",)


def without_machines(solved: SolvedRig, check: Check) -> Omissions:
    """A drivetrain with a motor whose losses the case does not state."""
    if solved.case.drivetrain is not None and not solved.case.rig_heat.machines:
        yield Omission("heat of motor and drive: rig_heat.machines names none")


TEMPERATURE = RuleFamily(
    key="oil.room_temperature",
    title="temperature of the room",
    procedure="Steady balance of the room at the held stages: heat of housings, tanks, pipes, pumps, couplings and "
    "machines against the air of the ventilation and the walls; the housings in a room of ambient.temperature.",
    unit=DEGREE_CELSIUS,
    group=GROUP,
    source="rig_heat.room.temperature_maximum",
    places=_rooms,
    leaves_out=(ROOM_HEAT, without_machines, *HEAT),
    moved_by=frozenset({"housing", "rig heat"}),
)


def checks(solved: SolvedRig) -> Iterator[Check]:
    """The warmest held stage; none without a limit of the room."""
    for place in _rooms(solved.case):
        room = solved.case.rig_heat.room
        assert room is not None
        found = [
            (
                balance.heat.room.temperature,
                f"stage {balance.heat.stage}, {_air(balance.heat.room.needed_air_flow)}",
            )
            for balance in solved.balances
            if balance.heat.room is not None
        ]
        yield TEMPERATURE.worst(solved, TEMPERATURE.rule(room.temperature_maximum, place), found)


def _air(flow: float | None) -> str:
    """Air flow that holds the limit [m3/s] as a reason shows it."""
    if flow is None:
        return "no ventilation holds the limit"
    return f"{3600.0 * flow:.4g} m3/h of air hold the limit"


REGISTRY.register(Topic(order=38, families=(TEMPERATURE,), checks=checks, of_housing_mesh=True))
