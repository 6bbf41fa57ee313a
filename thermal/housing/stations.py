"""Places of a gearbox where an engineer reads a clearance: bearings, seals, shafts, gears.

Coordinates: x along the shafts, y across (from pinion to wheel), z up; metres, as drawn.
"""

from dataclasses import dataclass

from thermal.fe.mesh import NamedMesh
from thermal.housing.geometry import HousingGeometry
from thermal.housing.housing_surfaces import FOOT, SEAT
from thermal.housing.shaft_geometry import SIDES, ShaftGeometry
from thermal.housing.shaft_surfaces import shaft_zones

Point = tuple[float, float, float]


@dataclass(frozen=True, kw_only=True)
class BearingStation:
    """A journal bearing: housing bore and journal, both cylinders about the shaft axis."""

    name: str
    shaft: str
    bore_surface: str
    journal_surface: str
    centre: Point
    diameter: float
    width: float
    locating: bool
    """True for the one bearing that fixes its shaft axially."""


@dataclass(frozen=True, kw_only=True)
class SealStation:
    """A contactless seal: bore and shaft surface with a radial gap between them."""

    name: str
    shaft: str
    bore_surface: str
    shaft_surface: str
    centre: Point
    shaft_diameter: float
    radial_gap: float


@dataclass(frozen=True, kw_only=True)
class ShaftStation:
    """A shaft with what is fixed on it: its body, axis and end faces."""

    name: str
    body: str
    axis: Point
    """Any point on the axis as drawn (which runs along x)."""
    start: float
    """x of the first end face [m]."""
    end: float
    start_surface: str
    end_surface: str


@dataclass(frozen=True, kw_only=True)
class GearStation:
    """A gear body on its shaft."""

    name: str
    shaft: str
    body: str
    rim_surface: str
    side_surfaces: tuple[str, ...]
    centre: Point
    face_width: float


@dataclass(frozen=True, kw_only=True)
class FootJoint:
    """A body that stands on the fixed body without sharing nodes: it follows the seat and slides on it."""

    body: str
    foot_surface: str
    seat_surface: str
    """Surface of the fixed body under the foot."""


@dataclass(frozen=True, kw_only=True)
class GearboxModel:
    """A meshed gearbox with its stations."""

    mesh: NamedMesh
    shafts: tuple[ShaftStation, ...]
    bearings: tuple[BearingStation, ...]
    seals: tuple[SealStation, ...]
    gears: tuple[GearStation, ...]
    fixed_body: str
    """Body that stands on the floor (clamping field or foot): carries the statically determinate support."""
    foot_surface: str
    """Surface of ``fixed_body`` on which it stands."""
    joint: FootJoint | None = None
    """What stands on the fixed body; None where they share their nodes or are one."""
    no_expansion: str = ""
    """Why no clearance can be read from this model, which then has no stations; empty where it can."""


# Where an engineer reads the clearances of a parametric gearbox: its stations, from the geometry alone.


def shaft_stations(geometry: HousingGeometry) -> tuple[ShaftStation, ...]:
    """One station a shaft, in the order of ``geometry.shafts``."""
    stations = []
    for shaft in geometry.shafts:
        zones = shaft_zones(geometry, shaft)
        body = f"shaft_{shaft.name}"
        stations.append(
            ShaftStation(
                name=shaft.name, body=body, axis=_on_axis(geometry, shaft, 0.0), start=zones[0].start,
                end=zones[-1].end, start_surface=f"{body}_end_front", end_surface=f"{body}_end_rear",
            )
        )  # fmt: skip
    return tuple(stations)


def foot_joint(geometry: HousingGeometry) -> FootJoint | None:
    """How the housing stands on its field; None where they share their nodes."""
    return FootJoint(body="housing", foot_surface=FOOT, seat_surface=SEAT) if geometry.foot_joint else None


def bearing_stations(geometry: HousingGeometry) -> tuple[BearingStation, ...]:
    """Front and rear bearing of every shaft, named ``<shaft>_front`` and ``<shaft>_rear``."""
    return tuple(
        BearingStation(
            name=f"{shaft.name}_{side}", shaft=shaft.name, bore_surface=f"bearing_bore_{shaft.name}_{side}",
            journal_surface=f"shaft_{shaft.name}_journal_{side}",
            centre=_on_axis(
                geometry, shaft, geometry.mirrored(side, sum(geometry.bearing_depths(shaft.bearing(side))) / 2.0)
            ),
            diameter=shaft.bearing(side).journal_diameter, width=shaft.bearing(side).width,
            locating=shaft.locating == side,
        )
        for shaft in geometry.shafts
        for side in SIDES
    )  # fmt: skip


def seal_stations(geometry: HousingGeometry) -> tuple[SealStation, ...]:
    """Seals of every shaft: ``<shaft>_<side>`` in partitions, ``<shaft>_<side>_end`` where it leaves an end wall."""
    stations = []
    for shaft in geometry.shafts:
        places: list[tuple[str, float, float]] = []
        if not geometry.one_chamber:
            places += [
                ("front", sum(geometry.partition_front) / 2.0, shaft.seal_diameter),
                ("rear", sum(geometry.partition_rear) / 2.0, shaft.seal_diameter),
            ]
        places += [
            (
                f"{side}_end",
                geometry.mirrored(side, geometry.bearing_depths(shaft.bearing(side))[0] / 2.0),
                shaft.overhang_diameter,
            )
            for side in SIDES
            if shaft.overhang(side) > 0.0
        ]
        stations += [
            SealStation(
                name=f"{shaft.name}_{place}", shaft=shaft.name,
                bore_surface=f"seal_bore_{shaft.name}_{place}",
                shaft_surface=f"shaft_{shaft.name}_seal_{place}", centre=_on_axis(geometry, shaft, x),
                shaft_diameter=diameter, radial_gap=shaft.seal_gap,
            )
            for place, x, diameter in places
        ]  # fmt: skip
    return tuple(stations)


def gear_stations(geometry: HousingGeometry) -> tuple[GearStation, ...]:
    """The gear of every shaft that carries one, named like its body ``gear_<shaft>``."""
    stations = []
    for shaft in geometry.shafts:
        if shaft.gear is None:
            continue
        body = f"gear_{shaft.name}"
        stations.append(
            GearStation(
                name=body, shaft=shaft.name, body=body, rim_surface=f"{body}_rim",
                side_surfaces=tuple(f"{body}_side_{side}" for side in SIDES),
                centre=_on_axis(geometry, shaft, sum(geometry.gear_limits(shaft)) / 2.0),
                face_width=shaft.gear.width,
            )
        )  # fmt: skip
    return tuple(stations)


def _on_axis(geometry: HousingGeometry, shaft: ShaftGeometry, x: float) -> Point:
    return x, shaft.y, geometry.shaft_height
