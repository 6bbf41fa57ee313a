"""The power lost at one place of the rig, of any kind."""

from dataclasses import dataclass, field

from dynamics.errors import DynamicsInputError


class LossError(DynamicsInputError):
    """Impossible input of a loss; the message names value, limit and remedy."""


RIVAL_LAW, RIVAL_POWER = "rival_law", "rival_power"
"""Among the details of a loss: the published law that differs most from the one taken, and what it gives [W]."""


@dataclass(frozen=True, kw_only=True)
class Loss:
    """Power lost at one place of the rig."""

    place: str
    """Name in the rig: ``test/mesh``, ``test/pinion shaft/bearing A`` ..."""
    kind: str
    """mesh, bearing, windage, churning, oil_acceleration, squeeze, seal."""
    power: float
    """[W]"""
    details: dict[str, float | str] = field(default_factory=dict)
    """Numbers behind it, SI, by field name, with the source under ``source``."""
    warnings: tuple[str, ...] = ()
