"""The settled prototype at its test stage, and the same with values of its case changed."""

import math
from functools import cache

from rigdesign.case import Case, load_case
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.loop import PointResult, solve_point
from rigdesign.coupling.time_run import held_points
from rigdesign.postprocessing.housing import stage_balance
from rigdesign.rig.model import Rig
from tests.builders.twisting import twisting_rig

Changes = tuple[tuple[str, object], ...]
Settled = tuple[Rig, IterationResult]


@cache
def base() -> tuple[Rig, PointResult]:
    """As shipped, but for shafts that only twist and analytic teeth; quick."""
    rig = twisting_rig(load_case("cases/uhcf_prototype"))
    return rig, solve_point(rig, held_points(rig)[-1])


def case_with(changes: Changes) -> Case:
    """The shipped case with values changed."""
    case = base()[0].case
    for path, value in changes:
        case = case.with_value(path, value)
    return case


@cache
def settled(*changes: tuple[str, object], remesh: bool = False) -> Settled:
    """Rig and last pass with values of the case changed: settled anew from the shipped state.

    remesh : the change is one of the housing's shape
    """
    rig, result = base()
    if not changes:
        return rig, result.last
    changed = twisting_rig(case_with(changes))
    if remesh:
        return changed, solve_point(changed, result.point, start=result.last.coupling_state).last
    changed = changed.with_models(rig.models)
    return changed, solve_point(
        changed, result.point, start=result.last.coupling_state, before=result.last
    ).last


def lost(last: IterationResult, kind: str, gearbox: str = "test") -> float:
    """Sum of the losses of a kind in a gearbox [W]."""
    return math.fsum(p.loss.power for p in last.losses if (p.loss.kind, p.gearbox) == (kind, gearbox))


def lost_in_all(last: IterationResult) -> float:
    """Sum of all losses [W]."""
    return math.fsum(placed.loss.power for placed in last.losses)


def drive_power(rig: Rig, last: IterationResult) -> float:
    """What the motor gives [W]."""
    assert last.response is not None
    return last.response.drive_torque * rig.drive_speed(last.point.speed)


def outlet(last: IterationResult, stream: str) -> float:
    """Temperature with which an oil stream comes back [K]."""
    return next(entry.outlet for entry in last.streams if entry.name == stream)


def heat_by_kind(last: IterationResult) -> dict[str, float]:
    """Heat balance of the test housing by kind [W], positive into the solids."""
    return last.fields["test"].solution.balance.by_kind()


def open_share(rig: Rig, last: IterationResult) -> float:
    """What losses and heaters put in beyond what cooler and room take out, over the losses."""
    balance = stage_balance(rig, last).cooling
    return abs(balance.imbalance) / balance.losses
