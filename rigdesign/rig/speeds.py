"""Speeds of shafts, relative to the gear at which test speed and torque are counted, and of the driving machines."""

from collections.abc import Iterator, Mapping, Sequence

from dynamics.drivetrain import power_loop
from dynamics.drivetrain.graph import Drivetrain
from rigdesign.base.errors import CaseError, Fault
from rigdesign.base.units import show
from rigdesign.case.model import Case
from rigdesign.rig_heat.drive_train import Machine
from rigdesign.rig_heat.machine_loss import LossMap


def speed_ratios(case: Case, drivetrain: Drivetrain | None) -> dict[str, float]:
    """Shaft -> speed ratio to the gear ``drivetrain.torque_at``; magnitude only, every shaft runs forward.

    Without a drivetrain the pinion of the first mesh of each gearbox runs at the test speed.
    """
    if drivetrain is None or case.drivetrain is None:
        return _by_gearbox(case)
    ratios = power_loop.speed_ratios(drivetrain)
    reference = ratios[drivetrain.gear(case.drivetrain.torque_at).shaft]
    return {shaft: ratio / reference for shaft, ratio in ratios.items()}


def _by_gearbox(case: Case) -> dict[str, float]:
    """Ratios along the meshes of each gearbox for itself."""
    ratios: dict[str, float] = {}
    for box in case.gearboxes.values():
        meshes = list(box.meshes.values())
        ratios[box.gears[meshes[0].pinion].shaft] = 1.0
        for _ in meshes:
            for mesh in meshes:
                pinion, wheel = box.gears[mesh.pinion], box.gears[mesh.wheel]
                ratio = pinion.teeth / wheel.teeth
                if pinion.shaft in ratios:
                    ratios.setdefault(wheel.shaft, ratios[pinion.shaft] * ratio)
                elif wheel.shaft in ratios:
                    ratios[pinion.shaft] = ratios[wheel.shaft] / ratio
    return ratios


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
