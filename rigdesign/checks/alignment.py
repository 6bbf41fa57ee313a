"""Checks of alignment: shafts in their bores, bores out of round, axes of the meshes, couplings as set and warm."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rigdesign.checks.clearances import NOT_EXPANDED
from rigdesign.checks.omissions import HEAT, coupled_shafts
from rigdesign.checks.places import couplings
from rigdesign.checks.registry import REGISTRY, RigRule, RuleFamily, Topic, Values
from rigdesign.results.check import Check
from rigdesign.results.units import MICROMETRE, MILLIMETRE, MILLIRADIAN, MM, NUMBER
from rigdesign.results.warm_gearbox import CouplingAlignment, ShaftOffset

if TYPE_CHECKING:
    from rigdesign.postprocessing.solved_rig import SolvedRig

GROUP = "alignment"
NO_END = "neither of its shafts is in a housing: nothing is known of its alignment"


def _no_clearances(solved: SolvedRig) -> str:
    return solved.no_clearances


def _no_coupling(solved: SolvedRig) -> str:
    return NO_END if solved.warm else solved.no_clearances


def _tilts(solved: SolvedRig) -> Values:
    return ((bore.tilt, f"{bore.bearing}, stage {warm.stage}") for warm in solved.warm for bore in warm.bores)


def _out_of_round(solved: SolvedRig) -> Values:
    return (
        (bore.out_of_round_share, f"{bore.bearing}, stage {warm.stage}")
        for warm in solved.warm
        for bore in warm.bores
    )


def _inclinations(solved: SolvedRig) -> Values:
    return (
        (abs(axes.inclination), f"{axes.mesh}, stage {warm.stage}")
        for warm in solved.warm
        for axes in warm.axes
    )


def _skews(solved: SolvedRig) -> Values:
    return (
        (abs(axes.skew), f"{axes.mesh}, stage {warm.stage}") for warm in solved.warm for axes in warm.axes
    )


RULES = (
    RigRule(
        key="alignment.bearing_tilt",
        title="largest tilt of a shaft in a bearing bore",
        procedure=(
            "Axis of every shaft through the warm places of its two bearings against the axis of each "
            "bore, at the held stages. The largest angle counts."
        ),
        unit=MILLIRADIAN,
        group=GROUP,
        source="limits.alignment.bearing_tilt_maximum",
        limit=lambda limits: limits.alignment.bearing_tilt_maximum,
        values=_tilts,
        absent=_no_clearances,
        housed=True,
        leaves_out=(NOT_EXPANDED, *HEAT),
        moved_by=frozenset({"housing"}),
    ),
    RigRule(
        key="alignment.bore_out_of_round",
        title="bearing bore out of round, share of the radial clearance",
        procedure=(
            "Peak to valley of the radius of every warm bearing bore over its warm radial clearance, at "
            "the held stages. The largest counts."
        ),
        unit=NUMBER,
        group=GROUP,
        source="limits.alignment.bore_out_of_round_maximum",
        limit=lambda limits: limits.alignment.bore_out_of_round_maximum,
        values=_out_of_round,
        absent=_no_clearances,
        housed=True,
        leaves_out=(NOT_EXPANDED, *HEAT),
        moved_by=frozenset({"housing"}),
    ),
    RigRule(
        key="alignment.axis_inclination",
        title="in-plane deviation of the axes of a mesh over the face",
        procedure=(
            "Warm axes of the two shafts of a mesh: their in-plane deviation over the face width, at the "
            "held stages. The largest counts."
        ),
        unit=MICROMETRE,
        group=GROUP,
        source="limits.alignment.axis_inclination_maximum",
        limit=lambda limits: limits.alignment.axis_inclination_maximum,
        values=_inclinations,
        absent=_no_clearances,
        housed=True,
        leaves_out=(NOT_EXPANDED, *HEAT),
        moved_by=frozenset({"housing"}),
    ),
    RigRule(
        key="alignment.axis_skew",
        title="out-of-plane deviation of the axes of a mesh over the face",
        procedure=(
            "Warm axes of the two shafts of a mesh: their out-of-plane deviation over the face width, at "
            "the held stages. The largest counts."
        ),
        unit=MICROMETRE,
        group=GROUP,
        source="limits.alignment.axis_skew_maximum",
        limit=lambda limits: limits.alignment.axis_skew_maximum,
        values=_skews,
        absent=_no_clearances,
        housed=True,
        leaves_out=(NOT_EXPANDED, *HEAT),
        moved_by=frozenset({"housing"}),
    ),
)
OFFSET = RuleFamily(
    key="alignment.coupling_offset",
    title="radial offset between the shafts at coupling {place}",
    procedure=(
        "Radial distance between the axes of the two shafts at the coupling, as set up and warm at "
        "the held stages. The larger counts."
    ),
    unit=MILLIMETRE,
    group=GROUP,
    source="drivetrain.couplings.{place}.radial_offset_maximum",
    places=couplings,
    absent=_no_coupling,
    housed=True,
    leaves_out=(coupled_shafts, *HEAT),
    moved_by=frozenset({"housing", "coupling offset"}),
)
ANGLE = RuleFamily(
    key="alignment.coupling_angle",
    title="angle between the shafts at coupling {place}",
    procedure=(
        "Angle between the axes of the two shafts at the coupling, as set up and warm at the held "
        "stages. The larger counts."
    ),
    unit=MILLIRADIAN,
    group=GROUP,
    source="drivetrain.couplings.{place}.angle_maximum",
    places=couplings,
    absent=_no_coupling,
    housed=True,
    leaves_out=(coupled_shafts, *HEAT),
    moved_by=frozenset({"housing", "coupling offset"}),
)


def checks(solved: SolvedRig) -> Iterator[Check]:
    """One check for every limit of alignment, two for every coupling."""
    yield from (rule.check(solved) for rule in RULES)
    for name, coupling in solved.case.power_circuit.couplings.items():
        states = list(_states(solved, name))
        offsets = ((state.radial_offset, where) for state, where in states)
        angles = ((state.angle, where) for state, where in states)
        yield OFFSET.worst(solved, OFFSET.rule(coupling.radial_offset_maximum, name), offsets)
        yield ANGLE.worst(solved, ANGLE.rule(coupling.angle_maximum, name), angles)


def _states(solved: SolvedRig, name: str) -> Iterator[tuple[ShaftOffset, str]]:
    """A coupling warm and as set at every held stage."""
    for warm in solved.warm:
        for coupling in warm.couplings:
            if coupling.coupling == name:
                yield coupling.warm, _where(coupling, f"stage {warm.stage}")
                yield coupling.as_set, _where(coupling, "cold")


def _where(coupling: CouplingAlignment, state: str) -> str:
    """Shafts and state, with the offset to be set that brings the axes together when warm."""
    lateral, vertical = coupling.moved
    return (
        f"{coupling.shown(0)} against {coupling.shown(1)}, {state}; first shaft set {-MM * lateral:+.3f} mm across "
        f"and {-MM * vertical:+.3f} mm up as set makes the warm offset zero"
    )


REGISTRY.register(Topic(order=40, families=(*RULES, OFFSET, ANGLE), checks=checks, of_housing_mesh=True))
