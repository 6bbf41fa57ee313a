"""Clearances and alignment of the warm gearboxes at the held stages: SI records.

As drawn means at the reference temperature of the drawing.
"""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class SealClearance:
    """Radial gap of one seal without contact [m]."""

    name: str
    shaft: str
    as_drawn: float
    minimum: float
    mean: float
    angle_of_minimum: float
    """[rad]"""
    by_hand: float
    """Of a ring and a shaft at their own mean temperatures."""
    axial_shift: float
    """Of the shaft in the seal."""
    angles: tuple[float, ...]
    """(n,) round the circumference [rad]."""
    gaps: tuple[float, ...]
    """(n,) at these angles."""


@dataclass(frozen=True, kw_only=True)
class WarmShaft:
    """Thermal expansion of one shaft from its locating bearing, and the axial play it leaves [m]."""

    name: str
    front: float
    rear: float
    free: float
    """Of the whole shaft at its own mean temperature, by hand."""
    play_as_drawn: float
    """0 where the case states none."""
    play: float

    @property
    def total(self) -> float:
        """Of both ends."""
        return self.front + self.rear


@dataclass(frozen=True, kw_only=True)
class MeshClearance:
    """One mesh as drawn and warm [m]."""

    name: str
    """``gearbox.mesh``."""
    centre_distance_as_drawn: float
    centre_distance: float
    backlash_as_drawn: float
    backlash: float
    """Transverse, at the pitch circle."""
    tip_clearance_as_drawn: float
    tip_clearance: float
    """The smaller of both gears."""
    inclination: float
    """Of the axes in their plane [rad]."""
    skew: float
    """Across that plane [rad]."""
    bulk_temperatures: tuple[float, float]
    """Of pinion and wheel [K]."""


@dataclass(frozen=True, kw_only=True)
class BearingClearance:
    """One journal bearing as drawn and warm, with its film."""

    name: str
    """``gearbox.bearing``."""
    clearance_as_drawn: float
    """Diametral [m]."""
    clearance: float
    """Diametral [m]."""
    bore_ovality: float
    """[m]"""
    minimum_film: float | None
    """[m]"""
    film_temperature: float
    """[K]"""
    specific_load: float | None
    """[Pa]"""
    transition_speed: float | None
    """[rad/s]"""


@dataclass(frozen=True, kw_only=True)
class BoreAlignment:
    """A shaft in the bore of its bearing and how far that bore is out of round; as drawn all are zero."""

    bearing: str
    """``gearbox.bearing``."""
    tilt: float
    """[rad]"""
    tilt_lateral: float
    """[rad]"""
    tilt_vertical: float
    """[rad]"""
    width: float
    """Of the bearing [m]."""
    out_of_round: float
    """Peak to valley of the radius [m]."""
    second_harmonic: float
    """[m]"""
    long_axis: float
    """Angle of the long axis of the oval [rad]."""
    out_of_round_share: float
    """Out of round as a share of the warm radial clearance."""


@dataclass(frozen=True, kw_only=True)
class AxisAlignment:
    """Axes of a mesh over its face width [m], with what is recommended for its gears; as drawn they are parallel."""

    mesh: str
    """``gearbox.mesh``."""
    centre_distance_change: float
    face_width: float
    inclination: float
    """In the plane of the axes; positive when they open towards the rear."""
    recommended_inclination: float
    skew: float
    """Across that plane."""
    recommended_skew: float


@dataclass(frozen=True, kw_only=True)
class ShaftOffset:
    """Two shaft ends at a coupling, the first against the second, in one state of the rig."""

    lateral: float
    """[m]"""
    vertical: float
    """[m]"""
    radial_offset: float
    """[m]"""
    angle: float
    """Between the axes [rad]."""


@dataclass(frozen=True, kw_only=True)
class CouplingAlignment:
    """Alignment at one coupling, as set and warm.

    A shaft without a housing stays at the place at which it was set.
    """

    coupling: str
    first: str
    second: str
    housed: tuple[bool, bool]
    """Whether a housing carries the first and the second shaft."""
    as_set: ShaftOffset
    warm: ShaftOffset
    ends_nearer: float
    """How much the shaft ends come nearer along the axis [m]."""

    @property
    def moved(self) -> tuple[float, float]:
        """What warming up adds to the offset, lateral and vertical [m]; set to its negative, the warm one is zero."""
        return self.warm.lateral - self.as_set.lateral, self.warm.vertical - self.as_set.vertical

    def shown(self, end: int) -> str:
        """Name of the first (0) or second (1) shaft; one that no housing carries is marked cold."""
        name = (self.first, self.second)[end]
        return name if self.housed[end] else f"{name} (cold)"


@dataclass(frozen=True, kw_only=True)
class WarmGearbox:
    """One gearbox with an expanded housing at one held stage."""

    gearbox: str
    stage: str
    seals: tuple[SealClearance, ...] = ()
    shafts: tuple[WarmShaft, ...] = ()
    meshes: tuple[MeshClearance, ...] = ()
    bearings: tuple[BearingClearance, ...] = ()
    bores: tuple[BoreAlignment, ...] = ()
    axes: tuple[AxisAlignment, ...] = ()
    couplings: tuple[CouplingAlignment, ...] = ()
    """Those whose first housed shaft is carried by this gearbox."""
