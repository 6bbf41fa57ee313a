"""Checks of the toothing as drawn: from its geometry alone, before anything is solved and alike at every fidelity."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING

from rigdesign.checks.registry import REGISTRY, RigRule, Topic, Values
from rigdesign.results.check import Check
from rigdesign.results.units import NUMBER

if TYPE_CHECKING:
    from dynamics.gear.pair import GearPair
    from rigdesign.postprocessing.solved_rig import SolvedRig

GEARS = ("pinion", "wheel")
Numbers = Iterator[tuple[float, str]]
"""Of the gears of a pair, or of the pair, each with what is behind it."""


def _as_drawn(numbers: Callable[[GearPair], Numbers]) -> Callable[[SolvedRig], Values]:
    """Numbers of every mesh as drawn, each with its place."""
    return lambda solved: (
        (value, f"{solved.label(mesh)} {text}")
        for mesh, name in enumerate(solved.rig.mesh_names)
        for value, text in numbers(solved.rig.pairs[name])
    )


def _tips(pair: GearPair) -> Numbers:
    for name, gear in zip(GEARS, pair.gears, strict=True):
        yield (
            gear.tip_thickness / pair.normal_module,
            f"{name}: {1e3 * gear.tip_thickness:.3f} mm at the tip circle",
        )


def _roots(pair: GearPair) -> Numbers:
    for name, clearance in zip(GEARS, pair.tip_clearances, strict=True):
        yield (
            clearance / pair.normal_module,
            f"{name}: {1e3 * clearance:.3f} mm from its tip to the root of its mate",
        )


def _fillets(pair: GearPair) -> Numbers:
    for name, distance, overlap in zip(GEARS, pair.fillet_distances, pair.fillet_overlaps, strict=True):
        side = "before" if distance >= 0.0 else "inside"
        text = f"{name}: its fillet ends {1e3 * abs(distance):.3f} mm {side} the path of contact"
        more = f" and stands {1e6 * overlap:.3g} um in the way of the mating tip" if overlap > 0.0 else ""
        yield distance / pair.normal_module, text + more


def _undercut(pair: GearPair) -> Numbers:
    for name, gear in zip(GEARS, pair.gears, strict=True):
        shift, least = gear.generating_profile_shift, gear.least_profile_shift
        yield shift - least, f"{name}: generated with x = {shift:.3f}, undercut below x_min = {least:.3f}"


def _contact_ratio(pair: GearPair) -> Numbers:
    transverse, overlap = pair.transverse_contact_ratio, pair.overlap_ratio
    ratio = transverse if overlap < 1.0 else pair.total_contact_ratio
    yield ratio, f"mesh: eps_alpha {transverse:.3f}, eps_beta {overlap:.3f}"


def _shift_sum(pair: GearPair) -> Numbers:
    first, second = pair.profile_shifts
    yield abs(first + second), f"mesh: {first:.3f} and {second:.3f}"


_RULE = partial(
    RigRule,
    unit=NUMBER,
    group="geometry",
    comparison=">=",
    only_inputs=("gearboxes.*.gears", "gearboxes.*.meshes"),
)
DRAWN = "Toothing as drawn, with the tools of the racks and the thickness allowances (ISO 21771)"
RULES = (
    _RULE(
        key="geometry.tip_thickness",
        title="least tooth thickness at a tip circle, in normal modules",
        procedure=f"{DRAWN}: transverse thickness at the tip circle over m_n; the thinnest tip counts.",
        source="limits.geometry.tip_thickness_minimum; involute of ISO 21771",
        limit=lambda limits: limits.geometry.tip_thickness_minimum,
        values=_as_drawn(_tips),
    ),
    _RULE(
        key="geometry.root_clearance",
        title="least clearance between a tip and the root of its mate as drawn, in normal modules",
        procedure=f"{DRAWN}: centre distance less tip radius and root radius of the mate, over m_n; the least counts.",
        source="limits.geometry.root_clearance_minimum; ISO 21771",
        limit=lambda limits: limits.geometry.root_clearance_minimum,
        values=_as_drawn(_roots),
    ),
    _RULE(
        key="geometry.fillet_distance",
        title="least distance of a fillet from the path of the mating tip, in normal modules",
        procedure=f"{DRAWN}: from the form circle, where the fillet ends, to where the mating tip begins to touch, "
        "along the line of action, over m_n; negative where the tip runs into the fillet. The least counts.",
        source="limits.geometry.fillet_distance_minimum; form circle of ISO 21771:2007, 5.4",
        limit=lambda limits: limits.geometry.fillet_distance_minimum,
        values=_as_drawn(_fillets),
    ),
    _RULE(
        key="geometry.undercut",
        title="least profile shift above that at which undercut begins",
        procedure=f"{DRAWN}: generating profile shift less x_min = h_fP - rho_fP (1 - sin alpha_n) - z sin^2 alpha_t / "
        "(2 cos beta), in modules. Undercut that takes part of the path of contact is no gear pair to be computed.",
        source="limits.geometry.undercut_distance_minimum; rack of ISO 53",
        limit=lambda limits: limits.geometry.undercut_distance_minimum,
        values=_as_drawn(_undercut),
    ),
    _RULE(
        key="geometry.contact_ratio",
        title="least contact ratio as drawn",
        procedure=f"{DRAWN}: transverse contact ratio of the active flanks; the total one where the overlap ratio is "
        "1 or more, so that some tooth always touches. The least mesh counts.",
        source="limits.geometry.contact_ratio_minimum; ISO 21771",
        limit=lambda limits: limits.geometry.contact_ratio_minimum,
        values=_as_drawn(_contact_ratio),
    ),
    _RULE(
        key="geometry.profile_shift_sum",
        title="largest sum of the profile shifts of a mesh",
        procedure=f"{DRAWN}: sum of both profile shifts that the centre distance asks for, without its sign.",
        source="limits.geometry.profile_shift_sum_maximum; ISO 21771",
        comparison="<=",
        limit=lambda limits: limits.geometry.profile_shift_sum_maximum,
        values=_as_drawn(_shift_sum),
    ),
)  # fmt: skip


def checks(solved: SolvedRig) -> list[Check]:
    """All of them; each the worst of the rig."""
    return [rule.check(solved) for rule in RULES]


def missed(unsolved: SolvedRig) -> Iterator[str]:
    """Limits of the toothing that a rig without solved points misses, in words."""
    for check in checks(unsolved):
        if check.verdict == "fail":
            yield f"missed before anything is solved: {check.title}: {check.value:.4g}, {check.reason}"


REGISTRY.register(Topic(order=5, families=RULES, checks=checks))
