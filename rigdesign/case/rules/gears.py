"""Rules of gears, meshes and bearings that span several keys."""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from dynamics.gear.involute import GearGeometryError, shift_sum
from rigdesign.base.errors import Fault
from rigdesign.base.units import show
from rigdesign.case.faults import unknown
from rigdesign.case.films import matched
from rigdesign.case.rotation import has_hands, helix_hands

if TYPE_CHECKING:
    from rigdesign.case.bearings import BearingInput
    from rigdesign.case.drivetrain import ShaftInput
    from rigdesign.case.gearbox import Gearbox
    from rigdesign.case.gears import Gear, GearMesh
    from rigdesign.case.model import Case

SHIFT_TOLERANCE = 0.002
"""Most difference between the sum of two stated profile shifts and that of the centre distance: both are printed with
three or four digits. The pinion keeps its own, the wheel takes the rest."""
LEAST_SHIFT_SUM, MOST_SHIFT_SUM = -2.0, 2.5
"""Sum of the profile shifts of a pair beyond which a centre distance belongs to other teeth."""

MEASURED_WITH_TOPOGRAPHY = (
    "profile_crowning", "lead_crowning", "tip_relief", "root_relief", "end_relief", "twist",
)  # fmt: skip
"""Modifications that a measured flank shows; slopes may stand beside it, for the place of the axes."""


def gearbox_faults(case: "Case") -> Iterator[Fault]:
    """References, tooth numbers, profile shifts, tips, bearings of every gearbox."""
    for name, box in case.gearboxes.items():
        at = f"gearboxes.{name}"
        meshed = [gear for mesh in box.meshes.values() for gear in (mesh.pinion, mesh.wheel)]
        for mesh_name, mesh in box.meshes.items():
            yield from _mesh(f"{at}.meshes.{mesh_name}", mesh, box)
        yield from hand_faults(at, box)
        yield from halves_faults(at, box)
        for gear_name, gear in box.gears.items():
            if gear_name not in meshed:
                yield Fault(
                    f"{at}.gears.{gear_name}",
                    "",
                    "meshes with no other gear",
                    "name it in a mesh or remove it",
                )
            yield from _gear(f"{at}.gears.{gear_name}", gear)
        yield from _bearings(at, box)
        yield from _stations(at, box)
        yield from _press_fits(at, box, case)
        shafts = _shafts_of(case, box)
        carried = list(dict.fromkeys(bearing.shaft for bearing in box.bearings.values()))
        for kind, parts, known in (
            ("gears", box.gears, shafts),
            ("bearings", box.bearings, shafts),
            ("seals", box.seals, carried),
        ):
            for part_name, part in parts.items():
                if known and part.shaft not in known:
                    yield unknown(f"{at}.{kind}.{part_name}.shaft", part.shaft, known, "shaft")


def _shafts_of(case: "Case", box: "Gearbox") -> list[str]:
    """Shafts a part of this gearbox may sit on; empty when nothing names any."""
    if box.housing is not None:
        return list(box.housing.shafts)
    return list(case.power_circuit.shafts)


def _gear(at: str, gear: "Gear") -> Iterator[Fault]:
    flank = gear.flank
    for key in ("single_pitch", "profile_slope_scatter", "tooth_stiffness"):
        entries = getattr(flank, key)
        if entries and len(entries) != gear.teeth:
            yield Fault(
                f"{at}.flank.{key}", f"{len(entries)} entries", f"the gear has {gear.teeth} teeth",
                "write one entry per tooth, or none",
            )  # fmt: skip
    scales = flank.tooth_stiffness
    if scales and not (min(scales) >= 0.0 and 0.0 < max(scales) <= 10.0):
        yield Fault(
            f"{at}.flank.tooth_stiffness", f"{min(scales):g} to {max(scales):g}",
            "are no shares of the stiffness of a sound tooth, limits 0 and 10, not all of them 0",
            "write 1 for a sound tooth, less for a weak one, 0 for a missing one",
        )  # fmt: skip
    if flank.weak_tooth.tooth >= gear.teeth:
        yield Fault(
            f"{at}.flank.weak_tooth.tooth", str(flank.weak_tooth.tooth),
            f"the gear has {gear.teeth} teeth, counted from 0", f"write 0 to {gear.teeth - 1}",
        )  # fmt: skip
    for name, gauge in gear.strain_gauges.items():
        if gauge.tooth >= gear.teeth:
            yield Fault(
                f"{at}.strain_gauges.{name}.tooth", str(gauge.tooth),
                f"the gear has {gear.teeth} teeth, counted from 0", f"write 0 to {gear.teeth - 1}",
            )  # fmt: skip
    yield from _body(at, gear)
    yield from _modifications(at, gear)
    for index, wave in enumerate(flank.pitch_waves):
        if 2 * wave.order > gear.teeth:
            yield Fault(
                f"{at}.flank.pitch_waves.{index}.order", str(wave.order),
                f"{gear.teeth} teeth show no wave above order {gear.teeth // 2}",
                f"write 1 to {gear.teeth // 2}, or single_pitch",
            )  # fmt: skip


def _body(at: str, gear: "Gear") -> Iterator[Fault]:
    """A web belongs inside of a rim and is no wider than the face."""
    if gear.web_thickness is None:
        return
    if gear.rim_thickness is None:
        yield Fault(
            f"{at}.web_thickness", show(gear.web_thickness, "length"), "begins inside of a rim, and none is stated",
            "write rim_thickness too, or leave web_thickness out",
        )  # fmt: skip
    elif gear.web_thickness > gear.face_width:
        yield Fault(
            f"{at}.web_thickness", show(gear.web_thickness, "length"),
            f"is above the face width, {show(gear.face_width, 'length')}", "correct one of them",
        )  # fmt: skip


def _modifications(at: str, gear: "Gear") -> Iterator[Fault]:
    """Reliefs without a length, and intended modifications together with a measured flank that has them already."""
    flank = gear.flank
    for name in ("root_relief", "end_relief"):
        amount = getattr(flank, name)
        if amount and not getattr(flank, f"{name}_length"):
            yield Fault(
                f"{at}.flank.{name}_length", "0", f"is needed with {name} = {show(amount, 'length', 'um')}",
                f'write how far the relief reaches, e.g. {name}_length = "1 mm"',
            )  # fmt: skip
    longest = gear.face_width * (0.5 if flank.end_relief_at == "both" else 1.0)
    if flank.end_relief and flank.end_relief_length > longest:
        yield Fault(
            f"{at}.flank.end_relief_length", show(flank.end_relief_length, "length"),
            f"is above {show(longest, 'length')}, the face that each relief has", "shorten it",
        )  # fmt: skip
    if flank.topography is None and flank.back_topography is None:
        return
    twice = [name for name in MEASURED_WITH_TOPOGRAPHY if getattr(flank, name)]
    if twice:
        yield Fault(
            f"{at}.flank.{twice[0]}", "", "is part of the measured topography of this gear, and would count twice",
            f"remove {', '.join(twice)}, or the topography",
        )  # fmt: skip


def _mesh(at: str, mesh: "GearMesh", box: "Gearbox") -> Iterator[Fault]:
    unknown_gears = [key for key in ("pinion", "wheel") if getattr(mesh, key) not in box.gears]
    for key in unknown_gears:
        yield unknown(f"{at}.{key}", getattr(mesh, key), list(box.gears), "gear in this gearbox")
    if unknown_gears:
        return
    pinion, wheel = box.gears[mesh.pinion], box.gears[mesh.wheel]
    if pinion.teeth > wheel.teeth:
        yield Fault(
            f"{at}.pinion", f'"{mesh.pinion}"',
            f"has {pinion.teeth} teeth, more than the wheel's {wheel.teeth}",
            "call the gear with fewer teeth the pinion",
        )  # fmt: skip
    yield from _profile_shifts(at, mesh, pinion, wheel)
    yield from _hands(at.rpartition(".meshes.")[0], mesh, pinion, wheel)
    if mesh.rack.protuberance and not 0.0 < mesh.rack.protuberance_angle < mesh.pressure_angle:
        yield Fault(
            f"{at}.rack.protuberance_angle", show(mesh.rack.protuberance_angle, "angle"),
            f"does not lie above 0 deg and below the pressure angle, {show(mesh.pressure_angle, 'angle')}",
            'write that of the tool, e.g. "10 deg"',
        )  # fmt: skip
    if mesh.contact_ratio is not None and (pinion.tip_shortening or wheel.tip_shortening):
        yield Fault(
            f"{at}.contact_ratio", str(mesh.contact_ratio),
            "the tips are also cut by tip_shortening of a gear",
            "keep contact_ratio or tip_shortening",
        )  # fmt: skip
    yield from _too_close(at, mesh, pinion.teeth + wheel.teeth)


def _hands(at: str, mesh: "GearMesh", pinion: "Gear", wheel: "Gear") -> Iterator[Fault]:
    """Spur and double-helical gears have no hand."""
    if has_hands(mesh):
        return
    for name, gear in ((mesh.pinion, pinion), (mesh.wheel, wheel)):
        if gear.helix_hand:
            yield Fault(
                f"{at}.gears.{name}.helix_hand", f'"{gear.helix_hand}"',
                "the gear is double-helical" if mesh.double_helical else "the gear has spur teeth",
                "leave it out",
            )  # fmt: skip


def halves_faults(at: str, box: "Gearbox") -> Iterator[Fault]:
    """All meshes of a gear see the same body: double-helical in all of them or in none, as many halves carrying."""
    first = box.first_meshes()
    for name, mesh in box.meshes.items():
        for gear in (mesh.pinion, mesh.wheel):
            other = first[gear][0]
            for key in ("double_helical", "carrying_halves"):
                own, expected = getattr(mesh, key), getattr(box.meshes[other], key)
                if own != expected and (key == "double_helical" or mesh.double_helical):
                    yield Fault(
                        f"{at}.meshes.{name}.{key}", _written(own),
                        f"gear {gear} is in mesh {other} as well, where it is {_written(expected)}: it has one body",
                        f"write {_written(expected)} in both meshes, or change that of {other}",
                    )  # fmt: skip
                    break


def _written(value: bool | int) -> str:
    """As the case file has it."""
    return str(value).lower()


def hand_faults(at: str, box: "Gearbox") -> Iterator[Fault]:
    """Helical gears of parallel axes are of opposite hand, also those that an idler joins."""
    hands = helix_hands(box)
    for mesh in box.meshes.values():
        first, second = hands.get(mesh.pinion), hands.get(mesh.wheel)
        if not has_hands(mesh) or first is None or second is None or first.hand != second.hand:
            continue
        source, other = first.stated, second.stated
        direct = {source, other} == {mesh.pinion, mesh.wheel}
        yield Fault(
            f"{at}.gears.{other}.helix_hand", f'"{box.gears[other].helix_hand}"',
            f"is that of its partner {source}" if direct else f"and {at}.gears.{source}.helix_hand give "
            f"{mesh.pinion} and {mesh.wheel}, which mesh, the same hand",
            "write the opposite hand, or leave one of the two out",
        )  # fmt: skip


def _profile_shifts(at: str, mesh: "GearMesh", pinion: "Gear", wheel: "Gear") -> Iterator[Fault]:
    """The centre distance fixes the sum; one shift or a split divides it, two shifts have to agree with it."""
    given = [gear.profile_shift for gear in (pinion, wheel) if gear.profile_shift is not None]
    if (mesh.profile_shift_split is not None) == bool(given):
        yield Fault(
            at, "", "the centre distance fixes the sum of the profile shifts, one more statement their split",
            'write profile_shift for one of the two gears or for both, or profile_shift_split = "equal"',
        )  # fmt: skip

    try:
        total = shift_sum(
            mesh.normal_module, mesh.pressure_angle, mesh.helix_angle, (pinion.teeth, wheel.teeth), mesh.centre_distance
        )  # fmt: skip
    except GearGeometryError:
        return  # gears that cannot mesh are another fault
    if not LEAST_SHIFT_SUM <= total <= MOST_SHIFT_SUM:
        reference = 0.5 * mesh.normal_module * (pinion.teeth + wheel.teeth) / math.cos(mesh.helix_angle)
        yield Fault(
            f"{at}.centre_distance", show(mesh.centre_distance, "length"),
            f"asks for a sum of the profile shifts of {total:.3g}, limits {LEAST_SHIFT_SUM:g} and {MOST_SHIFT_SUM:g}: "
            f"without shifts these teeth have {show(reference, 'length')}",
            "correct the centre distance, normal_module, helix_angle or the tooth numbers",
        )  # fmt: skip
    elif len(given) == 2 and mesh.profile_shift_split is None and abs(sum(given) - total) > SHIFT_TOLERANCE:
        yield Fault(
            f"{at}.centre_distance", show(mesh.centre_distance, "length"),
            f"fixes the sum of the profile shifts at {total:.4f}, the gears state {given[0]:g} + {given[1]:g} = "
            f"{sum(given):.4f}, limit of the difference {SHIFT_TOLERANCE:g}",
            f"correct the centre distance or a profile shift, or leave {mesh.wheel}.profile_shift out",
        )  # fmt: skip


def _too_close(at: str, mesh: "GearMesh", teeth: int) -> Iterator[Fault]:
    """Two gears mesh only where cos(alpha_wt) = a_d cos(alpha_t) / a is below 1 (ISO 21771, section 5)."""
    alpha_t = math.atan(math.tan(mesh.pressure_angle) / math.cos(mesh.helix_angle))
    reference = 0.5 * mesh.normal_module * teeth / math.cos(mesh.helix_angle)
    least = reference * math.cos(alpha_t)
    if mesh.centre_distance <= least:
        yield Fault(
            f"{at}.centre_distance", show(mesh.centre_distance, "length"),
            f"these gears cannot mesh at or below {show(least, 'length')}, where their base circles touch",
            f"write a centre distance near {show(reference, 'length')}, or change module or tooth numbers",
        )  # fmt: skip


def _stations(at: str, box: "Gearbox") -> Iterator[Fault]:
    """Two bearings on one spot hold no shaft: the lever rule has no lever."""
    seen: dict[tuple[str, float], str] = {}
    for name, bearing in box.bearings.items():
        if bearing.position is None:
            continue
        other = seen.setdefault((bearing.shaft, bearing.position), name)
        if other != name:
            yield Fault(
                f"{at}.bearings.{name}.position", show(bearing.position, "length"),
                f"is also where {other} holds the shaft {bearing.shaft}",
                "write the distance of the middle of each bearing from the start of the shaft",
            )  # fmt: skip


def _press_fits(at: str, box: "Gearbox", case: "Case") -> Iterator[Fault]:
    """A shaft fills the bore of a gear that is pressed on it: its bore lies inside the seat."""
    shafts = case.power_circuit.shafts
    for name, gear in box.gears.items():
        if not gear.shaft_interference or gear.seat_position is None or gear.shaft not in shafts:
            continue
        section = shafts[gear.shaft].section_at(gear.seat_position)
        if section is not None and section.inner_diameter >= gear.bore_diameter:
            yield Fault(
                f"{at}.gears.{name}.shaft_interference", show(gear.shaft_interference, "length", "um"),
                f"presses the gear, bore_diameter {show(gear.bore_diameter, 'length')}, on {gear.shaft}, whose bore is "
                f"{show(section.inner_diameter, 'length')} there: it must be below that of the gear",
                "correct bore_diameter of the gear, its position, or inner_diameter of the shaft section",
            )  # fmt: skip


def _bearings(at: str, box: "Gearbox") -> Iterator[Fault]:
    locating = [bearing.shaft for bearing in box.bearings.values() if bearing.locating]
    for name, bearing in box.bearings.items():
        here = f"{at}.bearings.{name}"
        if bearing.locating and locating.count(bearing.shaft) > 1:
            yield Fault(
                f"{here}.locating", "true", f"shaft {bearing.shaft} is fixed axially more than once",
                "let one bearing per shaft be locating",
            )  # fmt: skip
        if bearing.axial_play and not bearing.locating:
            yield Fault(
                f"{here}.axial_play", show(bearing.axial_play, "length"), "the bearing is not locating",
                "give the play to the locating bearing of this shaft",
            )  # fmt: skip


# Rules of bearings that span several keys: what carries their heat and their axial force, what they sit on.

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
    if box.bearing_oil.takes_heat:
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
    shafts = case.power_circuit.shafts
    if bearing.position is None or bearing.shaft not in shafts:
        return
    diameter = diameter_at(shafts[bearing.shaft], bearing.position)
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
