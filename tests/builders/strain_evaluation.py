"""From the recorded bridge output over time to the stress over the rolling angle, and what the low-pass kept back."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.strain_gauge.low_pass import LowPass
from rigdesign.strain_gauge.measuring_point import MeasuringPoint, StrainRecord
from rigdesign.strain_gauge.turn_average import AngleGrid, RollingAngle, TurnCurve, turn_average
from tests.builders.strain_zero import UnloadedAngles, ZeroReadings

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Evaluation:
    """How a record is evaluated.

    Parameters
    ----------
    grid : angles of the curve
    low_pass : of the channel, whose delay is taken back; None: no delay
    zero : where the zero comes from; None: the bridge's own
    temperature : of gauge and root, one of the record [K]; None: thermal output is not corrected
    """

    grid: AngleGrid
    low_pass: LowPass | None = None
    zero: ZeroReadings | UnloadedAngles | None = None
    temperature: float | None = None


def stress_over_angle(
    record: StrainRecord, point: MeasuringPoint, angle: RollingAngle, evaluation: Evaluation
) -> TurnCurve:
    """Stress along the fillet [Pa] over the rolling angle of a turn.

    A sample belongs to the angle at its time less the delay of the low-pass at rest, at any speed. What amplitude
    the low-pass keeps back is not given back: `passed_harmonics`, `lost_in_low_pass` state it.

    Raises
    ------
    MeasurementError
        An output that no strain gives; see `turn_average`, `UnloadedAngles.readings`.
    """
    delay = 0.0 if evaluation.low_pass is None else evaluation.low_pass.delay
    angles = angle(record.time - delay)
    zero = evaluation.zero
    if isinstance(zero, UnloadedAngles):
        zero = zero.readings(record.time, angles, record.ratio)
    offset = None if zero is None else zero.at(record.time)
    stress = point.stress(record.ratio, offset, evaluation.temperature)
    return turn_average(angles, stress, evaluation.grid)


@dataclass(frozen=True)
class PassedHarmonic:
    """What a low-pass leaves of one harmonic of the mesh after its delay at rest has been taken back.

    order : of the tooth mesh; frequency : [Hz]; amplitude : share that remains [-]
    angle_error : rolling angle by which it still comes late [rad]
    """

    order: int
    frequency: float
    amplitude: float
    angle_error: float


def passed_harmonics(
    low_pass: LowPass, speed: float, teeth: int, orders: Sequence[int]
) -> tuple[PassedHarmonic, ...]:
    """Residual amplitude and angle of harmonics of the tooth mesh at a speed [rad/s] of the gear."""
    found = []
    for order in orders:
        frequency = order * teeth * speed / (2.0 * np.pi)
        gain = complex(low_pass.gain(frequency) * np.exp(2j * np.pi * frequency * low_pass.delay))
        late = -float(np.angle(gain)) / (order * teeth)
        found.append(PassedHarmonic(order, frequency, abs(gain), late))
    return tuple(found)


def lost_in_low_pass(stress: Array, low_pass: LowPass, speed: float) -> Array:
    """(m,) by which the recorded curve differs from the true one at constant speed, its delay taken back [Pa].

    Parameters
    ----------
    stress : (m,) true (or, to first order, recorded) stress, evenly over one whole turn [Pa]
    speed : [rad/s]
    """
    orders = np.arange(len(stress) // 2 + 1)
    frequency = np.asarray(orders * speed / (2.0 * np.pi), dtype=float)
    gain = low_pass.gain(frequency) * np.exp(2j * np.pi * frequency * low_pass.delay)
    return np.asarray(np.fft.irfft(np.fft.rfft(stress) * (gain - 1.0), len(stress)))
