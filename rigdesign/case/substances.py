"""Room, oils and materials."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from rigdesign.case.fields import (
    SCUFFING,
    Conductivity,
    Density,
    ExpansionCoefficient,
    HeatCapacity,
    KinematicViscosity,
    LiquidDensity,
    LoadStage,
    Modulus,
    Part,
    PressureViscosity,
    RoomTemperature,
    Stress,
    Temperature,
    Time,
    Title,
    Usual,
    fault,
)
from rigdesign.properties.oil import Oil


class Ambient(Part):
    """The room."""

    temperature: RoomTemperature
    """Temperature of the room air."""
    surroundings_temperature: RoomTemperature | None = None
    """Walls that the rig radiates to; the air temperature when left out."""
    reference_temperature: Annotated[RoomTemperature, Usual("15 degC", "30 degC")] = 293.15
    """At which drawings and measures of the case hold; 20 degC by ISO 1."""
    warming_time: Time | None = None
    """How long an operating point had run from a rig at the temperature of the room; steady when left out. The housings
    then still take up heat: temperatures, oils and losses are marched over that time."""


class CustomOil(Part):
    """Oil described by two viscosities, its density and its heat data."""

    title: Title
    """Name of the oil in the report."""
    kinematic_viscosity_40: Annotated[KinematicViscosity, Usual(2.5, 30.0, "viscosity at 100 degC")]
    """Kinematic viscosity at 40 degC."""
    kinematic_viscosity_100: KinematicViscosity
    """Kinematic viscosity at 100 degC."""
    density_15: LiquidDensity
    """Density at 15 degC."""
    heat_capacity: HeatCapacity
    """Specific heat capacity, taken as constant."""
    conductivity: Annotated[Conductivity, Usual("0.08 W/(m K)", "0.7 W/(m K)")]
    """Thermal conductivity at 40 degC."""
    lubricant_factor: Annotated[float, Field(gt=0.1, le=2.0)] = 1.0
    """X_L of the friction laws: 1 for mineral oil."""
    pressure_viscosity: PressureViscosity = 1.8e-8
    """Pressure-viscosity coefficient at about 80 degC: film between the flanks."""
    scuffing_load_stage: LoadStage | None = None
    """Load stage of the FZG test A/8.3/90 at which the oil lets the gears scuff; without it scuffing is not checked."""

    def properties(self, name: str) -> Oil:
        """The oil by the name the case gives it."""
        return Oil.from_viscosities(
            name=name,
            viscosity_1=self.kinematic_viscosity_40,
            temperature_1=313.15,
            viscosity_2=self.kinematic_viscosity_100,
            temperature_2=373.15,
            density_15=self.density_15,
            heat_capacity=self.heat_capacity,
            conductivity_40=self.conductivity,
            lubricant_factor=self.lubricant_factor,
            pressure_viscosity=self.pressure_viscosity,
            scuffing_load_stage=self.scuffing_load_stage,
        )

    @model_validator(mode="after")
    def _thins(self) -> "CustomOil":
        if self.kinematic_viscosity_40 <= self.kinematic_viscosity_100:
            raise fault(
                "the viscosity at 40 degC is not above that at 100 degC",
                "exchange or correct the two viscosities",
            )
        return self


class CustomMaterial(Part):
    """Solid material."""

    title: Title
    """Name of the material in the report."""
    conductivity: Annotated[Conductivity, Usual("8 W/(m K)", "420 W/(m K)")]
    """Thermal conductivity."""
    expansion_coefficient: ExpansionCoefficient
    """Linear thermal expansion per kelvin."""
    elastic_modulus: Modulus
    """Young's modulus."""
    poisson_ratio: Annotated[float, Field(ge=0.0, lt=0.5), Usual(0.2, 0.4)]
    """Poisson's ratio."""
    density: Density
    """Mass density."""
    root_strength: Annotated[Stress, Usual("150 MPa", "1500 MPa")] | None = None
    """sigma_FE of ISO 6336-5 for gears: allowable stress number of the root, sigma_Flim Y_ST."""
    flank_strength: Annotated[Stress, Usual("250 MPa", "2500 MPa")] | None = None
    """sigma_Hlim of ISO 6336-5 for gears: strength of their flanks, and how they run in."""
    treatment: Literal["case_hardened", "nitrided", "through_hardened"] = "case_hardened"
    """Of gears: how their flanks run in (ISO 6336-1)."""
    scuffing_factor: Annotated[float, Field(ge=0.4, le=1.5), SCUFFING] = 1.0
    """X_W of ISO/TS 6336-20 for gears: 1 for case-hardened steel with 20 to 30 % of retained austenite, 1.15 with less,
    1.5 nitrided."""
    tempering_temperature: Annotated[Temperature, Usual("120 degC", "600 degC")] | None = None
    """Tempering temperature of gears; without it their bulk temperature is not checked."""

    @model_validator(mode="after")
    def _runs_in(self) -> "CustomMaterial":
        if self.treatment == "through_hardened" and self.flank_strength is None:
            raise fault(
                "through-hardened flanks run in by their strength, flank_strength is missing",
                'add it, e.g. flank_strength = "700 MPa"',
            )
        return self
