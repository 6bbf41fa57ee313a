"""Places of a gearbox where an engineer reads a clearance: bearings, seals, shafts, gears.

Coordinates: x along the shafts, y across (from pinion to wheel), z up; metres, as drawn.
"""

from dataclasses import dataclass, replace

import numpy as np

from thermal.fe.mesh import FloatArray, NamedMesh
from thermal.housing.geometry import HousingGeometry
from thermal.housing.housing_surfaces import FOOT, SEAT, joined_surfaces
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


# Stations of a user's mesh: circles fitted to the bores and shafts that carry the names of a gearbox.
#
# The surfaces and bodies that count are those that `thermal.housing.gearbox` names. Where one is missing, is no
# cylinder about an axis along x, or a journal does not stand in its bore, heat can be computed but no clearance be
# read, and the model says why.

ROUND = 0.02
"""Largest distance of a corner from the fitted circle, relative to its radius, of what is taken for a cylinder."""


@dataclass(frozen=True)
class FittedCylinder:
    """A cylinder about an axis along x."""

    centre: Point
    """In the middle of its length [m]."""
    radius: float
    length: float
    roundness: float
    """Largest distance of a node from the circle, relative to the radius."""


def fit_cylinder(points: FloatArray) -> FittedCylinder:
    """Least-squares circle in y and z through points (n, 3) [m], n at least 3.

    Source: Kasa, IEEE Trans. Instrum. Meas. 25 (1976) 8: linear in centre and r^2 - |centre|^2.
    """
    start, end = float(points[:, 0].min()), float(points[:, 0].max())
    middle = points[:, 1:].mean(axis=0)
    y, z = (points[:, 1:] - middle).T
    fit = np.linalg.lstsq(np.column_stack([2.0 * y, 2.0 * z, np.ones_like(y)]), y**2 + z**2)[0]
    radius = float(np.sqrt(max(fit[2] + fit[0] ** 2 + fit[1] ** 2, 0.0)))
    off = np.abs(np.hypot(y - fit[0], z - fit[1]) - radius).max()
    centre = (0.5 * (start + end), float(middle[0] + fit[0]), float(middle[1] + fit[1]))
    return FittedCylinder(centre, radius, end - start, float(off / radius) if radius > 0.0 else np.inf)


def fitted_model(mesh: NamedMesh, geometry: HousingGeometry) -> GearboxModel:
    """The model of a user's mesh; what ``geometry`` names is looked for, its measures are taken from the mesh.

    Clearances and which bearing locates a shaft are those of ``geometry``. ``no_expansion`` of the model says
    what is missing for clearances; it then has no stations.
    """
    missing = _missing(mesh, geometry)
    if missing:
        return GearboxModel(
            mesh=mesh, shafts=(), bearings=(), seals=(), gears=(), fixed_body="", foot_surface="",
            no_expansion=f"clearances need {missing}",
        )  # fmt: skip
    fits = {name: fit_cylinder(mesh.points[np.unique(nodes[:, : mesh.shape.side.n_corners])])
          for name, nodes in mesh.surfaces.items()}  # fmt: skip
    field = "field" in mesh.bodies
    return GearboxModel(
        mesh=mesh,
        shafts=tuple(
            replace(s, axis=(0.0, *fits[_journal(geometry, s.name)].centre[1:]),
                    start=fits[s.start_surface].centre[0], end=fits[s.end_surface].centre[0])
            for s in shaft_stations(geometry)
        ),
        bearings=tuple(
            replace(b, centre=fits[b.bore_surface].centre, diameter=2.0 * fits[b.journal_surface].radius,
                    width=fits[b.bore_surface].length)
            for b in bearing_stations(geometry)
        ),
        seals=tuple(
            replace(s, centre=fits[s.bore_surface].centre, shaft_diameter=2.0 * fits[s.shaft_surface].radius)
            for s in seal_stations(geometry)
            if {s.bore_surface, s.shaft_surface} <= set(mesh.surfaces)
        ),
        gears=tuple(
            replace(g, centre=fits[g.rim_surface].centre, face_width=fits[g.rim_surface].length)
            for g in gear_stations(geometry)
        ),
        fixed_body="field" if field else "housing",
        foot_surface="field_bottom" if field else FOOT,
        joint=foot_joint(geometry),
    )  # fmt: skip


def _journal(geometry: HousingGeometry, shaft: str) -> str:
    return next(b.journal_surface for b in bearing_stations(geometry) if b.shaft == shaft)


def _missing(mesh: NamedMesh, geometry: HousingGeometry) -> str:
    """What the mesh lacks for clearances, in words; empty if nothing."""
    if mesh.shape.n_corners != 4:
        return "a mesh of ten-node tetrahedra, on which gaps round a seal are read"
    bearings, gears = bearing_stations(geometry), gear_stations(geometry)
    shafts, seals = shaft_stations(geometry), seal_stations(geometry)
    bodies = ["housing", *(s.body for s in shafts), *(g.body for g in gears)]
    cylinders = [name for b in bearings for name in (b.bore_surface, b.journal_surface)]
    cylinders += [g.rim_surface for g in gears]
    ends = [name for s in shafts for name in (s.start_surface, s.end_surface)]
    ends.append("field_bottom" if "field" in mesh.bodies else FOOT)
    ends += joined_surfaces(geometry)
    lost = [f"body {name}" for name in bodies if name not in mesh.bodies]
    lost += [f"surface {name}" for name in cylinders + ends if name not in mesh.surfaces]
    if lost:
        return ", ".join(lost)
    cylinders += [name for s in seals for name in (s.bore_surface, s.shaft_surface) if name in mesh.surfaces]
    fits = {name: fit_cylinder(mesh.points[np.unique(mesh.surfaces[name][:, :3])]) for name in cylinders}
    flat = [name for name, fit in fits.items() if fit.roundness > ROUND]
    if flat:
        return f"cylinders about an axis along x: {', '.join(flat)}"
    apart = [
        f"{b.bore_surface} about {_millimetres(bore)}, {b.journal_surface} about {_millimetres(journal)}"
        for b in bearings
        if not _together(bore := fits[b.bore_surface], journal := fits[b.journal_surface])
    ]
    return f"bores round their journals: {'; '.join(apart)}" if apart else ""


def _together(bore: FittedCylinder, journal: FittedCylinder) -> bool:
    """Whether a journal turns in its bore: on its axis, and in it over half of the shorter one at least."""
    off = np.hypot(bore.centre[1] - journal.centre[1], bore.centre[2] - journal.centre[2])
    overlap = 0.5 * (bore.length + journal.length) - abs(bore.centre[0] - journal.centre[0])
    return bool(off <= ROUND * journal.radius and overlap >= 0.5 * min(bore.length, journal.length))


def _millimetres(fit: FittedCylinder) -> str:
    return f"({', '.join(f'{1e3 * value:.4g}' for value in fit.centre)}) mm"
