"""What a sensor and its logger let through."""

import cmath
import math

from rigdesign.measurement.reading.document import Transfer
from rigdesign.strain_gauge.low_pass import LowPass


def gain(transfer: Transfer, angular_frequency: float) -> complex:
    """Complex gain of a Butterworth low-pass and a delay at ``angular_frequency`` [rad/s].

    With signals as Re(X exp(i omega t)).
    """
    low_pass = LowPass("butterworth", transfer.poles, transfer.frequency)
    delay = cmath.exp(-1j * angular_frequency * transfer.delay)
    return delay * complex(low_pass.gain(angular_frequency / (2.0 * math.pi)))
