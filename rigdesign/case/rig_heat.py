"""Heat of the rig outside of its gearboxes and oil circuits: machines that drive it, couplings, and the room.

Pipes, tanks and pumps belong to the oil circuits, walls to the housings: all of them give their heat to the same room.
"""

from collections.abc import Iterator, Mapping
from typing import Annotated

from pydantic import Field, model_validator

from rigdesign.base.units import show
from rigdesign.case.fields import (
    AssumptionRecord,
    Conductance,
    Effect,
    Gap,
    Name,
    Part,
    Power,
    Quantity,
    RoomTemperature,
    Share,
    Size,
    Speed,
    Temperature,
    Text,
    Torque,
    Usual,
    fault,
)
from rigdesign.rig_heat.component import CouplingRotor

WATER = "water"
"""Coolant of a machine with cooling water of its own."""
OIL_COOLER = "oil_cooler"
"""Coolant of a machine whose oil goes to the cooler of the oils that no oil circuit of the case feeds."""
AirFlow = Annotated[float, Quantity("flow", at_least="0 m3/h", at_most="1e6 m3/h", example="2000 m3/h")]
"""Of a ventilation."""


class LossPointInput(Part):
    """Loss at one operating point of the output shaft."""

    speed: Speed
    """Of the output shaft."""
    torque: Torque
    """Of the output shaft."""
    loss: Power
    """Input less output power."""


class MachineInput(Part):
    """Transmission gearbox, motor or frequency converter between the rig and the mains."""

    drives: Name | None = None
    """Machine that it drives; the rig itself when left out."""
    efficiency: Annotated[float, Field(gt=0.0, le=1.0), Usual(0.4, 1.0)] | None = None
    """Output over input power at every operating point, or ``loss_map``."""
    loss_map: tuple[LossPointInput, ...] | None = Field(default=None, min_length=4)
    """Losses on a grid of speeds and torques of the output shaft, every speed with every torque; bilinear in between
    and not extrapolated. That of a frequency converter stands over speed and torque of its motor."""
    speed_ratio: Annotated[float, Field(gt=0.0, le=1000.0)] | None = None
    """Speed of its input shaft over that of its output shaft; 1 when left out, as for a motor or a converter."""
    coolant: Text | None = None
    """What takes ``coolant_share`` of its heat: an oil circuit by name, ``water`` of its own, or ``oil_cooler`` for the
    cooler of the oils that no oil circuit feeds. Left out, all heat goes to the room."""
    coolant_share: Share | None = None
    """Share of its heat that goes to ``coolant``; the rest goes to the room."""

    @model_validator(mode="after")
    def _complete(self) -> "MachineInput":
        if (self.efficiency is None) == (self.loss_map is None):
            raise fault(
                "needs efficiency or loss_map, one of the two",
                "write e.g. efficiency = 0.95 from its data sheet",
            )
        if (self.coolant is None) != (self.coolant_share is None):
            raise fault(
                "coolant and coolant_share need each other",
                'write e.g. coolant = "water" and coolant_share = 0.9, or leave out both for a machine cooled by air',
            )
        return self


class CouplingRotorInput(Part):
    """Coupling that stirs the air of its guard."""

    shaft: Name | None = None
    """Shaft with which it turns; the first one of ``drivetrain.couplings`` of the same name when left out."""
    diameter: Size
    """Of its rim."""
    length: Size
    """Of its rim along the shaft."""
    hub_diameter: Gap | None = None
    """Inside of which shafts cover its faces; whole faces when left out."""

    @model_validator(mode="after")
    def _open_face(self) -> "CouplingRotorInput":
        if self.hub_diameter is not None and self.hub_diameter >= self.diameter:
            raise fault(
                f"hub_diameter = {show(self.hub_diameter, 'length')} is not below "
                f"diameter = {show(self.diameter, 'length')}",
                "exchange or correct them",
            )
        return self

    def rotor(self, name: str) -> CouplingRotor:
        """The coupling as the balance of heat takes it; CaseError where it cannot be."""
        return CouplingRotor(
            name=name,
            radius=0.5 * self.diameter,
            length=self.length,
            hub_radius=0.5 * (self.hub_diameter or 0.0),
        )

    def assumptions(self, at: str) -> Iterator[AssumptionRecord]:
        """What it assumes by leaving it out."""
        if self.hub_diameter is None:
            yield AssumptionRecord(
                path=f"{at}.hub_diameter", value="0 mm",
                reason="not stated: both faces stir air up to the axis, which counts too much windage by less than "
                "(hub/rim)^5",
            )  # fmt: skip


class RoomInput(Part):
    """Room of the rig with its ventilation; it takes the heat of everything that stands in it."""

    air_flow: AirFlow
    """Of the ventilation, as it is supplied; 0 without one."""
    supply_temperature: RoomTemperature | None = None
    """Of the supplied air; ``ambient.temperature`` when left out."""
    wall_conductance: Conductance | None = None
    """Of its walls to the outside; walls that keep all heat when left out."""
    outside_temperature: RoomTemperature | None = None
    """Behind the walls; ``supply_temperature`` when left out."""
    temperature_maximum: Temperature | None = None
    """Most that the room may reach; no check when left out."""

    @model_validator(mode="after")
    def _way_out(self) -> "RoomInput":
        if not (self.air_flow or self.wall_conductance):
            raise fault(
                "the heat of the room has no way out: air_flow and wall_conductance are 0",
                'write e.g. air_flow = "2000 m3/h", or a wall_conductance above 0 W/K',
            )
        return self


class RigHeatInput(Part):
    """What gives heat to the room and its coolants besides gearboxes and oil circuits."""

    machines: Mapping[Name, MachineInput] = {}
    """Machines that drive the rig, by name; their losses follow from what the rig takes."""
    couplings: Mapping[Name, CouplingRotorInput] = {}
    """Couplings that stir air, by name; their windage loads the drive."""
    room: Annotated[RoomInput, Effect(checks=("rig heat",), solved=())] | None = None
    """Room that takes the heat; its temperature is not asked for when left out."""

    @property
    def stated(self) -> bool:
        """Whether the case says anything of it."""
        return bool(self.machines or self.couplings or self.room)

    @property
    def chain(self) -> tuple[str, ...]:
        """Machines from the rig to the mains, each driving the one before; as far as they follow each other."""
        driver: dict[str | None, str] = {}
        for name, machine in self.machines.items():
            driver.setdefault(machine.drives, name)
        found: list[str] = []
        following = driver.get(None)
        while following is not None and following not in found:
            found.append(following)
            following = driver.get(following)
        return tuple(found)

    def assumptions(self, ambient: float) -> Iterator[AssumptionRecord]:
        """What the case assumes by leaving it out; ambient : temperature of the room air [K]."""
        for place, (name, machine) in enumerate((name, self.machines[name]) for name in self.chain):
            at = f"rig_heat.machines.{name}"
            if machine.coolant is None:
                yield AssumptionRecord(
                    path=f"{at}.coolant_share", value="0",
                    reason="not stated: cooled by air, all of its heat goes to the room",
                )  # fmt: skip
            mapped = any(self.machines[other].loss_map for other in self.chain[place + 1 :])
            if machine.speed_ratio is None and mapped:
                yield AssumptionRecord(
                    path=f"{at}.speed_ratio", value="1",
                    reason="not stated: input and output turn alike, as in a motor; it decides where the loss maps of "
                    "the machines before it are read",
                )  # fmt: skip
        for name, coupling in self.couplings.items():
            yield from coupling.assumptions(f"rig_heat.couplings.{name}")
        if self.room is not None:
            yield from _of_room(self.room, ambient)


def _of_room(room: RoomInput, ambient: float) -> Iterator[AssumptionRecord]:
    supply = ambient if room.supply_temperature is None else room.supply_temperature
    if room.supply_temperature is None and room.air_flow:
        yield AssumptionRecord(
            path="rig_heat.room.supply_temperature", value=show(supply, "temperature"),
            reason="not stated: air of ambient.temperature, at which the housings are computed",
        )  # fmt: skip
    if room.wall_conductance is None:
        yield AssumptionRecord(
            path="rig_heat.room.wall_conductance", value="0 W/K",
            reason="not stated: all heat leaves with the air; walls of a hall take 1 to 3 W/(m2 K)",
        )  # fmt: skip
    elif room.outside_temperature is None and room.wall_conductance:
        yield AssumptionRecord(
            path="rig_heat.room.outside_temperature", value=show(supply, "temperature"),
            reason="not stated: as warm behind the walls as the supplied air",
        )  # fmt: skip
