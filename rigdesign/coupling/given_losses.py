"""Losses the case prescribes by place, measured or assumed, in place of computed ones."""

from rigdesign.case.losses import GivenLoss
from rigdesign.case.model import Case
from rigdesign.coupling.state import OperatingPoint


def given_power(case: Case, point: OperatingPoint, gearbox: str, kind: str, part: str) -> float | None:
    """Power [W] the case gives for one place at this point, or None where it gives none.

    The loss factor of its gearbox multiplies it, and of a bearing its own. A given power holds at the end of its
    stage. At other speeds of that stage (drag over a run-up) the torque behind it stays, and the power follows the
    speed.
    """
    for entry in case.losses.given.values():
        same = (entry.gearbox, entry.kind, entry.part) == (gearbox, kind, part)
        if same and (not entry.stages or point.stage in entry.stages):
            box = case.gearboxes[gearbox]
            own = box.bearings[part].friction_factor if kind == "bearing" else 1.0
            return own * box.loss_factors.of(kind) * _at_speed(case, entry, point)
    return None


def _at_speed(case: Case, entry: GivenLoss, point: OperatingPoint) -> float:
    speeds = {stage.name: stage.speed_end for stage in case.schedule.resolved()}
    full = speeds.get(point.stage, point.speed)
    return entry.power if full in (0.0, point.speed) else entry.power * point.speed / full
