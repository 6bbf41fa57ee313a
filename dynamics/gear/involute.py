"""The involute, and what follows from it in closed form: the sum of the profile shifts of a pair (ISO 21771)."""

from math import acos, atan, cos, degrees, tan

from dynamics.errors import DynamicsInputError


class GearGeometryError(DynamicsInputError):
    """A gear or gear pair that cannot be made or cannot mesh; the message names value, limit and remedy."""


def involute(angle: float) -> float:
    """Involute function tan(angle) - angle [rad]."""
    return tan(angle) - angle


def require_angles(pressure_angle: float, helix_angle: float) -> None:
    """Raise GearGeometryError for tool angles [rad] outside 10 .. 35 deg (normal) and 0 .. 45 deg (helix)."""
    for name, angle, low, high in (
        ("pressure_angle", pressure_angle, 10.0, 35.0),
        ("helix_angle", helix_angle, 0.0, 45.0),
    ):
        if not low <= degrees(angle) <= high:
            raise GearGeometryError(
                f"{name} = {degrees(angle):.3f} deg must lie in {low:.0f}..{high:.0f} deg; "
                "give the amount of the angle without sign of hand"
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
