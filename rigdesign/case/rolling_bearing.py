"""Rolling bearing as the case states it: by designation or by the numbers of its catalogue, with fits and clearance."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Annotated, Literal, TypeAlias

from pydantic import Field, field_validator, model_validator

from dynamics.rotor.rolling_kinds import ROLLING_KINDS, CatalogueBearing
from rigdesign.base.errors import Fault
from rigdesign.base.units import show
from rigdesign.case.fields import (
    COUPLED,
    Angle,
    AssumptionRecord,
    Deviation,
    Effect,
    Force,
    Gap,
    Length,
    LinearDamping,
    LinearStiffness,
    Mass,
    Name,
    Part,
    Play,
    Positive,
    Share,
    Speed,
    Text,
    Torque,
    TorsionalDamping,
    Usual,
    fault,
)
from rigdesign.case.losses import LossFactor
from rigdesign.case.lubrication import BearingOil

if TYPE_CHECKING:
    from dynamics.rotor.bearing import Bearing

    RollingKindName: TypeAlias = str
else:
    RollingKindName = Literal[tuple(ROLLING_KINDS)]
"""Kinds that the solver has, one choice each."""

# What surrounds a bearing, for the kinds of bearings of the case. SI units.


@dataclass(frozen=True, kw_only=True)
class BearingPlace:
    """Place of a bearing at one iteration.

    clearance : on the diameter as it runs [m]; of a rolling bearing negative as preload
    lubrication : how its oil comes
    sump_level : of the oil at rest above the shaft axes [m]; None without a sump
    seat_factors : on the conductances to the seats on the shaft and in the housing
    """

    clearance: float
    lubrication: BearingOil
    sump_level: float | None = None
    seat_factors: tuple[float, float] = (1.0, 1.0)


@dataclass(frozen=True, kw_only=True)
class BearingSeats:
    """Warm seats of a bearing.

    bore_less_journal : thermal expansion of the diameter of the bore less that of the journal [m]
    spin : expansion of the journal diameter by rotation [m]
    shaft, bearing, housing : temperatures of the seats and of the bearing between them [K]
    shaft_expansion, housing_expansion : coefficients of linear expansion [1/K]
    shaft_bore : of a hollow shaft [m]
    """

    bore_less_journal: float
    spin: float
    shaft: float
    bearing: float
    housing: float
    shaft_expansion: float
    housing_expansion: float
    shaft_bore: float = 0.0


# Numbers of a rolling bearing from the catalogue: those of a tabled designation, or those that a case writes.


class CatalogueNumbers(Part):
    """Numbers of a bearing as its catalogue prints them."""

    kind: RollingKindName
    """Kind of bearing."""
    series: Text
    """Dimension series, for the coefficients of its friction, e.g. ``62``, ``2``, ``302``, ``72B``."""
    bore: Annotated[Length, Usual(0.4, 2.5, "shaft diameter")]
    """Bore d."""
    outside_diameter: Annotated[Length, Usual(1.1, 3.6, "bore of the bearing")]
    """Outside diameter D."""
    width: Annotated[Length, Usual(0.12, 1.6, "bore of the bearing")]
    """Width B; T of a tapered roller bearing."""
    dynamic_rating: Force
    """Basic dynamic load rating C."""
    static_rating: Force
    """Basic static load rating C_0."""
    limiting_speed: Speed
    """Mechanical speed limit."""
    reference_speed: Speed
    """Thermal reference speed."""
    fatigue_limit: Force | None = None
    """Fatigue load limit; the simplified one of ISO 281 when left out."""
    contact_angle: Angle = 0.0
    """Nominal contact angle; of a tapered roller bearing atan(e / 1.5)."""
    axial_limit: float = Field(default=0.0, ge=0.0)
    """e of a tapered or angular contact bearing."""
    axial_factor: float = Field(default=0.0, ge=0.0)
    """Y of a tapered or angular contact bearing."""
    static_axial_factor: float = Field(default=0.0, ge=0.0)
    """Y_0 of a tapered or angular contact bearing."""
    f_0: Positive | None = None
    """Factor f_0 of a deep groove ball bearing; that of ISO 76 when left out."""
    minimum_load_factor: float = Field(default=0.0, ge=0.0)
    """Minimum load factor k_r of ball and cylindrical roller bearings; 0 asks for no least load."""
    inner_raceway: Gap = 0.0
    """Raceway diameter F of rollers without contact angle."""
    outer_raceway: Gap = 0.0
    """Raceway diameter E of rollers without contact angle."""
    carries_axial_load: bool = True
    """False for NU and N; kinds that never do carry none anyway."""

    @model_validator(mode="after")
    def _computable(self) -> "CatalogueNumbers":
        from dynamics.rotor.bearing import BearingError

        try:
            _ = catalogue_data("", self).elements
        except BearingError as error:
            problem, _, remedy = str(error).partition(": ")[2].partition("; ")
            raise fault(problem, remedy or "correct the number by the catalogue") from None
        return self


@cache
def catalogue_data(designation: str, numbers: CatalogueNumbers | None) -> CatalogueBearing:
    """Numbers of a tabled bearing, or those of the case.

    Raises
    ------
    BearingError
        A designation that is not tabled, numbers that do not go together.
    """
    from dynamics.rotor.rolling_catalogue import catalogue_bearing

    if numbers is None:
        return catalogue_bearing(designation)
    given = dict(numbers)
    return CatalogueBearing(designation="of the case", locating=given.pop("carries_axial_load"), **given)


SHAFT_INTERFERENCE = (0.3e-3, 0.0, 0.7e-3)
"""Effective interference on the shaft over the bore: usual, least, most (k6 with normal tolerances, 30 to 100 mm)."""
HOUSING_INTERFERENCE = (-0.2e-3, -0.4e-3, 0.0)
"""Effective interference in the housing over the outside diameter: usual, least, most (H7, loose)."""
ROLLING_DAMPING_TIME = 1.25e-5
"""Damping over stiffness of a rolling bearing [s]: middle of 0.25e-5 to 2.5e-5 s (E. Kraemer, Dynamics of Rotors and
Foundations, 1993)."""

Cleanliness = Literal[
    "extreme cleanliness",
    "high cleanliness",
    "normal cleanliness",
    "slight contamination",
    "typical contamination",
    "severe contamination",
    "very severe contamination",
]


Locating = Annotated[bool, Effect(checks=(), where=("bare", "torsional"), solved=("coupling",))]
AxialPlay = Annotated[Play, Usual("0.06 mm", "1.9 mm"), Effect(checks=("axial play",), solved=("coupling",))]
ConstantDrag = Annotated[TorsionalDamping, Effect(checks=(), where=("drag",))]


class RollingBearingInput(Part):
    """Rolling bearing."""

    type: Literal["rolling"]
    """Selects a rolling bearing."""
    shaft: Name
    """Shaft that it carries."""
    side: Literal["front", "rear"]
    """End of the housing it sits in; the front is where x starts."""
    designation: Text | None = None
    """Of a tabled bearing, e.g. ``NU 208``."""
    catalogue: CatalogueNumbers | None = None
    """Numbers of a bearing that is not tabled."""
    locating: Locating = False
    """Fixes its shaft axially and takes the axial force of its gears; one per shaft."""
    arrangement: Literal["back_to_back", "face_to_face"] | None = None
    """How a bearing with a contact angle stands to the one at the other end: back to back (O) or face to face (X). Left
    out, both are rated for either, and shafts that bend have them face to face."""
    axial_play: AxialPlay = 0.0
    """Free axial travel of the shaft between a stop at this bearing and one at the other, as drawn."""
    position: Gap | None = None
    """Distance of its middle from the start of its shaft in the drivetrain."""
    radial_load: Annotated[Force, Usual(0.01, 9.0, "tooth force")] | None = None
    """Load at the held stages; from the tooth forces when left out."""
    friction_law: Literal["skf", "iso_tr_14179_2"] = "skf"
    """Law of the friction torque: the four sources of SKF, or ISO/TR 14179-2 (Palmgren)."""
    oil_kind: Literal["mineral", "synthetic", "transmission"] = "mineral"
    """Sliding friction of the SKF law in full film."""
    oil_level: Play | None = None
    """Oil at rest above the lowest point of the outer raceway; from the level of the sump when left out, 0 for a
    bearing that is shut off from it."""
    clearance_class: Literal["C2", "CN", "C3", "C4", "C5"] = "CN"
    """Class of the radial internal clearance; its middle counts."""
    radial_clearance: Annotated[Play, Usual(1e-5, 3e-3, "bore of the bearing")] | None = None
    """Radial internal clearance of the unmounted bearing in place of a class; 0 for bearings set at assembly."""
    shaft_interference: Deviation | None = None
    """Effective interference of the inner ring on the shaft, on the diameter, negative if loose; 0.0003 of the bore
    (k6) when left out."""
    housing_interference: Deviation | None = None
    """Effective interference of the outer ring in the housing; -0.0002 of the outside diameter (H7) when left out."""
    seat_outside_diameter: Annotated[Length, Usual(1.3, 8.0, "bore of the bearing")] | None = None
    """Outside diameter of the housing round the outer ring; rigid when left out."""
    contamination: Cleanliness = "normal cleanliness"
    """Cleanliness of the lubricant, ISO 281 table 13."""
    contamination_factor: Share | None = None
    """Factor e_C of ISO 281 in place of ``contamination``."""
    reliability: Annotated[float, Field(ge=0.9, le=0.99)] = 0.9
    """Of the rating life."""
    seal_torque: Annotated[Torque, Usual(1e-5, 0.02, "test torque")] = 0.0
    """Friction torque of the bearing's own contact seals."""
    friction_factor: Annotated[LossFactor, COUPLED] = 1.0
    """Multiplies its friction, on top of ``loss_factors.bearing`` of the gearbox."""
    torsional_damping: ConstantDrag | None = None
    """Drag torque over speed, used where ``losses.bearing_drag`` is constant."""
    radial_stiffness: LinearStiffness | None = None
    """Used where ``drivetrain.bearing_coefficients`` is stated."""
    radial_damping: LinearDamping | None = None
    """Used with it; 1.25e-5 s of the stiffness (Kraemer 1993) when left out."""
    axial_stiffness: LinearStiffness | None = None
    """Of its rings, where the bearing locates its shaft; 1e8 N/m when left out."""
    support_stiffness: LinearStiffness | None = None
    """Of the housing under the bearing, radially and in series with it; rigid when left out."""
    support_damping: LinearDamping = 0.0
    """Damper in parallel with the stiffness of the support."""
    support_mass: Mass = 1.0
    """Of the housing that moves with the bearing on its support."""

    @field_validator("designation")
    @classmethod
    def _tabled(cls, value: str | None) -> str | None:
        from dynamics.rotor.bearing import BearingError

        try:
            if value is not None:
                catalogue_data(value, None)
        except BearingError as error:
            problem, _, remedy = str(error).partition(": ")[2].partition("; ")
            raise fault(problem, remedy) from None
        return value

    @model_validator(mode="after")
    def _one_source(self) -> "RollingBearingInput":
        if (self.designation is None) == (self.catalogue is None):
            raise fault(
                "needs either its designation or the numbers of its catalogue",
                'write designation = "NU 208", or a table catalogue, not both',
            )
        return self

    @property
    def data(self) -> CatalogueBearing:
        """Numbers of its catalogue."""
        return catalogue_data(self.designation or "", self.catalogue)

    @property
    def label(self) -> str:
        """Designation, for tables."""
        return self.data.designation

    @property
    def shaft_diameter(self) -> float:
        """Of the seat on the shaft [m]."""
        return self.data.bore

    @property
    def housing_bore(self) -> float:
        """Of the seat in the housing [m]."""
        return self.data.outside_diameter

    @property
    def width(self) -> float:
        """Along the shaft [m]."""
        return self.data.width

    @property
    def drawn_clearance(self) -> float:
        """Radial internal clearance of the unmounted bearing, on the diameter [m]."""
        from dynamics.rotor.rolling_clearance import class_clearance

        if self.radial_clearance is not None:
            return self.radial_clearance
        if self.data.contact_angle > 0.0:
            return 0.0
        return 0.5 * sum(class_clearance(self.data, self.clearance_class))

    @property
    def has_film(self) -> bool:
        """It joins shaft and housing by rolling elements, not by a film that takes up their heat."""
        return False

    @property
    def needs_fed_oil(self) -> bool:
        """Splash and grease carry a rolling bearing."""
        return False

    @property
    def shell_conductance(self) -> None:
        """It has no shell: the joints of its rings belong to its own heat paths."""
        return

    @property
    def interferences(self) -> tuple[float, float]:
        """On the shaft and in the housing [m]."""
        on_shaft, in_housing = self.shaft_interference, self.housing_interference
        data = self.data
        return (
            SHAFT_INTERFERENCE[0] * data.bore if on_shaft is None else on_shaft,
            HOUSING_INTERFERENCE[0] * data.outside_diameter if in_housing is None else in_housing,
        )

    @property
    def holds_axially(self) -> bool:
        """It takes up what its partner induces: by its contact angle, or where it locates the shaft."""
        return self.data.carries_axial_load and (self.locating or self.data.contact_angle > 0.0)

    def induced_axial_load(self, radial: float) -> float:
        """Axial force that a radial load produces inside the bearing [N]; 0 without a contact angle."""
        return self.data.rules.induced_axial_load(self.data, radial)

    def as_it_runs(self, place: BearingPlace) -> "Bearing":
        """The bearing for the solver at its place; BearingError where that is impossible."""
        from dynamics.rotor.rolling import RollingBearing, SeatConductances, housing_path, shaft_path

        level = self._oil_level(place)
        data = self.data
        return RollingBearing(
            data=data,
            law=self.friction_law,
            lubrication=place.lubrication.rolling_supply(level),
            oil_level=level or None,
            oil_kind=self.oil_kind,
            clearance=place.clearance,
            contamination=self.contamination
            if self.contamination_factor is None
            else self.contamination_factor,
            reliability=self.reliability,
            seal_torque=self.seal_torque,
            seats=SeatConductances(
                shaft=place.seat_factors[0] * shaft_path(data).conductance,
                housing=place.seat_factors[1] * housing_path(data).conductance,
            ),
        )

    def running_clearance(self, seats: BearingSeats) -> float:
        """Radial internal clearance as it runs, on the diameter [m]; negative is preload."""
        from dynamics.rotor.rolling import housing_path, shaft_path
        from dynamics.rotor.rolling_clearance import (
            Fit,
            RingTemperatures,
            SeatMaterial,
            operating_clearance,
        )

        on_shaft, in_housing = self.interferences
        data, node = self.data, seats.bearing
        fit = Fit(
            shaft_interference=on_shaft,
            housing_interference=in_housing,
            shaft_bore=seats.shaft_bore,
            housing_outside=self.seat_outside_diameter or float("inf"),
            shaft=SeatMaterial(expansion=seats.shaft_expansion),
            housing=SeatMaterial(expansion=seats.housing_expansion),
        )
        warm = RingTemperatures(
            shaft=seats.shaft,
            inner_ring=node - shaft_path(data).ring_share * (node - seats.shaft),
            elements=node,
            outer_ring=node - housing_path(data).ring_share * (node - seats.housing),
            housing=seats.housing,
        )
        return operating_clearance(data, self.drawn_clearance, fit, warm).clearance

    def own_faults(self, at: str) -> Iterator[Fault]:
        """What is wrong with it whatever stands around it."""
        data = self.data
        if self.locating and not data.carries_axial_load:
            yield Fault(
                f"{at}.locating", "true", f"{data.designation} carries no axial load: its rings move past each other",
                "let the other bearing locate the shaft, or take NJ, NUP or a ball bearing",
            )  # fmt: skip
        if self.friction_law not in data.rules.friction_sources:
            yield Fault(
                f"{at}.friction_law", f'"{self.friction_law}"',
                f"has no coefficients for a {data.kind.replace('_', ' ')} bearing",
                f"take {' or '.join(data.rules.friction_sources)}",
            )  # fmt: skip
        if self.oil_level is not None and self.oil_level > data.outside_diameter:
            yield Fault(
                f"{at}.oil_level", show(self.oil_level, "length"),
                f"is above the outside diameter {show(data.outside_diameter, 'length')}",
                "count it from the lowest point of the outer raceway",
            )  # fmt: skip
        if self.seat_outside_diameter is not None and self.seat_outside_diameter <= data.outside_diameter:
            yield Fault(
                f"{at}.seat_outside_diameter", show(self.seat_outside_diameter, "length"),
                f"is not above the outside diameter {show(data.outside_diameter, 'length')} of the bearing",
                "write the outside diameter of the boss, or leave it out for a rigid one",
            )  # fmt: skip
        if self.radial_clearance is None and data.contact_angle == 0.0:
            yield from self._unclassed(at)
        for key, value, size in (
            ("shaft_interference", self.shaft_interference, data.bore),
            ("housing_interference", self.housing_interference, data.outside_diameter),
        ):
            if value is not None and abs(value) > 2e-3 * size:
                yield Fault(
                    f"{at}.{key}", show(value, "length"),
                    f"is more than two thousandths of the seat {show(size, 'length')}",
                    "write the interference on the diameter, usually 0 to 0.0007 of it",
                )  # fmt: skip

    def assumptions(self, at: str) -> Iterator[AssumptionRecord]:
        """What takes the place of keys that are left out."""
        data = self.data
        for key, value, size, shares, fit in (
            ("shaft_interference", self.shaft_interference, data.bore, SHAFT_INTERFERENCE, "k6"),
            (
                "housing_interference", self.housing_interference, data.outside_diameter, HOUSING_INTERFERENCE,
                "H7",
            ),
        ):  # fmt: skip
            if value is None:
                usual, least, most = (f"{1e6 * share * size:.0f} um" for share in shares)
                yield AssumptionRecord(
                    path=f"{at}.{key}",
                    value=usual,
                    reason=f"not stated: effective interference of a {fit} seat; it moves the operating clearance",
                    range=(least, most),
                )

    def _unclassed(self, at: str) -> Iterator[Fault]:
        from dynamics.errors import DynamicsInputError

        try:
            _ = self.drawn_clearance
        except DynamicsInputError as error:
            yield Fault(
                f"{at}.clearance_class", f'"{self.clearance_class}"', str(error), "write radial_clearance instead"
            )  # fmt: skip

    def _oil_level(self, place: BearingPlace) -> float:
        """Oil above the lowest point of the outer raceway [m]; 0 where none stands there."""
        data = self.data
        if self.oil_level is not None:
            return self.oil_level
        if place.sump_level is None:
            return 0.0
        level = 0.5 * data.elements.outer_raceway + place.sump_level
        return min(max(level, 0.0), data.outside_diameter)
