"""A gearbox: gears, bearings, seals, their oil, and the housing if temperatures are wanted."""

from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import Field, model_validator

from dynamics.losses.oil_jet import JET_ANGLES, OilJet
from rigdesign.case.bearings import BearingInput
from rigdesign.case.fields import OF_HEAT, Effect, Name, Part, Share, Title, Usual, fault
from rigdesign.case.gears import Gear, GearMesh
from rigdesign.case.housing import Housing
from rigdesign.case.losses import LossFactors
from rigdesign.case.lubrication import (
    BearingOil,
    DipOil,
    FedOil,
    GearOil,
    JetOil,
    OilPaths,
    OilState,
    SplashOil,
)
from rigdesign.case.seals import Seals
from rigdesign.properties.oil import Oil

# How each power loss of a gearbox divides between its bodies and its oil.

MeshRule = Literal["assumed", "flank_film"]


class HeatSplit(Part):
    """Share of each loss that enters solid bodies; the rest goes into the oil at once."""

    mesh: MeshRule | None = None
    """assumed: ``mesh_into_gears`` of the friction heat enters the gears; flank_film: all of it enters the flanks,
    and the films on the rims (law ``flank_film``) decide how much heat goes into the oil. When left out:
    flank_film, or assumed where the case gives a share."""
    mesh_into_gears: Annotated[Share, Usual(0.1, 1.0)] | None = None
    """Share of the friction heat of the meshes that enters the gears, for ``mesh = assumed``."""
    mesh_pinion_share: Annotated[Share, Usual(0.1, 0.9)] | None = None
    """Of the friction heat, the part that enters the pinion; by the thermal contact of the flanks when left out."""
    windage_into_gears: Annotated[Share, Usual(0.02, 0.9)]
    """Share of the windage loss that heats the gear bodies."""
    seal_into_shaft: Annotated[Share, Usual(0.03, 1.0)]
    """Share of the seal losses that enters the shaft at the seal."""
    seal_into_housing: Annotated[Share, Usual(0.03, 1.0)]
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


OF_HOUSING = Effect(checks=("housing",), solved=("coupling",), through_heat=True)


class Gearbox(Part):
    """One gearbox of the rig."""

    title: Title
    """Name of the gearbox in the report."""
    role: Literal["specimen", "rig"]
    """specimen: its gears are what is tested, held against a target window; rig: against a safety."""
    gears: Mapping[Name, Gear] = Field(min_length=2)
    """Gears by name."""
    meshes: Mapping[Name, GearMesh] = Field(min_length=1)
    """Meshes by name, each of two gears."""
    oil: Annotated[GearOil, OF_HEAT]
    """Oil of the gears: injected at the meshes, or a sump into which they dip."""
    bearings: Mapping[Name, BearingInput] = Field(min_length=1)
    """Bearings by name."""
    bearing_oil: Annotated[BearingOil, OF_HEAT] = SplashOil(lubrication="splash")
    """Oil of the bearings: fed to them, thrown on them by the gears, or grease."""
    seals: Annotated[Mapping[Name, Seals], OF_HOUSING] = {}
    """Seals by name, one entry a shaft."""
    heat_split: Annotated[HeatSplit, Effect(checks=(), where=("bare",), through_heat=True)]
    """Shares of the losses that heat solid parts."""
    loss_factors: Annotated[LossFactors, OF_HEAT] = LossFactors()
    """Factors on the losses of this gearbox."""
    oil_paths: Annotated[OilPaths, OF_HEAT] = OilPaths()
    """Shares of the gear oil that take another way."""
    oil_state: Annotated[OilState, OF_HEAT] = OilState()
    """How both oils differ from their data sheet."""
    rotation: Literal["clockwise", "anticlockwise"] = "clockwise"
    """Sense in which the pinion of the first mesh turns, seen from the front of the housing; the other gears follow.
    It says to which side an inclination of the warm axes across their plane loads the faces."""
    housing: Annotated[Housing, OF_HOUSING] | None = None
    """Geometry and boundary conditions; a gearbox without one has no temperature field."""

    @property
    def jets(self) -> JetOil | None:
        """Oil injected at the meshes; None where the gears dip."""
        return self.oil.jets

    @property
    def sump(self) -> DipOil | None:
        """Sump into which the gears dip; None where oil is injected."""
        return self.oil.sump

    @property
    def fed_bearings(self) -> FedOil | None:
        """Oil fed to the bearings; None where they live on splash or grease."""
        return self.bearing_oil.fed

    @property
    def feeds(self) -> Mapping[str, tuple[JetOil | FedOil, int]]:
        """Oils that are fed by ``gear_oil`` and ``bearing_oil``, each with the number of its consumers."""
        found: dict[str, tuple[JetOil | FedOil, int]] = {}
        if self.jets is not None:
            found["gear_oil"] = self.jets, len(self.meshes)
        if self.fed_bearings is not None:
            found["bearing_oil"] = self.fed_bearings, len(self.bearings)
        return found

    @property
    def bearing_oil_name(self) -> str:
        """Oil of the bearings: that of the gears where it is thrown on them."""
        return self.bearing_oil.oil_name(self.oil.oil)

    @property
    def splash_share(self) -> float:
        """Share of the oil that gears lift or jets inject which passes each bearing; 0 where none is thrown on them."""
        return self.bearing_oil.splash_share

    @property
    def gear_oil_temperature(self) -> float | None:
        """Temperature at which the oil of the gears is fed or its sump is held [K]; None for a free sump."""
        return self.oil.temperature

    @property
    def stated_oil_temperatures(self) -> tuple[float, ...]:
        """Temperatures at which oils are fed or a sump is held [K]."""
        fed = self.fed_bearings
        found = (self.gear_oil_temperature, None if fed is None else fed.inlet_temperature)
        return tuple(temperature for temperature in found if temperature is not None)

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

    def carrying_halves(self, gear: str) -> int:
        """Halves of a gear that the loop has the springs and the mass of."""
        return self.meshes[self.first_meshes()[gear][0]].sharing

    def seat_diameter(self, gear: str) -> float:
        """Diameter of the shaft in a gear [m]: its bore, or where it is cut into the shaft that of the bearings."""
        part = self.gears[gear]
        on_shaft = [
            bearing.shaft_diameter for bearing in self.bearings.values() if bearing.shaft == part.shaft
        ]
        return part.bore_diameter or min(on_shaft, default=0.0)

    def body_width(self, gear: str) -> float:
        """Face width of a gear with both its halves [m]."""
        return self.halves(gear) * self.gears[gear].face_width

    # Oil jets of a gearbox as they reach the meshes: what is fed less leaks, through the nozzles that are open.

    def bearing_positions(self, shaft: str) -> tuple[float, float] | None:
        """Positions of the two bearings of a shaft [m]; None where they are not stated or not two."""
        stations = [bearing.position for bearing in self.bearings.values() if bearing.shaft == shaft]
        if len(stations) != 2 or stations[0] is None or stations[1] is None or stations[0] == stations[1]:
            return None
        return stations[0], stations[1]


def injected_flow(box: Gearbox) -> float:
    """Flow of the jets of one mesh [m3/s]: what is fed less what goes round the meshes; zero without jets."""
    return 0.0 if box.jets is None else (1.0 - box.oil_paths.bypass) * box.jets.flow


def jet_velocity(box: Gearbox, jets: JetOil) -> float:
    """Velocity of the oil in the jets [m/s]: that of the case with its flow through all of them."""
    return (1.0 - box.oil_paths.bypass) / (1.0 - jets.blocked_jets) * jets.jet_velocity


def mesh_jet(box: Gearbox, jets: JetOil, oil: Oil) -> OilJet:
    """Jet of one mesh, at the inlet temperature of the case; ``oil`` in its state in the gearbox."""
    return OilJet(
        flow=injected_flow(box),
        density=oil.density(jets.inlet_temperature),
        speed=jet_velocity(box, jets),
        angle=JET_ANGLES[jets.jet_direction],
    )
