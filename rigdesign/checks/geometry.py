"""Checks of the toothing as drawn: from its geometry alone, before anything is solved and alike at every fidelity."""

from collections.abc import Callable, Iterator
from functools import partial

from dynamics.gear.pair import GearPair
from rigdesign.checks.registry import REGISTRY, RigRule, Topic, Values
from rigdesign.records.solved_rig import SolvedRig
from rigdesign.results.check import Check
from rigdesign.results.units import NUMBER


def _pairs(solved: SolvedRig) -> Iterator[tuple[str, tuple[str, str], GearPair]]:
    """Label of every mesh, names of its gears, and the pair as drawn."""
    for box_name, box in solved.case.gearboxes.items():
        for name, mesh in box.meshes.items():
            label = box_name if len(box.meshes) == 1 else f"{box_name}.{name}"
            yield label, (mesh.pinion, mesh.wheel), solved.rig.pairs[f"{box_name}.{name}"]


def _of_gears(value: Callable[[GearPair, int], tuple[float, str]]) -> Callable[[SolvedRig], Values]:
    """A number of every gear of every mesh, with what is behind it."""

    def values(solved: SolvedRig) -> Values:
        for label, names, pair in _pairs(solved):
            for index, name in enumerate(names):
                number, text = value(pair, index)
                yield number, f"{label} {name}: {text}"

    return values


def _of_meshes(value: Callable[[GearPair], tuple[float, str]]) -> Callable[[SolvedRig], Values]:
    """A number of every mesh, with what is behind it."""

    def values(solved: SolvedRig) -> Values:
        for label, _, pair in _pairs(solved):
            number, text = value(pair)
            yield number, f"{label}: {text}"

    return values


def _tip(pair: GearPair, index: int) -> tuple[float, str]:
    thickness = pair.gears[index].tip_thickness
    return thickness / pair.normal_module, f"{1e3 * thickness:.3f} mm at the tip circle"


def _root_clearance(pair: GearPair, index: int) -> tuple[float, str]:
    clearance = pair.tip_clearances[index]
    return clearance / pair.normal_module, f"{1e3 * clearance:.3f} mm from its tip to the root of its mate"


def _fillet(pair: GearPair, index: int) -> tuple[float, str]:
    distance, overlap = pair.fillet_distances[index], pair.fillet_overlaps[index]
    side = "before" if distance >= 0.0 else "inside"
    text = f"its fillet ends {1e3 * abs(distance):.3f} mm {side} the path of contact"
    if overlap > 0.0:
        text += f" and stands {1e6 * overlap:.3g} um in the way of the mating tip"
    return distance / pair.normal_module, text


def _undercut(pair: GearPair, index: int) -> tuple[float, str]:
    gear = pair.gears[index]
    shift, least = gear.generating_profile_shift, gear.least_profile_shift
    return shift - least, f"generated with x = {shift:.3f}, undercut below x_min = {least:.3f}"


def _contact_ratio(pair: GearPair) -> tuple[float, str]:
    transverse, overlap = pair.transverse_contact_ratio, pair.overlap_ratio
    text = f"eps_alpha {transverse:.3f}, eps_beta {overlap:.3f}"
    return (transverse if overlap < 1.0 else pair.total_contact_ratio), text


def _shift_sum(pair: GearPair) -> tuple[float, str]:
    first, second = pair.profile_shifts
    return abs(first + second), f"{first:.3f} and {second:.3f}"


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
        values=_of_gears(_tip),
    ),
    _RULE(
        key="geometry.root_clearance",
        title="least clearance between a tip and the root of its mate as drawn, in normal modules",
        procedure=f"{DRAWN}: centre distance less tip radius and root radius of the mate, over m_n; the least counts.",
        source="limits.geometry.root_clearance_minimum; ISO 21771",
        limit=lambda limits: limits.geometry.root_clearance_minimum,
        values=_of_gears(_root_clearance),
    ),
    _RULE(
        key="geometry.fillet_distance",
        title="least distance of a fillet from the path of the mating tip, in normal modules",
        procedure=f"{DRAWN}: from the form circle, where the fillet ends, to where the mating tip begins to touch, "
        "along the line of action, over m_n; negative where the tip runs into the fillet. The least counts.",
        source="limits.geometry.fillet_distance_minimum; form circle of ISO 21771:2007, 5.4",
        limit=lambda limits: limits.geometry.fillet_distance_minimum,
        values=_of_gears(_fillet),
    ),
    _RULE(
        key="geometry.undercut",
        title="least profile shift above that at which undercut begins",
        procedure=f"{DRAWN}: generating profile shift less x_min = h_fP - rho_fP (1 - sin alpha_n) - z sin^2 alpha_t / "
        "(2 cos beta), in modules. Undercut that takes part of the path of contact is no gear pair to be computed.",
        source="limits.geometry.undercut_distance_minimum; rack of ISO 53",
        limit=lambda limits: limits.geometry.undercut_distance_minimum,
        values=_of_gears(_undercut),
    ),
    _RULE(
        key="geometry.contact_ratio",
        title="least contact ratio as drawn",
        procedure=f"{DRAWN}: transverse contact ratio of the active flanks; the total one where the overlap ratio is "
        "1 or more, so that some tooth always touches. The least mesh counts.",
        source="limits.geometry.contact_ratio_minimum; ISO 21771",
        limit=lambda limits: limits.geometry.contact_ratio_minimum,
        values=_of_meshes(_contact_ratio),
    ),
    _RULE(
        key="geometry.profile_shift_sum",
        title="largest sum of the profile shifts of a mesh",
        procedure=f"{DRAWN}: sum of both profile shifts that the centre distance asks for, without its sign.",
        source="limits.geometry.profile_shift_sum_maximum; ISO 21771",
        comparison="<=",
        limit=lambda limits: limits.geometry.profile_shift_sum_maximum,
        values=_of_meshes(_shift_sum),
    ),
)  # fmt: skip


def checks(solved: SolvedRig) -> list[Check]:
    """All of them; each the worst of the rig."""
    return [rule.check(solved) for rule in RULES]


REGISTRY.register(Topic(order=5, families=RULES, checks=checks))
