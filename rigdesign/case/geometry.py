"""From the housing of a case to the geometry the thermal model is built of, and what covers its surfaces."""

from collections.abc import Iterable, Mapping

from rigdesign.case.bearings import BearingInput
from rigdesign.case.films import matched
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.gears import Gear
from rigdesign.case.housing import Housing, HousingShaft
from rigdesign.case.seals import Seals
from thermal.housing.geometry import ClampingField, HousingGeometry
from thermal.housing.shaft_geometry import EndBearing, GearDisc, ShaftGeometry


def pitch_diameters(gearbox: Gearbox) -> dict[str, float]:
    """Working pitch diameter of every gear [m]: 2 a z / (z1 + z2)."""
    diameters = {}
    for mesh in gearbox.meshes.values():
        teeth = {name: gearbox.gears[name].teeth for name in (mesh.pinion, mesh.wheel)}
        for name, count in teeth.items():
            diameters[name] = 2.0 * mesh.centre_distance * count / sum(teeth.values())
    return diameters


def housing_geometry(gearbox: Gearbox, gear_diameters: Mapping[str, float] | None = None) -> HousingGeometry:
    """Geometry of the housing of ``gearbox``.

    Parameters
    ----------
    gearbox : with a housing
    gear_diameters : gear name -> diameter of its disc [m]; the working pitch diameter when left out

    Raises
    ------
    ValueError
        The gearbox has no housing, or (GeometryError) its measures do not go together.
    """
    housing = gearbox.housing
    if housing is None:
        raise ValueError("the gearbox has no housing; add a [gearboxes.<name>.housing] table")
    diameters = gear_diameters or pitch_diameters(gearbox)
    shafts = tuple(_shaft(name, shaft, gearbox, diameters) for name, shaft in housing.shafts.items())
    return HousingGeometry(
        chamber_length=housing.warm_length,
        cold_length_front=housing.cold_length_front or 0.0,
        cold_length_rear=housing.cold_length_rear or 0.0,
        height=housing.height,
        width=housing.width,
        wall_thickness=housing.wall_thickness,
        floor_thickness=housing.floor_thickness,
        top_thickness=housing.top_thickness,
        partition_thickness=housing.partition_thickness or 0.0,
        end_wall_thickness=housing.end_wall_thickness,
        shaft_height=housing.shaft_height,
        shafts=shafts,
        end_seal_width=housing.end_seal_width,
        foot_joint=housing.foot_contact is not None,
        field=ClampingField(
            length=housing.field.length, width=housing.field.width, thickness=housing.field.thickness
        ),
    )


def gear_on(gearbox: Gearbox, shaft: str) -> tuple[str, Gear] | None:
    """Name and gear of the gear on a shaft; None for a shaft without one."""
    return next(((name, gear) for name, gear in gearbox.gears.items() if gear.shaft == shaft), None)


def bearing_on(gearbox: Gearbox, shaft: str, side: str) -> BearingInput:
    """Bearing of a shaft at one end of the housing; KeyError when there is none."""
    for bearing in gearbox.bearings.values():
        if (bearing.shaft, bearing.side) == (shaft, side):
            return bearing
    raise KeyError(f"{shaft}, {side}")


def conditions_of(housing: Housing, names: Iterable[str]) -> list[tuple[str, str, tuple[str, ...]]]:
    """(condition, surface, what its stars stood for) for every surface that every condition names."""
    known = tuple(names)
    return [
        (name, surface, stood_for)
        for name, condition in housing.boundary.items()
        for surface, stood_for in matched(condition.surfaces, known).items()
    ]


def covering(housing: Housing, names: Iterable[str]) -> dict[str, list[str]]:
    """Surface -> its boundary conditions by name; an empty name for what may join a film or comes from elsewhere."""
    found: dict[str, list[str]] = {name: [] for name in names}
    for name, surface, stood_for in conditions_of(housing, found):
        condition = housing.boundary[name]
        found[surface].append("" if condition.may_join_a_film else name)
        if (partner := condition.partner_of(stood_for)) in found:
            found[str(partner)].append("")
    for enclosure in housing.enclosures.values():
        for surface in enclosure.emissivities(found):
            found[surface].append("")
    return found


def seals_on(gearbox: Gearbox, shaft: str) -> Seals:
    """Seals of a shaft; KeyError when there are none."""
    for seals in gearbox.seals.values():
        if seals.shaft == shaft:
            return seals
    raise KeyError(shaft)


def _end_bearing(bearing: BearingInput) -> EndBearing:
    return EndBearing(
        journal_diameter=bearing.shaft_diameter,
        width=bearing.width,
        clearance=0.5 * (bearing.housing_bore - bearing.shaft_diameter),
    )


def _shaft(name: str, shaft: HousingShaft, gearbox: Gearbox, diameters: Mapping[str, float]) -> ShaftGeometry:
    front, rear = (bearing_on(gearbox, name, side) for side in ("front", "rear"))
    seals = seals_on(gearbox, name)
    on_shaft = gear_on(gearbox, name)
    seal_diameter = shaft.seal_diameter or 0.0
    return ShaftGeometry(
        name=name,
        y=shaft.lateral_position,
        front=_end_bearing(front),
        rear=_end_bearing(rear),
        seal_diameter=seal_diameter,
        seat_diameter=gearbox.seat_diameter(on_shaft[0])
        if on_shaft
        else seal_diameter or shaft.outside_diameter,
        overhang_diameter=shaft.outside_diameter,
        seal_gap=seals.radial_gap,
        locating="rear" if rear.locating else "front",
        bore_diameter=shaft.bore_diameter,
        overhang_front=shaft.overhang_front,
        overhang_rear=shaft.overhang_rear,
        gear=GearDisc(outer_diameter=diameters[on_shaft[0]], width=gearbox.body_width(on_shaft[0]))
        if on_shaft
        else None,
    )


# Which surfaces of a housing a fluid wets.


def wetted_surfaces(housing: Housing, names: Iterable[str], fluid: str) -> tuple[str, ...]:
    """Surfaces with a film to ``fluid`` in the order of ``boundary``, among surfaces with ``names``."""
    rows = conditions_of(housing, names)
    return tuple(surface for entry, surface, _ in rows if housing.boundary[entry].wetted_by == fluid)


def stream_surfaces(housing: Housing, names: Iterable[str], stream: str) -> tuple[str, ...]:
    """Surfaces of a stream of the housing in the order in which it passes them."""
    known = tuple(names)
    order = housing.streams[stream].surfaces
    return tuple(matched(order, known)) if order else wetted_surfaces(housing, known, stream)
