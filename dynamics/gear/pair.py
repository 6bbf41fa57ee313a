"""A cylindrical gear pair that can mesh."""

from dataclasses import dataclass

from dynamics.gear import limits
from dynamics.gear.involute import GearGeometryError
from dynamics.gear.pair_geometry import PairGeometry


@dataclass(frozen=True, kw_only=True)
class GearPair(PairGeometry):
    """Two external cylindrical gears in mesh; fields and geometry are those of :class:`PairGeometry`.

    A pair at its reference temperature that cannot mesh raises :class:`GearGeometryError`; an expanded one only if it
    has no contact at all, so that a lost tip clearance or backlash shows as a number.
    """

    def __post_init__(self) -> None:
        limits.require_sizes(self)
        if self.expansion == (0.0, 0.0):
            limits.require_meshing(self)
        elif not self.path.length > 0.0:
            raise GearGeometryError(
                f"path of contact = {1e3 * self.path.length:.4f} mm of the warm pair must be positive; "
                "the gears have moved out of mesh: check temperatures and centre distance"
            )

    @property
    def warnings(self) -> tuple[str, ...]:
        """What makes the pair unusual without making it impossible: name, value, limit, remedy."""
        return limits.unusual(self)
