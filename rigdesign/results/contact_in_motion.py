"""Contact of the teeth in motion: shares of the pairs and where contact is lost, SI records."""

from dataclasses import dataclass

Row = tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class PairShare:
    """Force on one tooth pair over the way through the mesh at a held stage."""

    mesh: str
    stage: str
    angle: Row
    """(n,) rolling angle of the pinion, zero at the pitch point [rad]."""
    share: Row
    """(n,) of the force of the mesh at that moment, in motion [-]."""
    static_share: Row
    """(n,) at rest [-]"""
    force: Row
    """(n,) over the mean force of the mesh, in motion [-]."""
    most_loaded: float
    """Rolling angle at which a pair carries most, in motion [rad]."""
    face: Row
    """(m,) position of the slices from mid-face [m]; empty for a mesh of one slice, as the line loads."""
    line_load: Row
    """(m,) force in the transverse line of action per face width there, in motion [N/m]."""
    static_line_load: Row
    """(m,) at rest, at the same place on the path [N/m]."""


@dataclass(frozen=True, kw_only=True)
class ContactLossMap:
    """Least torque of a mesh over its mean on a grid of speed and torque; None where no stable response
    that repeats in every mesh was found."""

    mesh: str
    speed: Row
    """(s,) of the pinion of the mesh [rad/s]"""
    torque: Row
    """(t,) stated [N m]"""
    least_share: tuple[tuple[float | None, ...], ...]
    """(t, s) [-]; 0 or less where contact is lost."""
    lift_off: tuple[tuple[float | None, ...], ...]
    """(t, s) share of the time without contact [-]."""
    unstable: tuple[tuple[bool, ...], ...]
    """(t, s) True where the response that repeats in every mesh loses contact and does not last."""
