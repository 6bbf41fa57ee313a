"""Hooke's law at the free surface of the tooth root: strain along the fillet to stress along it, and back."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.number_faults import refuse, require_above

Array = NDArray[np.float64]
StressState = Literal["uniaxial", "plane_strain", "biaxial"]


@dataclass(frozen=True, kw_only=True)
class SurfaceStress:
    """Elastic surface with no stress normal to it: sigma = E (1 + nu r) / (1 - nu^2) eps, r = eps_across / eps.

    Parameters
    ----------
    youngs_modulus : [Pa]
    poisson_ratio : [-]
    state : uniaxial: r = -nu, sigma = E eps, as P1 converts ("Hooke's law") and as holds at the ends of the face;
        plane_strain: r = 0, sigma = E eps / (1 - nu^2), a wide tooth at mid-face, 9.9 % more for steel;
        biaxial: r is stated
    transverse_ratio : r of a biaxial state [-]

    Raises
    ------
    CaseError
        A modulus not above zero, a Poisson's ratio outside 0 to 0.5, a transverse ratio missing or out of place.
    """

    youngs_modulus: float
    poisson_ratio: float
    state: StressState = "uniaxial"
    transverse_ratio: float | None = None

    def __post_init__(self) -> None:
        require_above("youngs_modulus", self.youngs_modulus, "Pa", "write that of the gear's steel, 206e9")
        if not 0.0 <= self.poisson_ratio < 0.5:
            refuse(
                "poisson_ratio",
                f"{self.poisson_ratio:.6g}",
                "must lie within 0 to 0.5",
                "write 0.3 for steel",
            )
        if self.state not in ("uniaxial", "plane_strain", "biaxial"):
            refuse(
                "state", str(self.state), "no such stress state", "write uniaxial, plane_strain or biaxial"
            )
        given = "" if self.transverse_ratio is None else f"{self.transverse_ratio:.6g}"
        if (self.state == "biaxial") != (self.transverse_ratio is not None):
            refuse(
                "transverse_ratio",
                given,
                "belongs to a biaxial state and to no other",
                "give both or neither",
            )
        if self.transverse_ratio is not None and not -0.5 <= self.transverse_ratio <= 1.0:
            refuse("transverse_ratio", given, "must lie within -0.5 to 1", "take it from the computed stress")

    @property
    def strain_ratio(self) -> float:
        """r, strain across over strain along the fillet [-]."""
        if self.transverse_ratio is not None:
            return self.transverse_ratio
        return 0.0 if self.state == "plane_strain" else -self.poisson_ratio

    @property
    def modulus(self) -> float:
        """Stress over strain along the fillet [Pa]."""
        if self.state == "uniaxial":
            return self.youngs_modulus
        share = 1.0 + self.poisson_ratio * self.strain_ratio
        return self.youngs_modulus * share / (1.0 - self.poisson_ratio**2)

    def stress(self, strain: float | Array) -> Array:
        """Stress along the fillet [Pa]."""
        return np.asarray(self.modulus * np.asarray(strain, dtype=float))

    def strain(self, stress: float | Array) -> Array:
        """Strain along the fillet [-]."""
        return np.asarray(np.asarray(stress, dtype=float) / self.modulus)
