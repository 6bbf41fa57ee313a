"""What calibration froze: amplitudes, widening, thresholds and signature errors, with their origin.

Fitted by `rigdesign.diagnosis.calibration` to 76 healthy sets of the virtual rig: 36 of the prototype, 24 of the 1:1
loop and 16 of the loop with a hunting ratio, those with up to 700 numbers; dimensionless, so that they serve rigs that
nobody has simulated. Those of the loops predate the virtual rig's torque of eccentric gears and are to be fitted anew;
how they transfer from rig to rig is not measured yet. Drifts and thresholds come from the development split.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

from rigdesign.diagnosis.amplitudes import Amplitudes
from rigdesign.diagnosis.decision import Thresholds

AMPLITUDES = Amplitudes(
    constant_loss=1.87,
    constant_film=1.62,
    constant_oil=2.5,
    constant_loop=2.5,
    tooth=1.97,
    exponent=0.0862,
    link=0.625,
    link_speed=0.152,
    source=0.00504,
    channel=0.00558,
    channel_speed=0.000437,
    point=0.00442,
    series_mean=0.000708,
    series_mesh=0.0424,
    series_mesh_point=0.445,
    series_shaft=0.0792,
    series_shaft_point=0.0132,
    frequency=0.034,
    sensor=1.0,
    input=1.0,
)

WIDENING = {
    "shell_contact": 0.000384,
    "single_pitch": 4e-05,
    "seal_loss": 0.181,
    "bypass": 1.18,
    "bracing_drift": 0.000321,
    "motor_ripple": 0.0791,
    "weak_tooth": 0.182,
    "squeeze_loss": 4.99,
    "inertia": 0.26,
    "bearing_film": 1.08,
    "leak_warm_cold": 0.00565,
    "spline_stiffness": 0.428,
    "short_circuit": 0.593,
    "windage_loss": 0.45,
    "mesh_damping": 1.57,
    "run_out": 2.88e-06,
    "film.cold_oil": 0.176,
}
"""Spread of a coordinate beyond the columns, by likeness of the effect."""

SIGNATURE_ERROR = {
    "": 0.15,
    "film": 0.25,
    "ambient_film": 0.25,
    "bearing_film": 0.25,
    "emissivity": 0.25,
    "shell_contact": 0.35,
    "foot_contact": 0.35,
    "windage_loss": 0.25,
    "loss_split": 0.25,
    "run_out": 0.04,
    "cumulative_pitch": 0.04,
    "motor_ripple": 0.04,
    "coupling_order_2": 0.04,
}
"""Kind of effect -> relative error of the model's answer to it: how far the traces of 22 effects of the heat, and of
run-out, ripple and coupling torques, lie from those of the virtual rig with nominal constants."""


EVIDENCE_PLAIN = 30.0
"""More than any healthy set of the prototype gave without a baseline."""


@dataclass(frozen=True, kw_only=True)
class Calibration:
    """Everything a diagnosis takes from calibration."""

    amplitudes: Amplitudes = AMPLITUDES
    widening: Mapping[str, float] = field(default_factory=lambda: dict(WIDENING))
    """Likeness of an effect -> spread of its coordinate that healthy sets asked for beyond the columns."""
    thresholds: Thresholds = field(default_factory=Thresholds)
    evidence_plain: float = EVIDENCE_PLAIN
    """Without a baseline: logarithm of the Bayes factor that a name needs (`Thresholds.evidence`)."""
    signature_error: Mapping[str, float] = field(default_factory=lambda: dict(SIGNATURE_ERROR))
    drift: float = 0.03
    """With a baseline: share of the shared errors that changes between the sets."""
    drift_shaft: float = 0.05
    """The same of shaft orders and sidebands, from point to point."""
    drift_mesh: float = 0.25
    """The same of the orders of the meshes."""


DEFAULT = Calibration()
