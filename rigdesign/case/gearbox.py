"""A gearbox: gears, bearings, seals, their oil, and the housing if temperatures are wanted."""

from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import Field

from rigdesign.case.bearings import BearingInput
from rigdesign.case.fields import Clearance, Name, Part, Title, Torque, Usual
from rigdesign.case.gears import Gear, GearMesh
from rigdesign.case.heat_split import HeatSplit
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
    radial_gap: Annotated[Clearance, Usual(1.5e-3, 0.03, "shaft diameter")]
    """Half the difference of bore and shaft diameter as drawn; thermal expansion changes it."""
    axial_travel: Annotated[Clearance, Usual("0.35 mm", "8 mm")]
    """Axial movement of the shaft the seals take without touching."""
    rubbing_torque: Annotated[Torque, Usual(1e-5, 0.03, "test torque")] = 0.0
    """Friction torque of seals that touch, of all seals of the shaft together, on top of what ``kind`` loses."""


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
    oil: GearOil
    """Oil of the gears: injected at the meshes, or a sump into which they dip."""
    bearings: Mapping[Name, BearingInput] = Field(min_length=1)
    """Bearings by name."""
    bearing_oil: BearingOil = SplashOil(lubrication="splash")
    """Oil of the bearings: fed to them, thrown on them by the gears, or grease."""
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
    rotation: Literal["clockwise", "anticlockwise"] = "clockwise"
    """Sense in which the pinion of the first mesh turns, seen from the front of the housing; the other gears follow.
    It says to which side an inclination of the warm axes across their plane loads the faces."""
    housing: Housing | None = None
    """Geometry and boundary conditions; a gearbox without one has no temperature field."""

    @property
    def jets(self) -> JetOil | None:
        """Oil injected at the meshes; None where the gears dip."""
        return self.oil if isinstance(self.oil, JetOil) else None

    @property
    def sump(self) -> DipOil | None:
        """Sump into which the gears dip; None where oil is injected."""
        return self.oil if isinstance(self.oil, DipOil) else None

    @property
    def fed_bearings(self) -> FedOil | None:
        """Oil fed to the bearings; None where they live on splash or grease."""
        return self.bearing_oil if isinstance(self.bearing_oil, FedOil) else None

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
        return self.oil.oil if isinstance(self.bearing_oil, SplashOil) else self.bearing_oil.oil

    @property
    def splash_share(self) -> float:
        """Share of the oil that gears lift or jets inject which passes each bearing; 0 where none is thrown on them."""
        return self.bearing_oil.splash_share if isinstance(self.bearing_oil, SplashOil) else 0.0

    @property
    def gear_oil_temperature(self) -> float | None:
        """Temperature at which the oil of the gears is fed or its sump is held [K]; None for a free sump."""
        return self.oil.inlet_temperature if isinstance(self.oil, JetOil) else self.oil.sump_temperature

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
