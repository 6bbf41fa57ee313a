"""Conductance of a dry or filled joint of two rough metal surfaces under pressure, for `thermal.conditions.contact`.

Laws of the convection modules serve as well: `constant` for a measured joint, `bearing_film` for an oil film.
"""

from dataclasses import dataclass

from thermal.films.law import ExchangeLaw, FilmCoefficient, not_negative, outside, positive

LEAST_RELATIVE_PRESSURE, GREATEST_RELATIVE_PRESSURE = 1e-5, 2e-2
"""Range of pressure over hardness of the correlation of the gap thickness."""


@dataclass(frozen=True, kw_only=True)
class RoughContact:
    """Two rough faces under pressure.

    pressure : of the joint [Pa]
    hardness : micro-hardness of the softer side [Pa]
    roughness : root of the sum of both squared rms roughnesses [m]
    slope : root of the sum of both squared mean absolute asperity slopes [-], 0.05 to 0.3 for machined faces
    """

    pressure: float
    hardness: float
    roughness: float
    slope: float


@dataclass(frozen=True, kw_only=True)
class GapFilling:
    """What fills the gaps between the spots of contact.

    conductivity : of oil, grease or air [W/(m K)]; 0 for vacuum
    gas_parameter : temperature jump length of a gas, 0 for a liquid [m]; air at 1 bar about 0.37e-6
    """

    conductivity: float = 0.0
    gas_parameter: float = 0.0


VACUUM = GapFilling()


def pressed_joint(
    contact: RoughContact, conductivities: tuple[float, float], filling: GapFilling = VACUUM
) -> ExchangeLaw:
    """Spots of contact that yield plastically, and what fills the gaps between them, side by side.

    conductivities : of the two solids [W/(m K)]

    h = 1.25 k m / s (p / H)^0.95 + k_g / (Y + M), k = 2 k_a k_b / (k_a + k_b), Y = 1.53 s (p / H)^-0.097.
    Raises FilmError for impossible inputs; warns for p / H outside of 1e-5 to 2e-2.
    Source: Cooper, Mikic, Yovanovich, Int. J. Heat Mass Transfer 12 (1969) 279; Yovanovich, IEEE Trans.
    Components Packag. Technol. 28 (2005) 182.
    """
    inputs = {
        "pressure": positive("pressure", contact.pressure, "Pa"),
        "hardness": positive("hardness", contact.hardness, "Pa"),
        "conductivity_a": positive("conductivity_a", conductivities[0], "W/(m K)"),
        "conductivity_b": positive("conductivity_b", conductivities[1], "W/(m K)"),
        "roughness": positive("roughness", contact.roughness, "m"),
        "slope": positive("slope", contact.slope, ""),
        "gap_conductivity": not_negative("gap_conductivity", filling.conductivity, "W/(m K)"),
        "gas_parameter": not_negative("gas_parameter", filling.gas_parameter, "m"),
    }
    relative = contact.pressure / contact.hardness
    mean = 2.0 * conductivities[0] * conductivities[1] / (conductivities[0] + conductivities[1])
    spots = 1.25 * mean * contact.slope / contact.roughness * relative**0.95
    thickness = 1.53 * contact.roughness * relative**-0.097
    gaps = filling.conductivity / (thickness + filling.gas_parameter)
    coefficient = FilmCoefficient(
        value=spots + gaps,
        formula="cooper_mikic_yovanovich",
        inputs=inputs,
        valid_range=f"{LEAST_RELATIVE_PRESSURE:g} <= p/H <= {GREATEST_RELATIVE_PRESSURE:g}",
        source="Cooper, Mikic, Yovanovich 1969; gap thickness Yovanovich 2005",
        warnings=outside(
            "p/H",
            relative,
            LEAST_RELATIVE_PRESSURE,
            GREATEST_RELATIVE_PRESSURE,
            "give a measured conductance",
        ),
    )
    return lambda mean_a, mean_b: coefficient
