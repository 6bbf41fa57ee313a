"""Where two gears touch: path of contact, shift sum and tip cut for a centre distance (ISO 21771)."""

from dataclasses import dataclass, replace
from math import acos, atan, cos, tan
from typing import Literal

from scipy.optimize import brentq

from dynamics.gear.cylindrical_gear import CylindricalGear, GearGeometryError, involute, require_angles
from dynamics.gear.tooth_form import PLAIN, FlankEnds, GearDetails

TipCut = Literal["both", "wheel", "pinion"]


@dataclass(frozen=True, kw_only=True)
class PathOfContact:
    """Points on the transverse line of action, measured from the pitch point, growing to the pinion tip [m].

    ``start`` (A) and ``end`` (E) bound the active path; both may lie on one side of the pitch point.
    ``tip_start`` and ``tip_end`` are where the tips alone would put them; ``start`` or ``end`` lies
    inside of them where the generated flank of the mating root ends earlier.
    """

    start: float
    end: float
    tip_start: float
    tip_end: float
    base_pitch: float
    tangent_1: float
    """Base tangent point T1 of the pinion (negative)."""
    tangent_2: float
    """Base tangent point T2 of the wheel."""

    @property
    def inner_single_contact(self) -> float:
        """B, where the previous pair leaves the mesh at the pinion tip."""
        return self.end - self.base_pitch

    @property
    def outer_single_contact(self) -> float:
        """D, where the next pair enters the mesh."""
        return self.start + self.base_pitch

    @property
    def length(self) -> float:
        """Length of the active path AE."""
        return self.end - self.start


def path_between(
    pinion: CylindricalGear,
    wheel: CylindricalGear,
    centre_distance: float,
    flanks: tuple[FlankEnds, FlankEnds] | None = None,
) -> PathOfContact:
    """Path of contact of two gears from the ends of their flanks (ISO 21771:2007).

    centre_distance : [m], above the sum of the base radii; a smaller one raises ValueError
    flanks : ends of the involutes; None: generated form circles and tip circles
    """
    ends_1, ends_2 = flanks or (PLAIN.flank_of(pinion), PLAIN.flank_of(wheel))
    ratio = tan(acos((pinion.base_radius + wheel.base_radius) / centre_distance))
    reach_1, reach_2 = pinion.base_radius * ratio, wheel.base_radius * ratio
    tip_end = pinion.roll_length(ends_1.tip_radius) - reach_1
    tip_start = reach_2 - wheel.roll_length(ends_2.tip_radius)
    return PathOfContact(
        start=max(tip_start, pinion.roll_length(ends_1.form_radius) - reach_1),
        end=min(tip_end, reach_2 - wheel.roll_length(ends_2.form_radius)),
        tip_start=tip_start,
        tip_end=tip_end,
        base_pitch=0.5 * (pinion.base_pitch + wheel.base_pitch),
        tangent_1=-reach_1,
        tangent_2=reach_2,
    )


def shift_sum(
    normal_module: float,
    pressure_angle: float,
    helix_angle: float,
    teeth: tuple[int, int],
    centre_distance: float,
) -> float:
    """Sum of the profile shifts x1 + x2 [-] that mesh without backlash (ISO 21771:2007).

    normal_module, centre_distance : [m]; pressure_angle (normal), helix_angle : [rad]; teeth : pinion, wheel

    Raises GearGeometryError for angles out of range or a centre distance below the sum of the base radii.
    """
    require_angles(pressure_angle, helix_angle)
    alpha_t = atan(tan(pressure_angle) / cos(helix_angle))
    smallest = 0.5 * normal_module * sum(teeth) / cos(helix_angle) * cos(alpha_t)
    if not centre_distance > smallest:
        raise GearGeometryError(
            f"centre_distance = {1e3 * centre_distance:.4f} mm gives no working pressure angle: it must "
            f"exceed the sum of the base radii, {1e3 * smallest:.4f} mm; "
            "increase it or reduce module, teeth or helix angle"
        )
    opening = involute(acos(smallest / centre_distance)) - involute(alpha_t)
    return opening * sum(teeth) / (2.0 * tan(pressure_angle))


def tip_cut_for_contact_ratio(
    gears: tuple[CylindricalGear, CylindricalGear],
    centre_distance: float,
    wanted: float,
    tip_cut: TipCut,
    details: tuple[GearDetails, GearDetails] = (PLAIN, PLAIN),
) -> tuple[float, float]:
    """Radial shortening of both tips [m] that brings the transverse contact ratio down to ``wanted``.

    The tips named by ``tip_cut`` are shortened equally, by one module at most; tip edges go with them.

    Raises GearGeometryError if the uncut tips do not reach the ratio or a cut of one module does not bring it down.
    """
    pinion, wheel = gears
    share = {"both": (1.0, 1.0), "pinion": (1.0, 0.0), "wheel": (0.0, 1.0)}[tip_cut]

    def contact_ratio(cut: float) -> float:
        shorter = (
            replace(pinion, tip_diameter=pinion.tip_diameter - 2.0 * cut * share[0]),
            replace(wheel, tip_diameter=wheel.tip_diameter - 2.0 * cut * share[1]),
        )
        first, second = (part.flank_of(gear) for part, gear in zip(details, shorter, strict=True))
        path = path_between(*shorter, centre_distance, (first, second))
        return path.length / path.base_pitch

    deepest = pinion.normal_module
    most, least = contact_ratio(0.0), contact_ratio(deepest)
    if not least <= wanted <= most:
        raise GearGeometryError(
            f"contact_ratio = {wanted} must lie between {least:.4f} (tip_cut {tip_cut!r} by one module) and "
            f"{most:.4f} (uncut); change addendum, profile shift or the gear that is cut"
        )
    if wanted == most:
        return 0.0, 0.0
    cut = brentq(lambda amount: contact_ratio(amount) - wanted, 0.0, deepest, xtol=1e-15)
    return cut * share[0], cut * share[1]
