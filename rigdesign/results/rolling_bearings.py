"""Rolling bearings at the held stages: SI records."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class RollingBearingRecord:
    """One rolling bearing at one held stage."""

    name: str
    """``gearbox.bearing``."""
    stage: str
    designation: str
    radial_load: float
    """[N]"""
    axial_load: float
    """Inside the bearing, the induced one included [N]."""
    speed: float
    """[rad/s]"""
    torques: tuple[float, float, float, float]
    """Rolling, sliding, seals, drag [N m]."""
    power: float
    """Friction by its law [W]."""
    temperature: float
    """Of rolling elements and lubricant [K]."""
    inner_ring: float
    """[K]"""
    outer_ring: float
    """[K]"""
    heat_to_shaft: float
    """[W]"""
    heat_to_housing: float
    """[W]"""
    clearance: float
    """Radial internal clearance as it runs, on the diameter; negative is preload [m]."""
    basic_life: float
    """L_10h [h]; infinite at rest."""
    modified_life: float
    """L_nmh [h]; infinite at rest."""
    static_safety: float
    viscosity_ratio: float
    speed_utilisation: float
    """Speed over the limiting speed."""
    minimum_load: float
    """[N]"""
    radial_stiffness: float
    """[N/m]"""
    axial_stiffness: float
    """[N/m]"""
    tilting_stiffness: float
    """In the plane of the radial load [N m/rad]."""
