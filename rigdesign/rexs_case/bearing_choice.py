"""Bearing of a case for one of a file: tabled, with numbers of its own, or the nearest tabled one."""

import math
import re
from typing import TYPE_CHECKING

from rigdesign.rexs.gear_unit import UnitBearing

if TYPE_CHECKING:
    from dynamics.bearing.rolling_catalogue import BearingKind, CatalogueBearing

KIND_OF_TYPE: dict[str, "BearingKind"] = {
    "radial_grooved_ball_bearing": "deep_groove_ball",
    "radial_roller_bearing": "cylindrical_roller",
    "radial_tapered_roller_bearing": "tapered_roller",
    "angular_contact_ball_bearing": "angular_contact_ball",
}
"""Type in REXS -> kind of a case."""
SAME_BORE = 0.1
"""Difference of two bores, over the bore, up to which one bearing may replace another."""
PRINTED = 0.01
"""The same up to which a designation and a stated bore are of one bearing."""


def tabled_bearing(bearing: UnitBearing) -> "CatalogueBearing | None":
    """The tabled bearing of a designation, suffixes left out; None where the bore of the file is another one."""
    from dynamics.bearing.protocol import BearingError
    from dynamics.bearing.rolling_catalogue import catalogue_bearing

    written = (bearing.catalogue.designation or "").strip()
    basic = re.match(r"[A-Za-z]*\s*\d{3,5}", written)
    for name in (written, basic[0] if basic else ""):
        try:
            found = catalogue_bearing(name)
        except BearingError:
            continue
        kind = KIND_OF_TYPE.get(bearing.catalogue.type or "", found.kind)
        bore = bearing.inner_diameter
        if kind == found.kind and (bore is None or abs(bore / found.bore - 1.0) <= PRINTED):
            return found
    return None


def nearest_tabled(bearing: UnitBearing) -> "CatalogueBearing | None":
    """Tabled bearing of the same kind, of the same series if there is one, with the nearest diameters.

    None for a kind that a case does not have, and where no bore is known.
    """
    from dynamics.bearing.rolling_catalogue import catalogue_bearing, tabled_designations

    bore, kind = bearing.inner_diameter, KIND_OF_TYPE.get(bearing.catalogue.type or "")
    if bore is None or kind is None:
        return None
    outside, series = bearing.outer_diameter, series_of(bearing)
    known = [catalogue_bearing(name) for name in tabled_designations()]
    return min(
        (item for item in known if item.kind == kind),
        key=lambda item: (
            item.series != series,
            abs(math.log(item.bore / bore))
            + abs(math.log(item.outside_diameter / (outside or item.outside_diameter))),
            not item.locating,
        ),
        default=None,
    )


def series_of(bearing: UnitBearing) -> str | None:
    """Dimension series by the designation: 62 of 6207, 2 of NJ 204; None for one without friction coefficients."""
    from dynamics.bearing.rolling_catalogue import DESCRIBED_SERIES

    digits = re.search(r"\d{3,5}", bearing.catalogue.designation or "")
    kind = KIND_OF_TYPE.get(bearing.catalogue.type or "")
    if digits is None or kind is None:
        return None
    stem = digits[0][:-2]
    return next((name for name in (stem, f"{stem}B") if name in DESCRIBED_SERIES[kind]), None)


def same_bore(bearing: UnitBearing, other: "CatalogueBearing") -> bool:
    """Whether one may replace the other by their bores."""
    return bearing.inner_diameter is not None and abs(bearing.inner_diameter / other.bore - 1.0) <= SAME_BORE


def has_own_numbers(bearing: UnitBearing) -> bool:
    """Whether diameters, width and load ratings are stated; the rest scales from a tabled bearing."""
    data = bearing.catalogue
    stated = (
        bearing.inner_diameter, bearing.outer_diameter, bearing.width, data.dynamic_load_rating,
        data.static_load_rating,
    )  # fmt: skip
    return None not in stated and (bearing.outer_diameter or 0.0) > 1.2 * (bearing.inner_diameter or 0.0)


def example_designation(diameter: float | None) -> str:
    """A tabled bearing that holds its shaft, with the bore that is nearest to a shaft diameter [m]."""
    from dynamics.bearing.rolling_catalogue import catalogue_bearing, tabled_designations

    known = [catalogue_bearing(name) for name in tabled_designations()]
    wanted = 0.04 if diameter is None else diameter
    return min(
        (item for item in known if item.locating), key=lambda item: abs(item.bore - wanted)
    ).designation


def can_hold(bearing: UnitBearing) -> bool:
    """Whether the bearing, as the case will have it, carries axial load."""
    if bearing.kind == "journal":
        return True
    tabled, sibling = tabled_bearing(bearing), nearest_tabled(bearing)
    if tabled is not None:
        return tabled.locating
    if sibling is None:
        return bearing.axial_force in ("both_directions", "positive", "negative")
    free = sibling.kind == "cylindrical_roller" and bearing.axial_force == "no_direction"
    return not free if has_own_numbers(bearing) else sibling.locating
