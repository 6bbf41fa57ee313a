"""Root stress in motion over the rolling angle, with its strain rate: SI record."""

from dataclasses import dataclass

from rigdesign.results.stress_source import StressSource

Curve = tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class DynamicRootCurve:
    """Stress at one place of a root at one speed, dynamic and quasi-static, over the way through the mesh."""

    mesh: str
    """Its label."""
    gear: str
    """``pinion`` or ``wheel``."""
    gauge: str
    """Name of the strain gauge; empty for the point of fillet and face that is stressed most."""
    stage: str
    """Held stage; empty for a speed that the case asks for."""
    in_motion: bool
    """False where no periodic response was found at an asked speed: the dynamic stress is then the quasi-static one."""
    speed: float
    """Of the gear [rad/s]."""
    pinion_speed: float
    """Of the pinion of the mesh [rad/s]."""
    angle: Curve
    """(n,) rolling angle of the gear, zero at the pitch point, growing towards its tip [rad]."""
    dynamic: Curve
    """(n,) [Pa]"""
    quasi_static: Curve
    """(n,) [Pa]"""
    strain: Curve
    """(n,) of the dynamic stress [-]"""
    strain_rate: Curve
    """(n,) [1/s]"""
    source: StressSource

    @property
    def ratio(self) -> float:
        """Highest dynamic over highest quasi-static stress [-]."""
        return max(self.dynamic) / max(self.quasi_static)

    @property
    def highest_rate(self) -> float:
        """Largest strain rate, whichever its sign [1/s]."""
        return max(self.strain_rate, key=abs)


@dataclass(frozen=True, kw_only=True)
class MissingRootSpeed:
    """A speed asked for at which no periodic response was found; its curves are quasi-static."""

    speed: float
    """Stated [rad/s]."""
    reason: str


@dataclass(frozen=True, kw_only=True)
class DynamicRootRecord:
    """All curves, and the speeds that are missing."""

    curves: tuple[DynamicRootCurve, ...]
    missing: tuple[MissingRootSpeed, ...]
