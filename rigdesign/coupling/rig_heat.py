"""Heat of machines and couplings at one operating point: the drive delivers the losses of a back-to-back rig.

    power at the rig = losses of all gearboxes + windage of the couplings
    power from the mains = that + losses of transmission gearbox, motor and converter

Work of the mesh dampers is power of the drive as well; the kinetic energy of jets comes from the oil pumps.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

from rigdesign.base.errors import CaseError
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.placed_loss import PlacedLoss
from rigdesign.coupling.state import OperatingPoint
from rigdesign.rig.model import Rig
from rigdesign.rig_heat.component import ComponentHeat, heat_by_sink
from rigdesign.rig_heat.coupling_windage import coupling_windage
from rigdesign.rig_heat.drive_train import drive_train_heat


@dataclass(frozen=True, kw_only=True)
class DriveHeat:
    """What drives the rig at one operating point [W]."""

    power: float
    """At the shaft that drives the rig."""
    mains: float
    """Into the machine nearest to the mains; ``power`` without machines."""
    couplings: tuple[ComponentHeat, ...]
    machines: tuple[ComponentHeat, ...]

    @property
    def components(self) -> tuple[ComponentHeat, ...]:
        """Couplings and machines."""
        return *self.couplings, *self.machines


def drive_heat(
    rig: Rig, point: OperatingPoint, losses: Iterable[PlacedLoss], *, nearest: bool = False
) -> DriveHeat:
    """Heat of couplings and machines that drive the rig against its losses.

    nearest : an operating point outside of a loss map has the loss of the nearest one in it, while the loop iterates

    Raises
    ------
    CaseError
        An operating point outside of the loss map of a machine.
    """
    parts, air = rig.heat_parts, rig.case.ambient.temperature
    rotors = tuple(
        coupling_windage(rotor, abs(rig.shaft_speed(shaft, point.speed)), air)
        for rotor, shaft in parts.rotors
    )
    lost = [*(placed.loss.power for placed in losses), *(rotor.power for rotor in rotors)]
    power = max(math.fsum(lost), 0.0)
    speed = rig.driven_speed(point.speed)
    if not speed:
        return DriveHeat(power=0.0, mains=0.0, couplings=rotors, machines=())
    try:
        train = drive_train_heat(speed, power, parts.machines, nearest=nearest)
    except CaseError as error:
        faults = [replace(fault, path=f"rig_heat.machines.{fault.path}") for fault in error.faults]
        raise CaseError(faults, f"{rig.case.path}, stage {point.stage}") from error
    return DriveHeat(power=power, mains=train.input_power, couplings=rotors, machines=train.components)


def machine_heat(rig: Rig, done: IterationResult) -> dict[str, float]:
    """Heat of machines into their coolants [W], by coolant, at an iteration that may still be far off."""
    machines = drive_heat(rig, done.point, done.losses, nearest=True).machines
    return {sink: heat for sink, heat in heat_by_sink(machines).items() if sink in rig.oil_circuits}


def demand_loss_maps(rig: Rig, done: IterationResult) -> None:
    """Raise CaseError where the operating point of a machine is outside of its loss map."""
    drive_heat(rig, done.point, done.losses)
