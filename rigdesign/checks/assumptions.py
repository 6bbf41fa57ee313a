"""Which assumed inputs a check depends on: those its family declares (`registry.RuleFamily`) and its own limit."""

from dataclasses import replace
from functools import lru_cache

from rigdesign.case.model import Case
from rigdesign.checks.influences import INPUTS, MOVE_NO_CHECK, OF_ONE_GEARBOX, Influence
from rigdesign.checks.registry import PATH, REGISTRY, RuleFamily
from rigdesign.results.check import Check


def with_assumptions(case: Case, check: Check) -> Check:
    """The check with the paths of the assumed inputs it depends on; none where it does not apply."""
    if check.verdict == "not applicable":
        return check
    found = tuple(record.path for record in case.assumptions if depends(case, check, record.path))
    return replace(check, assumptions=found)


def depends(case: Case, check: Check, path: str) -> bool:
    """Whether the value or limit of a check depends on an input."""
    if any(is_under(path, part) for part in MOVE_NO_CHECK):
        return False
    group, _, name = check.id.partition(".")
    own = [
        *PATH.findall(check.source),
        *([f"limits.bought_parts.{name}"] if group.startswith("bought_part") else []),
    ]
    if any(is_under(path, part) for part in own):
        return True
    family = REGISTRY.family_of(case, check)
    if family.only_inputs is not None:
        return any(is_under(path, part) for part in family.only_inputs)
    influences = influences_of(case, path)
    return influences is None or any(_moves(influence, family, check, path) for influence in influences)


def _moves(influence: Influence, family: RuleFamily, check: Check, path: str) -> bool:
    """Whether an influence of an input moves a check."""
    if influence in OF_ONE_GEARBOX and not family.across_gearboxes:
        box = path.split(".")[1]
        if not check.id.startswith(f"{family.key}.{box}."):
            return False
    return influence in family.moved_by


def influences_of(case: Case, path: str) -> tuple[Influence, ...] | None:
    """What an input moves; None for all checks."""
    if any(is_under(path, part) for part in MOVE_NO_CHECK):
        return ()
    for inputs, influences in INPUTS.items():
        for part in inputs:
            if any(is_under(path, one) for one in _filled(case, part)):
                return influences
    return None


def _filled(case: Case, part: str) -> list[str]:
    """Paths that an entry of `INPUTS` means in a case."""
    if "{dry}" in part:
        wet = any(machine.coolant in case.oil_circuits for machine in case.rig_heat.machines.values())
        return [] if wet else [part.replace("{dry}", "")]
    if "{torsional}" in part:
        bends = case.drivetrain is not None and case.drivetrain.shaft_model == "elastic"
        return [] if bends else _filled(case, part.replace("{torsional}", ""))
    if "{film}" in part:
        return [part.replace("{film}", name) for name in _computed_films(case)]
    if "{bare}" in part:
        return [part.replace("{bare}", name) for name, box in case.gearboxes.items() if box.housing is None]
    return [part]


def _computed_films(case: Case) -> list[str]:
    """Plain bearings whose lateral coefficients the case does not take as stated, as ``gearbox.bearings.name``."""
    train = case.drivetrain
    if train is not None and train.shaft_model == "elastic" and train.bearing_coefficients == "stated":
        return []
    return [
        f"{box_name}.bearings.{name}"
        for box_name, box in case.gearboxes.items()
        for name, bearing in box.bearings.items()
        if bearing.has_film
    ]


@lru_cache(maxsize=1 << 16)
def is_under(path: str, part: str) -> bool:
    """Whether a path of the case is the part or lies under it."""
    names, wanted = path.split("."), part.split(".")
    return len(names) >= len(wanted) and all(want in ("*", name) for name, want in zip(names, wanted))
