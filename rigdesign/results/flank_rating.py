"""Load capacity of the flanks of a mesh at a held stage: SI record."""

from dataclasses import dataclass

from dynamics.rating.flank_contact import ContactFactors
from dynamics.rating.micropitting import FilmRatios
from dynamics.rating.pitting import Pitting
from dynamics.rating.scuffing import ContactTemperature


@dataclass(frozen=True, kw_only=True)
class FlankRating:
    """Pitting of both gears, contact temperature and film of their mesh at one held stage."""

    stage: str
    factors: ContactFactors
    sharing_basis: str
    """Where K_Hbeta and K_Halpha come from, in words."""
    oil_temperature: float
    """As it reaches the mesh, or of the sump [K]."""
    bulk_temperature: float
    """Of the teeth, mean of both gears [K]."""
    bulk_basis: str
    """Where that comes from, in words."""
    pitting: tuple[Pitting, Pitting] | None = None
    no_pitting: str = ""
    """Why it is not rated."""
    contact: ContactTemperature | None = None
    films: FilmRatios | None = None
    no_contact: str = ""
    """Why the contact is not followed over the path."""
    scuffing_temperature: float | None = None
    """Of the oil on these flanks [K]."""
    scuffing_safety: float | None = None
    """S_B [-]."""
    no_scuffing: str = ""
    """Why it is not rated."""
