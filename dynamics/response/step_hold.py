"""What a torque gives to a mode within a step of the march, by its values at start and end of the step.

A mode ``z' = lambda z + b u`` goes over a step h by ``z_1 = exp(x) z_0 + h b ((phi_1 - a) u_0 + a u_1)`` with ``x =
lambda h``, and the integral of z by ``h^2 b ((phi_2 - t) u_0 + t u_1)`` beyond that of z_0. A constant torque is exact
for any ``a`` and ``t``; two pairs of them are used:

- the straight line between both values, ``a = phi_2`` and ``t = phi_3``: exact for slow inputs that are one, and
  passive for torques that brake. Of second order: a mesh spring that it holds swings too slowly by (omega h)^2 / 24.
- the method of Numerov on the matrix exponential, exact for a torque that is a parabola over two steps: of fourth order
  in the displacements, so that meshes see where their bodies are. It uses both ends of a step alike, so that a step
  back in time undoes a step forward and an undamped vibration on mesh springs neither grows nor decays, which no
  polynomial through earlier values offers.

Sources: phi_k as in exponential integrators (Hochbruck and Ostermann, Acta Numerica 19, 2010); Numerov's method and
its exponential fitting: Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, III.10; time-symmetric
steps: Hairer, Lubich and Wanner, Geometric Numerical Integration, XI and XIII.
"""

from math import factorial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

ComplexArray = NDArray[np.complex128]

FASTEST = 1.5
"""Modulus of x up to which a mode follows the torques of the meshes by Numerov's method; faster ones, which follow
almost at once, take the straight line."""
TERMS = 12
"""Terms of the series in x^2, which end far below rounding within `FASTEST`."""


class HeldInput(NamedTuple):
    """Weights (n_modes,) of the torque at the end of a step.

    state : a, of the mode at the end of the step; turn : t, of its integral over the step
    """

    state: ComplexArray
    turn: ComplexArray


def straight_line(x: ComplexArray) -> HeldInput:
    """Hold of an input that is linear between start and end of the step; x : (n_modes,) poles times step."""
    return HeldInput(phi(2, x), phi(3, x))


def numerov(x: ComplexArray) -> HeldInput:
    """Hold of the torques of the meshes; x : (n_modes,) poles times step."""
    line = straight_line(x)
    slow = np.abs(x) <= FASTEST
    y = np.where(slow, x, 0.0)
    outer = _even(y, [2.0 / factorial(2 * k + 4) for k in range(TERMS)])
    sinhc = _even(y, [1.0 / factorial(2 * k + 1) for k in range(TERMS)])
    # (cosh y - 1) / y^2, and the difference of that and half of sinhc, over y^2 as well
    bowed = _even(y, [1.0 / factorial(2 * k + 2) for k in range(TERMS)])
    apart = _even(y, [1.0 / factorial(2 * k + 4) - 0.5 / factorial(2 * k + 3) for k in range(TERMS)])
    turn = outer + y * (bowed * outer + apart) / sinhc
    return HeldInput(np.where(slow, 0.5 + y * turn, line.state), np.where(slow, turn, line.turn))


def _even(x: ComplexArray, coefficients: list[float]) -> ComplexArray:
    """Sum of coefficients times x^0, x^2, x^4, ..."""
    return np.asarray(np.polynomial.polynomial.polyval(x * x, coefficients))


def phi(k: int, x: ComplexArray) -> ComplexArray:
    """Return phi_k(x) = sum_j x^j / (j + k)!, by series near zero and by recursion elsewhere."""
    small = np.abs(x) < 0.5
    near = np.where(small, x, 0.0)
    series = np.zeros_like(near)
    for j in range(18, -1, -1):
        series = series * near + 1.0 / factorial(j + k)
    far = np.where(small, 1.0, x)
    value = np.exp(far)
    for j in range(k):
        value = (value - 1.0 / factorial(j)) / far
    return np.where(small, series, value)
