"""Oil of a gearbox as it is: its state, and what of it reaches meshes, walls and bearings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rigdesign.base.part_name import OilStreamName
from rigdesign.case.gearbox import Gearbox, injected_flow
from rigdesign.case.lubrication import JetOil
from rigdesign.properties.oil import Oil
from thermal.films.flank import FilmOil

if TYPE_CHECKING:
    from rigdesign.rig.model import Rig


def gear_oil(rig: Rig, name: str) -> Oil:
    """Oil injected in the gearbox ``name``, in its state there."""
    box = rig.case.gearboxes[name]
    return _in_state(rig.oils[box.oil.oil], box)


def bearing_oil(rig: Rig, name: str) -> Oil:
    """Oil of the bearings of the gearbox ``name``, in its state there."""
    box = rig.case.gearboxes[name]
    return _in_state(rig.oils[box.bearing_oil_name], box)


def film_oil(rig: Rig, name: str) -> FilmOil:
    """The oil of the gears of the gearbox ``name`` as films see it."""
    oil = gear_oil(rig, name)
    return FilmOil(
        conductivity=oil.conductivity,
        density=oil.density,
        heat_capacity=oil.heat_capacity,
        kinematic_viscosity=oil.kinematic_viscosity,
        highest_temperature=oil.highest_temperature,
    )


@dataclass(frozen=True, kw_only=True)
class OilFeed:
    """Oil as it comes to a consumer: in its state there, at its inlet temperature."""

    oil: Oil
    inlet: float
    """[K]"""
    flow: float
    """[m3/s]; zero in a sump, and where oil is only thrown on the consumer."""

    @property
    def mass_flow(self) -> float:
        """[kg/s]"""
        return self.oil.density(self.inlet) * self.flow

    @property
    def capacity_rate(self) -> float:
        """Heat that warms it by one kelvin, rho c Q with properties at the inlet [W/K]."""
        return self.oil.density(self.inlet) * self.oil.heat_capacity(self.inlet) * self.flow

    def mean(self, outlet: float) -> float:
        """Mean temperature of inlet and ``outlet`` [K]."""
        return 0.5 * (self.inlet + outlet)


AS_STATED: Mapping[str, float] = {}
"""No oil stream is fed by a circuit: inlet temperatures are those of the case."""


@dataclass(frozen=True, kw_only=True)
class ChamberOil:
    """Gear oil of a chamber."""

    leaving: float
    """As it leaves the chamber; in a sump that of all its oil [K]."""
    supply: float | None = None
    """As an oil circuit feeds it [K]; None for the inlet temperature of the case."""

    @classmethod
    def of(cls, name: str, outlets: Mapping[str, float], supplies: Mapping[str, float]) -> ChamberOil:
        """That of the gearbox ``name``; outlets, supplies : by oil stream [K]."""
        stream = f"{name}.gear_oil"
        return cls(leaving=outlets[stream], supply=supplies.get(stream))

    def supplies(self, name: str) -> Mapping[str, float]:
        """Supply temperature by oil stream [K] of the gearbox ``name``, as `gear_feed` takes it."""
        return AS_STATED if self.supply is None else {f"{name}.gear_oil": self.supply}


def meant_supplies(rig: Rig) -> dict[str, float]:
    """Supply temperature that each oil stream of an oil circuit is meant to have [K], by ``gearbox.stream``."""
    return {
        stream: rig.case.gearboxes[stream.gearbox].feeds[stream.part][0].inlet_temperature
        for circuit in rig.case.oil_circuits.values()
        for line in circuit.lines.values()
        for stream in map(OilStreamName.read, line.consumers)
    }


def gear_feed(rig: Rig, name: str, chamber: float, supplies: Mapping[str, float] = AS_STATED) -> OilFeed:
    """Oil fed to all meshes of the gearbox ``name``; a sump at its temperature, without flow.

    chamber : temperature of the oil as it leaves the chamber, in a sump that of all its oil [K]
    supplies : ``gearbox.stream`` -> supply temperature of what oil circuits feed [K]; others as the case states
    """
    box = rig.case.gearboxes[name]
    if box.jets is None:
        return OilFeed(oil=gear_oil(rig, name), inlet=chamber, flow=0.0)
    flow = box.jets.flow * len(box.meshes)
    return OilFeed(
        oil=gear_oil(rig, name), inlet=supplies.get(f"{name}.gear_oil", box.jets.inlet_temperature), flow=flow
    )


def bearing_feed(rig: Rig, name: str, chamber: float, supplies: Mapping[str, float] = AS_STATED) -> OilFeed:
    """Oil fed to each bearing of the gearbox ``name``; where none is, oil of the chamber without flow.

    chamber : temperature of the gear oil as it leaves the chamber [K]; supplies : as in `gear_feed`
    """
    fed = rig.case.gearboxes[name].fed_bearings
    if fed is None:
        return OilFeed(oil=bearing_oil(rig, name), inlet=chamber, flow=0.0)
    return OilFeed(
        oil=bearing_oil(rig, name),
        inlet=supplies.get(f"{name}.bearing_oil", fed.inlet_temperature),
        flow=fed.flow,
    )


def conducting_share(rig: Rig, name: str, stream: str) -> float:
    """Conductivity of an oil of the gearbox ``name`` over that of its data sheet; ``stream``: gear_oil, bearing_oil."""
    box = rig.case.gearboxes[name]
    clear = rig.oils[box.oil.oil if stream == "gear_oil" else box.bearing_oil_name]
    return _in_state(clear, box).conductivity_40 / clear.conductivity_40


def _in_state(oil: Oil, box: Gearbox) -> Oil:
    state = box.oil_state
    return oil.in_state(
        air_content=state.air_content,
        viscosity_factor=state.viscosity_factor,
        heat_capacity_factor=state.heat_capacity_factor,
    )


def wetting_flow(box: Gearbox, jets: JetOil) -> float:
    """Flow of one mesh over the share of the face width its open jets reach [m3/s]: all of it lands there."""
    return injected_flow(box) / (1.0 - jets.blocked_jets)


def wetted_width(box: Gearbox) -> float:
    """Share of the face width that the open jets reach; all of it without jets."""
    return 1.0 if box.jets is None else 1.0 - box.jets.blocked_jets


def wall_flow(box: Gearbox) -> float:
    """Gear oil that passes walls, shafts and gear bodies on its way out, of all meshes [m3/s]; zero without jets."""
    paths = box.oil_paths
    fed = 0.0 if box.jets is None else box.jets.flow * len(box.meshes)
    return (1.0 - paths.bypass - paths.short_circuit) * fed
