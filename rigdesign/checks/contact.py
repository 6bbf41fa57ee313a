"""Checks of the loaded contact: pressure on the flanks, pressure at tip edges."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rigdesign.case.model import Case
from rigdesign.checks.omissions import long_periods
from rigdesign.checks.places import meshes, meshes_of
from rigdesign.checks.registry import LOADS, REGISTRY, RuleFamily, Topic
from rigdesign.checks.rules import Rule, hold, not_applicable, not_evaluated, worst
from rigdesign.results.check import NO_LIMIT, NO_LOADS, Check
from rigdesign.results.units import MEGAPASCAL, MPA

if TYPE_CHECKING:
    from rigdesign.postprocessing.loaded_contact import HeldContact
    from rigdesign.postprocessing.solved_rig import SolvedRig

ANALYTIC = "the teeth are analytic: no loaded contact"
NO_TORQUE = "the mesh carries no torque at any held stage: no loaded contact"


def _held_meshes(case: Case) -> Iterator[str]:
    """All with a stated limit, else those of the rig itself."""
    return meshes(case) if case.limits.flanks.contact_pressure_maximum is not None else meshes_of("rig", case)


def _with_edge_limit(case: Case) -> Iterator[str]:
    yield from () if case.limits.flanks.edge_pressure_maximum is None else meshes(case)


PRESSURE = RuleFamily(
    key="flank.contact_pressure",
    title="contact pressure of {place}",
    unit=MEGAPASCAL,
    group="dynamics",
    source="limits.flanks.contact_pressure_maximum, else sigma_HG of ISO 6336-2:2006 over "
    "limits.flanks.pitting_safety_minimum; loaded contact from influence numbers",
    procedure="Highest Hertzian pressure of the loaded contact over a mesh cycle and the face, away from tip edges, "
    "times the root of K_A and of the simulated K_V; the highest of all held stages counts. Limit as stated; else the "
    "pitting stress limit of the weaker gear after the planned cycles over the least pitting safety, for gears of the "
    "rig; that is a strength at the pitch point, so that a missed limit is advisory.",
    places=_held_meshes,
    limit_keys=("limits.flanks.contact_pressure_maximum", "limits.flanks.pitting_safety_minimum"),
    one_limit_suffices=True,
    needs=LOADS,
    leaves_out=(long_periods,),
    moved_by=frozenset({"gear rating", "test time", "housing"}),
)
EDGE = RuleFamily(
    key="flank.edge_pressure",
    title="pressure at the tip edges of {place}",
    unit=MEGAPASCAL,
    group="dynamics",
    source="limits.flanks.edge_pressure_maximum; loaded contact from influence numbers",
    procedure="Highest Hertzian pressure of the loaded contact at a tip corner or within half the contact width of a "
    "tip edge, on the radius of the edge, times the root of K_A and of the simulated K_V; the "
    "highest of all held stages counts. Without a limit pressure and share at the test stand with the loaded contact.",
    places=_with_edge_limit,
    needs=LOADS,
    leaves_out=(long_periods,),
    moved_by=frozenset({"gear rating", "housing"}),
)


def checks(solved: SolvedRig) -> list[Check]:
    """Pressure on the flanks, then at the edges, of every mesh that is held."""
    limits = solved.case.limits.flanks
    by_label = {solved.label(mesh): mesh for mesh in range(len(solved.rig.mesh_names))}
    found = []
    for label in PRESSURE.places(solved.case):
        mesh = by_label[label]
        rule = replace(PRESSURE.rule(limits.contact_pressure_maximum, label), role=solved.role(mesh))
        found.append(_pressure(solved, rule, mesh))
    for label in EDGE.places(solved.case):
        mesh = by_label[label]
        rule = replace(EDGE.rule(limits.edge_pressure_maximum, label), role=solved.role(mesh))
        found.append(_edge(solved, rule, mesh))
    return found


@dataclass(frozen=True, kw_only=True)
class _Held:
    """Loaded contact of a mesh at a held stage; raised : root of K_A and simulated K_V, as of a line contact [-]."""

    stage: str
    contact: HeldContact
    raised: float
    factors: str
    """In words."""


def _contacts(solved: SolvedRig, mesh: int) -> tuple[list[_Held], str]:
    """Loaded contact of a mesh at all held stages that load it, or why there is none."""
    if solved.loads is None:
        return [], NO_LOADS
    application, found = solved.application_factor(mesh), []
    for point in solved.points:
        contact, response = solved.held_contact(point, mesh), point.last.response
        if contact is None or response is None:
            continue
        dynamic = float(response.dynamic_factor[mesh])
        found.append(
            _Held(
                stage=point.point.stage,
                contact=contact,
                raised=math.sqrt(application * dynamic),
                factors=f"K_A {application:.2f}, simulated K_V {dynamic:.3f}",
            )
        )
    return found, ANALYTIC if solved.rig.mesh_stiffness != "influence_numbers" else NO_TORQUE


def _pressure(solved: SolvedRig, rule: Rule, mesh: int) -> Check:
    contacts, missing = _contacts(solved, mesh)
    if not contacts:
        return _without_contact(rule, missing)
    limit, basis = rule.limit, "limit as stated"
    if limit is None:
        permissible = _permissible(solved, mesh)
        if permissible is None:
            return not_applicable(rule, NO_LIMIT)
        limit, basis = permissible
        # sigma_HG belongs to the pitch point and the inner point of single contact, not to the peak of a pattern
        rule = replace(rule, advisory=True)
    pressure, how = worst(
        (
            MPA * held.contact.cycle.flank_pressure * held.raised,
            f"quasi-static {MPA * held.contact.cycle.flank_pressure:.0f} MPa, {held.factors}, stage {held.stage}",
        )
        for held in contacts
    )
    return hold(replace(rule, limit=limit), pressure, f"{how}; {basis}")


def _without_contact(rule: Rule, missing: str) -> Check:
    return (not_applicable if missing == NO_TORQUE else not_evaluated)(rule, missing)


def _edge(solved: SolvedRig, rule: Rule, mesh: int) -> Check:
    contacts, missing = _contacts(solved, mesh)
    if not contacts:
        return _without_contact(rule, missing)
    return hold(rule, *worst(_edges(held) for held in contacts))


def _edges(held: _Held) -> tuple[float, str]:
    """Pressure [MPa] at the tip edges at one stage and how it came about."""
    edges = held.contact.edges
    return (
        MPA * edges.tip_pressure * held.raised,
        f"{edges.where}, up to {100.0 * edges.tip_share:.0f} % of the mesh force; quasi-static "
        f"{MPA * edges.tip_pressure:.0f} MPa, {held.factors}, stage {held.stage}",
    )


def _permissible(solved: SolvedRig, mesh: int) -> tuple[float, str] | None:
    """Pitting stress limit [MPa] of the weaker gear over the least safety; None where one is not known."""
    safety = solved.case.limits.flanks.pitting_safety_minimum
    if safety is None:
        return None
    strengths = [
        (MPA * rated.strength, solved.rig.mesh_gear_name(mesh, index))
        for rating in solved.flank_ratings(mesh)
        if rating.pitting is not None
        for index, rated in enumerate(rating.pitting)
    ]
    if not strengths:
        return None
    weakest, gear = worst(strengths, smallest=True)
    return weakest / safety, f"limit {weakest:.0f} MPa of {gear} by ISO 6336-2 over S_H {safety:g}"


REGISTRY.register(Topic(order=22, families=(PRESSURE, EDGE), checks=checks))
