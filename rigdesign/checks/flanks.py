"""Checks of the flanks: pitting, scuffing, film over roughness, and flanks against the root of the specimens."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from rigdesign.case.limits import FlankLimits
from rigdesign.case.model import Case
from rigdesign.checks.omissions import HEAT, Omissions, long_periods
from rigdesign.checks.places import gears_of, meshes, rig_gears
from rigdesign.checks.registry import LOADS, REGISTRY, RuleFamily, Topic
from rigdesign.checks.rules import Omission, Rule, hold, not_applicable, not_evaluated, worst
from rigdesign.checks.strength import OF_SAFETY, GearFamily, root_safety
from rigdesign.results.check import NO_LIMIT, NO_LOADS, Check
from rigdesign.results.units import MPA, NUMBER, UM, ZERO

if TYPE_CHECKING:
    from rigdesign.postprocessing.solved_rig import SolvedRig
    from rigdesign.results.teeth import FlankRating

NO_SPECIMEN = "no specimen with a root strength is loaded"


def _mean_of_gear(solved: SolvedRig, check: Check) -> Omissions:
    """Teeth of a gearbox with a temperature field that have no temperature of their own."""
    name = next(name for name in solved.case.gearboxes if f".{name}." in f"{check.id}.")
    box = solved.case.gearboxes[name]
    if box.housing is not None and box.heat_split.rule == "assumed":
        yield Omission(f"teeth of gearbox {name} above the mean of their gear: heat_split.mesh = assumed")


LOAD_SHARING = (
    "K_Hbeta and K_Halpha of the loaded contact where that is computed, else from the K_Fbeta of the case and of "
    "ISO 6336-1"
)


def _all_gears(case: Case) -> Iterator[str]:
    yield from gears_of("specimen", case)
    yield from gears_of("rig", case)


PITTING = GearFamily(
    key="flank.pitting_safety",
    title="pitting safety of {place}, ISO 6336-2",
    unit=NUMBER,
    group="dynamics",
    source="limits.flanks.pitting_safety_minimum; ISO 6336-2:2006 method B with the simulated K_V",
    procedure="sigma_H of ISO 6336-2:2006 at every held stage: contact stress of the mean torque at the pitch point or "
    f"at the inner point of single contact, with K_A, simulated K_V, {LOAD_SHARING}. The strength is sigma_Hlim of "
    "the material times the factors of life (planned cycles of all specimens), oil, speed, roughness and size. Safety: "
    "strength over stress.",
    places=rig_gears,
    comparison=">=",
    needs=LOADS,
    leaves_out=(long_periods,),
    moved_by=OF_SAFETY | {"gear rating", "housing"},
)
OVER_ROOT = GearFamily(
    key="flank.over_specimen_root",
    title="load of the flanks of {place} over that of the specimen's root",
    unit=NUMBER,
    group="specimen",
    source="limits.flanks.flank_over_root_minimum; ISO 6336-2:2006 and ISO 6336-3:2006 method B",
    procedure="Load that the flank carries, S_H squared of ISO 6336-2 (stress grows with the root of the load), over "
    "the load that the root of the weakest specimen carries, S_F of ISO 6336-3; both after the planned cycles, of one "
    "test for specimens and of all for gears of the rig. Below 1 the flank pits before the root breaks.",
    places=_all_gears,
    comparison=">=",
    needs=LOADS,
    leaves_out=(long_periods,),
    moved_by=OF_SAFETY | {"gear rating", "housing"},
    across_gearboxes=True,
)
SCUFFING = RuleFamily(
    key="flank.scuffing_safety",
    title="scuffing safety of {place}, flash temperature",
    unit=NUMBER,
    group="dynamics",
    source="limits.flanks.scuffing_safety_minimum; ISO/TS 6336-20:2017 with the simulated K_V",
    procedure="Contact temperature at every held stage, ISO/TS 6336-20: temperature of the teeth from our own field "
    f"plus the flash temperature over the path, load shared by that document, K_A, simulated K_V, {LOAD_SHARING}. "
    "Scuffing temperature as stated, or from the FZG load stage of the oil. Safety: scuffing over contact temperature, "
    "both above the oil, or above the teeth where these are colder.",
    places=meshes,
    comparison=">=",
    needs=LOADS,
    unconfirmed="X_Gamma, X_J, mu_m and S_B of ISO/TS 6336-20 are from memory, not compared with a copy",
    leaves_out=(_mean_of_gear, long_periods, *HEAT),
    moved_by=frozenset({"gear rating", "flank rating", "housing"}),
)
FILM = RuleFamily(
    key="flank.film_ratio",
    title="least film over roughness of {place}",
    unit=NUMBER,
    group="dynamics",
    source="limits.flanks.film_ratio_minimum; ISO/TS 6336-22:2018 method B with the simulated K_V",
    procedure="lambda_GF of ISO/TS 6336-22 at every held stage: film of the line contact at the temperature of the "
    "teeth from our own field, thinned by the local contact temperature, over the mean Ra of both flanks, at the "
    "points A, AB, B, C, D, DE and E of the path. The least counts.",
    places=meshes,
    comparison=">=",
    needs=LOADS,
    unconfirmed="ISO/TS 6336-22 is from memory of ISO/TR 15144-1, not compared with a copy",
    leaves_out=(_mean_of_gear, long_periods, *HEAT),
    moved_by=frozenset({"gear rating", "housing"}),
)
Ratings = Sequence["FlankRating"]


def _ratings(solved: SolvedRig) -> Iterator[tuple[int, Ratings]]:
    """Ratings of every mesh at the held stages; none where losses are given."""
    for mesh in range(len(solved.rig.mesh_names)):
        yield mesh, solved.flank_ratings(mesh)


def load_checks(solved: SolvedRig) -> list[Check]:
    """Pitting safety of every gear of the rig, then all flanks against the root of the specimens."""
    rated = (
        dict(_ratings(solved))
        if _asked(solved, ("pitting_safety_minimum", "flank_over_root_minimum"))
        else {}
    )
    return [*_pitting_checks(solved, rated), *_over_root_checks(solved, rated)]


def heat_checks(solved: SolvedRig) -> list[Check]:
    """Scuffing safety and film of every mesh."""
    limits = solved.case.limits.flanks
    rated = (
        dict(_ratings(solved)) if _asked(solved, ("scuffing_safety_minimum", "film_ratio_minimum")) else {}
    )
    found = []
    for mesh in range(len(solved.rig.mesh_names)):
        ratings = rated.get(mesh, ())
        rule = _mesh_rule(solved, SCUFFING, limits.scuffing_safety_minimum, mesh)
        found.append(_held(solved, rule, _scuffing(ratings), [rating.no_scuffing for rating in ratings]))
        rule = _mesh_rule(solved, FILM, limits.film_ratio_minimum, mesh)
        found.append(_held(solved, rule, _films(ratings), [rating.no_contact for rating in ratings]))
    return found


def _asked(solved: SolvedRig, keys: Iterable[str]) -> bool:
    """Whether anything is held against these limits."""
    limits: FlankLimits = solved.case.limits.flanks
    return bool(solved.points) and any(getattr(limits, key) is not None for key in keys)


def _mesh_rule(solved: SolvedRig, family: RuleFamily, limit: float | None, mesh: int) -> Rule:
    return replace(family.rule(limit, solved.label(mesh)), role=solved.role(mesh))


def _held(
    solved: SolvedRig, rule: Rule, values: Iterable[tuple[float, str]], missing: Iterable[str]
) -> Check:
    """The least value against its rule, or why there is none."""
    if not any(point.last.response is not None for point in solved.points):
        return not_evaluated(rule, NO_LOADS)
    if rule.limit is None:
        return not_applicable(rule, NO_LIMIT)
    listed = list(values)
    if not listed:
        lacking = "; ".join(dict.fromkeys(filter(None, missing)))
        return (
            not_evaluated(rule, lacking)
            if lacking
            else not_applicable(rule, "no held stage turns under load")
        )
    return hold(rule, *worst(listed, smallest=True))


def _pitting_checks(solved: SolvedRig, rated: Mapping[int, Ratings]) -> Iterator[Check]:
    limit = solved.case.limits.flanks.pitting_safety_minimum
    for mesh in range(len(solved.rig.mesh_names)):
        if solved.role(mesh) == "specimen":
            continue
        ratings = rated.get(mesh, ())
        for index in (0, 1):
            rule = PITTING.rule(limit, _gear_place(solved, mesh, index))
            yield _held(solved, rule, _pitting(ratings, index), [rating.no_pitting for rating in ratings])


def _over_root_checks(solved: SolvedRig, rated: Mapping[int, Ratings]) -> Iterator[Check]:
    limit = solved.case.limits.flanks.flank_over_root_minimum
    root = _weakest_root(solved) if limit is not None and any(rated.values()) else None
    for mesh in sorted(range(len(solved.rig.mesh_names)), key=lambda mesh: solved.role(mesh) != "specimen"):
        ratings = rated.get(mesh, ())
        for index in (0, 1):
            rule = replace(OVER_ROOT.rule(limit, _gear_place(solved, mesh, index)), role=solved.role(mesh))
            values = () if root is None else _over_root(ratings, index, *root)
            missing = [NO_SPECIMEN] if root is None else [rating.no_pitting for rating in ratings]
            yield _held(solved, rule, values, missing)


def _gear_place(solved: SolvedRig, mesh: int, index: int) -> str:
    return f"{solved.label(mesh)}.{solved.rig.mesh_gear_name(mesh, index)}"


def _weakest_root(solved: SolvedRig) -> tuple[float, str] | None:
    """Least root safety of a specimen gear, and its place; None without specimens whose root strength is known."""
    found = [
        (rated[0], _gear_place(solved, mesh, index))
        for mesh in range(len(solved.rig.mesh_names))
        if solved.role(mesh) == "specimen"
        for index in (0, 1)
        if (rated := root_safety(solved, mesh, index)) is not None
    ]
    return worst(found, smallest=True) if found else None


def _pitting(ratings: Ratings, index: int) -> Iterator[tuple[float, str]]:
    for rating in ratings:
        if rating.pitting is not None:
            gear = rating.pitting[index]
            words = " ".join(f"{symbol} {value:.3f}" for symbol, value in gear.strength_factors.items())
            yield (
                gear.safety,
                f"nominal {MPA * gear.nominal:.0f} MPa, simulated K_V {rating.factors.dynamic:.3f}, K_Hbeta "
                f"{rating.factors.face_load:.2f}, K_Halpha {rating.factors.transverse:.3f}, {rating.sharing_basis}, "
                f"stage {rating.stage}; "
                f"sigma_H {MPA * gear.stress:.0f} MPa of {MPA * gear.strength:.0f} MPa = sigma_Hlim {words}",
            )


def _over_root(ratings: Ratings, index: int, root: float, where: str) -> Iterator[tuple[float, str]]:
    for rating in ratings:
        if rating.pitting is not None:
            gear = rating.pitting[index]
            yield (
                gear.load_safety / root,
                f"flank S_H {gear.safety:.3f}, carries {gear.load_safety:.2f} of its load at stage {rating.stage}; "
                f"root of {where} S_F {root:.3f}",
            )


def _scuffing(ratings: Ratings) -> Iterator[tuple[float, str]]:
    for rating in ratings:
        if rating.scuffing_safety is not None and rating.contact is not None:
            assert rating.scuffing_temperature is not None
            contact = rating.contact
            yield (
                rating.scuffing_safety,
                f"contact {contact.highest - ZERO:.0f} degC, scuffing at "
                f"{rating.scuffing_temperature - ZERO:.0f} degC, stage {rating.stage}; "
                f"bulk {contact.bulk - ZERO:.0f} degC ({rating.bulk_basis}), flash "
                f"{contact.highest - contact.bulk:.0f} K at {1e3 * contact.hottest:.2f} mm from the pitch point, "
                f"friction {contact.friction:.3f}, oil {rating.oil_temperature - ZERO:.0f} degC",
            )


def _films(ratings: Ratings) -> Iterator[tuple[float, str]]:
    for rating in ratings:
        if rating.films is not None:
            films = rating.films
            at = films.points.index(films.thinnest)
            yield (
                films.least,
                f"film {UM * films.film[at]:.3f} um at {films.thinnest}, contact "
                f"{films.contact_temperature[at] - ZERO:.0f} degC, stage {rating.stage}; "
                f"{MPA * films.pressure[at]:.0f} MPa, teeth {rating.bulk_temperature - ZERO:.0f} degC "
                f"({rating.bulk_basis})",
            )


REGISTRY.register(Topic(order=21, families=(PITTING, OVER_ROOT), checks=load_checks))
REGISTRY.register(Topic(order=31, families=(SCUFFING, FILM), checks=heat_checks, of_housing_mesh=True))
