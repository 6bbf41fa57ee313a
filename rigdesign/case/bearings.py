"""Bearings of a gearbox as the case states them, each kind with the bearing of the solver it stands for."""

from typing import TYPE_CHECKING, Literal, TypeAlias

from rigdesign.case.fields import (
    Clearance,
    Force,
    Gap,
    HeatTransferCoefficient,
    Length,
    LinearDamping,
    LinearStiffness,
    Name,
    Part,
    Play,
    Share,
    TorsionalDamping,
)

if TYPE_CHECKING:
    from dynamics.bearing.protocol import Bearing


class JournalBearingInput(Part):
    """Plain journal bearing."""

    shaft: Name
    """Shaft that it carries."""
    side: Literal["front", "rear"]
    """End of the housing it sits in; the front is where x starts."""
    diameter: Length
    """Nominal diameter of the journal."""
    width: Length
    """Load-carrying width along the shaft."""
    diametral_clearance: Clearance
    """Bore minus journal, as drawn."""
    locating: bool = False
    """Fixes its shaft axially; one per shaft."""
    axial_play: Play = 0.0
    """Free axial travel of the shaft between a stop at this bearing and one at the other, as drawn: the thermal
    expansion of the shaft against the housing between them uses it up. Left out for a shaft with stops at one end
    only."""
    position: Gap | None = None
    """Distance of its middle from the start of its shaft in the drivetrain."""
    radial_load: Force | None = None
    """Load at the held stages; from the tooth forces when left out."""
    feed_share: Share = 1.0
    """Share of the oil fed that cools the film; 1 as ISO 7902 assumes, less where oil passes by."""
    shell_conductance: HeatTransferCoefficient | None = None
    """Between shell and housing, on the area of the bore, in series with its film; perfect when left out."""
    torsional_damping: TorsionalDamping | None = None
    """Drag torque over speed, used where ``losses.bearing_drag`` is constant."""
    radial_stiffness: LinearStiffness | None = None
    """For the record: the drivetrain is torsional."""
    radial_damping: LinearDamping | None = None
    """For the record: the drivetrain is torsional."""

    @property
    def needs_fed_oil(self) -> bool:
        """Splash or grease do not carry a plain bearing."""
        return True

    def at_clearance(self, diametral_clearance: float) -> "Bearing":
        """The bearing for the solver with its clearance as it runs [m]; BearingError where that is impossible."""
        from dynamics.bearing.journal import JournalBearing

        return JournalBearing(
            diameter=self.diameter,
            width=self.width,
            diametral_clearance=diametral_clearance,
            feed_share=self.feed_share,
        )


BearingInput: TypeAlias = JournalBearingInput
"""Bearing of any kind; a further kind joins here."""
