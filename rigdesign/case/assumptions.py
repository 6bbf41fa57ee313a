"""Assumptions of a case: those it marks, and those it makes by saying nothing, which a report lists as well."""

from collections.abc import Iterator, Mapping

from rigdesign.base.units import show
from rigdesign.case.fields import AssumptionRecord
from rigdesign.case.films import FAN_VELOCITY, BathFilm, ForcedAir
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.housing import OILED, EnclosureInput
from rigdesign.case.rotation import has_hands, helix_hands
from rigdesign.case.surface_conditions import Condition

__all__ = ["AssumptionRecord", "implied_assumptions"]


def implied_assumptions(gearboxes: Mapping[str, Gearbox]) -> Iterator[AssumptionRecord]:
    """Inputs that are left out and whose place an idealisation takes, in the order of the case."""
    for name, box in gearboxes.items():
        for part, bearing in box.bearings.items():
            yield from bearing.assumptions(f"gearboxes.{name}.bearings.{part}")
        yield from _senses(f"gearboxes.{name}", box)
        if box.housing is not None and box.housing.foot_contact is None and box.housing.step_file is None:
            yield AssumptionRecord(
                path=f"gearboxes.{name}.housing.foot_contact",
                value="perfect",
                reason="not stated: foot and field share their nodes, no joint holds heat back and the field holds "
                "the foot; write a conductance (bolted machined faces about 2000 W/(m2 K), 75 to 7000 plausible)",
            )
        if box.housing is not None:
            yield from _fans(f"gearboxes.{name}.housing.boundary", box.housing.boundary)
            yield from _splashed(f"gearboxes.{name}.housing.boundary", box.housing.boundary)
            yield from _oiled(f"gearboxes.{name}.housing.enclosures", box.housing.enclosures)


def _senses(at: str, box: Gearbox) -> Iterator[AssumptionRecord]:
    """Sense of rotation and hand, where axes as made turn their sign to a side of the face or a flank.

    Of single-helical gears of known hand h that turn in the sense sigma, the end of the face that comes into mesh last
    is -sigma h: over it a skew opens by h alone, an inclination by both. Other gears have it at the rear: there the
    skew needs sigma.
    """
    hands = helix_hands(box)
    turned = False
    for name, mesh in box.meshes.items():
        if not (mesh.axis_inclination or mesh.axis_skew):
            continue
        known = has_hands(mesh) and mesh.pinion in hands
        turned = turned or bool(mesh.axis_inclination if known else mesh.axis_skew)
        if has_hands(mesh) and not known:
            yield AssumptionRecord(
                path=f"{at}.gears.{mesh.pinion}.helix_hand",
                value="rear end last in mesh",
                reason=f"not stated: it says at which end of the face the axes of {name} as made open; write right "
                "or left",
            )
    if turned and "rotation" not in box.model_fields_set:
        yield AssumptionRecord(
            path=f"{at}.rotation",
            value=box.rotation,
            reason="not stated: the other sense turns the sign of what the axes as made open over the face; write "
            "clockwise or anticlockwise",
        )


def _fans(at: str, boundary: Mapping[str, Condition]) -> Iterator[AssumptionRecord]:
    """Air streams of unknown velocity."""
    for entry, condition in boundary.items():
        if isinstance(condition, ForcedAir) and condition.velocity is None:
            yield AssumptionRecord(
                path=f"{at}.{entry}.velocity",
                value=show(FAN_VELOCITY, "velocity"),
                reason="not stated: fans of motors and gear units blow 1.5 to 6 m/s along the housing; measure it",
                range=("1.5 m/s", "6 m/s"),
            )


def _splashed(at: str, boundary: Mapping[str, Condition]) -> Iterator[AssumptionRecord]:
    """Films on the inner walls of a box with a sump as the standard has them."""
    for entry, condition in boundary.items():
        if isinstance(condition, BathFilm) and condition.usual_film:
            yield AssumptionRecord(
                path=f"{at}.{entry}.film_factor",
                value="1",
                reason="not stated: 200 W/(m2 K) on walls wetted by splash, whatever speed and level (ISO/TR 14179-2); "
                "Niemann/Winter have 100 to 300",
                range=("0.5", "1.5"),
            )


def _oiled(at: str, enclosures: Mapping[str, EnclosureInput]) -> Iterator[AssumptionRecord]:
    """Chambers of unknown emissivity."""
    for entry, enclosure in enclosures.items():
        if enclosure.chamber is not None and enclosure.emissivity is None:
            yield AssumptionRecord(
                path=f"{at}.{entry}.emissivity",
                value=f"{OILED:g}",
                reason="not stated: thick film of oil on polished steel (P2); dry ground steel has 0.2 to 0.5",
                range=("0.5", "0.95"),
            )
