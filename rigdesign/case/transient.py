"""What `check --transient` adds to the schedule: warm-up, dwell, stops, and where temperatures are kept."""

from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import Field

from rigdesign.case.fields import (
    HeatTransferCoefficient,
    Hours,
    Name,
    Part,
    TemperatureDifference,
    Text,
    Time,
)

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
