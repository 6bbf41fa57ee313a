"""What a rig offers to measure: the places of every quantity, and the orders its tooth numbers make."""

import re
from collections.abc import Iterator
from fractions import Fraction
from functools import cached_property
from math import fsum, lcm

from rigdesign.base.part_name import GearName
from rigdesign.case import Case
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.geometry import housing_geometry
from thermal.housing.geometry import HousingGeometry
from thermal.housing.housing_surfaces import body_names, surface_names

MOTOR = "motor"
ROUNDED = 1e-3
"""Most an order written as a decimal may be off the fraction it stands for."""
SHAFT_ORDERS = (1, 2, 3, 4)
"""Orders of every shaft that are compared unless a channel says otherwise."""
MESH_ORDERS = (1, 2)
"""Harmonics of every tooth mesh, each with first sidebands of both its gears."""


class Places:
    """Places of a case by quantity, and its order lines."""

    def __init__(self, case: Case) -> None:
        self.case = case

    def of(self, quantity: str) -> tuple[str, ...]:
        """Places where a channel or setting of this quantity can sit; empty when the rig has none.

        Of ``natural_frequency`` and ``resonance_speed`` the first three; any higher number and the name of a mode is
        one, too (`is_mode`).
        """
        known = {
            "temperature": self.surfaces,
            "oil_outlet_temperature": self.streams,
            "inlet_temperature": self.streams,
            "flow": self.streams,
            "motor_power": self._driven(MOTOR),
            "drive_torque": self._driven(MOTOR),
            "torque": tuple(self.case.power_circuit.couplings),
            "angle": self.shafts,
            "acceleration": self.bearings,
            "shaft_displacement": (*self.bearings, *self.shafts),
            "natural_frequency": self._driven("1", "2", "3"),
            "resonance_speed": self._driven("1", "2", "3"),
            "backlash": self.meshes,
            "seal_gap": self.seals,
            "root_strain": self.strain_gauges,
        }
        return known.get(quantity, ())

    def is_mode(self, place: str) -> bool:
        """Whether a place is the number of a torsional natural frequency, or a mode named by how it moves.

        ``3`` or ``torsional 3``, ``lateral test_pinion 1``, ``axial test_pinion 1``, ``housing 2``.
        """
        name, _, number = place.rpartition(" ")
        if not re.fullmatch(r"[1-9][0-9]{0,3}", number):
            return False
        kind, _, shaft = name.partition(" ")
        if kind in ("lateral", "axial", "torsion"):
            return shaft in self.of("angle")
        return name in ("", "torsional", "housing")

    def _driven(self, *places: str) -> tuple[str, ...]:
        """Places that need a power circuit."""
        return places if self.case.drivetrain is not None else ()

    @cached_property
    def streams(self) -> tuple[str, ...]:
        """Oil streams."""
        return tuple(f"{box}.{oil}" for box in self.case.gearboxes for oil in ("gear_oil", "bearing_oil"))

    @cached_property
    def meshes(self) -> tuple[str, ...]:
        """Meshes, ``gearbox.mesh``."""
        return tuple(f"{name}.{mesh}" for name, box in self.case.gearboxes.items() for mesh in box.meshes)

    @cached_property
    def strain_gauges(self) -> tuple[str, ...]:
        """Strain gauges in tooth roots, ``gearbox.gear.gauge``; none without a drivetrain, whose torque they show."""
        return (
            tuple(
                f"{name}.{gear}.{gauge}"
                for name, box in self.case.gearboxes.items()
                for gear, entry in box.gears.items()
                for gauge in entry.strain_gauges
            )
            if self.case.drivetrain is not None
            else ()
        )

    def teeth_of(self, gear: str) -> tuple[int, int]:
        """Teeth of a gear, ``gearbox.gear``, and of its partner in its first mesh."""
        name, gear_name = GearName.read(gear).both
        box = self.case.gearboxes[name]
        mesh = box.meshes[box.first_meshes()[gear_name][0]]
        partner = mesh.wheel if gear_name == mesh.pinion else mesh.pinion
        return box.gears[gear_name].teeth, box.gears[partner].teeth

    def face_position(self, gauge: str) -> float:
        """Of a strain gauge, from mid-face [m]."""
        name, gear, gauge_name = gauge.split(".")
        return self.case.gearboxes[name].gears[gear].strain_gauges[gauge_name].face_position

    @cached_property
    def shafts(self) -> tuple[str, ...]:
        """Shafts of the power circuit."""
        return tuple(self.case.power_circuit.shafts)

    def length(self, shaft: str) -> float:
        """Length of one of them [m]."""
        return fsum(section.length for section in self.case.power_circuit.shafts[shaft].sections)

    @cached_property
    def bearings(self) -> tuple[str, ...]:
        """Bearings of the power circuit, ``gearbox.bearing``."""
        if self.case.drivetrain is None:
            return ()
        return tuple(f"{name}.{part}" for name, box in self.case.gearboxes.items() for part in box.bearings)

    @cached_property
    def housings(self) -> tuple[str, ...]:
        """Gearboxes with a temperature field."""
        return tuple(name for name, box in self.case.gearboxes.items() if box.housing is not None)

    @cached_property
    def surfaces(self) -> tuple[str, ...]:
        """Surfaces and bodies of the housings; without those of a mesh that is read from a file."""
        return tuple(f"{name}.{part}" for name, geometry in self._geometries() for part in
                     (*body_names(geometry), *surface_names(geometry)))  # fmt: skip

    @cached_property
    def seals(self) -> tuple[str, ...]:
        """Seals as results name them, ``gearbox.shaft_side``, those in the end walls ``…_end``."""
        prefix = "seal_bore_"
        return tuple(
            f"{name}.{surface.removeprefix(prefix)}"
            for name, geometry in self._geometries()
            for surface in surface_names(geometry)
            if surface.startswith(prefix)
        )

    def from_file(self, gearbox: str) -> bool:
        """Whether the housing of a gearbox is a file, whose surfaces only its reader knows."""
        box = self.case.gearboxes.get(gearbox)
        return box is not None and box.housing is not None and box.housing.part_file is not None

    def _geometries(self) -> Iterator[tuple[str, HousingGeometry]]:
        """Parametric housings."""
        for name, box in self.case.gearboxes.items():
            if box.housing is not None:
                yield name, housing_geometry(box)

    @cached_property
    def gear_orders(self) -> dict[str, Fraction]:
        """Turns of every gear, ``gearbox.gear``, per turn of the reference gear."""
        gears = {
            f"{name}.{gear}": (name, gear) for name, box in self.case.gearboxes.items() for gear in box.gears
        }
        turns: dict[str, Fraction] = {self.counting_gear: Fraction(1)}
        links = list(self._links())
        for _ in links:
            for first, second, ratio in links:
                if first in turns:
                    turns.setdefault(second, turns[first] * ratio)
                elif second in turns:
                    turns[first] = turns[second] / ratio
        return {gear: turns[gear] for gear in gears if gear in turns}

    @cached_property
    def counting_gear(self) -> GearName:
        """Gear whose turns count."""
        if self.case.drivetrain is not None:
            return self.case.power_circuit.counting_gear
        name, box = next(iter(self.case.gearboxes.items()))
        return GearName(name, next(iter(box.meshes.values())).pinion)

    def _links(self) -> Iterator[tuple[str, str, Fraction]]:
        """Pairs of gears that turn together with the speed ratio of the second to the first."""
        on_shaft: dict[str, list[str]] = {}
        for name, box in self.case.gearboxes.items():
            for mesh in box.meshes.values():
                ratio = Fraction(box.gears[mesh.pinion].teeth, box.gears[mesh.wheel].teeth)
                yield f"{name}.{mesh.pinion}", f"{name}.{mesh.wheel}", ratio
            for gear, entry in box.gears.items():
                on_shaft.setdefault(entry.shaft, []).append(f"{name}.{gear}")
        joined = list(on_shaft.values())
        joined += [
            [gear for shaft in coupling.shafts for gear in on_shaft.get(shaft, ())]
            for coupling in self.case.power_circuit.couplings.values()
        ]
        for gears in joined:
            yield from ((gears[0], other, Fraction(1)) for other in gears[1:])

    @cached_property
    def mesh_orders(self) -> dict[str, Fraction]:
        """Tooth meshes per turn of the reference gear, by ``gearbox.mesh``."""
        orders = {}
        for name, box in self.case.gearboxes.items():
            for mesh, entry in box.meshes.items():
                pinion = f"{name}.{entry.pinion}"
                if pinion in self.gear_orders:
                    orders[f"{name}.{mesh}"] = self.gear_orders[pinion] * box.gears[entry.pinion].teeth
        return orders

    @cached_property
    def cycle(self) -> int:
        """Turns of the reference gear until the same teeth meet everywhere: the hunting cycle."""
        return lcm(1, *(self._cycle(name, box) for name, box in self.case.gearboxes.items()))

    def _cycle(self, name: str, box: Gearbox) -> int:
        turns = [self.gear_orders[gear] for gear in self.gear_orders if gear.startswith(f"{name}.")]
        return lcm(1, *(turn.denominator for turn in turns))

    def snapped(self, order: float) -> float:
        """The order that turns with some gear, a multiple of 1 / cycle, if one is as near as a rounded decimal."""
        exact = Fraction(round(order * self.cycle), self.cycle)
        return float(exact) if abs(float(exact) - order) < ROUNDED else order

    @cached_property
    def orders(self) -> tuple[float, ...]:
        """Order lines that are compared where a channel names none: mean, shafts, meshes with sidebands."""
        shafts = sorted(set(self.gear_orders.values()))
        lines = {Fraction(0)} | {turn * k for turn in shafts for k in SHAFT_ORDERS}
        for order in self.mesh_orders.values():
            for k in MESH_ORDERS:
                lines |= {order * k} | {order * k + sign * turn for turn in shafts for sign in (-1, 1)}
        return tuple(float(line) for line in sorted(line for line in lines if line >= 0))
