"""At which speeds a rig may dwell, and the ramp that follows: SI records. Speeds are those of the first pinion."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

ResonanceKind = Literal["dynamic factor", "root stress", "shaft torque", "shaft order"]


def nearer(peak: float, margin: float) -> tuple[float, float]:
    """Speeds between which a peak is nearer than a margin, a share of the speed [rad/s]."""
    return peak / (1.0 + margin), peak / (1.0 - margin) if margin < 1.0 else math.inf


@dataclass(frozen=True, kw_only=True)
class AvoidedResonance:
    """Speeds around one peak of the response, or a crossing of a shaft order with a mode.

    low, high : between which a speed is nearer than the margin (`nearer`), or the response itself above the share
    """

    kind: ResonanceKind
    where: str
    """Gearbox, gear, place of a torque, or mode."""
    mode: str = ""
    """What vibrates, of a peak of a mesh."""
    speed: float
    """Of the peak [rad/s]."""
    share: float | None
    """Dynamic part over the mean there [-]; None of a crossing, whose response is not computed."""
    low: float
    """[rad/s]"""
    high: float
    """[rad/s]"""

    def widened(self, margin: float) -> "AvoidedResonance":
        """With the speeds round the peak that are nearer than a margin."""
        low, high = nearer(self.speed, margin)
        return replace(self, low=min(self.low, low), high=max(self.high, high))

    def distance(self, speed: float, margin: float) -> float:
        """Of a speed from the peak, as a share of that speed [-]; 0 in the band beyond the margin, where the response
        itself is above the stated share. Below the margin just where the speed is in the band."""
        away = abs(speed - self.speed) / speed
        return 0.0 if away >= margin and self.low < speed < self.high else away


@dataclass(frozen=True, kw_only=True)
class NearResonance:
    """The resonance nearest to a dwell."""

    distance: float
    """As a share of the speed of the dwell; the range searched where none is near [-]."""
    resonance: AvoidedResonance | None


@dataclass(frozen=True, kw_only=True)
class AvoidedBand:
    """Resonances whose bands touch."""

    low: float
    """[rad/s]"""
    high: float
    """[rad/s]"""
    resonances: tuple[AvoidedResonance, ...]


@dataclass(frozen=True, kw_only=True)
class DwellStage:
    """A stage of the schedule that turns at one speed, or is held at its end."""

    stage: str
    kind: str
    speed: float
    """[rad/s]"""
    computed: bool
    """Whether the response is known at its speed."""
    near: NearResonance | None
    """None where it is not known."""
    band: AvoidedBand | None
    """In which it lies."""
    nearest_safe: float | None
    """Nearest safe speed within the limit of the rig for a stage in a band [rad/s]; None where there is none."""
    above_limit: bool
    """Whether it turns faster than the rig may."""
    loses_contact: bool
    """Whether contact is lost at its speed under the start torque, with which it begins or ends."""


@dataclass(frozen=True, kw_only=True)
class RampStep:
    """One step of the recommended ramp."""

    action: str
    speed: float
    """At its end [rad/s]."""
    torque: float
    """Stated, at its end [N m]."""
    reason: str


@dataclass(frozen=True, kw_only=True)
class DwellRecord:
    """Bands to avoid between two speeds, what is left, the stages of the case and the recommended ramp."""

    share_limit: float
    """Of meshes and root stress [-]."""
    shaft_share_limit: float
    """Of the torque in shafts and joints [-]."""
    margin: float
    low: float
    """[rad/s]"""
    high: float
    """[rad/s]"""
    speed_limit: float | None
    """Of the rig [rad/s]; None where the case states none."""
    speed_limit_source: str
    """Key that states it."""
    bands: tuple[AvoidedBand, ...]
    safe: tuple[tuple[float, float], ...]
    """Within the limit of the rig [rad/s]."""
    stages: tuple[DwellStage, ...]
    ramp: tuple[RampStep, ...]
    speeds: tuple[float, ...]
    """(s,) [rad/s]"""
    highest: Mapping[ResonanceKind, tuple[float, ...]]
    """(s,) largest share of all quantities of a kind [-]."""
