"""What takes the place of keys that a case with shafts that bend leaves out, and what a report says of it."""

import math
from collections.abc import Iterator, Mapping

from rigdesign.case.bearings import BearingInput
from rigdesign.case.drivetrain import DrivetrainInput
from rigdesign.case.fields import AssumptionRecord
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.rolling_bearing import ROLLING_DAMPING_TIME
from rigdesign.case.rotation import has_hands, helix_hands

AXIAL_STIFFNESS = 1e8
"""Of a thrust face or of the rings of a bearing that locates its shaft [N/m]."""
BALANCE_GRADE = 2.5
"""Of a shaft that states none, ISO 21940-11 [mm/s]."""
BALANCE_GRADES = ("1", "6.3")
"""What it may be: grinding-machine drives, and pumps and gear units in general."""
STEEL_DENSITY = 7850.0
"""Of a disc whose mass is not stated [kg/m3]."""


def disc_mass(inertia: float) -> float:
    """Mass of a steel disc a third as thick as its radius [kg], from its polar inertia [kg m2]."""
    radius = (6.0 * inertia / (math.pi * STEEL_DENSITY)) ** 0.2
    return float(2.0 * inertia / radius**2)


def elastic_assumptions(
    train: DrivetrainInput | None, gearboxes: Mapping[str, Gearbox]
) -> Iterator[AssumptionRecord]:
    """Masses, joints and bearings that the case leaves out; none where the shafts only twist."""
    if train is None or train.shaft_model != "elastic":
        return
    for name, box in gearboxes.items():
        for part, bearing in box.bearings.items():
            condensed = box.housing is not None and box.housing.bearing_seats == "elastic"
            yield from _bearing(f"gearboxes.{name}.bearings.{part}", bearing, train, condensed)
        yield from _hands(f"gearboxes.{name}", box)
    yield from _discs(train)
    if train.balance_grade is None and any(
        shaft.balance_grade is None and not shaft.unbalances for shaft in train.shafts.values()
    ):
        yield AssumptionRecord(
            path="drivetrain.balance_grade",
            value=f"{BALANCE_GRADE:g}",
            reason="not stated: grade of turbines and machine-tool drives (ISO 21940-11, table 1), in phase in both "
            "bearing planes; 1 for grinding drives, 6.3 for general machinery; take it from the balancing report",
            range=BALANCE_GRADES,
        )
    for name, coupling in train.couplings.items():
        if coupling.radial_stiffness is None and coupling.angular_stiffness is None:
            yield AssumptionRecord(
                path=f"drivetrain.couplings.{name}.radial_stiffness",
                value="none",
                reason="not stated, nor angular_stiffness: the coupling passes torque only, its two shafts bend each "
                "by itself; take both from its data sheet",
            )


def _hands(at: str, box: Gearbox) -> Iterator[AssumptionRecord]:
    """Hands that no key states, a record for every train of single-helical gears."""
    hands = helix_hands(box)
    for mesh in box.meshes.values():
        listed = mesh.axis_inclination or mesh.axis_skew  # with the ends of the face that they open
        if has_hands(mesh) and mesh.pinion not in hands and not listed:
            yield AssumptionRecord(
                path=f"{at}.gears.{mesh.pinion}.helix_hand",
                value="right",
                reason="not stated: it says which bearing the tilting moment of the axial force relieves; bearings are "
                "rated for either hand, positions and stiffness are those of the right hand; write right or left",
            )


def _bearing(
    at: str, bearing: BearingInput, train: DrivetrainInput, condensed: bool
) -> Iterator[AssumptionRecord]:
    angled = bearing.induced_axial_load(1.0) > 0.0 and train.bearing_coefficients == "computed"
    if angled and bearing.arrangement is None:
        yield AssumptionRecord(
            path=f"{at}.arrangement",
            value="face_to_face",
            reason="not stated here: said at the other end of the shaft, or usual in gearboxes; it says which way the "
            "elements lean",
        )
    if bearing.locating and bearing.axial_stiffness is None and not angled:
        yield AssumptionRecord(
            path=f"{at}.axial_stiffness",
            value=f"{1e-6 * AXIAL_STIFFNESS:g} N/um",
            reason="not stated: order of a thrust face, or of rolling elements that carry axially; it sets the axial "
            "frequency of the shaft",
        )
    if bearing.support_stiffness is None and not condensed:
        yield AssumptionRecord(
            path=f"{at}.support_stiffness",
            value="rigid",
            reason="not stated: the housing under the bearing does not give; state it where its wall is thin or stands "
            'far from the foot, or write bearing_seats = "elastic" at its housing',
        )
    if not bearing.has_film and train.bearing_coefficients == "computed":
        yield AssumptionRecord(
            path=f"{at}.radial_damping",
            value=f"{ROLLING_DAMPING_TIME:.3g} s of the stiffness",
            reason="middle of 0.25e-5 to 2.5e-5 s (E. Kraemer, Dynamics of Rotors and Foundations, 1993); no theory "
            "gives the damping of rolling elements",
        )


def _discs(train: DrivetrainInput) -> Iterator[AssumptionRecord]:
    for shaft, part in train.shafts.items():
        for name, disc in part.discs.items():
            if disc.mass is None:
                yield AssumptionRecord(
                    path=f"drivetrain.shafts.{shaft}.discs.{name}.mass",
                    value=f"{disc_mass(disc.inertia):.3g} kg",
                    reason="not stated: steel disc of the stated inertia, a third as thick as its radius",
                )
