"""What calibration froze: amplitudes, widening, thresholds and signature errors, with their origin.

Fitted by `rigdesign.diagnosis.calibration` to 52 healthy sets of the virtual rig: 36 of the prototype, 16 of the
1:1 loop with few sensors; dimensionless, so that they serve rigs that nobody has simulated. How they transfer from
one rig to another is not measured yet, nor are the thresholds tuned: they are those of the workflow's design.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

from rigdesign.diagnosis.amplitudes import Amplitudes
from rigdesign.diagnosis.decision import Thresholds

AMPLITUDES = Amplitudes(
    constant_loss=2.57,
    constant_film=2.57,
    constant_oil=2.57,
    constant_loop=2.57,
    tooth=1.5,
    exponent=0.157,
    link=0.609,
    link_speed=0.141,
    source=0.00208,
    channel=0.00668,
    channel_speed=0.000635,
    point=0.0107,
    series_mean=0.00143,
    series_mesh=0.0323,
    series_mesh_point=0.503,
    series_shaft=0.053,
    series_shaft_point=0.0122,
    frequency=0.0422,
    sensor=1.0,
    input=1.0,
)

WIDENING = {
    "short_circuit": 0.871,
    "film.shaft_warm": 2.81,
    "single_pitch": 1.97e-05,
    "weak_tooth": 0.183,
    "shell_contact": 0.000544,
    "film.gear_sides": 1.63,
    "motor_ripple": 0.0376,
    "film.shaft_cold": 5.89,
    "seal_loss": 0.16,
    "squeeze_loss": 5.57,
    "bracing_drift": 0.000573,
    "inertia": 0.23,
    "film.cold_oil": 0.743,
    "jet_loss": 0.426,
    "run_out": 4.91e-06,
    "profile_slope": 1.52e-06,
    "bypass": 0.106,
    "spline_stiffness": 0.129,
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


DEFAULT = Calibration()
