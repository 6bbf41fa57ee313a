"""What calibration froze: amplitudes, widening, thresholds and signature errors, with their origin.

Fitted to healthy sets of the virtual rig (tests/virtual_rig) on three rigs; dimensionless, so that they serve rigs
that nobody has simulated. `tests/virtual_rig/README.md` says how they were made and how they transfer.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

from rigdesign.diagnosis.amplitudes import Amplitudes
from rigdesign.diagnosis.decision import Thresholds

SIGNATURE_ERROR = {
    "": 0.15,
    "film": 0.25,
    "ambient_film": 0.25,
    "bearing_film": 0.25,
    "emissivity": 0.25,
    "shell_contact": 0.25,
    "foot_contact": 0.25,
    "loss_split": 0.25,
    "run_out": 0.04,
    "cumulative_pitch": 0.04,
    "motor_ripple": 0.04,
    "coupling_order_2": 0.04,
}
"""Kind of effect -> relative error of the model's answer to it."""


@dataclass(frozen=True, kw_only=True)
class Calibration:
    """Everything a diagnosis takes from calibration."""

    amplitudes: Amplitudes = field(default_factory=Amplitudes)
    widening: Mapping[str, float] = field(default_factory=dict)
    """Likeness of an effect -> spread of its coordinate that healthy sets asked for beyond the columns."""
    thresholds: Thresholds = field(default_factory=Thresholds)
    signature_error: Mapping[str, float] = field(default_factory=lambda: dict(SIGNATURE_ERROR))
    response_error: float = 0.2
    """With a baseline: share of an observed change by which the model may answer wrongly."""
    drift: float = 0.02
    """With a baseline: share of the shared errors that changes between the sets."""


DEFAULT = Calibration()
