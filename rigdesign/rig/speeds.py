"""Speed of every shaft of the rig, relative to the gear at which test speed and torque are counted."""

from collections.abc import Iterator

from rigdesign.case.model import Case


def speed_ratios(case: Case) -> dict[str, float]:
    """Shaft -> speed ratio to the gear ``drivetrain.torque_at``; magnitude only, every shaft runs forward.

    Without a drivetrain the pinion of the first mesh of each gearbox runs at the test speed.
    """
    if case.drivetrain is None:
        ratios = {
            box.gears[next(iter(box.meshes.values())).pinion].shaft: 1.0 for box in case.gearboxes.values()
        }
    else:
        box, gear = case.drivetrain.torque_at.split(".")
        ratios = {case.gearboxes[box].gears[gear].shaft: 1.0}
    links = list(_links(case))
    for _ in links:
        for first, second, ratio in links:
            if first in ratios:
                ratios.setdefault(second, ratios[first] * ratio)
            elif second in ratios:
                ratios[first] = ratios[second] / ratio
    return ratios


def _links(case: Case) -> Iterator[tuple[str, str, float]]:
    """(first shaft, second shaft, speed of the second per speed of the first)."""
    for box in case.gearboxes.values():
        for mesh in box.meshes.values():
            pinion, wheel = box.gears[mesh.pinion], box.gears[mesh.wheel]
            yield pinion.shaft, wheel.shaft, pinion.teeth / wheel.teeth
    if case.drivetrain is not None:
        for coupling in case.drivetrain.couplings.values():
            yield coupling.shafts[0], coupling.shafts[1], 1.0
