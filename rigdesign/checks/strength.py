"""Checks of the teeth: root stress by standard and over the path, a window or a safety, load cycles.

Which stress governs: where the stress over the path comes from influence numbers it decides, as ISO 6336-1 ranks a
comprehensive calculation (method A) above method B; the check by ISO 6336-3 is then a hand check beside it, whose limit
is advisory. Where it comes from the factors of ISO 6336-3 itself, both count.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rigdesign.case.fields import Influence
from rigdesign.checks.omissions import long_periods
from rigdesign.checks.places import rig_gears, specimen_gears
from rigdesign.checks.registry import LOADS, REGISTRY, SPEEDS, RuleFamily, Topic
from rigdesign.checks.rules import Rule, hold, not_applicable, not_evaluated, worst
from rigdesign.results.check import NO_LIMIT, NO_LOADS, Check
from rigdesign.results.units import HOUR, MEGAPASCAL, MPA, NUMBER, RPM

if TYPE_CHECKING:
    from rigdesign.postprocessing.solved_rig import SolvedRig
    from rigdesign.results.loads import RootStressPath


@dataclass(frozen=True)
class StressMethod:
    """A way to the root stress of a gear."""

    name: str
    """In ids."""
    title: str
    source: str
    procedure: str
    """Of the stress."""
    moved_by: frozenset[Influence] = frozenset()


@dataclass(frozen=True, kw_only=True)
class GearFamily(RuleFamily):
    """One rule for every gear of every mesh; the place is ``mesh.gear``."""

    def rule(self, limit: float | None, place: str = "") -> Rule:
        """The rule of one gear with its limit [SI]."""
        label, _, gear = place.rpartition(".")
        return replace(super().rule(limit, place), title=self.title.format(place=f"{label} {gear}"))


ISO = StressMethod(
    "iso",
    "ISO 6336-3",
    "ISO 6336-3:2006 method B with the simulated K_V",
    "sigma_F of ISO 6336-3:2006 at every held stage: nominal stress of the mean torque at the outer point of single "
    "contact times K_A, simulated K_V, K_Fbeta and K_Falpha, those of the loaded contact where it is computed; the "
    "highest stage counts.",
    frozenset({"gear rating", "housing"}),
)
PATH = StressMethod(
    "path",
    "over the path",
    "sigma_F over the path from the dynamic tooth forces, local lever",
    "Forces on one tooth through its whole contact in the periodic response, shared between the pairs by their "
    "stiffness and deviations. With influence numbers the stress of every force at all points of the fillet and over "
    "the face, forces on both neighbours included: this one governs. Without them by the form "
    "and stress correction factors of ISO 6336-3 at the lever of its place. The peak of the path and of all held "
    "stages counts, times K_A.",
)
METHODS = (ISO, PATH)
OF_WINDOW: frozenset[Influence] = frozenset({"specimen limits"})
OF_SAFETY: frozenset[Influence] = frozenset({"strength limits", "test time"})

WINDOWS = {
    method.name: GearFamily(
        key=f"specimen.root_stress_{method.name}",
        title=f"root stress of specimen {{place}}, {method.title}",
        unit=MEGAPASCAL,
        group="specimen",
        source=method.source,
        procedure=method.procedure,
        places=specimen_gears,
        limit_keys=("limits.specimen.root_stress_minimum", "limits.specimen.root_stress_maximum"),
        comparison="within",
        needs=LOADS,
        leaves_out=(long_periods,),
        moved_by=OF_WINDOW | method.moved_by,
    )
    for method in METHODS
}
SAFETIES = {
    method.name: GearFamily(
        key=f"strength.root_safety_{method.name}",
        title=f"root safety of {{place}}, {method.title}",
        unit=NUMBER,
        group="dynamics",
        source=f"{method.source}; sigma_FE of the material, ISO 6336-3:2006 clauses 12, 13, 15",
        procedure=f"{method.procedure} The strength is sigma_FE of the material times the factors of life (planned "
        "cycles of all specimens), notch, surface and size. For an idler that is bent both ways they are those of the "
        "highest stress in the fillet that this mesh loads: with the centrifugal stress and that of the press fit, and "
        "the mean stress influence factor Y_M of ISO 6336-3:2006, Annex B, at its stress ratio R; below R = -1.2, "
        "where the annex ends, at the stress amplitude of -1.2. Safety: strength over stress.",
        places=rig_gears,
        limit_keys=("limits.strength.root_safety_minimum",),
        comparison=">=",
        needs=LOADS,
        leaves_out=(long_periods,),
        moved_by=OF_SAFETY | method.moved_by,
    )
    for method in METHODS
}
LOAD_CYCLES = RuleFamily(
    key="specimen.load_cycles",
    title="load cycles of a specimen tooth in the planned time",
    procedure="Turns of every specimen gear at test speed in the planned time; the slowest gear counts.",
    unit=NUMBER,
    group="specimen",
    source="limits.specimen.load_cycles_minimum; test_plan.time at test speed",
    comparison=">=",
    absent="no gearbox is a specimen",
    only_inputs=("test_plan", "limits.specimen", *SPEEDS),
)


def checks(solved: SolvedRig) -> list[Check]:
    """Root stress of every gear of every mesh, then the load cycles of the specimens."""
    found = [check for mesh in range(len(solved.rig.mesh_names)) for check in _of_mesh(solved, mesh)]
    return [*found, _load_cycles(solved)]


def _of_mesh(solved: SolvedRig, mesh: int) -> Iterator[Check]:
    """A window for specimens, a safety for the rig's own gears."""
    check = _window if solved.role(mesh) == "specimen" else _safety
    for index in (0, 1):
        for method in METHODS:
            yield check(solved, mesh, index, method)


def _window(solved: SolvedRig, mesh: int, index: int, method: StressMethod) -> Check:
    window, family = solved.case.limits.specimen, WINDOWS[method.name]
    low, high = window.root_stress_minimum, window.root_stress_maximum
    label, gear = solved.label(mesh), solved.rig.mesh_gear_name(mesh, index)
    rule = replace(
        family.rule(low, f"{label}.{gear}"),
        role="specimen",
        upper_limit=None if high is None else MPA * high,
        advisory=_by_hand(solved, mesh, method),
    )
    if solved.loads is None or low is None:
        return not_applicable(rule, NO_LIMIT) if low is None else not_evaluated(rule, NO_LOADS)
    stress, how = _stress(solved, mesh, index, method)
    return hold(rule, stress, f"{how}{_beside(solved, mesh, index, method)}")


def _safety(solved: SolvedRig, mesh: int, index: int, method: StressMethod) -> Check:
    family, limit = SAFETIES[method.name], solved.case.limits.strength.root_safety_minimum
    label, gear = solved.label(mesh), solved.rig.mesh_gear_name(mesh, index)
    rule = replace(family.rule(limit, f"{label}.{gear}"), advisory=_by_hand(solved, mesh, method))
    if solved.loads is None or limit is None:
        return not_applicable(rule, NO_LIMIT) if limit is None else not_evaluated(rule, NO_LOADS)
    found = root_safety(solved, mesh, index, method)
    if found is None:
        material = solved.rig.materials[solved.rig.mesh_gear(mesh, index).material]
        return not_evaluated(rule, f"material {material.title} has no root strength")
    safety, how = found
    return hold(rule, safety, f"{how}{_beside(solved, mesh, index, method)}")


def _path(solved: SolvedRig, mesh: int, index: int) -> RootStressPath:
    assert solved.loads is not None
    return solved.loads.meshes[solved.label(mesh)].root_stress[index]


def _by_hand(solved: SolvedRig, mesh: int, method: StressMethod) -> bool:
    """Whether a method stands beside the one that governs."""
    return method is ISO and solved.loads is not None and _path(solved, mesh, 0).by_influence


def _beside(solved: SolvedRig, mesh: int, index: int, method: StressMethod) -> str:
    """Which of both stresses governs and why, in words."""
    path = _path(solved, mesh, index)
    if not path.by_influence:
        return ""
    field, nominal = _stress(solved, mesh, index, PATH)[0], worst(_iso_stresses(solved, mesh, index))[0]
    if method is ISO:
        return f"; a hand check: the computed field governs with {field:.0f} MPa where ISO 6336-3 has {nominal:.0f} MPa"
    return (
        f"; it governs: computed from {path.source} under the dynamic force of every tooth, "
        f"{field:.0f} MPa, beside "
        f"{nominal:.0f} MPa of ISO 6336-3 method B by hand"
    )


def _stress(solved: SolvedRig, mesh: int, index: int, method: StressMethod) -> tuple[float, str]:
    """Highest root stress [MPa] of one gear over the held stages and how it came about."""
    if method is ISO:
        return worst(_iso_stresses(solved, mesh, index))
    path = _path(solved, mesh, index)
    application = solved.application_factor(mesh)
    raised = "" if application == 1.0 else f", times K_A {application:.2f}"
    dynamic, static = max(path.dynamic), max(path.quasi_static)
    return (
        application * dynamic * MPA,
        f"peak of sigma_F over the path, {dynamic / static:.3f} times the quasi-static one{raised}, "
        f"stage {path.stage}",
    )


def _iso_stresses(solved: SolvedRig, mesh: int, index: int) -> Iterator[tuple[float, str]]:
    """sigma_F [MPa] of ISO 6336-3 at every held stage, with the simulated K_V in K_Falpha too."""
    for load, stress in solved.standard_root_stresses(mesh, index):
        yield (
            stress.sigma_F,
            f"nominal {stress.sigma_F0:.0f} MPa, simulated K_V {stress.K_V:.3f}, K_Fbeta {stress.K_Fbeta:.2f}, "
            f"K_Falpha {stress.K_Falpha:.3f}, {load.sharing_basis}, stage {load.stage}",
        )


def root_safety(
    solved: SolvedRig, mesh: int, index: int, method: StressMethod = ISO
) -> tuple[float, str] | None:
    """Root safety S_F of one gear and how it came about; None for a material without a root strength."""
    material = solved.rig.materials[solved.rig.mesh_gear(mesh, index).material]
    if material.root_strength is None:
        return None
    stress, how = _stress(solved, mesh, index, method)
    share, factors = _strength_share(solved, mesh, index)
    bending = solved.reversed_bending(mesh, index, stress / MPA, over_path=method is PATH)
    words = f"sigma_F {stress:.0f} MPa"
    if bending is not None:
        stress, share = stress + MPA * bending.mean, share * bending.strength_factor
        words += f" + {MPA * bending.mean:.0f} MPa held all the time"
        factors += (
            f", Y_M {bending.strength_factor:.3f} for R {bending.stress_ratio:.2f} (idler, bent both ways)"
        )
    strength = MPA * share * material.root_strength
    return strength / stress, f"{how}; {words} of {strength:.0f} MPa = sigma_FE {factors}"


def _strength_share(solved: SolvedRig, mesh: int, index: int) -> tuple[float, str]:
    """Share of sigma_FE that the planned cycles, notch and size leave, and its factors."""
    cycles, factors = solved.strength_factors(mesh, index)
    share = math.prod(factors.values())
    words = " ".join(f"{symbol} {value:.3f}" for symbol, value in factors.items())
    return share, f"{words} at {cycles:.2e} cycles"


def _load_cycles(solved: SolvedRig) -> Check:
    """The slowest specimen gear has to get its cycles."""
    hours = solved.case.test_plan.time / HOUR
    rule = LOAD_CYCLES.rule(solved.case.limits.specimen.load_cycles_minimum)
    specimens = (
        (
            solved.load_cycles(gear.shaft),
            f"{hours:.0f} h of {name}.{key} at {_gear_rpm(solved, gear.shaft):.0f} rpm",
        )
        for name, box in solved.case.gearboxes.items()
        if box.role == "specimen"
        for key, gear in box.gears.items()
    )
    return LOAD_CYCLES.worst(solved, replace(rule, role="specimen"), specimens)


def _gear_rpm(solved: SolvedRig, shaft: str) -> float:
    return solved.rig.shaft_speed(shaft, solved.case.schedule.test_speed) * RPM


REGISTRY.register(
    Topic(order=20, families=(*WINDOWS.values(), *SAFETIES.values(), LOAD_CYCLES), checks=checks)
)
