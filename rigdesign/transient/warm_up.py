"""Warm-up that a gearbox needs before full torque."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Soak:
    """Warm-up a gearbox needs before it may run up to full torque."""

    gearbox: str
    stage: str
    soak_time_s: float | None
    """Shortest warm-up after which every clearance limit holds up to the end of the dwell; None if none does."""
    reason: str
