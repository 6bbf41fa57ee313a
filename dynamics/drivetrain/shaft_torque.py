"""Torques that alternate with the rotation of a shaft: ripple of the motor, couplings between axes out of line."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

WHOLE = 1e-6
"""How far an order may be from a whole number of waves per period."""


@dataclass(frozen=True, kw_only=True)
class ShaftTorque:
    """torque cos(order angle - phase): order per turn of its shaft, torque [N m], phase [rad].

    The angle is that of the uniform rotation, zero where the pinion of the first mesh passes zero.
    """

    order: float
    torque: float
    phase: float = 0.0

    def __post_init__(self) -> None:
        if not self.order > 0.0:
            raise DynamicsInputError(
                f"order = {self.order} of a torque must be above 0; a mean torque is none"
            )


@dataclass(frozen=True, kw_only=True)
class ShaftTorques:
    """All of one part.

    load : (n,) torque on each freedom per unit; dof : freedom whose angle counts
    """

    name: str
    load: Array
    dof: int
    parts: tuple[ShaftTorque, ...]

    def at(self, angle: Array) -> Array:
        """Torque over the angle of the shaft (n,) [rad] -> (n,) [N m]."""
        waves = (part.torque * np.cos(part.order * angle - part.phase) for part in self.parts)
        return np.asarray(sum(waves, np.zeros_like(angle)))


def waves_within(order: float, ratio: float, turns: float) -> int | None:
    """Waves of an order in ``turns`` of the reference, whose shaft turns ``ratio`` times as fast; None if no whole
    number: a response of that period cannot hold them."""
    waves = order * abs(ratio) * turns
    return round(waves) if abs(waves - round(waves)) < WHOLE * max(waves, 1.0) else None


def harmonic_loads(torques: Sequence[ShaftTorques], ratios: Array, turns: float) -> dict[int, Complex]:
    """Complex torque on all freedoms (n,) by harmonic of a period: the load is Re(value exp(i harmonic w t)).

    ratios : (n,) speed of each freedom per speed of the reference; turns : of the reference in the period. What does
    not fit the period is left out.
    """
    loads: dict[int, Complex] = {}
    for of_part in torques:
        for part in of_part.parts:
            harmonic = waves_within(part.order, float(ratios[of_part.dof]), turns)
            if harmonic:
                value = part.torque * np.exp(-1j * part.phase) * of_part.load
                loads[harmonic] = loads.get(harmonic, 0.0) + value
    return loads


def left_out(torques: Sequence[ShaftTorques], ratios: Array, turns: float) -> list[str]:
    """Names and orders that a period of so many turns of the reference cannot hold."""
    return [
        f"{of_part.name} order {part.order:g}"
        for of_part in torques
        for part in of_part.parts
        if waves_within(part.order, float(ratios[of_part.dof]), turns) is None
    ]
