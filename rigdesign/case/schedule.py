"""What the rig is asked to do: stages of speed and torque, and the planned test."""

from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import Field, model_validator

from rigdesign.case.fields import Count, Hours, Name, Part, Share, Speed, Text, Time, Torque, Usual, fault

StageKind = Literal["load", "unload", "run_up", "run_down", "dwell"]


class StageInput(Part):
    """One stage; it starts where the one before ended, the first at standstill without torque.

    load, unload: the torque rises, falls at constant speed. run_up, run_down: the speed rises, falls at
    constant torque. dwell: both stay.
    """

    name: Name
    """Name of the stage in results and paths."""
    kind: StageKind
    """What changes during the stage: the torque (load, unload), the speed (run_up, run_down) or nothing
    (dwell)."""
    speed: Annotated[Speed, Usual(0.005, 1.6, "test speed")] | None = None
    """Speed at its end; that of the stage before when left out."""
    torque: Annotated[Torque, Usual(0.005, 2.0, "test torque")] | None = None
    """Torque at its end; that of the stage before when left out."""
    torque_share: Share | None = None
    """The torque as a share of the test torque."""
    duration: Time
    """How long the stage takes."""
    drive_torque: Torque | None = None
    """Constant drive torque instead of speed control; ``duration`` is then the most it may take."""
    held: bool = False
    """Long enough for steady temperatures; the others carry losses only."""

    @model_validator(mode="after")
    def _one_torque(self) -> "StageInput":
        if self.torque is not None and self.torque_share is not None:
            raise fault("both torque and torque_share are given", "keep one of the two")
        return self


@dataclass(frozen=True, kw_only=True)
class StageValues:
    """A stage with its ends filled in: speeds [rad/s], torques [N m], duration [s]."""

    name: str
    kind: StageKind
    speed_start: float
    speed_end: float
    torque_start: float
    torque_end: float
    duration: float
    drive_torque: float | None
    held: bool


class ScheduleInput(Part):
    """Stages in their order."""

    test_speed: Annotated[Speed, Usual(1.0, 80.0, "speed of 1 m/s at the pitch circle")]
    """Speed of the test, counted at ``drivetrain.torque_at``."""
    test_torque: Annotated[Torque, Usual(1e6, 6e8, "torque of 1 Pa on face width times module")]
    """Torque of the test, counted at ``drivetrain.torque_at``."""
    stages: tuple[StageInput, ...] = Field(min_length=1)
    """Stages in the order in which they run."""
    simulation_only: Text | None = None
    """Why the schedule cannot be run on the rig; left out for one that can."""

    def resolved(self) -> tuple[StageValues, ...]:
        """The stages with start and end values, each starting where the one before ended."""
        speed = torque = 0.0
        values = []
        for stage in self.stages:
            speed_end = speed if stage.speed is None else stage.speed
            torque_end = torque if stage.torque is None else stage.torque
            if stage.torque_share is not None:
                torque_end = stage.torque_share * self.test_torque
            values.append(
                StageValues(
                    name=stage.name,
                    kind=stage.kind,
                    speed_start=speed,
                    speed_end=speed_end,
                    torque_start=torque,
                    torque_end=torque_end,
                    duration=stage.duration,
                    drive_torque=stage.drive_torque,
                    held=stage.held,
                )
            )
            speed, torque = speed_end, torque_end
        return tuple(values)

    def held(self) -> tuple[StageValues, ...]:
        """Stages long enough for steady temperatures; the last one if none is marked as such."""
        stages = self.resolved()
        return tuple(stage for stage in stages if stage.held) or stages[-1:]


class TestPlan(Part):
    """What the test is to reach."""

    time: Hours
    """Time planned at test speed and torque; the cycles wanted are ``limits.specimen.load_cycles_minimum``."""
    specimens: Count = 1
    """How many test gears one gear of the rig has to outlive."""
