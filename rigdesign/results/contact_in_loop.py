"""K_V of a mesh with its contact solved in the loop, against that of the contact tables, SI records."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class ContactInLoop:
    """At fidelity reference, of all places; empty below it, for analytic teeth and shafts that only twist."""

    meshes: tuple["LoopedContact", ...] = ()
    missing: tuple[str, ...] = ()
    """Places without a comparison, each with its reason."""


@dataclass(frozen=True, kw_only=True)
class LoopedContact:
    """One mesh at a held stage or at the peak of its K_V over speed; all teeth alike, no loads once a turn.

    speed : of the pinion of the mesh [rad/s]; torque : mean, at its pinion, contact in the loop [N m]
    """

    mesh: str
    stage: str
    """Empty for a peak of K_V over speed."""
    peak: bool
    """Whether it is the highest K_V of this mesh over speed."""
    stated: tuple[float, float]
    """Speed [rad/s] and torque [N m] as the schedule states them."""
    speed: float
    torque: float
    dynamic_factor: float
    dynamic_factor_by_table: float
    least_share: float
    """Least over mean torque, contact in the loop [-]."""
    least_share_by_table: float
    other_flank: float
    """Largest force of the flank that does not carry, over the mean [-]."""
    apart: float
    """Share of the time without contact [-]."""
    tilt: float
    """Of the gears against each other about their mean, peak to peak [rad]."""
    still_changing: float
    """Estimated remaining change of K_V when the march ended [-]."""
    settled: bool
    time: float
    """That was marched [s]."""
    unconverged: int
    """Steps whose contacts were not solved to their tolerance."""

    @property
    def shift(self) -> float:
        """K_V in the loop less that by the contact table [-]."""
        return self.dynamic_factor - self.dynamic_factor_by_table

    @property
    def least_shift(self) -> float:
        """The same of the least share [-]."""
        return self.least_share - self.least_share_by_table
