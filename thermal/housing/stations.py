"""Places of a gearbox where an engineer reads a clearance: bearings, seals, shafts, gears.

Coordinates: x along the shafts, y across (from pinion to wheel), z up; metres, as drawn.
"""

from dataclasses import dataclass

from thermal.fe.mesh import NamedMesh

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
