"""Oil of a gearbox: how it gets to gears and bearings, the ways it takes, and its state.

Every kind of lubrication is a class whose key ``lubrication`` has one choice, joined in `GearOil` or `BearingOil`.
"""

from typing import Annotated, Literal, TypeAlias

from pydantic import Field, Tag, model_validator

from rigdesign.case.fields import (
    Flow,
    LoadStage,
    Offset,
    Part,
    Share,
    Size,
    Temperature,
    Text,
    Usual,
    Velocity,
    Volume,
    fault,
    kind_from,
)


class JetOil(Part):
    """Oil injected at the meshes of a gearbox."""

    lubrication: Literal["jet"] = "jet"
    """Selects injection at the meshes."""
    oil: Text
    """Built-in oil or a name under ``oils``."""
    inlet_temperature: Temperature
    """Temperature at which the oil enters the gearbox."""
    flow: Annotated[Flow, Usual(7e-11, 2.1e-9, "circulating power")]
    """Flow per mesh."""
    jet_direction: Literal["into_mesh", "out_of_mesh", "radial"]
    """Where the jets point: with the motion of the teeth into the mesh, against their motion out of the
    mesh, or radially; decides the power that brings the oil up to speed."""
    jet_velocity: Annotated[Velocity, Usual("4 m/s", "80 m/s")]
    """Velocity of the oil as it leaves the jets, all open and nothing in ``oil_paths.bypass``."""
    outlet_temperature: Temperature | None = None
    """Measured outlet; computed from the heat when left out."""
    blocked_jets: Annotated[float, Field(ge=0.0, le=0.9)] = 0.0
    """Share of the jets that is closed: the same flow leaves the others faster, and wets so much less face width."""
    scuffing_load_stage: LoadStage | None = None
    """Load stage of the FZG test A/8.3/90 at which this oil lets the gears scuff; that of the oil when left out."""
    scuffing_temperature: Temperature | None = None
    """Contact temperature at which this oil lets gears scuff, where a test or table has it; goes before the stage."""


class DipOil(Part):
    """Sump of a gearbox into which its gears dip."""

    lubrication: Literal["dip"]
    """Selects a sump."""
    oil: Text
    """Built-in oil or a name under ``oils``."""
    level: Offset
    """Height of the oil at rest above the shaft axes; below them it is negative."""
    volume: Annotated[Volume, Usual(0.35, 12.0, "cube of the centre distance")]
    """Oil in the sump."""
    sump_temperature: Temperature | None = None
    """Held by heater and cooler of the sump. Left out: it follows from the losses and from what the housing gives to
    its surroundings."""
    churning: Literal["recommended", "changenet_2011", "changenet_2007", "iso_tr_14179_2"] = "recommended"
    """Law of the churning loss; recommended: of the three the one that is extrapolated least."""
    plan_length: Size | None = None
    """Inner length of the box along the shafts, for ISO/TR 14179-2 in a gearbox without a housing."""
    plan_width: Size | None = None
    """Inner width of the box across the shafts, for ISO/TR 14179-2 in a gearbox without a housing."""
    scuffing_load_stage: LoadStage | None = None
    """Load stage of the FZG test A/8.3/90 at which this oil lets the gears scuff; that of the oil when left out."""
    scuffing_temperature: Temperature | None = None
    """Contact temperature at which this oil lets gears scuff, where a test or table has it; goes before the stage."""


GearOil: TypeAlias = Annotated[
    Annotated[JetOil, Tag("jet")] | Annotated[DipOil, Tag("dip")], kind_from("lubrication", "jet")
]
"""Oil of the gears; a further kind of lubrication joins here."""


class FedOil(Part):
    """Oil fed to the bearings of a gearbox."""

    lubrication: Literal["fed"] = "fed"
    """Selects oil that is fed to every bearing."""
    oil: Text
    """Built-in oil or a name under ``oils``."""
    inlet_temperature: Temperature
    """Temperature at which the oil enters the bearings."""
    flow: Annotated[Flow, Usual(4.2e-3, 0.1, "bore times width of the bearings")]
    """Flow per bearing."""
    outlet_temperature: Temperature | None = None
    """Measured outlet; computed from the heat when left out."""


class SplashOil(Part):
    """What the gears throw off lubricates the bearings."""

    lubrication: Literal["splash"]
    """Selects the oil of the gears as it is thrown off."""
    splash_share: Annotated[float, Field(ge=0.001, le=0.1)] = 0.01
    """Share of the oil that the gears lift, or the jets inject, which passes each bearing. No law predicts it."""


class Grease(Part):
    """Bearings packed with grease."""

    lubrication: Literal["grease"]
    """Selects grease."""
    oil: Text
    """Base oil of the grease: built-in oil or a name under ``oils``."""


BearingOil: TypeAlias = Annotated[
    Annotated[FedOil, Tag("fed")] | Annotated[SplashOil, Tag("splash")] | Annotated[Grease, Tag("grease")],
    kind_from("lubrication", "fed"),
]
"""Oil of the bearings; a further kind of lubrication joins here."""


PathShare = Annotated[float, Field(ge=0.0, le=0.9)]
"""Part of the gear oil that takes another way."""


class OilPaths(Part):
    """Ways of the gear oil other than jets, meshes, walls, drain: shares of what is fed."""

    leak_warm_cold: PathShare = 0.0
    """Through the seals of the chamber into the oil of the bearings, and out with it."""
    leak_front_share: Share = 0.5
    """Part of that leak that reaches the cold chamber at the front; the rest reaches the one at the rear."""
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
    viscosity_factor: Annotated[float, Field(ge=0.2, le=5.0), Usual(0.4, 2.5)] = 1.0
    """Viscosity over that of the data sheet, at every temperature."""
    heat_capacity_factor: Annotated[float, Field(ge=0.5, le=2.0)] = 1.0
    """Heat capacity over that of the data sheet."""
