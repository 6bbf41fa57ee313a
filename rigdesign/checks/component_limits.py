"""Limits of bought parts: a result at the part itself, or a given value, against what its maker allows."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from rigdesign.base.part_name import GearName, MeshName
from rigdesign.base.units import KINDS, display
from rigdesign.case.component_limits import shafts_of
from rigdesign.case.limits import BoughtPart, ResultQuantity
from rigdesign.case.model import Case
from rigdesign.checks.oil import FLOWS
from rigdesign.checks.omissions import Omissions, constant_drag, warming
from rigdesign.checks.registry import REGISTRY, SPEEDS, RuleFamily, Topic
from rigdesign.checks.rules import Omission, Rule, hold, not_applicable, not_evaluated, worst
from rigdesign.results.check import NO_HOUSING, NO_LOADS, Check
from rigdesign.results.units import NUMBER
from rigdesign.rig.shaft_seals import shaft_seals

if TYPE_CHECKING:
    from rigdesign.postprocessing.run_torques import PartTorque
    from rigdesign.postprocessing.solved_rig import SolvedRig
    from rigdesign.results.loads import StageBracing

Found = tuple[float | None, str]
"""A result [SI] and where it occurs; None with the reason where there is none."""
GROUP = "bought parts"


def checks(solved: SolvedRig) -> Iterator[Check]:
    """One check for each bought part of the case."""
    for name, part in solved.case.limits.bought_parts.items():
        yield _check(solved, name, part)


def _check(solved: SolvedRig, name: str, part: BoughtPart) -> Check:
    rule = _rule(name, part)
    value: float | None
    value, reason = part.given_si, "given in the case"
    if value is None:
        value, reason = RESULTS[part.quantity](solved, part.part)
    if value is None:
        return (not_evaluated if reason in (NO_LOADS, NO_HOUSING) else not_applicable)(rule, reason)
    return hold(rule, display(value, part.kind), reason)


def is_at(torque: PartTorque, part: str) -> bool:
    """Whether a torque is that of a coupling or shaft of the case, by its path."""
    kinds = {"couplings": "coupling", "shafts": "shaft"}
    group, _, name = part.removeprefix("drivetrain.").partition(".")
    return torque.kind == kinds.get(group) and torque.part == name


def _rule(name: str, part: BoughtPart) -> Rule:
    return Rule(
        id=f"bought_part.{name}", title=f"{part.title} ({part.part})", unit=KINDS[part.kind].display_unit,
        source=part.source, group=GROUP, limit=display(part.limit_si, part.kind),
        by_definition=FAMILY_OF[part.quantity if part.given is None else "given"].by_definition,
    )  # fmt: skip


def _speed(solved: SolvedRig, part: str) -> Found:
    top = max(solved.case.schedule.resolved(), key=lambda stage: stage.speed_end)
    return worst(
        (solved.rig.shaft_speed(shaft, top.speed_end), f"shaft {shaft}, stage {top.name}")
        for shaft in shafts_of(solved.case, part)
    )


def _torque_mean(solved: SolvedRig, part: str) -> Found:
    rig = solved.rig
    top = max(solved.case.schedule.resolved(), key=lambda stage: abs(stage.torque_end))
    force = rig.torque_ratio * abs(top.torque_end) / rig.pairs[rig.control_mesh].base_radii[0]
    return worst(
        (abs(rig.mesh_forces[mesh]) * force * radius, f"{gear}, stage {top.name}")
        for mesh, gear, radius in _gears_at(solved, part)
    )


def _torque_peak(solved: SolvedRig, part: str) -> Found:
    """Of a coupling or shaft that in its own sections; of gears that of their meshes, referred to the gear."""
    if solved.loads is None:
        return None, NO_LOADS
    own = [torque for torque in solved.part_torques if torque.event is None and is_at(torque, part)]
    if own:
        return worst((torque.torque, f"{torque.place}, {torque.where}") for torque in own)
    rig, found = solved.rig, solved.loads.meshes
    return worst(
        (
            found[rig.mesh_labels[mesh]].torque_peak * radius / rig.pairs[mesh].base_radii[0],
            f"tooth force at {gear}",
        )
        for mesh, gear, radius in _gears_at(solved, part)
    )


def _gears_at(solved: SolvedRig, part: str) -> Iterator[tuple[MeshName, GearName, float]]:
    """(mesh, gear, base radius) of every gear that loads a part: of a gearbox or mesh the pinions, as torques count;
    of a coupling or shaft the gears of its line."""
    rig = solved.rig
    names = part.split(".")
    whole = names[0] == "gearboxes" and (len(names) == 2 or names[2] == "meshes")
    lines = rig.drivetrain.lines()
    own = {lines.get(shaft) for shaft in shafts_of(solved.case, part)}
    for mesh in rig.mesh_names:
        box = rig.mesh(mesh)[0]
        if names[0] == "gearboxes" and (mesh.gearbox != names[1] or names[2:] not in _naming(solved, mesh)):
            continue
        gears = rig.mesh_gears(mesh)
        for index, gear in enumerate(gears[:1] if whole else gears):
            if (
                whole
                or part.endswith(f".gears.{gear.part}")
                or (names[0] == "drivetrain" and lines[box.gears[gear.part].shaft] in own)
            ):
                yield mesh, gear, rig.pairs[mesh].base_radii[index]


def _naming(solved: SolvedRig, mesh: MeshName) -> list[list[str]]:
    """Ends of the paths that mean a mesh: its gearbox, itself, its two gears."""
    gears = (gear.part for gear in solved.rig.mesh_gears(mesh))
    return [[], ["meshes", mesh.part], *(["gears", gear] for gear in gears)]


def _drive_torque(solved: SolvedRig, part: str) -> Found:
    if solved.run is None:
        return None, NO_LOADS
    return float(abs(solved.run.ramp.drive_torque).max()), "time run over the schedule"


def _drive_power(solved: SolvedRig, part: str) -> Found:
    """At the speed of the motor; that of the time run is the first pinion's."""
    if solved.run is None:
        return None, NO_LOADS
    ramp, rig = solved.run.ramp, solved.rig
    ratio = rig.drive_speed(1.0) / rig.pinion_speed(1.0)
    return float(abs(ramp.drive_torque * ramp.speed * ratio).max()), "time run over the schedule"


def _worst_of_shift(
    solved: SolvedRig, values: Callable[[StageBracing], Iterator[tuple[float, str]]]
) -> Found:
    """Worst value of the bracing at the held stages of a loop that is braced by the shift of a gear."""
    bracing = solved.case.power_circuit.bracing
    if solved.loads is None:
        return None, NO_LOADS
    if bracing.mode == "twist_held" or bracing.shifted_gear is None:
        return None, "the loop is braced by a twist: no gear is shifted"
    return worst(value for held in solved.loads.bracing for value in values(held))


def _actuator_force(solved: SolvedRig, part: str) -> Found:
    return _worst_of_shift(solved, _forces)


def _forces(bracing: StageBracing) -> Iterator[tuple[float, str]]:
    warm = bracing.drift.warm
    yield warm.actuator_force + warm.friction_force, f"stage {bracing.stage}"


def _shift_travel(solved: SolvedRig, part: str) -> Found:
    """From the assembled position, cold or warm: what is left of the way to the end stop is the reserve of control."""
    return _worst_of_shift(solved, _shifts)


def _shifts(bracing: StageBracing) -> Iterator[tuple[float, str]]:
    for heat, state in (("cold", bracing.drift.initial), ("warm", bracing.drift.warm)):
        yield abs(state.shift), f"stage {bracing.stage}, {heat}"


def _circulating_power(solved: SolvedRig, part: str) -> Found:
    """Torque times speed: the same at every place of one loop."""
    return worst(
        (abs(stage.torque_end) * stage.speed_end, f"stage {stage.name}")
        for stage in solved.case.schedule.resolved()
    )


NO_SEAL = "no shaft of the part has such a seal: none leaves its gearbox or passes a wall of its chamber"


def _seal_velocity(solved: SolvedRig, part: str) -> Found:
    """Surface speed in the largest seal of every shaft; the gap in a wall of the chamber is no lip."""
    box, top = part.split(".")[1], max(stage.speed_end for stage in solved.case.schedule.resolved())
    lips = {one.shaft for one in solved.case.gearboxes[box].seals.values() if one.end.touches}
    speeds = [
        (0.5 * seal.diameter * solved.rig.shaft_speed(shaft, top), shaft)
        for shaft in shafts_of(solved.case, part)
        for seal in shaft_seals(solved.rig, box, shaft)
        if seal.leaves or shaft not in lips
    ]
    return worst(speeds) if speeds else (None, NO_SEAL)


def _shaft_expansion(solved: SolvedRig, part: str) -> Found:
    box, shafts = part.split(".")[1], shafts_of(solved.case, part)
    found = [shaft for warm in solved.warm if warm.gearbox == box for shaft in warm.shafts]
    if not found:
        return None, NO_HOUSING
    return worst((shaft.total, shaft.name) for shaft in found if shaft.name in shafts)


KEYS = {"gear_oil": "oil", "bearing_oil": "bearing_oil"}
"""Key of a gearbox by the oil stream that it states."""


def _oil_flow(solved: SolvedRig, part: str) -> Found:
    """Flow of one circuit, of both of a gearbox, or of the rig."""
    _, _, rest = part.partition(".")
    box_name, _, circuit = rest.partition(".")
    flow = 0.0
    for name, box in solved.case.gearboxes.items():
        if box_name in ("", name):
            for stream, (feed, consumers) in box.feeds.items():
                flow += feed.flow * consumers if circuit in ("", KEYS[stream]) else 0.0
    return flow, part


def _temperature(solved: SolvedRig, part: str) -> Found:
    box = part.split(".")[1]
    found = [housing for housing in solved.temperatures if housing.gearbox == box]
    if not found:
        return None, NO_HOUSING
    return worst((housing.max_temperature, housing.max_temperature_body) for housing in found)


def _saturated(solved: SolvedRig, check: Check) -> Omissions:
    """What the speed control asked of the motor beyond its limit: the torque of the run is less than that."""
    run = solved.run
    if run is None:
        return
    controlled = np.array([stage.drive_torque is None for stage in solved.case.schedule.resolved()])
    stage = solved.schedule.at(run.ramp.time).stage
    full = np.abs(run.ramp.drive_torque) >= (1.0 - 1e-9) * solved.case.power_circuit.motor.torque_limit
    share = float(np.mean(full & controlled[stage]))
    if share:
        yield Omission(
            f"what the speed control asked for beyond drivetrain.motor.torque_limit, {100.0 * share:.1f} % of the run: "
            "the motor stands at its limit; raise it to see how much"
        )


RESULTS: dict[ResultQuantity, Callable[[SolvedRig, str], Found]] = {
    "torque_peak": _torque_peak,
    "torque_mean": _torque_mean,
    "speed": _speed,
    "drive_torque": _drive_torque,
    "drive_power": _drive_power,
    "actuator_force": _actuator_force,
    "shift_travel": _shift_travel,
    "circulating_power": _circulating_power,
    "seal_surface_velocity": _seal_velocity,
    "shaft_growth": _shaft_expansion,
    "oil_flow": _oil_flow,
    "temperature_maximum": _temperature,
}
"""How each quantity is found at a part."""


@dataclass(frozen=True, kw_only=True)
class PartFamily(RuleFamily):
    """Limits of bought parts on one quantity; unit, source and title are those that the case states."""

    def rules(self, case: Case) -> Iterator[Rule]:
        """The rule of every bought part that is held against this quantity."""
        quantity = self.key.partition(".")[2]
        for name, part in case.limits.bought_parts.items():
            if quantity == (part.quantity if part.given is None else "given"):
                yield _rule(name, part)

    def limits_of(self, rule: Rule) -> tuple[str, ...]:
        """The limit that the case states for the part."""
        return (f"limits.bought_parts.{rule.id.partition('.')[2]}.limit",)


def _family(quantity: ResultQuantity | Literal["given"], title: str, procedure: str) -> PartFamily:
    return PartFamily(
        key=f"bought_part.{quantity}", title=title, procedure=procedure, unit=NUMBER, group=GROUP,
        source="limits.bought_parts",
    )  # fmt: skip


FAMILIES = (
    replace(
        _family(
            "torque_peak",
            "highest dynamic torque",
            "Largest torque of a coupling or of the sections of a shaft in the periodic responses of the held stages "
            "and at the samples of the time run; of a gearbox, mesh or gear that of its meshes, referred to the gear.",
        ),
        moved_by=frozenset({"time run"}),
    ),
    replace(
        _family(
            "torque_mean",
            "largest mean torque",
            "Largest mean torque of the schedule at the gears of the part, by the ratios of the meshes.",
        ),
        only_inputs=SPEEDS,
        by_definition=True,
    ),
    replace(
        _family(
            "speed",
            "highest speed",
            "Largest speed of the schedule at the shafts of the part, by the ratios of the meshes.",
        ),
        only_inputs=SPEEDS,
        by_definition=True,
    ),
    replace(
        _family(
            "drive_torque",
            "highest torque of the motor",
            "Time run over the whole schedule: largest torque of the motor.",
        ),
        leaves_out=(constant_drag, _saturated),
        moved_by=frozenset({"time run", "housing"}),
    ),
    replace(
        _family(
            "drive_power",
            "highest power of the motor",
            "Time run over the whole schedule: largest torque of the motor times its speed.",
        ),
        leaves_out=(constant_drag, _saturated),
        moved_by=frozenset({"time run", "housing"}),
    ),
    replace(
        _family(
            "actuator_force",
            "largest force of the load unit",
            "Axial force of the shifted gear at the held stages, warm, plus the friction of its seat.",
        ),
        moved_by=frozenset({"spline friction", "housing"}),
    ),
    replace(
        _family(
            "shift_travel",
            "largest axial shift of the gear that braces the loop",
            "Axial shift from the assembled position at the held stages, cold and warm.",
        ),
        moved_by=frozenset({"housing"}),
    ),
    replace(
        _family(
            "circulating_power",
            "largest power in the loop",
            "Largest torque times speed of the schedule: the same at every place of the loop.",
        ),
        only_inputs=SPEEDS,
    ),
    replace(
        _family(
            "seal_surface_velocity",
            "highest surface speed in a seal",
            "Diameter of the seal times the largest speed of its shaft; the largest of all seals of the part.",
        ),
        only_inputs=(
            *SPEEDS,
            "gearboxes.*.housing.shafts",
            "gearboxes.*.bearings",
            "gearboxes.*.seals",
            "drivetrain.shafts",
        ),
    ),
    replace(
        _family(
            "shaft_growth",
            "largest thermal expansion of a shaft",
            "Thermal expansion of the whole shaft at the held stages, from its mean temperatures.",
        ),
        housed=True,
        leaves_out=(warming, constant_drag),
        moved_by=frozenset({"housing"}),
    ),
    replace(
        _family("oil_flow", "oil flow", "Sum of the flows of the circuits of the part."),
        only_inputs=FLOWS,
        by_definition=True,
    ),
    replace(
        _family(
            "temperature_maximum",
            "highest temperature",
            "Highest temperature of the field of the gearbox at the held stages.",
        ),
        housed=True,
        leaves_out=(warming, constant_drag),
        moved_by=frozenset({"housing"}),
    ),
    replace(_family("given", "value given in the case", "The value that the case gives."), only_inputs=()),
)
"""By quantity: the id of a check ends with the name of its part."""
FAMILY_OF = {family.key.partition(".")[2]: family for family in FAMILIES}

REGISTRY.register(Topic(order=60, families=FAMILIES, checks=checks))
