"""What left the range of its law, and which checks depend on it: oils, losses and films of the solved points."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from rigdesign.results.check import Finding
from rigdesign.rig.oil_supply import bearing_oil, gear_oil

if TYPE_CHECKING:
    from rigdesign.coupling.located_loss import PlacedLoss
    from rigdesign.postprocessing.solved_rig import SolvedRig

HEAT = ("temperature.*", "clearance.*", "alignment.*", "bearing.*temperature", "bearing.*clearance", "oil.*")
"""Checks that rest on the heat of the rig."""
OF_OIL = {
    "gear_oil": (*HEAT, "flank.film_ratio.{0}*", "flank.scuffing_safety.{0}*", "bought_part.*"),
    "bearing_oil": (*HEAT, "bearing.*", "lateral.*", "ramp.start_torque", "bought_part.*"),
}
"""Checks that rest on the viscosity of an oil of gearbox {0}."""
MATTERS = 0.1
"""Share of the heat from which a loss or film outside of the range of its law leaves open what rests on the heat."""


def out_of_range(solved: SolvedRig, losses: Mapping[str, Sequence[PlacedLoss]]) -> list[Finding]:
    """Each once; ``losses`` by stage."""
    return list(dict.fromkeys([*loss_findings(losses), *oil_findings(solved), *film_findings(solved)]))


def loss_findings(losses: Mapping[str, Sequence[PlacedLoss]]) -> Iterator[Finding]:
    """A warning of a loss at several stages is reported once, with their names."""
    stages: dict[tuple[str, str], dict[str, float]] = {}
    for stage, found in losses.items():
        whole = sum(placed.loss.power for placed in found)
        for placed in found:
            outside = not placed.kind.of_teeth  # whose floors and caps belong to the law of its friction
            for text in placed.loss.warnings:
                share = placed.loss.power / whole if whole and outside else 0.0
                stages.setdefault((placed.name, text), {})[stage] = share
    for (place, text), shares in stages.items():
        where = list(shares)
        named = f"stage {where[0]}" if len(where) == 1 else f"stages {', '.join(where)}"
        everywhere = len(where) == len(losses) > 1
        yield Finding(
            id="loss",
            text=f"{place}, {'all stages that rotate' if everywhere else named}: {text}",
            checks=HEAT if max(shares.values()) > MATTERS else (),
        )


def oil_findings(solved: SolvedRig) -> Iterator[Finding]:
    """Every oil at the coldest and at the hottest place of its stream."""
    for point in solved.points:
        for stream in point.last.streams:
            name, kind = stream.name.both
            oil = gear_oil(solved.rig, name) if kind == "gear_oil" else bearing_oil(solved.rig, name)
            places = stream.inlet, stream.outlet, stream.chamber
            for temperature in (min(places), max(places)):
                for text in oil.warnings(temperature):
                    yield Finding(
                        id="oil",
                        text=f"{stream.name}, stage {point.point.stage}: {text}",
                        checks=tuple(check.format(name) for check in OF_OIL[kind]),
                    )


def film_findings(solved: SolvedRig) -> Iterator[Finding]:
    """What the films of all temperature fields say of their range, by the share of the heat that they pass."""
    for point in solved.points:
        for field in point.last.fields.values():
            balance = field.solution.balance
            for text in field.solution.warnings:
                passed = [
                    abs(row.power)
                    for row in balance.rows
                    if row.coefficient and text in row.coefficient.warnings
                ]
                share = sum(passed) / balance.turnover if balance.turnover else 0.0
                yield Finding(id="film", text=text, checks=HEAT if share > MATTERS else ())
