"""What calibration froze: amplitudes, widening, thresholds and signature errors, with their origin.

Fitted by `rigdesign.diagnosis.calibration` to 76 healthy sets of the virtual rig: 36 of the prototype, 24 of the 1:1
loop and 16 of the loop with a hunting ratio, those with up to 700 numbers; dimensionless, so that they serve rigs that
nobody has simulated. Thresholds come from the development split.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

from rigdesign.diagnosis.amplitudes import Amplitudes
from rigdesign.diagnosis.baseline import Drift
from rigdesign.diagnosis.decision import Thresholds

AMPLITUDES = Amplitudes(
    constant_loss=1.95,
    constant_film=0.932,
    constant_oil=2.25,
    constant_loop=2.5,
    tooth=1.85,
    exponent=0.0798,
    link=0.625,
    link_speed=0.147,
    answer=0.375,
    source=0.00109,
    channel=0.00298,
    channel_speed=0.00072,
    point=0.00366,
    series_mean=0.000851,
    series_mesh=0.0567,
    series_mesh_point=0.451,
    series_shaft=0.0111,
    series_shaft_point=0.00915,
    frequency=0.0158,
    sensor=1.0,
    input=1.0,
)

WIDENING = {
    "bypass": 0.324,
    "shell_contact": 0.000255,
    "single_pitch": 3.42e-06,
    "seal_loss": 0.12,
    "bracing_drift": 0.000264,
    "weak_tooth": 0.0743,
    "bearing_film": 0.601,
    "spline_stiffness": 0.333,
    "windage_loss": 0.369,
    "motor_ripple": 0.00121,
    "not_steady": 8.81e-06,
    "jet_loss": 0.198,
    "leak_warm_cold": 0.00299,
    "inertia": 0.0545,
    "run_out": 2.37e-06,
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


PLAIN = Thresholds(evidence=10.0, evidence_loop=30.0)
"""Without a baseline; the evidence is more than healthy sets gave."""

GIVEN_BASELINE = Thresholds(evidence=6.0, evidence_loop=30.0)
"""With one."""

DRIFT = Drift(
    shared=0.00399,
    shaft=0.00162,
    mesh=0.17,
    amplitude=0.0394,
    widening={
        "coupling_stiffness": 0.0752,
        "coupling_damping": 0.453,
        "film.chamber_oil": 0.00144,
        "inertia": 0.0422,
        "spline_stiffness": 0.0405,
        "bearing_film": 0.0164,
        "film.gear_sides": 0.00712,
        "film.chamber_sump": 0.00593,
        "short_circuit": 0.002,
        "jet_loss": 0.00852,
        "single_pitch": 3.18e-08,
        "film.shaft_cold": 0.0152,
        "bracing_drift": 5.5e-07,
    },
)
"""Fitted to 80 pairs of healthy sets: 36 of the prototype, 28 of the 1:1 loop, 16 of the loop with a hunting ratio."""


@dataclass(frozen=True, kw_only=True)
class Calibration:
    """Everything a diagnosis takes from calibration."""

    amplitudes: Amplitudes = AMPLITUDES
    widening: Mapping[str, float] = field(default_factory=lambda: dict(WIDENING))
    """Likeness of an effect -> spread of its coordinate that healthy sets asked for beyond the columns."""
    plain: Thresholds = PLAIN
    """Without a baseline."""
    given_baseline: Thresholds = GIVEN_BASELINE
    signature_error: Mapping[str, float] = field(default_factory=lambda: dict(SIGNATURE_ERROR))
    drift: Drift = DRIFT
    """With a baseline."""


DEFAULT = Calibration()
