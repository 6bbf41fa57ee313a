"""Ribs on a wall as a factor on its film: the array of fins that is not drawn."""

import math
from dataclasses import dataclass, replace

from thermal.films.inputs import FilmError, outside, positive
from thermal.films.law import FilmCoefficient, FilmLaw

LEAST_GAP = 5e-3
"""Clear distance [m] of two ribs below which their boundary layers meet in room air (limit assumed)."""


@dataclass(frozen=True, kw_only=True)
class RibArray:
    """Straight ribs of constant thickness, side by side on a plane wall [m].

    Raises FilmError for a measure that is not positive, and for ribs that leave no gap.
    """

    height: float
    """From the wall to the tip."""
    thickness: float
    pitch: float
    """From middle to middle."""

    def __post_init__(self) -> None:
        positive("rib height", self.height, "m")
        positive("rib thickness", self.thickness, "m")
        positive("rib pitch", self.pitch, "m")
        if self.thickness >= self.pitch:
            raise FilmError(
                f"rib thickness = {self.thickness:g} m must be below the pitch of {self.pitch:g} m; thin the ribs or "
                "set them further apart"
            )

    @property
    def _corrected(self) -> float:
        """Height with half the thickness added, which stands for the heat through the tip [m]."""
        return self.height + 0.5 * self.thickness

    def efficiency(self, film: float, conductivity: float) -> float:
        """Fin efficiency tanh(m L)/(m L), m = sqrt(2 h/(k t)) [-]; film : h [W/(m2 K)], conductivity : [W/(m K)]."""
        slender = self._corrected * math.sqrt(2.0 * film / (conductivity * self.thickness))
        return math.tanh(slender) / slender if slender > 0.0 else 1.0

    def factor(self, film: float, conductivity: float) -> float:
        """Heat of the ribbed wall over that of the bare one at the same film [-]: gaps, ribs at their efficiency."""
        ribs = 2.0 * self._corrected / self.pitch
        return 1.0 - self.thickness / self.pitch + ribs * self.efficiency(film, conductivity)


def ribbed(law: FilmLaw, ribs: RibArray, conductivity: float) -> FilmLaw:
    """``law`` on wall and ribs, referred to the area of the wall without them.

    conductivity : of the ribs [W/(m K)]

    Source: Incropera et al., Fundamentals of Heat and Mass Transfer, 7th ed., section 3.6: eq. 3.94 to 3.97 (straight
    fin with adiabatic tip at the corrected length) and 3.107 (overall surface efficiency of an array).
    """
    positive("conductivity of the ribs", conductivity, "W/(m K)")

    def law_with_ribs(wall: float, fluid: float) -> FilmCoefficient:
        bare = law(wall, fluid)
        warnings = bare.warnings + outside(
            "gap between ribs", ribs.pitch - ribs.thickness, LEAST_GAP, math.inf,
            "use a coefficient measured on such ribs: air hardly passes between them", "m",
        )  # fmt: skip
        if bare.radiation_included:
            warnings += (
                f"film {bare.formula} contains radiation, which ribs hardly add to as they see each other; use "
                "a film of convection alone with law = radiation beside it",
            )
        factor = ribs.factor(bare.value, conductivity)
        measures = {"height": ribs.height, "thickness": ribs.thickness, "pitch": ribs.pitch}
        inputs = {f"rib_{name}": value for name, value in measures.items()}
        inputs |= {"rib_conductivity": conductivity, "rib_factor": factor}
        inputs["rib_efficiency"] = ribs.efficiency(bare.value, conductivity)
        return replace(
            bare, value=factor * bare.value, formula=f"{bare.formula} with ribs", inputs=bare.inputs | inputs,
            source=f"{bare.source}; ribs: Incropera et al., section 3.6", warnings=warnings,
        )  # fmt: skip

    return law_with_ribs
