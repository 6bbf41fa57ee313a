"""What a sensor and its logger let through."""

import cmath
import math

from rigdesign.measurement.reading.document import Transfer


def gain(transfer: Transfer, angular_frequency: float) -> complex:
    """Complex gain of a Butterworth low-pass and a delay at ``angular_frequency`` [rad/s].

    With signals as Re(X exp(i omega t)); poles at exp(i pi (2k + n - 1) / (2n)) of the corner frequency
    (Butterworth 1930).
    """
    n = transfer.poles
    s = 1j * angular_frequency / (2.0 * math.pi * transfer.frequency)
    response = cmath.exp(-1j * angular_frequency * transfer.delay)
    for k in range(1, n + 1):
        response /= s - cmath.exp(1j * math.pi * (2 * k + n - 1) / (2 * n))
    return response if n % 2 == 0 else response * _odd_sign(n)


def _odd_sign(n: int) -> complex:
    """Product of the negated poles, which makes the gain 1 at rest."""
    product = 1.0 + 0.0j
    for k in range(1, n + 1):
        product *= -cmath.exp(1j * math.pi * (2 * k + n - 1) / (2 * n))
    return product
