"""Lubricating oil from two viscosities, and the temperature at which a consumer gives it back.

    lg lg(nu + c) = m - n lg T        (Ubbelohde-Walther; nu [mm2/s], T [K])

with c = 0.7 (ASTM D341) or 0.8 (DIN 51563). The solvers get numbers or the bound methods, never an `Oil`.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Literal, Self

from rigdesign.base.units import ZERO_CELSIUS

Confidence = Literal["high", "medium", "low"]
WALTHER_CONSTANT = {"ASTM D341": 0.7, "DIN 51563": 0.8}
VISCOSITY_RANGE = (2e-6, 2e-2)
"""Kinematic viscosity within which Walther's line is trusted [m2/s]."""
PUMPED_VISCOSITY = 2e-3
"""Most kinematic viscosity that a gear pump takes at its start [m2/s]; data sheets say 1000 to 2000 mm2/s."""


AIR_CONDUCTIVITY = 0.030
"""Of air at about 80 degC [W/(m K)]."""


class OilError(ValueError):
    """Oil data that cannot be; the message names value, limit and remedy."""


@dataclass(frozen=True, kw_only=True)
class Oil:
    """Properties of one oil; temperatures in kelvin, results in SI.

    walther_m, walther_n, walther_constant : the line of the viscosity-temperature chart
    density_15 : at 15 degC [kg/m3]; density_slope : relative change per kelvin, negative [1/K]
    heat_capacity_40 : at 40 degC [J/(kg K)]; heat_capacity_slope : [J/(kg K2)]
    conductivity_40 : at 40 degC [W/(m K)]; conductivity_slope : relative change per kelvin [1/K]
    lubricant_factor : X_L of the friction laws [-]
    pressure_viscosity : coefficient at about 80 degC [1/Pa]
    highest_temperature : bulk oil temperature it stands for long [K]
    scuffing_load_stage : of the FZG test A/8.3/90; None where it is not known
    viscosity_factor : multiplies the viscosity of the line [-]
    """

    name: str
    walther_m: float
    walther_n: float
    walther_constant: float
    density_15: float
    density_slope: float = -6.5e-4
    heat_capacity_40: float = 1950.0
    heat_capacity_slope: float = 0.0
    conductivity_40: float = 0.13
    conductivity_slope: float = -5e-4
    lubricant_factor: float = 1.0
    pressure_viscosity: float = 1.8e-8
    highest_temperature: float = 373.15
    viscosity_factor: float = 1.0
    scuffing_load_stage: float | None = None
    source: str
    confidence: Confidence

    def __post_init__(self) -> None:
        for name in (
            "walther_n",
            "walther_constant",
            "density_15",
            "heat_capacity_40",
            "conductivity_40",
            "lubricant_factor",
            "pressure_viscosity",
            "highest_temperature",
            "viscosity_factor",
        ):
            value = getattr(self, name)
            if not value > 0.0:
                raise OilError(
                    f"oil {self.name!r}: {name} = {value:.6g}: must be above 0; correct the oil data"
                )
        if not -2e-3 <= self.density_slope <= 0.0:
            raise OilError(
                f"oil {self.name!r}: the density changes by {self.density_slope:.3g} of itself per kelvin: must lie "
                "within -2e-3 to 0; correct the densities, usual is about -6.5e-4"
            )

    @classmethod
    def from_viscosities(
        cls,
        *,
        name: str,
        viscosity_1: float,
        temperature_1: float,
        viscosity_2: float,
        temperature_2: float,
        density_15: float,
        heat_capacity: float,
        standard: Literal["ASTM D341", "DIN 51563"] = "ASTM D341",
        source: str = "input of the case",
        confidence: Confidence = "medium",
        **properties: float | None,
    ) -> Self:
        """Oil from two kinematic viscosities [m2/s] at two temperatures [K], density at 15 degC and c_p.

        ``properties`` are further fields of `Oil` (conductivity_40, lubricant_factor ...). Raises OilError if
        the viscosities do not fall with temperature or are below 0.3 mm2/s.
        """
        (low_t, at_low), (high_t, at_high) = sorted(
            [(temperature_1, viscosity_1), (temperature_2, viscosity_2)]
        )
        if not (low_t > 0.0 and high_t - low_t >= 1.0):
            raise OilError(
                f"oil {name!r}: viscosities at {temperature_1:.2f} K and {temperature_2:.2f} K: they "
                "must lie apart by at least 1 K; give them at 40 and 100 degC"
            )
        if not at_low > at_high >= 0.3e-6:
            raise OilError(
                f"oil {name!r}: viscosities {at_low * 1e6:.4g} and {at_high * 1e6:.4g} mm2/s: must fall with "
                "temperature and be at least 0.3 mm2/s; check the order and the unit"
            )
        constant = WALTHER_CONSTANT[standard]
        first, second = _double_log(at_low, constant), _double_log(at_high, constant)
        slope = (first - second) / (math.log10(high_t) - math.log10(low_t))
        return cls(
            name=name,
            walther_m=first + slope * math.log10(low_t),
            walther_n=slope,
            walther_constant=constant,
            density_15=density_15,
            heat_capacity_40=heat_capacity,
            source=source,
            confidence=confidence,
            **properties,  # type: ignore[arg-type]
        )

    def kinematic_viscosity(self, temperature: float) -> float:
        """nu [m2/s] at a temperature [K]."""
        exponent = self.walther_m - self.walther_n * math.log10(temperature)
        value: float = 10.0 ** (10.0**exponent) - self.walther_constant
        return value * 1e-6 * self.viscosity_factor

    def in_state(
        self, *, air_content: float = 0.0, viscosity_factor: float = 1.0, heat_capacity_factor: float = 1.0
    ) -> "Oil":
        """This oil with free air in it, or with other properties than its data sheet has.

        air_content : volume share a of small bubbles, 0 to 0.3. Density falls as 1 - a, the mass of the air is
            left out, and with it the heat capacity of a volume; the dynamic viscosity rises as 1 + 1.5 a (Hayward
            1961, bubbly hydraulic oil), the conductivity falls as Maxwell (1873) has it for spheres of air
        viscosity_factor, heat_capacity_factor : multiply those of the data sheet

        Raises OilError outside of 0 to 0.3, or for factors that are not above 0.
        """
        if not 0.0 <= air_content <= 0.3:
            raise OilError(
                f"oil {self.name!r}: air_content = {air_content:.3g}: must lie within 0 to 0.3, beyond that it "
                "is foam; let the oil rest"
            )
        if (air_content, viscosity_factor, heat_capacity_factor) == (0.0, 1.0, 1.0):
            return self
        rest = 1.0 - air_content
        air = AIR_CONDUCTIVITY / self.conductivity_40
        conducts = (2.0 + air - 2.0 * air_content * (1.0 - air)) / (2.0 + air + air_content * (1.0 - air))
        return replace(
            self,
            density_15=rest * self.density_15,
            conductivity_40=conducts * self.conductivity_40,
            heat_capacity_40=heat_capacity_factor * self.heat_capacity_40,
            heat_capacity_slope=heat_capacity_factor * self.heat_capacity_slope,
            viscosity_factor=self.viscosity_factor * viscosity_factor * (1.0 + 1.5 * air_content) / rest,
        )

    def dynamic_viscosity(self, temperature: float) -> float:
        """eta = rho nu [Pa s] at a temperature [K]."""
        return self.density(temperature) * self.kinematic_viscosity(temperature)

    def density(self, temperature: float) -> float:
        """rho [kg/m3] at a temperature [K], linear."""
        return self.density_15 * (1.0 + self.density_slope * (temperature - ZERO_CELSIUS - 15.0))

    def heat_capacity(self, temperature: float) -> float:
        """c_p [J/(kg K)] at a temperature [K], linear."""
        return self.heat_capacity_40 + self.heat_capacity_slope * (temperature - ZERO_CELSIUS - 40.0)

    def conductivity(self, temperature: float) -> float:
        """k [W/(m K)] at a temperature [K], linear."""
        return self.conductivity_40 * (1.0 + self.conductivity_slope * (temperature - ZERO_CELSIUS - 40.0))

    def warnings(self, temperature: float) -> tuple[str, ...]:
        """Sentences for a temperature [K] outside the data: name, value, limit, remedy."""
        sentences = []
        viscosity = self.kinematic_viscosity(temperature)
        low, high = VISCOSITY_RANGE
        if not low <= viscosity <= high:
            sentences.append(
                f"oil {self.name}: viscosity at {temperature - ZERO_CELSIUS:.0f} degC = "
                f"{viscosity * 1e6:.3g} mm2/s: outside {low * 1e6:g} to {high * 1e6:g} mm2/s of the "
                "viscosity line; measure it there"
            )
        if viscosity > PUMPED_VISCOSITY:
            sentences.append(
                f"oil {self.name}: viscosity at {temperature - ZERO_CELSIUS:.0f} degC = {viscosity * 1e6:.3g} mm2/s: "
                f"above the {PUMPED_VISCOSITY * 1e6:g} mm2/s that pumps and nozzles take; heat it before the start or "
                "take a thinner oil"
            )
        if temperature > self.highest_temperature:
            sentences.append(
                f"oil {self.name}: temperature = {temperature - ZERO_CELSIUS:.0f} degC: above "
                f"{self.highest_temperature - ZERO_CELSIUS:.0f} degC; cool it or take an oil made for it"
            )
        return tuple(sentences)


def oil_outlet(
    oil: Oil, inlet_temperature: float, flow: float, loss_into_oil: float, heat_from_bodies: float = 0.0
) -> float:
    """Temperature at which a consumer gives the oil back [K]: T_in + (loss + heat) / (rho c Q).

    Parameters
    ----------
    oil : its properties are taken at the mean temperature, found by iteration; the flow counts at the inlet
    inlet_temperature : [K]
    flow : volume flow at the inlet [m3/s], above 0
    loss_into_oil : friction heat set free in the oil [W]
    heat_from_bodies : heat taken from walls, shafts, gears; negative where they cool the oil [W]
    """
    if not flow > 0.0:
        raise OilError(f"oil flow = {flow} m3/s: must be above 0 to carry heat; feed the consumer")
    heat = loss_into_oil + heat_from_bodies
    mass_flow = oil.density(inlet_temperature) * flow
    outlet = inlet_temperature
    for _ in range(100):
        better = inlet_temperature + heat / (
            mass_flow * oil.heat_capacity(0.5 * (inlet_temperature + outlet))
        )
        if abs(better - outlet) < 1e-10:
            return better
        outlet = better
    raise OilError(
        f"oil outlet: {heat:.4g} W into {flow * 6e4:.3g} l/min gives no steady temperature; "
        "correct flow or heat"
    )


def _double_log(viscosity: float, constant: float) -> float:
    return math.log10(math.log10(viscosity * 1e6 + constant))


FVA_3 = Oil(
    name="FVA 3",
    walther_m=9.2384,
    walther_n=3.5810,
    walther_constant=0.7,
    density_15=900.0,
    density_slope=-5.5e-4,
    heat_capacity_40=2000.0,
    conductivity_40=0.1324,
    conductivity_slope=-1.68e-4,
    pressure_viscosity=2.0e-8,
    highest_temperature=ZERO_CELSIUS + 110.0,
    source="public constants of the FVA reference oil 3 (mineral, ISO VG 100): m 9.2384, n 3.5810, rho 900, "
    "c_p 2000",
    confidence="high",
)
FVA_3A = Oil.from_viscosities(
    name="FVA 3A",
    viscosity_1=95.0e-6,
    temperature_1=ZERO_CELSIUS + 40.0,
    viscosity_2=10.7e-6,
    temperature_2=ZERO_CELSIUS + 100.0,
    density_15=885.0,
    heat_capacity=2000.0,
    density_slope=-6.5e-4,
    conductivity_40=0.1324,
    conductivity_slope=-1.68e-4,
    pressure_viscosity=2.0e-8,
    highest_temperature=ZERO_CELSIUS + 110.0,
    source="FVA 3 with 4 % Anglamol 99; typical data of the field (95 / 10.7 mm2/s, 885 kg/m3)",
    confidence="medium",
)
MIL_PRF_23699 = Oil.from_viscosities(
    name="MIL-PRF-23699",
    viscosity_1=27.6e-6,
    temperature_1=ZERO_CELSIUS + 40.0,
    viscosity_2=5.1e-6,
    temperature_2=ZERO_CELSIUS + 100.0,
    density_15=1000.0,
    heat_capacity=1900.0,
    heat_capacity_slope=2.5,
    density_slope=-7.3e-4,
    conductivity_40=0.15,
    conductivity_slope=-8e-4,
    lubricant_factor=0.8,
    pressure_viscosity=1.2e-8,
    highest_temperature=ZERO_CELSIUS + 200.0,
    source="neopentyl polyol ester, 5 mm2/s class of the specification; typical data sheet 27.6 / 5.1 mm2/s, "
    "rho and c_p from the field",
    confidence="medium",
)
OILS: Mapping[str, Oil] = MappingProxyType({oil.name: oil for oil in (FVA_3, FVA_3A, MIL_PRF_23699)})
"""Built-in oils by name."""


# Oil flows that meet: each knows how it was fed and what heat it has taken up since.


@dataclass(frozen=True, kw_only=True)
class Portion:
    """An oil flow on its way: how it was fed, and the heat it has taken up since."""

    oil: Oil
    inlet: float
    """[K]"""
    flow: float
    """[m3/s], at the inlet."""
    heat: float = 0.0
    """[W]"""

    def capacity(self, temperature: float) -> float:
        """Mean heat capacity flow between inlet and a temperature [W/K]."""
        mean = 0.5 * (self.inlet + temperature)
        return self.oil.density(self.inlet) * self.flow * self.oil.heat_capacity(mean)

    def heat_at(self, temperature: float) -> float:
        """Heat with which it has a temperature [W]."""
        return self.capacity(temperature) * (temperature - self.inlet)

    def warmed(self, temperature: float) -> "Portion":
        """The same at a temperature [K]."""
        return replace(self, heat=self.heat_at(temperature))


def mixed(portions: Sequence[Portion], heat: float = 0.0) -> float:
    """Temperature of oil flows that meet and take up ``heat`` [W] together [K]: the sum of heats is kept."""
    whole = heat + math.fsum(portion.heat for portion in portions)
    temperature = math.fsum(portion.inlet for portion in portions) / len(portions)
    for _ in range(100):
        capacities = [portion.capacity(temperature) for portion in portions]
        fed = math.fsum(c * portion.inlet for c, portion in zip(capacities, portions))
        better = (whole + fed) / math.fsum(capacities)
        if abs(better - temperature) < 1e-10:
            return better
        temperature = better
    raise OilError(f"oil streams that mix under {whole:.4g} W find no temperature; correct flows or heat")
