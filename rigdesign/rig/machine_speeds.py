"""Speeds of the machines that drive the rig, held against the loss maps that the case gives of them."""

from collections.abc import Iterator, Mapping, Sequence

from rigdesign.base.errors import CaseError, Fault
from rigdesign.base.units import show
from rigdesign.rig_heat.drive_train import Machine
from rigdesign.rig_heat.machine_loss import LossMap


def refuse_uncovered_speeds(machines: Sequence[Machine], speeds: Mapping[str, float], source: str) -> None:
    """Raise CaseError where the loss map of a machine does not hold a speed; its torque follows from the losses.

    machines : from the rig to the mains; speeds : stage -> speed of the shaft that is driven [rad/s]
    source : case file
    """
    faults = [fault for stage, speed in speeds.items() for fault in _uncovered(machines, stage, speed)]
    if faults:
        raise CaseError(faults, source)


def _uncovered(machines: Sequence[Machine], stage: str, speed: float) -> Iterator[Fault]:
    for machine in machines:
        loss = machine.loss
        if speed and isinstance(loss, LossMap) and not loss.holds_speed(speed):
            low, high = (show(float(end), "speed") for end in loss.speeds[[0, -1]])
            yield Fault(
                f"rig_heat.machines.{machine.name}.loss_map", show(speed, "speed"),
                f"is the speed of its output at stage {stage}, outside of the map, {low} to {high}",
                "extend the map to this speed, it is not extrapolated; or correct speed_ratio of the machines between "
                "it and the rig",
            )  # fmt: skip
        speed *= machine.speed_ratio
