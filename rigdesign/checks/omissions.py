"""What the value of a check leaves out: finders that the families of rules name (`registry.RuleFamily.leaves_out`).

A held check with an omission is open and names it, unless the size of the omission is known and below
the margin (`rules.with_omissions`). A finder depends on the case: a part that it states and no model follows, an
effect that another part of the run computes and the value does not count. Finders of one family only stand with it.
Simplifications that all rigs share are listed in the report (`run.warnings.not_modelled`); contributions that could
only add to the margin, as the heat that a housing would take from the cooler, are none.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from rigdesign.base.units import show
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.losses import LOSS_KINDS
from rigdesign.checks.registry import REGISTRY, Finder
from rigdesign.checks.rules import Omission
from rigdesign.results.check import Check

if TYPE_CHECKING:
    from rigdesign.postprocessing.solved_rig import SolvedRig

Omissions = Iterator[Omission]


def omissions(solved: SolvedRig, check: Check) -> tuple[Omission, ...]:
    """What the value of a check leaves out, in the order in which its family names it."""
    if check.margin is None:
        return ()
    family = REGISTRY.family_of(solved.case, check)
    found = [omission for finder in family.leaves_out for omission in finder(solved, check)]
    if reason := family.cut_run(solved):
        found.insert(0, Omission(reason))
    return tuple(dict.fromkeys(found))


def of_gearboxes(text: str, applies: Callable[[SolvedRig, str, Gearbox], bool]) -> Finder:
    """One omission for every gearbox to which it applies.

    text : with ``{box}`` for the name of the gearbox, ``{why}`` for the reason for which it is not expanded
    """

    def finder(solved: SolvedRig, check: Check) -> Omissions:
        for name, box in solved.case.gearboxes.items():
            if applies(solved, name, box):
                yield Omission(text.format(box=name, why=solved.why_unexpanded(name)))

    return finder


def without_housing(solved: SolvedRig, name: str, box: Gearbox) -> bool:
    """A gearbox without a housing: no temperature field."""
    return box.housing is None


def unexpanded(solved: SolvedRig, name: str, box: Gearbox) -> bool:
    """A gearbox without hot clearances."""
    return name in solved.unexpanded


def thrust(solved: SolvedRig, name: str, box: Gearbox) -> bool:
    """A gearbox whose gears push axially, where the tilting moment of that is in the load of not all its bearings."""
    pushed = {
        box.gears[gear].shaft
        for mesh in box.meshes.values()
        if mesh.helix_angle and not mesh.double_helical
        for gear in (mesh.pinion, mesh.wheel)
    }
    return any(
        bearing.shaft in pushed
        and bearing.radial_load is None
        and box.bearing_positions(bearing.shaft) is None
        for bearing in box.bearings.values()
    )


def sealed(solved: SolvedRig, name: str, box: Gearbox) -> bool:
    """One of these with seals without contact."""
    return unexpanded(solved, name, box) and any(not seals.end.touches for seals in box.seals.values())


def with_play(solved: SolvedRig, name: str, box: Gearbox) -> bool:
    """One of these with a stated axial play."""
    return unexpanded(solved, name, box) and any(b.axial_play > 0.0 for b in box.bearings.values())


def coupled_shafts(solved: SolvedRig, check: Check) -> Omissions:
    """Shafts of a coupling that no housing carries: they stay where they were set."""
    housed = {
        gear.shaft
        for name, box in solved.case.gearboxes.items()
        if name not in solved.unexpanded
        for gear in box.gears.values()
    }
    for shaft in solved.case.power_circuit.couplings[check.id.split(".", 2)[2]].shafts:
        if shaft not in housed:
            yield Omission(f"thermal expansion behind shaft {shaft}: it stays where it was set")


def warming(solved: SolvedRig, check: Check) -> Omissions:
    """A rig that still warms up."""
    time = solved.case.ambient.warming_time
    if time is not None:
        yield Omission(f"the rest of the warm-up after ambient.warming_time = {show(time, 'time')}")


def constant_drag(solved: SolvedRig, check: Check) -> Omissions:
    """With the constant drag of the bearings nothing but them and the teeth loses power."""
    if solved.case.drivetrain is not None and solved.case.losses.bearing_drag == "constant":
        yield Omission("windage, seals, oil acceleration and squeezing (losses.bearing_drag = constant)")


def given_losses(solved: SolvedRig, check: Check) -> Omissions:
    """Kinds of loss of a gearbox of which the case gives none, where it gives the losses."""
    if solved.case.losses.basis != "input":
        return
    for name, box in solved.case.gearboxes.items():
        wanted = [kind.name for kind in LOSS_KINDS.values() if kind.awaited and kind.parts_of(box)]
        given = {entry.kind for entry in solved.case.losses.given.values() if entry.gearbox == name}
        missing = [kind for kind in wanted if kind not in given]
        if missing:
            yield Omission(f"{', '.join(missing)} losses of gearbox {name}: losses.given holds none")


def long_periods(solved: SolvedRig, check: Check) -> Omissions:
    """Single teeth and alternating torques that do not fit into the period of the response."""
    rig = solved.rig
    if rig.case.drivetrain is None or not solved.points:
        return
    beyond = solved.beyond_period
    missing = [f"differences between the teeth of {gear}" for gear in beyond.gears]
    missing += [f"alternating torque of {name}" for name in beyond.loads]
    for what in missing:
        yield Omission(f"{what} (numerics.response_period = {rig.case.numerics.response_period})")
    lines = beyond.lines
    if lines and solved.lateral is not None and check.value is not None:
        shares = (mesh.share(lines) for stage in solved.lateral.of("held") for mesh in stage.meshes)
        share = max((one for one in shares if math.isfinite(one)), default=0.0)
        yield Omission(
            f"unbalance, bow and run-out of {', '.join(lines)}: {100.0 * share:.2g} % of the mesh force by its linear "
            f"response (numerics.response_period = {rig.case.numerics.response_period})",
            size=share * abs(check.value),
        )


EXPANSION = "thermal expansion of gearbox {box}: {why}"
HEAT: tuple[Finder, ...] = (warming, constant_drag, given_losses)
"""Of every value that follows from the heat of the rig."""
