"""Keys of the bearings: a tabled designation, else the numbers of the file, else a tabled bearing of the same bore."""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from dynamics.rotor.rolling_kinds import ROLLING_KINDS, CatalogueBearing
from rigdesign.rexs.gear_stage import (
    SIDES,
    CaseTable,
    Entry,
    GearStage,
    Origins,
    SeatedGear,
    assumed,
    diameter_at,
    millimetres,
    needed,
    quantity,
    quoted,
)
from rigdesign.rexs.gear_unit import UnitBearing

CLASSES = ("C2", "CN", "C3", "C4", "C5")
RPM = math.pi / 30.0


@dataclass(frozen=True)
class SeatedBearing:
    """A bearing with its place in the case.

    locating : whether it holds its shaft, by the file or because one has to
    diameter : of the shaft section there [m]; has_to_hold : no bearing of the shaft carries axial load by the file,
    this one is taken to
    """

    name: str
    shaft: str
    side: str
    bearing: UnitBearing
    position: float | None
    locating: Literal["stated", "assumed", ""]
    diameter: float | None
    has_to_hold: bool = False


def bearing_tables(origins: Origins, stage: GearStage) -> Iterator[CaseTable]:
    """The bearings of both shafts; a shaft with less than two gets what the user has to give."""
    helical = bool(stage.pinion.gear.helix_angle) and not stage.double_helical
    for seated in stage.gears:
        for seat in _seats(seated, helical):
            path = f"gearboxes.test.bearings.{seat.name}"
            title = f"{origins.file}: bearing {seat.bearing.id} {seat.bearing.name}"
            if seat.bearing.kind == "journal":
                yield CaseTable(path, (*_place(origins, seat), *_journal(origins, seat.bearing)), (title,))
            else:
                yield from _rolling(origins, seat, path, title)
        for side in SIDES[len(seated.bearings) :]:
            remedy = f"the file has {len(seated.bearings)} bearings on the shaft of the {seated.name}"
            example = '{ type = "rolling", designation = "NU 208" }'
            entry = needed(
                f"{seated.name}_{side}", example.replace("{ ", f"{{ {_at(seated, side)}, "), remedy
            )
            yield CaseTable("gearboxes.test.bearings", (entry,))


def _at(seated: SeatedGear, side: str) -> str:
    return f'shaft = "test_{seated.name}", side = "{side}"'


def _seats(seated: SeatedGear, helical: bool) -> Iterator[SeatedBearing]:
    places = [seated.bearing_at(bearing) for bearing in seated.bearings]
    holds = _locating(seated.bearings)
    able = [number for number, bearing in enumerate(seated.bearings) if can_hold(bearing)]
    wanted = able[-1] if helical and holds is None and able else None
    last = None if able or helical or not seated.bearings else len(seated.bearings) - 1
    for number, bearing in enumerate(seated.bearings):
        yield SeatedBearing(
            name=f"{seated.name}_{SIDES[number]}",
            shaft=f"test_{seated.name}",
            side=SIDES[number],
            bearing=bearing,
            position=places[number] if seated.position is not None else None,
            diameter=_section_diameter(seated, places[number]),
            locating="stated" if number == holds else "assumed" if number == wanted else "",
            has_to_hold=number == last,
        )


def _section_diameter(seated: SeatedGear, place: float | None) -> float | None:
    return None if seated.shaft is None or place is None else diameter_at(seated.shaft, place)


def _locating(bearings: tuple[UnitBearing, ...]) -> int | None:
    """Which bearing holds the shaft: that for both directions, else the first for one; None leaves it open."""
    for wanted in (("both_directions",), ("positive", "negative")):
        for number, bearing in enumerate(bearings):
            if bearing.axial_force in wanted and can_hold(bearing):
                return number
    return None


def _place(origins: Origins, seat: SeatedBearing) -> Iterator[Entry]:
    at = f"bearings[{seat.bearing.id}]"
    yield origins.stated("shaft", quoted(seat.shaft), note="shaft of the gear")
    yield origins.stated("side", quoted(seat.side), note="order along the shaft")
    if seat.position is not None:
        side = "inner" if origins.knows(f"{at}.place.inner_position") else "outer"
        yield origins.stated("position", millimetres(seat.position), f"{at}.place.{side}_position")


def _journal(origins: Origins, bearing: UnitBearing) -> Iterator[Entry]:
    at = f"bearings[{bearing.id}]"
    if bearing.inner_diameter is None:
        yield needed("diameter", '"40 mm"', "diameter of the journal")
    else:
        yield origins.stated("diameter", millimetres(bearing.inner_diameter), f"{at}.inner_diameter")
    if bearing.width is not None:
        yield origins.stated("width", millimetres(bearing.width), f"{at}.width")
    if bearing.radial_clearance:
        value = quantity(1e6 * bearing.radial_clearance, "um")
        yield origins.stated("diametral_clearance", value, f"{at}.radial_clearance")


def _rolling(origins: Origins, seat: SeatedBearing, path: str, title: str) -> Iterator[CaseTable]:
    bearing, at = seat.bearing, f"bearings[{seat.bearing.id}]"
    tabled, sibling = tabled_bearing(bearing), nearest_tabled(bearing)
    kind = origins.stated("type", '"rolling"', note="rolling bearing")
    entries = [Entry("type", '"rolling"', "stated", kind.text, markable=False), *_place(origins, seat)]
    numbers: tuple[Entry, ...] = ()
    if tabled is not None:
        entries.append(
            origins.stated("designation", quoted(tabled.designation), f"{at}.catalogue.designation")
        )
    elif sibling is not None and has_own_numbers(bearing):
        numbers = tuple(_catalogue(origins, bearing, sibling, has_to_hold=seat.has_to_hold))
    elif sibling is not None and same_bore(bearing, sibling):
        written = bearing.catalogue.designation or bearing.name or "a bearing without designation"
        reason = f"in place of {written}, which is not tabled: the nearest one in bore and outside diameter"
        entries.append(assumed("designation", quoted(sibling.designation), reason))
    else:
        example = quoted(example_designation(seat.diameter))
        entries.append(needed("designation", example, _missing(seat)))
    if seat.locating == "stated":
        entries.append(origins.stated("locating", "true", f"{at}.axial_force"))
    elif seat.locating == "assumed":
        entries.append(assumed("locating", "true", "one bearing takes the axial force of helical gears"))
    entries += _condition(origins, bearing)
    yield CaseTable(path, tuple(entries), (title,))
    if numbers:
        yield CaseTable(f"{path}.catalogue", numbers)


def _missing(seat: SeatedBearing) -> str:
    """What is to be given of a bearing, with what is known of it."""
    written = seat.bearing.catalogue.designation or seat.bearing.name
    known = "" if not written else f" ({written})"
    bore = "" if seat.diameter is None else f"; the shaft has {1e3 * seat.diameter:.4g} mm there"
    return f"designation or catalogue numbers of this bearing{known}{bore}"


def _condition(origins: Origins, bearing: UnitBearing) -> Iterator[Entry]:
    """Clearance as delivered, and cleanliness; a clearance in operation is computed."""
    at, clearance = f"bearings[{bearing.id}]", bearing.radial_clearance
    operating = origins.attribute(f"{at}.radial_clearance").startswith("operating")
    if clearance is not None and clearance > 0.0 and not operating:
        yield origins.stated("radial_clearance", quantity(1e6 * clearance, "um"), f"{at}.radial_clearance")
    name = (bearing.clearance_class or "").replace("C0", "CN")
    if name in CLASSES:
        yield origins.stated("clearance_class", quoted(name), f"{at}.clearance_class")
    factor = bearing.catalogue.contamination_factor
    if factor is not None and factor <= 1.0:
        yield origins.stated("contamination_factor", f"{factor:.9g}", f"{at}.catalogue.contamination_factor")


def _catalogue(
    origins: Origins, bearing: UnitBearing, sibling: CatalogueBearing, *, has_to_hold: bool
) -> Iterator[Entry]:
    """Numbers of the file, and what it lacks from a tabled bearing of the kind, scaled by its diameters."""
    at, data = f"bearings[{bearing.id}]", bearing.catalogue
    bore, outside = bearing.inner_diameter or 0.0, bearing.outer_diameter or 0.0
    like = f"as {sibling.designation}"
    yield origins.stated("kind", quoted(sibling.kind), f"{at}.catalogue.type")
    if (series := series_of(bearing)) is not None:
        yield origins.stated("series", quoted(series), f"{at}.catalogue.designation")
    else:
        yield assumed("series", quoted(sibling.series), f"{like}, the nearest tabled bearing of the kind")
    yield origins.stated("bore", millimetres(bore), f"{at}.inner_diameter")
    yield origins.stated("outside_diameter", millimetres(outside), f"{at}.outer_diameter")
    yield origins.stated("width", millimetres(bearing.width or 0.0), f"{at}.width")
    for key, force, field in (
        ("dynamic_rating", data.dynamic_load_rating, "dynamic_load_rating"),
        ("static_rating", data.static_load_rating, "static_load_rating"),
        ("fatigue_limit", data.fatigue_limit_load, "fatigue_limit_load"),
    ):
        if force is not None:
            yield origins.stated(key, quantity(force, "N"), f"{at}.catalogue.{field}")
    scale = sibling.mean_diameter / (0.5 * (bore + outside))
    for key, speed, of_sibling in (
        ("limiting_speed", data.limiting_speed, sibling.limiting_speed),
        ("reference_speed", data.reference_speed, sibling.reference_speed),
    ):
        if speed is not None:
            yield origins.stated(key, quantity(speed / RPM, "rpm"), f"{at}.catalogue.{key}")
        else:
            value = of_sibling * scale / RPM
            ends = (f'"{0.7 * value:.3g} rpm"', f'"{1.3 * value:.3g} rpm"')
            yield assumed(key, f'"{value:.3g} rpm"', f"{like}: same speed times mean diameter", *ends)
    if has_to_hold and sibling.rules.comes_loose:
        reason = (
            "the file has no bearing that holds this shaft axially: lips, or a thrust washer, at the rear"
        )
        yield assumed("carries_axial_load", "true", reason)
    elif sibling.rules.comes_loose and bearing.axial_force is not None:
        carries = "false" if bearing.axial_force == "no_direction" else "true"
        yield origins.stated("carries_axial_load", carries, f"{at}.axial_force")
    yield from _of_kind(origins, bearing, sibling, like)


def _of_kind(origins: Origins, bearing: UnitBearing, sibling: CatalogueBearing, like: str) -> Iterator[Entry]:
    """What only one kind of bearing has: raceways, contact angle and axial factors."""
    at, data = f"bearings[{bearing.id}]", bearing.catalogue
    if sibling.rules.prints_raceways:
        bore, outside = bearing.inner_diameter or 0.0, bearing.outer_diameter or 0.0
        section = sibling.outside_diameter - sibling.bore
        for key, raceway in (
            ("inner_raceway", sibling.inner_raceway),
            ("outer_raceway", sibling.outer_raceway),
        ):
            value = bore + (raceway - sibling.bore) / section * (outside - bore)
            yield assumed(key, millimetres(round(value, 5)), f"{like}: same share of the section height")
    if sibling.rules.has_contact_angle:
        yield _contact_angle(origins, bearing, sibling, like)
        for key, stated, of_sibling, field in (
            ("axial_limit", data.limit_e, sibling.axial_limit, "limit_e"),
            ("axial_factor", data.axial_factor, sibling.axial_factor, "axial_factor"),
            (
                "static_axial_factor",
                data.static_axial_factor,
                sibling.static_axial_factor,
                "static_axial_factor",
            ),
        ):
            if stated is not None:
                yield origins.stated(key, f"{stated:.9g}", f"{at}.catalogue.{field}")
            else:
                yield assumed(key, f"{of_sibling:.9g}", f"{like}, the nearest tabled bearing of the kind")


def _contact_angle(origins: Origins, bearing: UnitBearing, sibling: CatalogueBearing, like: str) -> Entry:
    """Contact angle of the file; of a tapered roller bearing also by its limit e = 1.5 tan(alpha) (ISO 281)."""
    data, at = bearing.catalogue, f"bearings[{bearing.id}].catalogue"
    if data.contact_angle:
        angle = abs(data.contact_angle)
        return origins.stated("contact_angle", quantity(math.degrees(angle), "deg"), f"{at}.contact_angle")
    by_limit = None if data.limit_e is None else sibling.rules.contact_angle(data.limit_e)
    if by_limit is not None:
        value = quantity(math.degrees(by_limit), "deg")
        return origins.stated("contact_angle", value, f"{at}.limit_e", note="e = 1.5 tan(alpha), ISO 281")
    value = quantity(math.degrees(sibling.contact_angle), "deg")
    return assumed("contact_angle", value, f"{like}, the nearest tabled bearing of the kind")


# Bearing of a case for one of a file: tabled, with numbers of its own, or the nearest tabled one.

KIND_OF_TYPE = {kind.rexs_type: name for name, kind in ROLLING_KINDS.items() if kind.rexs_type}
"""Type in REXS -> kind of a case."""
SAME_BORE = 0.1
"""Difference of two bores, over the bore, up to which one bearing may replace another."""
PRINTED = 0.01
"""The same up to which a designation and a stated bore are of one bearing."""


def tabled_bearing(bearing: UnitBearing) -> CatalogueBearing | None:
    """The tabled bearing of a designation, suffixes left out; None where the bore of the file is another one."""
    from dynamics.rotor.bearing import BearingError
    from dynamics.rotor.rolling_catalogue import catalogue_bearing

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


def nearest_tabled(bearing: UnitBearing) -> CatalogueBearing | None:
    """Tabled bearing of the same kind, of the same series if there is one, with the nearest diameters.

    None for a kind that a case does not have, and where no bore is known.
    """
    from dynamics.rotor.rolling_catalogue import catalogue_bearing, tabled_designations

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
            not item.carries_axial_load,
        ),
        default=None,
    )


def series_of(bearing: UnitBearing) -> str | None:
    """Dimension series by the designation: 62 of 6207, 2 of NJ 204; None for one without friction coefficients."""

    digits = re.search(r"\d{3,5}", bearing.catalogue.designation or "")
    kind = KIND_OF_TYPE.get(bearing.catalogue.type or "")
    if digits is None or kind is None:
        return None
    stem = digits[0][:-2]
    return next((name for name in (stem, f"{stem}B") if name in ROLLING_KINDS[kind].series), None)


def same_bore(bearing: UnitBearing, other: CatalogueBearing) -> bool:
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
    from dynamics.rotor.rolling_catalogue import catalogue_bearing, tabled_designations

    known = [catalogue_bearing(name) for name in tabled_designations()]
    wanted = 0.04 if diameter is None else diameter
    return min(
        (item for item in known if item.carries_axial_load), key=lambda item: abs(item.bore - wanted)
    ).designation


def can_hold(bearing: UnitBearing) -> bool:
    """Whether the bearing, as the case will have it, carries axial load."""
    if bearing.kind == "journal":
        return True
    tabled, sibling = tabled_bearing(bearing), nearest_tabled(bearing)
    if tabled is not None:
        return tabled.carries_axial_load
    if sibling is None:
        return bearing.axial_force in ("both_directions", "positive", "negative")
    free = sibling.rules.comes_loose and bearing.axial_force == "no_direction"
    return not free if has_own_numbers(bearing) else sibling.carries_axial_load
