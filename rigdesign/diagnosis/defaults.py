"""What calibration froze: amplitudes, widening, thresholds and signature errors, with their origin.

Fitted by `rigdesign.diagnosis.calibration` to 76 healthy sets of the virtual rig: 36 of the prototype, 24 of the 1:1
loop and 16 of the loop with a hunting ratio, those with up to 700 numbers; dimensionless, so that they serve rigs that
nobody has simulated.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

from rigdesign.diagnosis.amplitudes import Amplitudes
from rigdesign.diagnosis.decision import Thresholds

AMPLITUDES = Amplitudes(
    constant_loss=1.88,
    constant_film=1.2,
    constant_oil=2.55,
    constant_loop=5.41,
    tooth=1.99,
    exponent=0.0874,
    link=1.06,
    link_speed=0.152,
    source=0.00477,
    channel=0.00564,
    channel_speed=0.000437,
    point=0.0044,
    series_mean=0.000706,
    series_mesh=0.0211,
    series_mesh_point=0.443,
    series_shaft=0.0792,
    series_shaft_point=0.0132,
    frequency=0.0504,
    sensor=1.0,
    input=1.0,
)

WIDENING = {
    "shell_contact": 0.000419,
    "single_pitch": 4.17e-05,
    "seal_loss": 0.176,
    "bypass": 1.22,
    "motor_ripple": 0.0789,
    "bracing_drift": 0.000301,
    "weak_tooth": 0.181,
    "squeeze_loss": 4.85,
    "short_circuit": 0.846,
    "leak_warm_cold": 0.00515,
    "mesh_damping": 2.48,
    "bearing_film": 0.879,
    "inertia": 0.217,
    "windage_loss": 0.446,
    "run_out": 2.72e-06,
    "coupling_stiffness": 0.122,
    "spline_stiffness": 0.0276,
}
"""Spread of a coordinate beyond the columns, by likeness of the effect."""

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

    amplitudes: Amplitudes = AMPLITUDES
    widening: Mapping[str, float] = field(default_factory=lambda: dict(WIDENING))
    """Likeness of an effect -> spread of its coordinate that healthy sets asked for beyond the columns."""
    thresholds: Thresholds = field(default_factory=Thresholds)
    signature_error: Mapping[str, float] = field(default_factory=lambda: dict(SIGNATURE_ERROR))
    drift: float = 0.02
    """With a baseline: share of the shared errors that changes between the sets."""
    drift_shaft: float = 0.05
    """The same of shaft orders and sidebands, from point to point."""
    drift_mesh: float = 0.25
    """The same of the orders of the meshes."""


DEFAULT = Calibration()
