"""Contact of the teeth in motion: shares of the pairs, SI records."""

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
