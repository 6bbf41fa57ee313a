"""A gearbox: gears, bearings, seals, their oil, and the housing if temperatures are wanted."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Literal, TypeAlias

from pydantic import Field, model_validator

from rigdesign.case.fields import (
    Clearance,
    Flow,
    Force,
    Gap,
    HeatTransferCoefficient,
    Length,
    LinearDamping,
    LinearStiffness,
    Name,
    Part,
    Play,
    Share,
    Temperature,
    Text,
    Torque,
    TorsionalDamping,
    Velocity,
    fault,
)
from rigdesign.case.gears import Gear, GearMesh
from rigdesign.case.housing import Housing
from rigdesign.case.losses import LossFactors

if TYPE_CHECKING:
    from dynamics.bearing.protocol import Bearing


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


class JournalBearingInput(Part):
    """Plain journal bearing."""

    shaft: Name
    """Shaft that it carries."""
    side: Literal["front", "rear"]
    """End of the housing it sits in; the front is where x starts."""
    diameter: Length
    """Nominal diameter of the journal."""
    width: Length
    """Load-carrying width along the shaft."""
    diametral_clearance: Clearance
    """Bore minus journal, as drawn."""
    locating: bool = False
    """Fixes its shaft axially; one per shaft."""
    axial_play: Play = 0.0
    """Free axial travel of the shaft between a stop at this bearing and one at the other, as drawn: the thermal
    expansion of the shaft against the housing between them uses it up. Left out for a shaft with stops at one end
    only."""
    position: Gap | None = None
    """Distance of its middle from the start of its shaft in the drivetrain."""
    radial_load: Force | None = None
    """Load at the held stages; from the tooth forces when left out."""
    feed_share: Share = 1.0
    """Share of the oil fed that cools the film; 1 as ISO 7902 assumes, less where oil passes by."""
    shell_conductance: HeatTransferCoefficient | None = None
    """Between shell and housing, on the area of the bore, in series with its film; perfect when left out."""
    torsional_damping: TorsionalDamping | None = None
    """Drag torque over speed, used where ``losses.bearing_drag`` is constant."""
    radial_stiffness: LinearStiffness | None = None
    """For the record: the drivetrain is torsional."""
    radial_damping: LinearDamping | None = None
    """For the record: the drivetrain is torsional."""

    def at_clearance(self, diametral_clearance: float) -> "Bearing":
        """The bearing for the solver with its clearance as it runs [m]; BearingError where that is impossible."""
        from dynamics.bearing.journal import JournalBearing

        return JournalBearing(
            diameter=self.diameter,
            width=self.width,
            diametral_clearance=diametral_clearance,
            feed_share=self.feed_share,
        )


BearingInput: TypeAlias = JournalBearingInput
"""Bearing of any kind; a further kind joins here."""


class Seals(Part):
    """Seals of one shaft: where it passes the walls of the chamber, and where it leaves the gearbox.

    A wall of the chamber always is a gap of ``radial_gap``; ``kind`` says what seals the shaft where it leaves, one
    seal a side. A gearbox without a housing has no walls: its shafts leave it towards couplings, motor and parts of
    other gearboxes.
    """

    shaft: Name
    """Shaft that they seal."""
    kind: Literal["contactless", "radial_lip"] = "contactless"
    """What seals the shaft where it leaves the gearbox: a gap without contact, or a radial lip."""
    radial_gap: Clearance
    """Half the difference of bore and shaft diameter as drawn; thermal expansion changes it."""
    axial_travel: Clearance
    """Axial movement of the shaft the seals take without touching."""
    rubbing_torque: Torque = 0.0
    """Friction torque of seals that touch, of all seals of the shaft together, on top of what ``kind`` loses."""


MeshRule = Literal["assumed", "flank_film"]


class HeatSplit(Part):
    """Share of each loss that enters solid bodies; the rest goes into the oil at once."""

    mesh: MeshRule | None = None
    """assumed: ``mesh_into_gears`` of the friction heat enters the gears; flank_film: all of it enters the flanks,
    and the films on the rims (law ``flank_film``) decide how much heat goes into the oil. When left out:
    flank_film, or assumed where the case gives a share."""
    mesh_into_gears: Share | None = None
    """Share of the friction heat of the meshes that enters the gears, for ``mesh = assumed``."""
    mesh_pinion_share: Share | None = None
    """Of the friction heat, the part that enters the pinion; by the thermal contact of the flanks when left out."""
    windage_into_gears: Share
    """Share of the windage loss that heats the gear bodies."""
    seal_into_shaft: Share
    """Share of the seal losses that enters the shaft at the seal."""
    seal_into_housing: Share
    """Share of the seal losses that enters the bore of the seal."""

    @property
    def rule(self) -> MeshRule:
        """How the friction heat of the meshes divides: as stated, by a given share, else by the films on the flanks."""
        if self.mesh is not None:
            return self.mesh
        return "flank_film" if self.mesh_into_gears is None else "assumed"

    @model_validator(mode="after")
    def _share_given(self) -> "HeatSplit":
        if self.mesh == "assumed" and self.mesh_into_gears is None:
            raise fault(
                "mesh_into_gears is missing: the split of the mesh heat is assumed",
                'write a share, or remove mesh and write law = "flank_film" at the rims of the gears',
            )
        if self.mesh == "flank_film" and self.mesh_into_gears is not None:
            raise fault(
                f"mesh_into_gears = {self.mesh_into_gears:g} is not used: the film on the flanks decides",
                'remove it, or write mesh = "assumed"',
            )
        return self

    @model_validator(mode="after")
    def _seal_heat_fits(self) -> "HeatSplit":
        total = self.seal_into_shaft + self.seal_into_housing
        if total > 1.0:
            raise fault(
                f"seal_into_shaft and seal_into_housing add up to {total:g}, more than the whole",
                "write shares whose sum is at most 1; the rest goes into the oil",
            )
        return self


class Gearbox(Part):
    """One gearbox of the rig."""

    title: Text
    """Name of the gearbox in the report."""
    role: Literal["specimen", "rig"]
    """specimen: its gears are what is tested, held against a target window; rig: against a safety."""
    gears: Mapping[Name, Gear] = Field(min_length=2)
    """Gears by name."""
    meshes: Mapping[Name, GearMesh] = Field(min_length=1)
    """Meshes by name, each of two gears."""
    oil: GearOil
    """Oil injected at the meshes."""
    bearings: Mapping[Name, BearingInput] = Field(min_length=1)
    """Bearings by name."""
    bearing_oil: BearingOil
    """Oil fed to the bearings."""
    seals: Mapping[Name, Seals] = {}
    """Seals by name, one entry a shaft."""
    heat_split: HeatSplit
    """Shares of the losses that heat solid parts."""
    loss_factors: LossFactors = LossFactors()
    """Factors on the losses of this gearbox."""
    oil_paths: OilPaths = OilPaths()
    """Shares of the gear oil that take another way."""
    oil_state: OilState = OilState()
    """How both oils differ from their data sheet."""
    housing: Housing | None = None
    """Geometry and boundary conditions; a gearbox without one has no temperature field."""

    def first_meshes(self) -> dict[str, tuple[str, int]]:
        """The first mesh each gear is in, with its side there: 0 as pinion, 1 as wheel."""
        found: dict[str, tuple[str, int]] = {}
        for name, mesh in self.meshes.items():
            for side, gear in enumerate((mesh.pinion, mesh.wheel)):
                found.setdefault(gear, (name, side))
        return found

    def halves(self, gear: str) -> int:
        """2 for a double-helical gear, whose face width is that of one half; else 1."""
        return 2 if self.meshes[self.first_meshes()[gear][0]].double_helical else 1

    def body_width(self, gear: str) -> float:
        """Face width of a gear with both its halves [m]."""
        return self.halves(gear) * self.gears[gear].face_width
