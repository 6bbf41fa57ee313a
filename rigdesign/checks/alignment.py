"""Checks of alignment: shafts in their bores, bores out of round, axes of the meshes, couplings cold and hot."""

from collections.abc import Iterator
from typing import NamedTuple

from rigdesign.case.drivetrain import CouplingInput
from rigdesign.checks.rules import Rule, hold, not_applicable
from rigdesign.coupling.alignment import AlignmentQuantity
from rigdesign.records.solved_rig import NO_LIMIT, SolvedRig, worst
from rigdesign.results.result import Check

GROUP = "alignment"
NO_END = "neither of its shafts is in a housing: nothing is known of its alignment"


class AlignmentKind(NamedTuple):
    """A quantity of alignment as a result has it."""

    title: str
    unit: str
    scale: float
    """Unit per SI."""
    rows: str
    """Field of the record of thermal expansion."""
    place: str
    """Key of the place in a row."""
    entry: str
    """Key of the value in a row."""


KINDS: dict[AlignmentQuantity, AlignmentKind] = {
    "bearing_tilt": AlignmentKind(
        "largest tilt of a shaft in a bearing bore", "mrad", 1e3, "bores", "bearing", "tilt_mrad"
    ),
    "bore_out_of_round": AlignmentKind(
        "bearing bore out of round, share of the radial clearance", "-", 1.0, "bores", "bearing", "out_of_round_share"
    ),
    "axis_inclination": AlignmentKind(
        "in-plane deviation of the axes of a mesh over the face", "um", 1e6, "axes", "gear_pair", "inclination_um"
    ),
    "axis_skew": AlignmentKind(
        "out-of-plane deviation of the axes of a mesh over the face", "um", 1e6, "axes", "gear_pair", "skew_um"
    ),
}  # fmt: skip
"""Every quantity whose limit stands under ``limits.alignment``; its key is the quantity with ``_maximum``."""


def checks(solved: SolvedRig) -> Iterator[Check]:
    """One check for every quantity, two for every coupling."""
    for quantity, kind in KINDS.items():
        values = (
            (abs(row[kind.entry]), f"{row[kind.place]}, stage {expansion.stage}")
            for expansion in solved.expansion
            for row in getattr(expansion, kind.rows)
        )
        limit = getattr(solved.case.limits.alignment, f"{quantity}_maximum")
        rule = Rule(
            id=f"alignment.{quantity}", title=kind.title, unit=kind.unit, group=GROUP,
            source=f"limits.alignment.{quantity}_maximum", limit=None if limit is None else kind.scale * limit,
        )  # fmt: skip
        yield _held(rule, list(values), solved.no_clearances)
    train = solved.case.drivetrain
    for name, coupling in () if train is None else train.couplings.items():
        yield from _coupling(solved, name, coupling)


def _coupling(solved: SolvedRig, name: str, coupling: CouplingInput) -> Iterator[Check]:
    """Offset and angle of a coupling, the larger of cold and hot."""
    for key, words, unit, limit, attribute in (
        ("offset", "radial offset", "mm", coupling.radial_offset_maximum, "radial_offset_maximum"),
        ("angle", "angle", "mrad", coupling.angle_maximum, "angle_maximum"),
    ):
        rule = Rule(
            id=f"alignment.coupling_{key}.{name}", title=f"{words} between the shafts at coupling {name}", unit=unit,
            source=f"drivetrain.couplings.{name}.{attribute}", group=GROUP,
            limit=None if limit is None else 1e3 * limit,
        )  # fmt: skip
        values = [
            (float(row[f"{key}_{state}_{unit}"]), _where(row, state, expansion.stage))
            for expansion in solved.expansion
            for row in expansion.couplings
            if row["coupling"] == name
            for state in ("hot", "cold")
        ]
        yield _held(rule, values, solved.no_clearances if not solved.expansion else NO_END)


def _where(row: dict[str, object], state: str, stage: str) -> str:
    """Shafts and state, with the cold offset that brings the axes together when hot."""
    advice = (
        f"first shaft set {row['recommended_cold_lateral_mm']:+.3f} mm across and "
        f"{row['recommended_cold_vertical_mm']:+.3f} mm up when cold makes the hot offset zero"
    )
    shafts = f"{row['first']} against {row['second']}"
    return f"{shafts}, {state if state == 'cold' else f'stage {stage}'}; {advice}"


def _held(rule: Rule, values: list[tuple[float, str]], absent: str) -> Check:
    if rule.limit is None:
        return not_applicable(rule, NO_LIMIT)
    if not values:
        return not_applicable(rule, absent)
    return hold(rule, *worst(values))
