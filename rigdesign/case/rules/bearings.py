"""Rules of bearings that span several keys: what carries their heat and their axial force, what they sit on."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rigdesign.base.errors import Fault
from rigdesign.base.units import show
from rigdesign.case.matching import matched

if TYPE_CHECKING:
    from rigdesign.case.bearings import BearingInput
    from rigdesign.case.drivetrain import ShaftInput
    from rigdesign.case.gearbox import Gearbox
    from rigdesign.case.model import Case

SEAT_TOLERANCE = 5e-5
"""Most difference [m] between the bore of a bearing and the shaft it sits on."""


def bearing_faults(case: "Case") -> Iterator[Fault]:
    """Everything wrong with how bearings that are bought sit in their gearbox; a journal is part of its shaft."""
    for box_name, box in case.gearboxes.items():
        at = f"gearboxes.{box_name}"
        for name, bearing in box.bearings.items():
            here = f"{at}.bearings.{name}"
            yield from bearing.own_faults(here)
            if not bearing.has_film:
                yield from _heat(at, here, box, bearing)
                yield from _seat(here, case, bearing)
        yield from _thrust(at, box)
        yield from _induced(at, box)


def missing_ends(case: "Case") -> Iterator[Fault]:
    """Shafts of a housing without a bearing at either end; places and loads of the others follow from it."""
    for name, box in case.gearboxes.items():
        for shaft in () if box.housing is None else box.housing.shafts:
            own = {part: bearing.side for part, bearing in box.bearings.items() if bearing.shaft == shaft}
            if sorted(own.values()) != ["front", "rear"]:
                found = ", ".join(f"{part} at the {side}" for part, side in own.items()) or "none"
                yield Fault(
                    f"gearboxes.{name}.bearings", "",
                    f"shaft {shaft} needs a bearing at the front and one at the rear, has {found}",
                    "add or remove bearings, or correct side",
                )  # fmt: skip


def _heat(at: str, here: str, box: "Gearbox", bearing: "BearingInput") -> Iterator[Fault]:
    """Grease carries no heat away: shaft or housing has to."""
    if box.bearing_oil.lubrication != "grease":
        return
    seats = (f"shaft_{bearing.shaft}_journal_{bearing.side}", f"bearing_bore_{bearing.shaft}_{bearing.side}")
    conditions = {} if box.housing is None else box.housing.boundary
    films = [entry for entry in conditions.values() if getattr(entry, "law", "") == "bearing_film"]
    if not any(matched(entry.surfaces, seats) for entry in films):
        yield Fault(
            f"{at}.bearing_oil.lubrication", '"grease"',
            f"nothing carries the heat of bearing {here.rpartition('.')[2]}: grease takes none along, and "
            + ("the gearbox has no housing" if box.housing is None else "no bearing_film joins its seats"),
            f"add a [{at}.housing] table"
            if box.housing is None
            else f'cover {" and ".join(seats)} by law = "bearing_film"',
        )  # fmt: skip


def _seat(here: str, case: "Case", bearing: "BearingInput") -> Iterator[Fault]:
    """The bore has to be the diameter of the shaft where both are stated."""
    power = case.drivetrain
    if power is None or bearing.position is None or bearing.shaft not in power.shafts:
        return
    diameter = diameter_at(power.shafts[bearing.shaft], bearing.position)
    if diameter is not None and abs(diameter - bearing.shaft_diameter) > SEAT_TOLERANCE:
        yield Fault(
            f"{here}.position", show(bearing.position, "length"),
            f"the shaft {bearing.shaft} has {show(diameter, 'length')} there, the bore of the bearing is "
            f"{show(bearing.shaft_diameter, 'length')}",
            "take a bearing of that bore, move it or correct the sections of the shaft",
        )  # fmt: skip


def diameter_at(shaft: "ShaftInput", position: float) -> float | None:
    """Outer diameter of a shaft at a distance from its start [m]; at a step the one next to it that is smaller.

    None beyond its ends.
    """
    start, found = 0.0, []
    for section in shaft.sections:
        if start - SEAT_TOLERANCE <= position <= start + section.length + SEAT_TOLERANCE:
            found.append(section.outer_diameter)
        start += section.length
    return min(found, default=None)


def _thrust(at: str, box: "Gearbox") -> Iterator[Fault]:
    """The axial force of single-helical gears needs a bearing that takes it."""
    pushed = {
        box.gears[gear].shaft
        for mesh in box.meshes.values()
        if mesh.helix_angle and not mesh.double_helical
        for gear in (mesh.pinion, mesh.wheel)
        if gear in box.gears
    }
    for shaft in sorted(pushed):
        own = {name: bearing for name, bearing in box.bearings.items() if bearing.shaft == shaft}
        if own and not any(bearing.has_film or bearing.locating for bearing in own.values()):
            yield Fault(
                f"{at}.bearings", "", f"helical gears push shaft {shaft} axially and no bearing locates it",
                f"write locating = true at {' or '.join(own)}",
            )  # fmt: skip


def _induced(at: str, box: "Gearbox") -> Iterator[Fault]:
    """A bearing with a contact angle pushes its shaft away: the other end has to hold it."""
    for name, bearing in box.bearings.items():
        if bearing.induced_axial_load(1.0) == 0.0:
            if bearing.arrangement is not None:
                yield Fault(
                    f"{at}.bearings.{name}.arrangement", bearing.arrangement, f"{bearing.label} has no contact angle",
                    "leave it out",
                )  # fmt: skip
            continue
        for other, partner in box.bearings.items():
            if other != name and partner.shaft == bearing.shaft and not partner.holds_axially:
                yield Fault(
                    f"{at}.bearings.{name}", bearing.label,
                    f"its contact angle pushes shaft {bearing.shaft} away, and {other} at the other end does not hold "
                    "it axially",
                    f"take a second bearing with a contact angle, or one for {other} that locates the shaft, "
                    "locating = true",
                )  # fmt: skip
            if name < other and partner.shaft == bearing.shaft and _opposed(bearing, partner):
                yield Fault(
                    f"{at}.bearings.{other}.arrangement", partner.arrangement or "",
                    f"{name} on the same shaft says {bearing.arrangement}",
                    "write the same at both, or at one of them",
                )  # fmt: skip


def _opposed(bearing: "BearingInput", partner: "BearingInput") -> bool:
    """Whether two bearings of a shaft state different arrangements."""
    return (
        None not in (bearing.arrangement, partner.arrangement) and bearing.arrangement != partner.arrangement
    )
