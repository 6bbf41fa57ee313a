"""Speed of every shaft of the rig, relative to the gear at which test speed and torque are counted."""

from dynamics.drivetrain import power_loop
from dynamics.drivetrain.graph import Drivetrain
from rigdesign.case.model import Case


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
