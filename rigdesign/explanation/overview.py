"""A case at a glance: its parts, its schedule, where its inputs come from, what it is held against."""

from collections import Counter
from dataclasses import dataclass

from rigdesign.base.units import show
from rigdesign.case.defaults.rule import BY_THE_TOOL
from rigdesign.case.model import Case
from rigdesign.case.usual import unusual_inputs
from rigdesign.explanation.keys import declared_rules


@dataclass(frozen=True, kw_only=True)
class StageSummary:
    """One stage with the speed and torque at its end, as the case would write them."""

    name: str
    kind: str
    speed: str
    torque: str
    duration: str
    held: bool


@dataclass(frozen=True, kw_only=True)
class Overview:
    """What a case holds.

    gearboxes : name -> role, gears and housing in words
    drivetrain : shafts, couplings and bracing in words; empty without one
    inputs : kind of origin -> number of inputs; ranged : assumed inputs with a range
    checks : group -> ids of the checks, with a limit in the case; unlimited : ids of those without
    """

    name: str
    title: str
    path: str
    gearboxes: dict[str, str]
    drivetrain: str
    stages: tuple[StageSummary, ...]
    inputs: dict[str, int]
    ranged: int
    checks: dict[str, tuple[str, ...]]
    unlimited: tuple[str, ...]
    unusual: tuple[str, ...]
    """Values outside of their usual range, each in words."""


def overview(case: Case) -> Overview:
    """A case at a glance; nothing is solved."""
    by_group: dict[str, list[str]] = {}
    unlimited = []
    for family, rule in declared_rules(case):
        if family.key.startswith("transient."):
            continue
        if all(path in case.origin.value_of for path in family.limits_of(rule)):
            by_group.setdefault(rule.group, []).append(rule.id)
        else:
            unlimited.append(rule.id)
    return Overview(
        name=case.name,
        title=case.title,
        path=str(case.path),
        gearboxes={name: _gearbox(case, name) for name in case.gearboxes},
        drivetrain=_drivetrain(case),
        stages=tuple(
            StageSummary(
                name=stage.name,
                kind=stage.kind,
                speed=show(stage.speed_end, "speed"),
                torque=show(stage.torque_end, "torque"),
                duration=show(stage.duration, "time"),
                held=stage.held,
            )
            for stage in case.schedule.resolved()
        ),
        inputs=_by_basis(case),
        ranged=sum(record.range is not None for record in case.assumptions),
        checks={group: tuple(found) for group, found in by_group.items()},
        unlimited=tuple(unlimited),
        unusual=tuple(unusual_inputs(case).values()),
    )


def _gearbox(case: Case, name: str) -> str:
    box = case.gearboxes[name]
    meshes = "; ".join(
        f"{mesh.pinion} {box.gears[mesh.pinion].teeth} / {mesh.wheel} {box.gears[mesh.wheel].teeth} teeth, "
        f"module {show(mesh.normal_module, 'length')}"
        for mesh in box.meshes.values()
    )
    housing = "with housing" if box.housing is not None else "without housing"
    return f"{box.role}; {meshes}; {len(box.bearings)} bearings; {housing}"


def _drivetrain(case: Case) -> str:
    power = case.drivetrain
    if power is None:
        return ""
    return f"{len(power.shafts)} shafts, {len(power.couplings)} couplings, braced {power.bracing.mode}"


def _by_basis(case: Case) -> dict[str, int]:
    """Number of inputs by where they come from; those that say nothing are ``stated``."""
    found: Counter[str] = Counter()
    for row in case.inputs:
        mark = case.origin.mark_of.get(row.path)
        kind, text = mark.said[0] if mark is not None and mark.said else ("stated", "")
        found["default" if text.startswith(BY_THE_TOOL) else kind] += 1
    return dict(found.most_common())
