"""Oil of a gearbox: how it is fed, the ways it takes, and its state."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from rigdesign.case.fields import Flow, Part, Temperature, Text, Velocity, fault


class GearOil(Part):
    """Oil injected at the meshes of a gearbox."""

    oil: Text
    """Built-in oil or a name under ``oils``."""
    inlet_temperature: Temperature
    """Temperature at which the oil enters the gearbox."""
    flow: Flow
    """Flow per mesh."""
    jet_direction: Literal["into_mesh", "out_of_mesh", "radial"]
    """Where the jets point: with the motion of the teeth into the mesh, against their motion out of the
    mesh, or radially; decides the power that brings the oil up to speed."""
    jet_velocity: Velocity
    """Velocity of the oil as it leaves the jets, all open and nothing in ``oil_paths.bypass``."""
    outlet_temperature: Temperature | None = None
    """Measured outlet; computed from the heat when left out."""
    blocked_jets: Annotated[float, Field(ge=0.0, le=0.9)] = 0.0
    """Share of the jets that is closed: the same flow leaves the others faster, and wets so much less face width."""


class BearingOil(Part):
    """Oil fed to the journal bearings of a gearbox."""

    oil: Text
    """Built-in oil or a name under ``oils``."""
    inlet_temperature: Temperature
    """Temperature at which the oil enters the bearings."""
    flow: Flow
    """Flow per bearing."""
    outlet_temperature: Temperature | None = None
    """Measured outlet; computed from the heat when left out."""


PathShare = Annotated[float, Field(ge=0.0, le=0.9)]
"""Part of the gear oil that takes another way."""


class OilPaths(Part):
    """Ways of the gear oil other than jets, meshes, walls, drain: shares of what is fed."""

    leak_warm_cold: PathShare = 0.0
    """Through the seals of the chamber into the oil of the bearings, and out with it."""
    bypass: PathShare = 0.0
    """Round meshes and walls straight to the outlet."""
    short_circuit: PathShare = 0.0
    """From the meshes straight to the outlet, past walls, shafts and gear bodies."""

    @model_validator(mode="after")
    def _leave_some(self) -> "OilPaths":
        total = self.leak_warm_cold + self.bypass + self.short_circuit
        if total > 0.9:
            raise fault(
                f"leak_warm_cold, bypass and short_circuit add up to {total:g}, which leaves no oil for the gears",
                "write shares whose sum is at most 0.9",
            )
        return self


class OilState(Part):
    """How the oil in a gearbox differs from its data sheet; for gears and bearings alike."""

    air_content: Annotated[float, Field(ge=0.0, le=0.3)] = 0.0
    """Volume share of free air in the oil fed, bubbles: less mass and conductivity, more viscosity."""
    viscosity_factor: Annotated[float, Field(ge=0.2, le=5.0)] = 1.0
    """Viscosity over that of the data sheet, at every temperature."""
    heat_capacity_factor: Annotated[float, Field(ge=0.5, le=2.0)] = 1.0
    """Heat capacity over that of the data sheet."""
