"""Ribs on a surface of a housing, which its mesh does not have."""

from pydantic import model_validator

from rigdesign.base.units import show
from rigdesign.case.fields import Conductivity, Length, Part, fault
from rigdesign.case.surface_place import SurfacePlace
from thermal.films import convection
from thermal.films.law import FilmLaw
from thermal.films.ribs import RibArray


class Ribs(Part):
    """Straight ribs of constant thickness, side by side."""

    height: Length
    """From the wall to the tip."""
    thickness: Length
    """Mean thickness of a rib."""
    pitch: Length
    """From middle to middle of two ribs."""
    conductivity: Conductivity | None = None
    """Thermal conductivity of the ribs; that of the housing when left out."""

    @model_validator(mode="after")
    def _room_between(self) -> "Ribs":
        if self.thickness >= self.pitch:
            raise fault(
                f"ribs of {show(self.thickness, 'length')} on a pitch of {show(self.pitch, 'length')} leave no gap",
                "write a pitch above the thickness",
            )
        return self

    def on(self, law: FilmLaw, place: SurfacePlace) -> FilmLaw:
        """The film of wall and ribs, referred to the wall without them."""
        array = RibArray(height=self.height, thickness=self.thickness, pitch=self.pitch)
        return convection.ribbed(law, array, self.conductivity or place.wall_conductivity)
