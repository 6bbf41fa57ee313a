"""Checks of the loaded contact: pressure on the flanks, pressure at tip edges."""

import math
from collections.abc import Iterator
from dataclasses import replace

from rigdesign.case.model import Case
from rigdesign.checks.omissions import long_periods
from rigdesign.checks.places import meshes, meshes_of
from rigdesign.checks.registry import LOADS, REGISTRY, RuleFamily, Topic
from rigdesign.checks.rules import Rule, hold, not_applicable
from rigdesign.records.flank_rating import flank_ratings
from rigdesign.records.gear_loads import application_factor
from rigdesign.records.solved_rig import NO_LIMIT, NO_LOADS, SolvedRig, worst
from rigdesign.results.check import Check
from rigdesign.results.loaded_contact import LoadedContact
from rigdesign.results.units import MEGAPASCAL, MPA

NO_CONTACT = (
    "no loaded contact: influence numbers are not computed at this fidelity, or the mesh carries no torque"
)


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
    "times the root of K_A and of the simulated K_V. Limit as stated; else the pitting stress limit of the weaker gear "
    "after the planned cycles over the least pitting safety, for gears of the rig; that is a strength at the pitch "
    "point and warns at most.",
    places=_held_meshes,
    limit_keys=("limits.flanks.contact_pressure_maximum", "limits.flanks.pitting_safety_minimum"),
    needs=LOADS,
    leaves_out=(long_periods,),
    moved_by=frozenset({"gear rating", "test time"}),
)
EDGE = RuleFamily(
    key="flank.edge_pressure",
    title="pressure at the tip edges of {place}",
    unit=MEGAPASCAL,
    group="dynamics",
    source="limits.flanks.edge_pressure_maximum; loaded contact from influence numbers",
    procedure="Highest Hertzian pressure of the loaded contact at a tip corner or within half the contact width of a "
    "tip edge, on the radius of the edge, times the root of K_A and of the simulated K_V. Without a limit the pressure "
    "and its share stand with the loaded contact.",
    places=_with_edge_limit,
    needs=LOADS,
    leaves_out=(long_periods,),
    moved_by=frozenset({"gear rating"}),
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


def _contact(solved: SolvedRig, mesh: int) -> tuple[LoadedContact | None, str]:
    """Loaded contact of a mesh, or why there is none."""
    if solved.loads is None:
        return None, NO_LOADS
    found = solved.loads.meshes[solved.label(mesh)].contact
    return found, "" if found is not None else NO_CONTACT


def _pressure(solved: SolvedRig, rule: Rule, mesh: int) -> Check:
    contact, missing = _contact(solved, mesh)
    if contact is None:
        return not_applicable(rule, missing)
    limit, basis = rule.limit, "limit as stated"
    if limit is None:
        permissible = _permissible(solved, mesh)
        if permissible is None:
            return not_applicable(rule, NO_LIMIT)
        limit, basis = permissible
        # sigma_HG belongs to the pitch point and the inner point of single contact, not to the peak of a pattern
        rule = replace(rule, warn_only=True)
    raised, words = _dynamic(solved, mesh)
    pressure = contact.cycle.flank_pressure
    return hold(
        replace(rule, limit=limit),
        MPA * pressure * raised,
        f"quasi-static {MPA * pressure:.0f} MPa, {words}, stage {contact.stage}; {basis}",
    )


def _edge(solved: SolvedRig, rule: Rule, mesh: int) -> Check:
    contact, missing = _contact(solved, mesh)
    if contact is None:
        return not_applicable(rule, missing)
    raised, words = _dynamic(solved, mesh)
    edges = contact.edges
    return hold(
        rule,
        MPA * edges.tip_pressure * raised,
        f"{edges.where}, up to {100.0 * edges.tip_share:.0f} % of the mesh force; quasi-static "
        f"{MPA * edges.tip_pressure:.0f} MPa, {words}, stage {contact.stage}",
    )


def _dynamic(solved: SolvedRig, mesh: int) -> tuple[float, str]:
    """Root of the factors by which the load exceeds the quasi-static one: line contact."""
    response = solved.test.last.response
    assert response is not None
    application, dynamic = application_factor(solved.rig, mesh), float(response.dynamic_factor[mesh])
    return math.sqrt(application * dynamic), f"K_A {application:.2f}, simulated K_V {dynamic:.3f}"


def _permissible(solved: SolvedRig, mesh: int) -> tuple[float, str] | None:
    """Pitting stress limit [MPa] of the weaker gear over the least safety; None where one is not known."""
    safety = solved.case.limits.flanks.pitting_safety_minimum
    if safety is None:
        return None
    strengths = [
        (MPA * rated.strength, solved.rig.mesh_gear_name(mesh, index))
        for rating in flank_ratings(solved.rig, solved.points, mesh)
        if rating.pitting is not None
        for index, rated in enumerate(rating.pitting)
    ]
    if not strengths:
        return None
    weakest, gear = worst(strengths, smallest=True)
    return weakest / safety, f"limit {weakest:.0f} MPa of {gear} by ISO 6336-2 over S_H {safety:g}"


REGISTRY.register(Topic(order=22, families=(PRESSURE, EDGE), checks=checks))
