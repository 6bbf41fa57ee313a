"""A solved rig with some inputs changed: from its converged state, only what they touch is solved again."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from dynamics.vibration.time_response import TimeResponse
from rigdesign.case.fields import MODEL_PARTS, ModelPart
from rigdesign.case.model import Case
from rigdesign.case.paths import effects_at
from rigdesign.coupling.fixed_point import Anderson
from rigdesign.coupling.loop import PointResult, governing_point, solve_point
from rigdesign.coupling.time_run import held_points, run_ramp
from rigdesign.postprocessing.curves import Curves, solve_curves
from rigdesign.postprocessing.dynamics import DynamicRun
from rigdesign.postprocessing.housing import housing_temperatures
from rigdesign.postprocessing.solved_rig import SolvedRig, housing_fields, solved_rig
from rigdesign.results.loads import DynamicLoads
from rigdesign.rig.model import Rig, build_rig
from rigdesign.rig.reuse import same_housings, with_housings_of
from rigdesign.studies.shifted_run import Array, shifted_drive, shifted_run

TimeRun = Literal["marched", "shifted"]
"""How the time run follows loads that move."""


@dataclass(frozen=True)
class Reanalysis:
    """A case with changed inputs, and what of it is solved again.

    parts : of the model that the changed inputs touch
    time_run : ``shifted`` where the periodic response may move its envelopes (`shifted_run`), else ``marched``
    """

    case: Case
    parts: tuple[ModelPart, ...]
    time_run: TimeRun = "marched"


def reanalysis(case: Case, changed: Collection[str]) -> Reanalysis | None:
    """What is solved again of ``case`` where these inputs change; None where everything is.

    The time run is marched where heat moves the mean torque of the loop: a bracing that holds twist or shift winds up
    with warm gears, and one with a temperature drift follows the oil. With a constant bearing drag the factor of
    that loss is part of the drivetrain.
    """
    parts = tuple(part for part in MODEL_PARTS if any(part in parts_of(path) for path in changed))
    in_heat = [path for path in changed if through_heat(path)]
    if any(path not in in_heat and parts_of(path) == MODEL_PARTS for path in changed):
        return None
    if case.losses.bearing_drag == "constant" and any(".loss_factors" in path for path in in_heat):
        return None
    bracing = case.power_circuit.bracing
    steady = bracing.mode == "torque_controlled" and bracing.temperature_drift == 0.0
    shifted = steady and all(path in in_heat or "time run" not in parts_of(path) for path in changed)
    return Reanalysis(case, parts, "shifted" if shifted else "marched")


def parts_of(path: str) -> tuple[ModelPart, ...]:
    """Parts of the model that have to be solved again when the value at ``path`` changes."""
    stated = (effect.solved for effect in reversed(effects_at(Case, path)))
    return next((parts for parts in stated if parts is not None), MODEL_PARTS)


def through_heat(path: str) -> bool:
    """Whether an input reaches the loads through temperatures and drag torques alone."""
    return any(effect.through_heat for effect in effects_at(Case, path))


ACTUATOR = ("actuator_force", "shift_travel")
"""Quantities of bought parts that follow the setting of the bracing, hot."""
LOADS_MOVE = {"gear_temperature": 0.25, "centre_distance": 2e-6, "axial_expansion": 2e-6}
"""Change of a field of `CouplingState` [K, m] beyond which the loads are solved again: on the prototype half a
kelvin moves a check on loads by up to 0.001 of its limit, `verdicts.LEAST_MOVE`, and 5 um do."""


def modified_rig(
    stated: SolvedRig, again: Reanalysis, motor_losses: Array | None
) -> tuple[SolvedRig, tuple[ModelPart, ...]]:
    """The modified rig and the parts that were solved again; all others are those of the stated rig.

    motor_losses : torque of all losses at the motor over the stated time run [N m], (n,)
    """
    case, parts = again.case, again.parts
    rig = _rig_like(stated.rig, case, parts)
    points = list(stated.points)
    if "coupling" in parts:
        points = [coupled_again(rig, stated, number) for number in range(len(stated.points))]
        parts = MODEL_PARTS if stated.run is not None and _loads_move(points, stated.points) else parts
    run, loads = stated.run, stated.loads
    if run is None:
        return with_records(rig, points, None), tuple(part for part in parts if part == "coupling")
    test = governing_point(points)
    curves = solve_curves(rig, test.last) if "curves" in parts else run.curves
    ramp, solved = _time_run(rig, test, replace(again, parts=parts), (run, curves), motor_losses)
    run = DynamicRun(tuple(points), curves, ramp)
    if "curves" in parts or "time run" in parts or ("coupling" in parts and _asks_for(case, ACTUATOR)):
        loads = None
    # events are not marched again: checks based on them keep their value
    return replace(with_records(rig, points, run, loads), events=stated.events), solved


def _time_run(
    rig: Rig,
    test: PointResult,
    again: Reanalysis,
    responses: tuple[DynamicRun, Curves],
    motor_losses: Array | None,
) -> tuple[TimeResponse, tuple[ModelPart, ...]]:
    """The time run of the modified rig and the parts that were solved again.

    responses : of the stated rig, and the curves of the modified one
    """
    (run, curves), parts = responses, list(again.parts)
    ramp: TimeResponse | None = run.ramp
    if "time run" in parts and again.time_run == "shifted":
        ramp = shifted_run(rig, run, curves)
        parts.remove("time run")
    if ramp is not None and "time run" not in parts and "coupling" in parts:
        assert motor_losses is not None
        ramp = shifted_drive(rig, test.last, ramp, motor_losses)
    if ramp is None or "time run" in parts:
        assert test.setting is not None
        ramp = run_ramp(rig, test.last, test.setting, test.last.coupling_state)
        parts = [*dict.fromkeys((*parts, "time run"))]
    return ramp, tuple(parts)


def _loads_move(points: Sequence[PointResult], stated: Sequence[PointResult]) -> bool:
    """Whether gears or axes are so much warmer or colder that the loads change."""
    return any(
        abs(value - getattr(before.last.coupling_state, name)[part]) > most
        for point, before in zip(points, stated, strict=True)
        for name, most in LOADS_MOVE.items()
        for part, value in getattr(point.last.coupling_state, name).items()
    )


def _rig_like(stated: Rig, case: Case, parts: tuple[ModelPart, ...]) -> Rig:
    """The rig of ``case``; it takes over what the stated rig has computed and the change does not touch."""
    rig = replace(build_rig(case, stated.fidelity), tooth_influence=stated.tooth_influence)
    if "coupling" not in parts or same_housings(rig, stated):
        rig = with_housings_of(rig, stated)
    return rig


def coupled_again(rig: Rig, stated: SolvedRig, number: int) -> PointResult:
    """A held point of a modified rig, coupled from its state in the stated one.

    The fields of the stated rig are the first guess where both have the same meshes.
    """
    near = stated.points[number]
    start = near.last.coupling_state
    same = all(model is stated.rig.models.get(name) for name, model in rig.models.items())
    return solve_point(
        rig,
        held_points(rig)[number],
        start=start,
        before=near.last if same else None,
        acceleration=Anderson(start, known=near.differences),
    )


def _asks_for(case: Case, quantities: tuple[str, ...]) -> bool:
    return any(
        part.given is None and part.quantity in quantities for part in case.limits.bought_parts.values()
    )


def with_records(
    rig: Rig, points: Sequence[PointResult], run: DynamicRun | None, loads: DynamicLoads | None = None
) -> SolvedRig:
    """The records of solved points, with the loads of the run where none are given; nothing is solved to compare."""
    temperatures = [housing_temperatures(rig, *found) for found in housing_fields(points)]
    return solved_rig(rig, points, temperatures, run=run, loads=loads)
