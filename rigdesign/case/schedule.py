"""What the rig is asked to do: stages of speed and torque, and the planned test."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import Field, model_validator

from rigdesign.case.fields import (
    Count,
    Effect,
    Frequency,
    HeatTransferCoefficient,
    Hours,
    Length,
    Name,
    Part,
    Positive,
    Share,
    Speed,
    TemperatureDifference,
    Text,
    Time,
    Torque,
    Usual,
    fault,
)

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
    duration: Annotated[Time, Effect(checks=("time run",), solved=("time run",))]
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


# How finely and how long to compute.


class Numerics(Part):
    """Tolerances of the coupling loop and sizes of the models; the fidelity scales the sizes."""

    temperature_tolerance: Annotated[TemperatureDifference, Usual("0.004 K", "0.3 K")]
    """Most change of any temperature in the last iteration of the coupling loop."""
    growth_tolerance: Annotated[Length, Usual("0.04 um", "4 um")]
    """Most change of any thermal expansion in the last iteration of the coupling loop."""
    torque_tolerance: Annotated[Positive, Usual(5e-5, 5e-3)]
    """Most relative change of any torque in the last iteration of the coupling loop."""
    coupling_passes: Count = 30
    """Most iterations of the coupling loop."""
    sample_rate: Frequency
    """Rate at which the time run is stored; it integrates ``internal_steps`` times as fast."""
    internal_steps: Annotated[int, Field(ge=4, le=256)] = 4
    """Integration steps per sample."""
    slices_spur: Annotated[int, Field(ge=1, le=101)] | None = None
    """Slices over the face of spur gears; by what their faces need when left out: 1 if flat, else 8."""
    slices_helical: Annotated[int, Field(ge=3, le=101)] | None = None
    """Slices over the face of helical gears; when left out 8 a base pitch of overlap, at least 8."""
    shaft_element_length: Length | None = None
    """Longest element of the shafts; when left out a sixteenth of the torsional wave of the fourth mesh harmonic at
    the highest speed, at most of 20 kHz."""
    curve_speed_start: Annotated[Speed, Usual(0.02, 1.0, "test speed")]
    """First speed of the dynamic factor curve."""
    curve_speed_end: Annotated[Speed, Usual(0.3, 3.0, "test speed")]
    """Last speed of the dynamic factor curve."""
    curve_speeds: Annotated[int, Field(ge=2, le=5000), Usual(8, 900)] = 200
    """Speeds between both, evenly spaced; resonances get more."""
    root_stress_speeds: Annotated[tuple[Speed, ...], Effect(of_rig=False)] = ()
    """Speeds at which root stress and strain rate are shown over the rolling angle, in addition to the held stages."""
    response_period: Literal["mesh", "revolution", "hunting_cycle"] = "mesh"
    """What the periodic response repeats after. When left out: a mesh; in a loop whose meshes pass teeth at different
    rates a revolution of the pinion of ``torque_at``, or the hunting cycle where that ends on part of a tooth."""


# What `check --transient` adds to the schedule: warm-up, dwell, stops, and where temperatures are kept.

Event = Literal["cold_start", "emergency_stop", "oil_loss"]
HOUR = 3600.0


class TransientProbe(Part):
    """A place whose temperature is kept over time."""

    gearbox: Name
    """Gearbox in which the place is."""
    place: Text
    """Surface or body of its housing, named as the thermal model names them."""
    quantity: Literal["mean", "max", "min"] = "mean"
    """Mean, highest or lowest temperature of the place."""


class Transient(Part):
    """Thermal history of the schedule; every key has a default."""

    warm_up: Hours = 4.0 * HOUR
    """Oil on at standstill before the first stage."""
    dwell: Hours | None = None
    """Length of every held stage; the planned time of the test when left out."""
    oil_run_on: Time = 0.5 * HOUR
    """How long the oil runs on after the stop."""
    soak_back: Hours = 8.0 * HOUR
    """Standstill without oil after that."""
    stop_time: Time = 10.0
    """From full speed to standstill in an emergency."""
    oil_loss_time: Time = 10.0
    """Turning on without oil until the loss is noticed; the emergency stop follows."""
    events: tuple[Event, ...] = ("cold_start", "emergency_stop", "oil_loss")
    """Computed in addition to the schedule: the run without warm-up, and what may end the dwell."""
    still_film: HeatTransferCoefficient = 5.0
    """Least film of a shaft, gear or dry wall in air that hardly moves: free convection in a chamber."""
    settled_share: Annotated[float, Field(gt=0.0, lt=0.5)] = 0.05
    """A quantity is steady once it stays within this share of its whole change in the dwell."""
    tolerance: TemperatureDifference = 0.2
    """Most error of a time step."""
    probes: Mapping[Name, TransientProbe] = {}
    """Places in addition to the bodies, bearings and oil outlets that are always kept."""
