"""What shakes the shafts of a case once a turn, and couplings out of line, as parts of the elastic rig."""

from collections.abc import Iterator, Mapping

from dynamics.drivetrain.graph import Drivetrain
from dynamics.drivetrain.power_loop import speed_ratios
from dynamics.elastic_rig.balance import BalanceGrade, residual_unbalances
from dynamics.elastic_rig.rotating_parts import (
    AxisMisalignment,
    CrossJoint,
    FlangeRunOut,
    RotatingPart,
    ShaftBow,
    ShaftUnbalance,
)
from rigdesign.case.drivetrain import ShaftInput
from rigdesign.case.elastic_shafts import BALANCE_GRADE
from rigdesign.case.model import Case
from rigdesign.properties.materials import Material

MM_PER_S = 1e-3
"""Unit of a balance grade [m/s]."""


def rotating_parts(
    case: Case, drivetrain: Drivetrain, materials: Mapping[str, Material]
) -> Iterator[RotatingPart]:
    """Unbalances as stated or by grade, bows, run-out of flanges.

    Raises DrivetrainError for parts that do not fit the drivetrain.
    """
    power = case.drivetrain
    assert power is not None
    highest = highest_speeds(case, drivetrain)
    for name, shaft in power.shafts.items():
        for own in shaft.unbalances.values():
            yield ShaftUnbalance(shaft=name, position=own.position, moment=own.unbalance, angle=own.angle)
        grade = grade_of(case, shaft)
        speed = shaft.balance_speed or highest[name]
        if grade and speed:
            yield from residual_unbalances(
                drivetrain,
                name,
                BalanceGrade(grade=MM_PER_S * grade, speed=speed, angles=shaft.balance_angles),
            )
        if shaft.bow is not None:
            yield _bow(name, shaft, drivetrain, materials)
    for name, coupling in power.couplings.items():
        if coupling.flange_run_out or coupling.flange_tilt:
            yield FlangeRunOut(
                coupling=name,
                offset=coupling.flange_run_out,
                offset_angle=coupling.flange_run_out_angle,
                tilt=coupling.flange_tilt,
                tilt_angle=coupling.flange_tilt_angle,
            )


def without_residual_unbalance(case: Case) -> Case:
    """The case with the unbalances that it states alone: what a balance grade leaves turns at angles nobody knows."""
    power = case.drivetrain
    assert power is not None
    shafts = {name: shaft.model_copy(update={"balance_grade": None}) for name, shaft in power.shafts.items()}
    return case.model_copy(
        update={"drivetrain": power.model_copy(update={"balance_grade": 0.0, "shafts": shafts})}
    )


def misalignments(case: Case) -> Iterator[AxisMisalignment]:
    """Couplings that resist the offset or angle in which their axes were set up."""
    assert case.drivetrain is not None
    for name, coupling in case.drivetrain.couplings.items():
        offset = coupling.cold_offset_lateral, coupling.cold_offset_vertical
        slope = coupling.cold_angle_lateral, coupling.cold_angle_vertical
        found = AxisMisalignment(
            coupling=name,
            offset=offset if coupling.radial_stiffness else (0.0, 0.0),
            slope=slope if coupling.angular_stiffness else (0.0, 0.0),
        )
        if any((*found.offset, *found.slope)):
            yield found


def cross_joints(case: Case) -> Iterator[CrossJoint]:
    """Couplings that are cross joints under an angle."""
    assert case.drivetrain is not None
    for name, coupling in case.drivetrain.couplings.items():
        slope = coupling.cold_angle_lateral, coupling.cold_angle_vertical
        if coupling.joint == "hooke" and any(slope):
            yield CrossJoint(coupling=name, slope=slope)


def grade_of(case: Case, shaft: ShaftInput) -> float:
    """Balance quality grade of a shaft [mm/s], 0 where its unbalances are stated in its place."""
    assert case.drivetrain is not None
    if shaft.balance_grade is not None:
        return shaft.balance_grade
    if shaft.unbalances:
        return 0.0
    common = case.drivetrain.balance_grade
    return BALANCE_GRADE if common is None else common


def highest_speeds(case: Case, drivetrain: Drivetrain) -> dict[str, float]:
    """Highest speed of every shaft in the schedule [rad/s]."""
    assert case.drivetrain is not None
    box, gear = case.drivetrain.torque_at.split(".")
    ratios = speed_ratios(drivetrain)
    reference = ratios[case.gearboxes[box].gears[gear].shaft]
    top = max(max(stage.speed_start, stage.speed_end) for stage in case.schedule.resolved())
    return {name: abs(ratio / reference) * top for name, ratio in ratios.items()}


def _bow(name: str, shaft: ShaftInput, drivetrain: Drivetrain, materials: Mapping[str, Material]) -> ShaftBow:
    bow = shaft.bow
    assert bow is not None
    places = sorted(bearing.position for bearing in drivetrain.bearings if bearing.shaft == name)
    difference = bow.temperature_difference or 0.0
    return ShaftBow(
        shaft=name,
        supports=(places[0], places[-1]),
        amplitude=bow.amplitude,
        position=bow.position,
        angle=bow.angle,
        # the hot side is the outer one of the bend: away from the centre of curvature
        gradient=-materials[shaft.material].expansion_coefficient * difference,
        gradient_angle=bow.hot_side,
    )
