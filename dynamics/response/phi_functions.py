"""Functions phi_k of exponential integrators: integrals of an exponential with powers of time.

phi_1(x) = (e^x - 1) / x, phi_(k+1)(x) = (phi_k(x) - 1 / k!) / x.
Source: Hochbruck and Ostermann, Acta Numerica 19 (2010) 209, section 2.1.
"""

from math import factorial

import numpy as np
from numpy.typing import NDArray

Complex = NDArray[np.complex128]

NEAR = 0.5
"""Arguments below which the series is summed: the recurrence loses digits there."""
TERMS = 18


def phi_functions(x: Complex) -> tuple[Complex, Complex, Complex]:
    """Return phi_1, phi_2 and phi_3 of complex arguments (n,)."""
    small = np.abs(x) < NEAR
    safe = np.where(small, 1.0, x)
    found = []
    last = np.exp(safe)
    for k in (1, 2, 3):
        last = (last - 1.0 / factorial(k - 1)) / safe
        series = sum(x**n / factorial(n + k) for n in range(TERMS))
        found.append(np.where(small, series, last))
    return found[0], found[1], found[2]
