"""Checks of the oil circuits: supply temperatures at the held stages, and how long they take over time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from rigdesign.case.model import Case
from rigdesign.checks.omissions import Omissions
from rigdesign.checks.registry import REGISTRY, RuleFamily, Topic
from rigdesign.checks.rules import Omission, hold
from rigdesign.results.check import Check
from rigdesign.results.units import HOUR, HOURS, DisplayUnit

if TYPE_CHECKING:
    from rigdesign.postprocessing.solved_rig import SolvedRig

KELVIN = DisplayUnit("K", 1.0)


def supply_lines(case: Case) -> Iterator[str]:
    """Lines that are meant to have a supply temperature: ``circuit.lines.line``."""
    return (
        f"{name}.lines.{line}"
        for name, circuit in case.oil_circuits.items()
        for line in circuit.lines
        if circuit.lines[line].setpoint is not None
    )


def machines_over_time(solved: SolvedRig, check: Check) -> Omissions:
    """Machines cooled with the oil of the circuit, whose heat the thermal history does not follow."""
    circuit = check.id.split(".")[2]
    for name, machine in solved.case.rig_heat.machines.items():
        if machine.coolant == circuit:
            yield Omission(f"heat of machine {name} in oil circuit {circuit} over time")


SUPPLY = RuleFamily(
    key="oil.supply",
    title="distance of the supply temperature from its setpoint, {place}",
    procedure="Heat balance of the oil circuit at the held stages with heaters and coolers at what they can give and "
    "carry: supply temperature at the consumers less the setpoint, either way.",
    unit=KELVIN,
    group="oil",
    source="oil_circuits.{place}.tolerance",
    places=supply_lines,
    moved_by=frozenset({"housing"}),
)
WARM_UP = RuleFamily(
    key="transient.oil_supply",
    title="time until the supply temperature holds its setpoint, {place}",
    procedure="Thermal history (check --transient) of housings and oil circuits together: time after the start from "
    "which the supply temperature stays within its tolerance until the end of the last dwell.",
    unit=HOURS,
    group="transient",
    source="transient.warm_up; oil circuit with the limits of its heaters and coolers",
    places=supply_lines,
    leaves_out=(machines_over_time,),
    moved_by=frozenset({"housing", "test time", "thermal history"}),
)


def steady_checks(solved: SolvedRig) -> Iterator[Check]:
    """The worst held stage of every line."""
    for place in supply_lines(solved.case):
        name, _, line = place.split(".")
        given = solved.case.oil_circuits[name].lines[line]
        distances = [
            (
                abs(balance.circuits[name].lines[line].supply - (given.setpoint or 0.0)),
                f"stage {balance.cooling.stage}",
            )
            for balance in solved.balances
            if name in balance.circuits
        ]
        yield SUPPLY.worst(solved, SUPPLY.rule(given.tolerance, place), distances)


def checks_over_time(solved: SolvedRig) -> Iterator[Check]:
    """Every line against the planned warm-up; none without a thermal history."""
    if solved.history is None:
        return
    for held in solved.history.supplies:
        rule = replace(WARM_UP.rule(None, held.place), limit=solved.case.transient.warm_up / HOUR)
        if held.time is None:
            text = f"{held.reached:.4g} degC at the end of the last dwell: the setpoint is not held at all"
            yield replace(hold(rule, held.end / HOUR, text), verdict="fail")
        else:
            yield hold(rule, held.time / HOUR, f"{held.reached:.4g} degC when the warm-up ends")


REGISTRY.register(
    Topic(order=37, families=(SUPPLY,), checks=steady_checks, of_housing_mesh=True)
)  # fmt: skip
REGISTRY.register(Topic(order=71, families=(WARM_UP,), checks=checks_over_time))
