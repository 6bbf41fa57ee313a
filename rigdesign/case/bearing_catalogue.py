"""Numbers of a rolling bearing from the catalogue: those of a tabled designation, or those that a case writes."""

from functools import cache
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field, model_validator

from rigdesign.case.fields import Angle, Force, Gap, Length, Part, Positive, Speed, Text, Usual, fault

if TYPE_CHECKING:
    from dynamics.bearing.rolling_catalogue import CatalogueBearing


class CatalogueNumbers(Part):
    """Numbers of a bearing as its catalogue prints them."""

    kind: Literal["deep_groove_ball", "cylindrical_roller", "tapered_roller", "angular_contact_ball"]
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
    """Raceway diameter F of a cylindrical roller bearing."""
    outer_raceway: Gap = 0.0
    """Raceway diameter E of a cylindrical roller bearing."""
    carries_axial_load: bool = True
    """False for NU and N."""

    @model_validator(mode="after")
    def _computable(self) -> "CatalogueNumbers":
        from dynamics.bearing.protocol import BearingError

        try:
            _ = catalogue_data("", self).elements
        except BearingError as error:
            problem, _, remedy = str(error).partition(": ")[2].partition("; ")
            raise fault(problem, remedy or "correct the number by the catalogue") from None
        return self


@cache
def catalogue_data(designation: str, numbers: CatalogueNumbers | None) -> "CatalogueBearing":
    """Numbers of a tabled bearing, or those of the case.

    Raises
    ------
    BearingError
        A designation that is not tabled, numbers that do not go together.
    """
    from dynamics.bearing.rolling_catalogue import CatalogueBearing, catalogue_bearing

    if numbers is None:
        return catalogue_bearing(designation)
    given = dict(numbers)
    return CatalogueBearing(designation="of the case", locating=given.pop("carries_axial_load"), **given)
