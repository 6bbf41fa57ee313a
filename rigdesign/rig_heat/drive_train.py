"""From the power a back-to-back rig takes to the mains: transmission gearbox, motor, drive, each with its loss."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from rigdesign.base.errors import CaseError
from rigdesign.base.number_faults import require_above, require_at_least
from rigdesign.rig_heat.component import ComponentHeat, HeatSplit
from rigdesign.rig_heat.machine_loss import MachineLoss


@dataclass(frozen=True, kw_only=True)
class Machine:
    """A machine between the mains and the rig.

    loss : over the operating point of its output
    speed_ratio : speed of its input over that of its output [-]; for a motor, and for a frequency converter, 1: a loss
        map of a converter stands over speed and torque of its motor
    """

    name: str
    loss: MachineLoss
    speed_ratio: float = 1.0
    split: HeatSplit = field(default_factory=HeatSplit)

    def __post_init__(self) -> None:
        require_above(f"{self.name}.speed_ratio", self.speed_ratio, "", "give input over output speed")


@dataclass(frozen=True, kw_only=True)
class DriveTrainHeat:
    """Heat of every machine, and the power taken from the mains [W]."""

    components: tuple[ComponentHeat, ...]
    input_power: float


def drive_train_heat(
    speed: float, power: float, machines: Sequence[Machine], *, nearest: bool = False
) -> DriveTrainHeat:
    """Losses of the machines that drive a rig.

    Parameters
    ----------
    speed : of the shaft that drives the rig [rad/s], above 0
    power : at that shaft [W]; in a back-to-back rig the sum of its losses
    machines : from the rig to the mains, each driving the one before
    nearest : an operating point outside of a loss map has the loss of the nearest one in it, for a power that is not
        yet the final one

    Raises CaseError for a negative power, or an operating point outside of a loss map.
    """
    require_above("drive.speed", speed, "rad/s", "give the speed of the driven shaft")
    require_at_least("drive.power", power, "W", "the losses of the rig cannot be negative")
    found = []
    for machine in machines:
        lost = _lost(machine, speed, power / speed, nearest=nearest)
        found.append(
            ComponentHeat(name=machine.name, power=lost, split=machine.split, source=machine.loss.source)
        )
        power += lost
        speed *= machine.speed_ratio
    return DriveTrainHeat(components=tuple(found), input_power=power)


def _lost(machine: Machine, speed: float, torque: float, *, nearest: bool) -> float:
    """Loss of a machine [W]; faults begin with its name."""
    try:
        return machine.loss.power(*(machine.loss.nearest(speed, torque) if nearest else (speed, torque)))
    except CaseError as error:
        raise CaseError(
            [replace(fault, path=f"{machine.name}.{fault.path}") for fault in error.faults]
        ) from error
