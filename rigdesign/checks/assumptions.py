"""Which assumed inputs a check depends on: those whose effect its family names (`registry.RuleFamily`) and its own
limit."""

from dataclasses import dataclass, replace
from functools import lru_cache

from rigdesign.case.fields import Condition, Influence
from rigdesign.case.model import Case
from rigdesign.case.paths import effects_at
from rigdesign.checks.registry import PATH, REGISTRY, RuleFamily
from rigdesign.results.check import Check

OF_ONE_GEARBOX: tuple[Influence, ...] = ("gear rating",)
"""Influences of an input that stay in its gearbox: the place of a check begins with it."""


def with_assumptions(case: Case, check: Check) -> Check:
    """The check with the paths of the assumed inputs it depends on; none where it does not apply."""
    if check.verdict == "not applicable":
        return check
    basis = _Basis.of(case, check)
    found = tuple(record.path for record in case.assumptions if basis.holds(record.path))
    return replace(check, assumptions=found)


def depends(case: Case, check: Check, path: str) -> bool:
    """Whether the value or limit of a check depends on an input."""
    return _Basis.of(case, check).holds(path)


@dataclass(frozen=True)
class _Basis:
    """What a check depends on in a case: its family, and the inputs it names itself."""

    check: Check
    family: RuleFamily
    own: tuple[str, ...]
    kind: "_CaseKind"

    @classmethod
    def of(cls, case: Case, check: Check) -> "_Basis":
        group, _, name = check.id.partition(".")
        own = [
            *PATH.findall(check.source),
            *([f"limits.bought_parts.{name}"] if group.startswith("bought_part") else []),
        ]
        return cls(check, REGISTRY.family_of(case, check), tuple(own), _CaseKind.of(case))

    def holds(self, path: str) -> bool:
        """Whether an input is part of it."""
        if not all(effect.of_rig for effect in effects_at(Case, path)):
            return False
        if any(is_under(path, part) for part in self.own):
            return True
        if self.family.only_inputs is not None:
            return any(is_under(path, part) for part in self.family.only_inputs)
        influences = _influences(self.kind, path)
        return influences is None or any(
            _moves(influence, self.family, self.check, path) for influence in influences
        )


def _moves(influence: Influence, family: RuleFamily, check: Check, path: str) -> bool:
    """Whether an influence of an input moves a check."""
    if influence in OF_ONE_GEARBOX and not family.across_gearboxes:
        box = path.split(".")[1]
        if not check.id.startswith(f"{family.key}.{box}."):
            return False
    return influence in family.moved_by


def influences_of(case: Case, path: str) -> tuple[Influence, ...] | None:
    """What an input moves; None for all checks."""
    return _influences(_CaseKind.of(case), path)


@dataclass(frozen=True)
class _CaseKind:
    """What an `Effect` asks of a case.

    wet : a machine is cooled by an oil circuit; bends : the shafts do; drags : bearing films give their drag
    films : plain bearings whose lateral coefficients the case does not take as stated, as ``gearbox.bearings.name``
    bare : gearboxes without a housing
    """

    wet: bool
    bends: bool
    drags: bool
    films: tuple[str, ...]
    bare: tuple[str, ...]

    @classmethod
    def of(cls, case: Case) -> "_CaseKind":
        train = case.power_circuit
        bends = train.shaft_model == "elastic"
        return cls(
            wet=any(machine.coolant in case.oil_circuits for machine in case.rig_heat.machines.values()),
            bends=bends,
            drags=case.losses.bearing_drag == "film",
            films=() if bends and train.bearing_coefficients == "stated" else _films(case),
            bare=tuple(name for name, box in case.gearboxes.items() if box.housing is None),
        )

    def meets(self, condition: Condition, path: str) -> bool:
        """Whether a condition of an effect holds at a path."""
        match condition:
            case "dry":
                return not self.wet
            case "drag":
                return self.drags
            case "torsional":
                return not self.bends
            case "film":
                return any(is_under(path, f"gearboxes.{name}") for name in self.films)
            case "bare":
                return any(is_under(path, f"gearboxes.{name}") for name in self.bare)


def _films(case: Case) -> tuple[str, ...]:
    """Plain bearings that carry on a film."""
    return tuple(
        f"{box_name}.bearings.{name}"
        for box_name, box in case.gearboxes.items()
        for name, bearing in box.bearings.items()
        if bearing.has_film
    )


@lru_cache(maxsize=1 << 13)
def _influences(kind: _CaseKind, path: str) -> tuple[Influence, ...] | None:
    """What an input moves in a case of this kind; None for all checks."""
    for effect in reversed(effects_at(Case, path)):
        if not effect.of_rig:
            return ()
        if effect.checks is not None and all(kind.meets(one, path) for one in effect.where):
            return effect.checks
    return None


@lru_cache(maxsize=1 << 16)
def is_under(path: str, part: str) -> bool:
    """Whether a path of the case is the part or lies under it."""
    names, wanted = path.split("."), part.split(".")
    return len(names) >= len(wanted) and all(want in ("*", name) for name, want in zip(names, wanted))
