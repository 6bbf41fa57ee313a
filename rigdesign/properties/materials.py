"""Solid materials of a rig, with source and confidence; SI units.

Elastic constants and densities are those of the field's standards; strength numbers are starting values
that a material certificate should replace before a verdict depends on them.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

from rigdesign.base.units import ZERO_CELSIUS

Confidence = Literal["high", "medium", "low"]
Treatment = Literal["case_hardened", "nitrided", "through_hardened"]


class MaterialError(ValueError):
    """Impossible material data; the message names value, limit and remedy."""


@dataclass(frozen=True, kw_only=True)
class Material:
    """One solid material.

    conductivity [W/(m K)], expansion_coefficient [1/K] (mean from 20 degC to about 150 degC), elastic_modulus
    [Pa], poisson_ratio [-], density [kg/m3], heat_capacity [J/(kg K)]
    root_strength : sigma_FE = sigma_Flim Y_ST of ISO 6336-5 [Pa]; None if not for gears
    flank_strength : sigma_Hlim of ISO 6336-5 [Pa]; None if not for gears
    treatment : of the flanks of gears, how they run in by ISO 6336-1
    scuffing_factor : X_W of ISO/TS 6336-20, structure of the flanks of gears
    tempering_temperature : bulk temperature above which hardness is lost [K]; None if it has none
    """

    title: str
    conductivity: float
    expansion_coefficient: float
    elastic_modulus: float
    poisson_ratio: float
    density: float
    heat_capacity: float = 470.0
    root_strength: float | None = None
    flank_strength: float | None = None
    treatment: Treatment = "case_hardened"
    scuffing_factor: float = 1.0
    tempering_temperature: float | None = None
    source: str = "input of the case"
    confidence: Confidence = "medium"

    def __post_init__(self) -> None:
        for name in ("conductivity", "elastic_modulus", "density", "heat_capacity"):
            value = getattr(self, name)
            if not value > 0.0:
                raise MaterialError(
                    f"material {self.title!r}: {name} = {value:.6g}: must be above 0; correct it"
                )
        if not 0.0 <= self.poisson_ratio < 0.5:
            raise MaterialError(
                f"material {self.title!r}: poisson_ratio = {self.poisson_ratio}: must lie within 0 to 0.5; "
                "correct it"
            )
        if not 0.0 <= self.expansion_coefficient <= 1e-4:
            raise MaterialError(
                f"material {self.title!r}: expansion_coefficient = {self.expansion_coefficient:.3g} 1/K: "
                "must lie within 0 to 1e-4; steel has 11.5e-6"
            )

    @property
    def shear_modulus(self) -> float:
        """E / (2 (1 + nu)) [Pa]."""
        return self.elastic_modulus / (2.0 * (1.0 + self.poisson_ratio))


CASE_HARDENED_STEEL = Material(
    title="Case-hardened steel (18CrNiMo7-6, quality MQ)",
    conductivity=42.0,
    expansion_coefficient=11.5e-6,
    elastic_modulus=206e9,
    poisson_ratio=0.30,
    density=7830.0,
    heat_capacity=470.0,
    root_strength=920e6,
    flank_strength=1500e6,
    tempering_temperature=ZERO_CELSIUS + 180.0,
    source="E, nu, rho as in ISO 6336-1; sigma_FE about 860 to 1000 MPa and sigma_Hlim 1500 MPa of "
    "quality MQ, ISO 6336-5; tempered at 180 degC as usual for carburized gears; "
    "conductivity of low-alloy steel",
    confidence="medium",
)
STRUCTURAL_STEEL = Material(
    title="Structural steel (S355, clamping field and plates)",
    conductivity=50.0,
    expansion_coefficient=12.0e-6,
    elastic_modulus=210e9,
    poisson_ratio=0.30,
    density=7850.0,
    heat_capacity=470.0,
    source="EN 1993-1-1 elastic constants and expansion, EN 1993-1-2 heat data near 100 degC (rounded)",
    confidence="high",
)
GREY_IRON = Material(
    title="Grey cast iron (EN-GJL-250)",
    conductivity=48.0,
    expansion_coefficient=11.0e-6,
    elastic_modulus=110e9,
    poisson_ratio=0.26,
    density=7200.0,
    heat_capacity=460.0,
    source="EN 1561, informative annex; E 103 to 118 GPa, expansion 10 to 12e-6 1/K",
    confidence="medium",
)
DUCTILE_IRON = Material(
    title="Ductile cast iron (EN-GJS-400-15)",
    conductivity=36.0,
    expansion_coefficient=12.0e-6,
    elastic_modulus=169e9,
    poisson_ratio=0.275,
    density=7100.0,
    heat_capacity=500.0,
    source="EN 1563, informative annex; conductivity 30 to 36 W/(m K) by grade",
    confidence="medium",
)
ALUMINIUM = Material(
    title="Aluminium alloy (EN AW-6082, T6)",
    conductivity=170.0,
    expansion_coefficient=23.4e-6,
    elastic_modulus=70e9,
    poisson_ratio=0.33,
    density=2700.0,
    heat_capacity=900.0,
    source="EN 1999-1-1 elastic constants; typical heat data of the alloy",
    confidence="medium",
)
MATERIALS: Mapping[str, Material] = MappingProxyType(
    {
        "case_hardened_steel": CASE_HARDENED_STEEL,
        "structural_steel": STRUCTURAL_STEEL,
        "grey_iron": GREY_IRON,
        "ductile_iron": DUCTILE_IRON,
        "aluminium": ALUMINIUM,
    }
)
"""Built-in materials by the name a case uses."""
