"""Bearings of a gearbox as the case states them, each kind with the bearing of the solver it stands for.

A kind is a class whose key ``type`` has one choice, joined in `BearingInput`; all kinds answer alike:
``label``, ``shaft_diameter``, ``housing_bore``, ``width``, ``drawn_clearance`` (measures as drawn), ``has_film``,
``needs_fed_oil``, ``holds_axially``, ``shell_conductance`` (what others have to know of it), ``as_it_runs`` (bearing
of the solver), ``running_clearance`` (clearance of the warm rig), ``induced_axial_load``, ``assumptions`` and
``own_faults``.
"""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Literal, TypeAlias

from pydantic import Tag

from dynamics.rotor.journal_feed import Feed
from rigdesign.base.errors import Fault
from rigdesign.base.units import show
from rigdesign.case.fields import (
    COUPLED,
    AssumptionRecord,
    Clearance,
    Effect,
    Force,
    Gap,
    HeatTransferCoefficient,
    Length,
    LinearDamping,
    LinearStiffness,
    Mass,
    Name,
    Part,
    Share,
    Usual,
    kind_from,
)
from rigdesign.case.losses import LossFactor
from rigdesign.case.rolling_bearing import (
    AxialPlay,
    BearingPlace,
    BearingSeats,
    ConstantDrag,
    Locating,
    RollingBearingInput,
)

if TYPE_CHECKING:
    from dynamics.rotor.bearing import Bearing


STATED = Effect(checks=(), where=("film",))


class JournalBearingInput(Part):
    """Plain journal bearing."""

    type: Literal["journal"] = "journal"
    """Selects a plain bearing."""
    shaft: Name
    """Shaft that it carries."""
    side: Literal["front", "rear"]
    """End of the housing it sits in; the front is where x starts."""
    diameter: Annotated[Length, Usual(0.4, 2.5, "shaft diameter")]
    """Nominal diameter of the journal."""
    width: Annotated[Length, Usual(0.15, 2.5, "bore of the bearing"), COUPLED]
    """Load-carrying width along the shaft."""
    diametral_clearance: Annotated[Clearance, Usual(4e-4, 5e-3, "bore of the bearing"), COUPLED]
    """Bore minus journal, as drawn."""
    locating: Locating = False
    """Fixes its shaft axially; one per shaft."""
    axial_play: AxialPlay = 0.0
    """Free axial travel of the shaft between a stop at this bearing and one at the other, as drawn: the thermal
    expansion of the shaft against the housing between them uses it up. Left out for a shaft with stops at one end
    only."""
    position: Gap | None = None
    """Distance of its middle from the start of its shaft in the drivetrain."""
    radial_load: Annotated[Force, Usual(0.01, 9.0, "tooth force")] | None = None
    """Load at the held stages; from the tooth forces when left out."""
    feed_share: Annotated[Share, Usual(0.3, 1.0), COUPLED] = 1.0
    """Share of the oil fed that cools the film; 1 as ISO 7902 assumes, less where oil passes by."""
    feed: Annotated[Feed, COUPLED] = "widest_gap"
    """Where oil enters. widest_gap: at the widest gap, as ISO 7902-1 has it; two_axial_grooves: by two grooves of
    20 degrees across the load, as in a split shell (J. W. Lund, K. K. Thomsen 1978)."""
    shell_conductance: HeatTransferCoefficient | None = None
    """Between shell and housing, on the area of the bore, in series with its film; perfect when left out."""
    friction_factor: Annotated[LossFactor, COUPLED] = 1.0
    """Multiplies its friction, on top of ``loss_factors.bearing`` of the gearbox."""
    torsional_damping: ConstantDrag | None = None
    """Drag torque over speed, used where ``losses.bearing_drag`` is constant."""
    radial_stiffness: Annotated[LinearStiffness, STATED] | None = None
    """Used where ``drivetrain.bearing_coefficients`` is stated."""
    radial_damping: Annotated[LinearDamping, STATED] | None = None
    """Used with it; none when left out."""
    axial_stiffness: LinearStiffness | None = None
    """Of its thrust face, where the bearing locates its shaft; 1e8 N/m when left out."""
    support_stiffness: LinearStiffness | None = None
    """Of the housing under the bearing, radially and in series with it; rigid when left out."""
    support_damping: LinearDamping = 0.0
    """Damper in parallel with the stiffness of the support."""
    support_mass: Mass = 1.0
    """Of the housing that moves with the bearing on its support."""

    @property
    def label(self) -> str:
        """Kind, for tables."""
        return "plain bearing"

    @property
    def shaft_diameter(self) -> float:
        """Of the journal [m]."""
        return self.diameter

    @property
    def housing_bore(self) -> float:
        """Of the bore in the housing [m]."""
        return self.diameter + self.diametral_clearance

    @property
    def drawn_clearance(self) -> float:
        """On the diameter, as drawn [m]."""
        return self.diametral_clearance

    @property
    def has_film(self) -> bool:
        """Its oil film takes up heat of shaft and shell."""
        return True

    @property
    def needs_fed_oil(self) -> bool:
        """Splash or grease do not carry a plain bearing."""
        return True

    @property
    def holds_axially(self) -> bool:
        """Its thrust face takes up what its partner induces, where it locates the shaft."""
        return self.locating

    @property
    def arrangement(self) -> None:
        """It has no contact angle."""
        return

    def induced_axial_load(self, radial: float) -> float:
        """None: a film pushes radially [N]."""
        return 0.0

    def as_it_runs(self, place: BearingPlace) -> "Bearing":
        """The bearing for the solver at its place; BearingError where that is impossible."""
        from dynamics.rotor.journal import JournalBearing

        return JournalBearing(
            diameter=self.diameter,
            width=self.width,
            diametral_clearance=place.clearance,
            feed_share=self.feed_share,
            feed=self.feed,
        )

    def running_clearance(self, seats: BearingSeats) -> float:
        """Clearance as it runs, on the diameter [m]: thermal expansion of bore and journal, journal by rotation."""
        return self.diametral_clearance + (-seats.spin + seats.bore_less_journal)

    def assumptions(self, at: str) -> Iterator[AssumptionRecord]:
        """None: a plain bearing states what it needs."""
        yield from ()

    def own_faults(self, at: str) -> Iterator[Fault]:
        """What is wrong with it whatever stands around it."""
        if self.diametral_clearance >= 0.05 * self.diameter:
            yield Fault(
                f"{at}.diametral_clearance", show(self.diametral_clearance, "length"),
                f"is above a twentieth of the diameter {show(self.diameter, 'length')}",
                "write bore minus journal, usually 0.001 to 0.003 of the diameter",
            )  # fmt: skip


BearingInput: TypeAlias = Annotated[
    Annotated[JournalBearingInput, Tag("journal")] | Annotated[RollingBearingInput, Tag("rolling")],
    kind_from("type", "journal"),
]
"""Bearing of any kind; a further kind joins here."""
