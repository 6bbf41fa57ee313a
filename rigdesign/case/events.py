"""Events that a rig has to survive: loss of teeth, emergency stop, overspeed; each kind is a table of its own."""

from typing import Annotated, Literal, TypeAlias

from pydantic import Field, Tag, model_validator

from rigdesign.case.fields import (
    Force,
    Part,
    Share,
    Speed,
    Text,
    Time,
    Torque,
    Usual,
    Velocity,
    fault,
    kind_from,
)


class EventLoadLimits(Part):
    """Load limits of parts in an event."""

    coupling_torque_maximum: Annotated[Torque, Usual(0.5, 15.0, "test torque")] | None = None
    """Highest torque that the couplings and their flanges may carry."""
    shaft_torque_maximum: Annotated[Torque, Usual(0.5, 15.0, "test torque")] | None = None
    """Highest torque that a section of a shaft may carry."""
    bearing_force_maximum: Annotated[Force, Usual(0.1, 15.0, "tooth force")] | None = None
    """Highest radial force that a bearing may carry."""


class LoadedEvent(EventLoadLimits):
    """What every event on the ramp states."""

    speed: Annotated[Speed, Usual(0.15, 1.6, "test speed")] | None = None
    """Speed at which it happens, counted as that of the test; the test speed when left out."""
    torque: Annotated[Torque, Usual(0.15, 2.0, "test torque")] | None = None
    """Torque under which it happens, counted as that of the test; the test torque when left out."""


class ToothLoss(LoadedEvent):
    """One or two adjacent teeth of a gear break off under load."""

    kind: Literal["tooth_loss"]
    """Selects the loss of teeth."""
    mesh: Text
    """``gearbox.mesh`` in which the teeth carry when they break."""
    gear: Literal["pinion", "wheel"] = "pinion"
    """Gear of the mesh that loses them."""
    teeth: Literal[1, 2] = 1
    """Adjacent teeth that are lost."""
    monitor: Text | None = None
    """Path of the monitored part, a coupling (``trip_torque``) or a bearing (``trip_velocity``)."""
    trip_torque: Annotated[Torque, Usual(0.15, 6.0, "test torque")] | None = None
    """Absolute torque in the monitored coupling that stops the rig."""
    trip_velocity: Velocity | None = None
    """Lateral velocity of the journal in the monitored bearing that stops the rig."""
    trip_delay: Annotated[Time, Usual("0.6 ms", "45 ms")] = 0.01
    """From the crossing of that limit until the motor is off and the brake begins."""
    brake_torque: Annotated[Torque, Usual(0.005, 1.0, "test torque")] = 0.0
    """Torque of motor or brake against the rotation, after the trip."""
    duration: Time = 0.03
    """Time computed after the loss; the gap comes into mesh once in every turn."""
    trip_time_maximum: Annotated[Time, Usual("0.7 ms", "50 ms")] | None = None
    """Longest time from the loss until the limit is crossed."""

    @model_validator(mode="after")
    def _one_limit(self) -> "ToothLoss":
        limits = [self.trip_torque, self.trip_velocity]
        if self.monitor is not None and sum(limit is not None for limit in limits) != 1:
            raise fault("monitor is given without one limit", "give trip_torque or trip_velocity")
        if self.monitor is None and any(limit is not None for limit in (*limits, self.trip_time_maximum)):
            raise fault(
                "a limit of a trip is given without a monitor", "name the monitored coupling or bearing"
            )
        return self


class EmergencyStop(LoadedEvent):
    """The motor brakes the rig to standstill under the braced torque."""

    kind: Literal["emergency_stop"]
    """Selects the emergency stop."""
    brake_torque: Annotated[Torque, Usual(0.005, 1.0, "test torque")] | None = None
    """Torque of motor or brake against the rotation; or state ``stop_time``."""
    stop_time: Time | None = None
    """Time to standstill, from which the brake torque follows; or state ``brake_torque``."""
    brake_onset: Time = 0.02
    """Time in which the brake torque rises."""
    duration: Time = 0.1
    """Time computed from the stop on."""
    standstill_time_maximum: Annotated[Time, Usual("0.6 s", "45 s")] | None = None
    """Longest time to standstill."""

    @model_validator(mode="after")
    def _one_brake(self) -> "EmergencyStop":
        if (self.brake_torque is None) == (self.stop_time is None):
            raise fault("brake_torque and stop_time are both given or both missing", "state one of the two")
        return self


class Overspeed(EventLoadLimits):
    """The rig runs faster than the schedule, under the test torque."""

    kind: Literal["overspeed"]
    """Selects the overspeed."""
    speed: Annotated[Speed, Usual(1.0, 1.6, "test speed")]
    """Speed it reaches, counted as that of the test."""
    torque: Torque | None = None
    """Torque under which it runs; the test torque when left out."""
    dynamic_factor_maximum: Annotated[float, Field(gt=1.0), Usual(1.02, 4.0)] | None = None
    """K_V at this speed, max over mean, at most."""
    resonance_distance_minimum: Annotated[Share, Usual(0.003, 0.6)] | None = None
    """Distance from the nearest resonance, as a share of this speed, at least."""


Event: TypeAlias = Annotated[
    Annotated[ToothLoss, Tag("tooth_loss")]
    | Annotated[EmergencyStop, Tag("emergency_stop")]
    | Annotated[Overspeed, Tag("overspeed")],
    kind_from("kind", ""),
]
