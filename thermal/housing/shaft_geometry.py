"""A shaft of a parametric gearbox with its bearings, seals and gear, as drawn. All lengths in metres."""

import math
import re
from dataclasses import dataclass
from typing import Literal

from thermal.errors import ThermalInputError

# Lengths of a gearbox: what they have to keep, and the error of those that do not.

Side = Literal["front", "rear"]
SIDES: tuple[Side, Side] = ("front", "rear")
MINIMUM_LAND = 1e-3
"""Least length or thickness [m] that geometry may leave between two features."""


class GeometryError(ThermalInputError):
    """A gearbox that cannot be built; the message names the quantity, its value, the limit and the remedy."""


def require_positive(part: object, *names: str) -> None:
    """Raises GeometryError for a length of ``part`` that is not above 0."""
    for name in names:
        value = getattr(part, name)
        if not (math.isfinite(value) and value > 0.0):
            raise GeometryError(
                f"{_label(part)}{name} = {value} m must be greater than 0; give a positive length"
            )


def require_not_negative(part: object, *names: str) -> None:
    """Raises GeometryError for a length of ``part`` below 0."""
    for name in names:
        value = getattr(part, name)
        if not (math.isfinite(value) and value >= 0.0):
            raise GeometryError(f"{_label(part)}{name} = {value} m must not be negative; give 0 or more")


def _label(part: object) -> str:
    """Who owns the quantity: the shaft by name, the field, the gear; nothing for the housing itself."""
    labels = {
        "ShaftGeometry": f"shaft {getattr(part, 'name', '')}: ",
        "EndBearing": "bearing: ",
        "GearDisc": "gear: ",
        "ClampingField": "field: ",
    }
    return labels.get(type(part).__name__, "")


@dataclass(frozen=True, kw_only=True)
class GearDisc:
    """A gear body as a solid disc on the gear seat of its shaft; the teeth are not drawn.

    Discs of a meshing pair may overlap (tip diameters do): they are separate bodies that share no nodes.
    """

    outer_diameter: float
    """Diameter of the disc [m]; tip diameter, or the mean of tip and root to keep the mass."""
    width: float
    """Face width [m]."""
    offset: float = 0.0
    """x of the disc's mid-plane relative to the middle of the chamber [m]."""

    def __post_init__(self) -> None:
        require_positive(self, "outer_diameter", "width")


@dataclass(frozen=True, kw_only=True)
class EndBearing:
    """Bearing at one end of a shaft, as the housing and the shaft are cut for it. Lengths in metres."""

    journal_diameter: float
    """Diameter of the shaft in it."""
    width: float
    clearance: float = 0.0
    """Radial distance from the shaft to the bore of the housing: of a plain bearing its clearance, of a rolling
    bearing its section."""

    def __post_init__(self) -> None:
        require_positive(self, "journal_diameter", "width")
        require_not_negative(self, "clearance")

    @property
    def bore_radius(self) -> float:
        """Radius of its bore in the housing [m]."""
        return self.journal_diameter / 2.0 + self.clearance


@dataclass(frozen=True, kw_only=True)
class ShaftGeometry:
    """A stepped shaft on two bearings, with its seals and at most one gear. Lengths in metres."""

    name: str
    """Lower-case letters, digits and underscores; part of the names of its bodies and surfaces."""
    y: float
    """Position of the axis as drawn across the housing."""
    front: EndBearing
    rear: EndBearing
    seal_diameter: float = 0.0
    """Diameter in the partition seals and in the cold sections between partition and bearing; 0 without partitions."""
    seat_diameter: float
    """Diameter in the chamber: gear seat, and bore of the gear."""
    overhang_diameter: float
    """Diameter in the end seals and outside the housing."""
    seal_gap: float
    """Radial gap of every seal of this shaft."""
    locating: Side
    """The end whose bearing fixes the shaft axially."""
    bore_diameter: float = 0.0
    """Central bore right through the shaft; 0 for a solid one."""
    overhang_front: float = 0.0
    """Length that leaves the front end wall; 0: the shaft ends at its bearing behind a closed cover."""
    overhang_rear: float = 0.0
    gear: GearDisc | None = None

    def __post_init__(self) -> None:
        if not re.fullmatch(r"[a-z][a-z0-9_]*", self.name):
            raise GeometryError(
                f"shaft name {self.name!r} is not allowed: use lower-case letters, digits and underscores, "
                "starting with a letter"
            )
        require_positive(self, "seat_diameter", "overhang_diameter", "seal_gap")
        require_not_negative(self, "seal_diameter", "bore_diameter", "overhang_front", "overhang_rear")
        if not math.isfinite(self.y):
            raise GeometryError(
                f"shaft {self.name}: y = {self.y} is no number; give the axis position in metres"
            )
        if self.locating not in SIDES:
            raise GeometryError(
                f"shaft {self.name}: locating = {self.locating!r} is neither 'front' nor 'rear'"
            )
        self._check_bore()

    def _check_bore(self) -> None:
        if 0.0 < self.bore_diameter < 2.0 * MINIMUM_LAND:
            raise GeometryError(
                f"shaft {self.name}: bore_diameter = {self.bore_diameter:g} m is below "
                f"{2.0 * MINIMUM_LAND:g} m; give 0 for a solid shaft or a wider bore"
            )
        zones = {
            **{
                f"journal_diameter of its {side} bearing": self.bearing(side).journal_diameter
                for side in SIDES
            },
            "seat_diameter": self.seat_diameter,
            "overhang_diameter": self.overhang_diameter,
        }
        if self.seal_diameter > 0.0:
            zones["seal_diameter"] = self.seal_diameter
        thinnest = min(zones, key=lambda zone: zones[zone])
        limit = zones[thinnest] - 2.0 * MINIMUM_LAND
        if self.bore_diameter > limit:
            raise GeometryError(
                f"shaft {self.name}: bore_diameter = {self.bore_diameter:g} m is above {limit:g} m, which "
                f"{thinnest} leaves; make the bore smaller or the shaft thicker"
            )
        if self.gear is not None and self.gear.outer_diameter < self.seat_diameter + 2.0 * MINIMUM_LAND:
            raise GeometryError(
                f"shaft {self.name}: outside diameter of the gear = {self.gear.outer_diameter:g} m must exceed "
                f"that of its seat = {self.seat_diameter:g} m; enlarge the gear or reduce the seat"
            )

    def bearing(self, side: Side) -> EndBearing:
        """Bearing of one end."""
        return self.front if side == "front" else self.rear

    def overhang(self, side: Side) -> float:
        """Length outside the end wall of one side [m]."""
        return self.overhang_front if side == "front" else self.overhang_rear
