"""Checks by id."""

from rigdesign.case.model import Case
from rigdesign.checks.registry import REGISTRY
from rigdesign.results.check import Check, Verdict


def rule_ids(case: Case) -> set[str]:
    """Ids of all checks of a case but those over time, known before it is solved."""
    found = {rule.id for family in REGISTRY.families() for rule in family.rules(case)}
    return {identity for identity in found if not identity.startswith("transient.")}


def check(identity: str, source: str = "", verdict: Verdict = "pass") -> Check:
    return Check(
        id=identity, title="", value=1.0, limit=2.0, unit="-", comparison="<=", margin=1.0, distance=0.5,
        verdict=verdict, source=source, role="rig",
    )  # fmt: skip


def limit_of(identity: str) -> str:
    """The limit that the checks name as their source."""
    parts = identity.split(".")
    return {
        "dynamics": f"limits.dynamics.{parts[1]}_minimum; limits.dynamics.{parts[1]}_maximum",
        "temperature": f"limits.temperatures.{parts[1]}_maximum; limits.temperatures.tempering_distance_minimum",
        "clearance": f"limits.clearances.{parts[1]}_minimum; gearboxes.test.seals.{parts[-1]}.axial_travel",
        "bearing": "limits.bearing.film_thickness_minimum; limits.bearing.specific_load_maximum",
        "alignment": f"limits.alignment.{parts[1]}_maximum; drivetrain.couplings.{parts[-1]}.radial_offset_maximum; "
        f"drivetrain.couplings.{parts[-1]}.angle_maximum",
        "flank": f"limits.flanks.{parts[1]}_minimum; limits.flanks.flank_over_root_minimum",
        "oil": f"limits.oil.{parts[1]}_maximum; limits.oil.{parts[1]}_power_maximum; limits.oil.room_heat_maximum",
    }.get(parts[0], "")
