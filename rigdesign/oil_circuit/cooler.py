"""Oil coolers by effectiveness and number of transfer units.

    Q = eps(NTU, C_r) C_min (T_oil - T_coolant) ,    NTU = UA / C_min ,    C_r = C_min / C_max

eps by `ht.hx.effectiveness_from_NTU` (Bergman, Lavine, Incropera, DeWitt, 6th ed., tables 11.3 and 11.4; Shah and
Sekulic 2002). UA is constant: a cooler with less oil than at its rated point (bypass half open) has less, so the
share of the bypass is approximate; what it carries with the bypass shut is that of the rated point.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Literal, Self

from rigdesign.base.errors import CaseError
from rigdesign.base.number_faults import celsius, refuse, require_above, require_at_least
from rigdesign.oil_circuit.heat_content import enthalpy, temperature_at
from rigdesign.properties.oil import Oil

Arrangement = Literal["counterflow", "parallel", "crossflow approximate", "S&T"]
"""Flows against each other; S&T: one shell pass, two or more tube passes."""


@dataclass(frozen=True, kw_only=True)
class Coolant:
    """What takes the heat of a cooler.

    flow : at the inlet [m3/s]; inlet_temperature : [K]
    fluid : name in CoolProp, such as ``Water`` or ``INCOMP::MEG[0.3]``; pressure : absolute [Pa]

    Raises CaseError for a fluid CoolProp does not know, or that is no liquid at the inlet.
    """

    flow: float
    inlet_temperature: float
    fluid: str = "Water"
    pressure: float = 3e5

    def __post_init__(self) -> None:
        require_above("coolant.flow", self.flow, "m3/s", "open the coolant, or leave the cooler out")
        require_above(
            "coolant.inlet_temperature", self.inlet_temperature, "K", "give an absolute temperature"
        )
        require_above("coolant.pressure", self.pressure, "Pa", "give the absolute pressure")

    @cached_property
    def capacity_rate(self) -> float:
        """Heat that warms it by one kelvin, with properties at the inlet [W/K]."""
        density, heat_capacity = _liquid(self.fluid, self.inlet_temperature, self.pressure)
        return density * heat_capacity * self.flow

    @cached_property
    def boiling_temperature(self) -> float | None:
        """[K]; None for mixtures, of which CoolProp has no vapour pressure."""
        return None if self.fluid.startswith("INCOMP::") else _boiling(self.fluid, self.pressure)


@dataclass(frozen=True, kw_only=True)
class RatedPoint:
    """Point of a cooler's data sheet.

    heat : carried [W]; flow : of oil, at its inlet [m3/s]; inlet_temperature : of the oil [K]
    """

    oil: Oil
    heat: float
    flow: float
    inlet_temperature: float


@dataclass(frozen=True, kw_only=True)
class Cooler:
    """Heat exchanger from oil to a coolant.

    conductance : UA, overall coefficient times area [W/K]
    """

    conductance: float
    coolant: Coolant
    arrangement: Arrangement = "counterflow"

    def __post_init__(self) -> None:
        require_above("cooler.conductance", self.conductance, "W/K", "give UA, or a rated point")

    @classmethod
    def from_rated_point(
        cls, rated: RatedPoint, coolant: Coolant, arrangement: Arrangement = "counterflow"
    ) -> Self:
        """Cooler that carries ``rated.heat`` with the coolant it is rated with.

        Raises CaseError for a heat that no area carries between these flows and temperatures.
        """
        from ht import hx

        require_above("cooler.rated.heat", rated.heat, "W", "give the heat of the data sheet")
        require_above("cooler.rated.flow", rated.flow, "m3/s", "give the oil flow of the data sheet")
        difference = rated.inlet_temperature - coolant.inlet_temperature
        require_above("cooler.rated.inlet_temperature", difference, "K over the coolant", "check both inlets")
        oil, inlet = rated.oil, rated.inlet_temperature
        mass_flow = oil.density(inlet) * rated.flow
        outlet = temperature_at(oil, enthalpy(oil, inlet) - rated.heat / mass_flow)
        capacity_rate = mass_flow * oil.heat_capacity(0.5 * (inlet + outlet))
        least, most = sorted((capacity_rate, coolant.capacity_rate))
        effectiveness = rated.heat / (least * difference)
        best = _effectiveness(1e4, least / most, arrangement)
        if effectiveness >= best:
            refuse(
                "cooler.rated.heat",
                f"{1e-3 * rated.heat:.4g} kW",
                f"must be below the {1e-3 * best * least * difference:.4g} kW that the largest cooler of this kind "
                f"({arrangement}) carries between these flows and inlet temperatures",
                "check flows and inlet temperatures of the rated point",
            )
        transfer_units: Callable[..., float] = hx.NTU_from_effectiveness
        units = transfer_units(effectiveness, least / most, arrangement)
        return cls(conductance=units * least, coolant=coolant, arrangement=arrangement)

    def carried(self, oil: Oil, mass_flow: float, inlet_temperature: float) -> float:
        """Heat that an oil flow gives to the coolant [W]; 0 for oil colder than the coolant.

        mass_flow : [kg/s]; inlet_temperature : of the oil [K]
        """
        difference = inlet_temperature - self.coolant.inlet_temperature
        if mass_flow <= 0.0 or difference <= 0.0:
            return 0.0
        heat = 0.0
        for _ in range(50):
            outlet = temperature_at(oil, enthalpy(oil, inlet_temperature) - heat / mass_flow)
            capacity_rate = mass_flow * oil.heat_capacity(0.5 * (inlet_temperature + outlet))
            least, most = sorted((capacity_rate, self.coolant.capacity_rate))
            units = self.conductance / least
            better = _effectiveness(units, least / most, self.arrangement) * least * difference
            if abs(better - heat) <= 1e-13 * better:
                break
            heat = better
        return better

    def coolant_outlet(self, heat: float) -> float:
        """Temperature of the coolant behind the cooler [K] that carries ``heat`` [W]."""
        return self.coolant.inlet_temperature + heat / self.coolant.capacity_rate

    def warnings(self, name: str, heat: float) -> tuple[str, ...]:
        """Sentence where the coolant would boil under ``heat`` [W]."""
        outlet, boiling = self.coolant_outlet(heat), self.coolant.boiling_temperature
        if boiling is None or outlet < boiling:
            return ()
        return (
            f"{name}: coolant outlet = {celsius(outlet)}: above boiling, {celsius(boiling)} at "
            f"{1e-5 * self.coolant.pressure:.3g} bar; open the coolant or raise its pressure",
        )


@dataclass(frozen=True, kw_only=True)
class TankCooler:
    """Cooler that holds the temperature of the tank.

    setpoint : of the tank [K]
    band : hysteresis of its thermostat [K], as `Heater.band` (on above, off below); 0 for continuous control
    flow : oil of its own pump, from the tank and back [m3/s]; None for a cooler in the common return of all lines
    """

    cooler: Cooler
    setpoint: float
    band: float = 0.0
    flow: float | None = None

    def __post_init__(self) -> None:
        require_above("tank_cooler.setpoint", self.setpoint, "K", "give an absolute temperature")
        require_at_least("tank_cooler.band", self.band, "K", "give 0 for continuous control")
        if self.flow is not None:
            require_above("tank_cooler.flow", self.flow, "m3/s", "leave it out for a cooler in the return")


def _effectiveness(units: float, ratio: float, arrangement: Arrangement) -> float:
    from ht import hx

    law: Callable[..., float] = hx.effectiveness_from_NTU
    return law(units, ratio, subtype=arrangement)


@lru_cache(maxsize=64)
def _liquid(fluid: str, temperature: float, pressure: float) -> tuple[float, float]:
    """Density [kg/m3] and heat capacity [J/(kg K)] of a coolant."""
    from CoolProp.CoolProp import PhaseSI, PropsSI

    given = f"{fluid} at {celsius(temperature)}, {1e-5 * pressure:.3g} bar"
    try:
        found = tuple(float(PropsSI(key, "T", temperature, "P", pressure, fluid)) for key in ("D", "C"))
        phase = "liquid" if fluid.startswith("INCOMP::") else PhaseSI("T", temperature, "P", pressure, fluid)
    except ValueError as error:
        refuse("coolant.fluid", given, f"CoolProp has no properties ({error})", "name a liquid such as Water")
    if "liquid" not in phase:
        refuse("coolant.fluid", given, f"must be a liquid, is {phase}", "check temperature and pressure")
    return found[0], found[1]


@lru_cache(maxsize=64)
def _boiling(fluid: str, pressure: float) -> float:
    from CoolProp.CoolProp import PropsSI

    try:
        return float(PropsSI("T", "P", pressure, "Q", 0, fluid))
    except ValueError as error:
        raise CaseError(
            f"coolant.pressure = {pressure:.4g} Pa: {fluid} has no boiling point there ({error})"
        ) from error
