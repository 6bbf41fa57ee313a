"""Loads that alternate with the rotation of a shaft: ripple of a motor, couplings out of line, unbalance, bow, run-out.

One that turns with its shaft across the axis, a force or a moment, is two of them on one freedom each: its cosine and
its sine (`rotating_load`).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

WHOLE = 1e-6
"""How far an order may be from a whole number of waves per period."""


@dataclass(frozen=True, kw_only=True)
class LoadOrder:
    """amplitude speed^speed_power cos(order angle - phase): order per turn of its shaft, phase [rad].

    amplitude : [N m] or what the unit of its load row asks for; of speed_power 2 times [s2/rad2], as that of an
        unbalance, with the speed of the shaft [rad/s]

    The angle is that of the uniform rotation, zero where the pinion of the first mesh passes zero.

    Raises DynamicsInputError for an order that is not above 0.
    """

    order: float
    amplitude: float
    phase: float = 0.0
    speed_power: Literal[0, 2] = 0

    def __post_init__(self) -> None:
        if not self.order > 0.0:
            raise DynamicsInputError(
                f"order = {self.order} of a periodic load must be above 0; a mean load is none"
            )

    def at_speed(self, speed: float) -> float:
        """Amplitude at a speed of its shaft [rad/s]."""
        return self.amplitude * speed**self.speed_power


@dataclass(frozen=True, kw_only=True)
class PeriodicLoad:
    """All orders that act through one row of load.

    load : (n,) load on each freedom per unit; dof : freedom whose angle and speed count
    """

    name: str
    load: Array
    dof: int
    parts: tuple[LoadOrder, ...]

    def at(self, angle: Array, speed: float | Array = 1.0) -> Array:
        """Value over the angle of the shaft (n,) [rad] at its speed [rad/s], one or (n,) -> (n,).

        The speed may be left out where no amplitude depends on it.
        """
        waves = (
            part.amplitude * speed**part.speed_power * np.cos(part.order * angle - part.phase)
            for part in self.parts
        )
        return np.asarray(sum(waves, np.zeros_like(angle)))


def rotating_load(name: str, load: Complex, dof: int, part: LoadOrder) -> tuple[PeriodicLoad, PeriodicLoad]:
    """Cosine and sine of a load (n,) complex: Re(load exp(i (order angle - phase))) times the amplitude of ``part``."""
    sine = LoadOrder(
        order=part.order,
        amplitude=part.amplitude,
        phase=part.phase + 0.5 * math.pi,
        speed_power=part.speed_power,
    )
    return (
        PeriodicLoad(name=name, load=np.real(load).copy(), dof=dof, parts=(part,)),
        PeriodicLoad(name=name, load=-np.imag(load), dof=dof, parts=(sine,)),
    )


def waves_within(order: float, ratio: float, turns: float) -> int | None:
    """Waves of an order in ``turns`` of the reference, whose shaft turns ``ratio`` times as fast; None if no whole
    number: a response of that period cannot hold them."""
    waves = order * abs(ratio) * turns
    return round(waves) if abs(waves - round(waves)) < WHOLE * max(waves, 1.0) else None


def within_period(loads: Sequence[PeriodicLoad], ratios: Array, turns: float) -> list[PeriodicLoad]:
    """The same loads with the orders alone that a period of so many turns of the reference holds."""
    return [
        PeriodicLoad(
            name=of_part.name,
            load=of_part.load,
            dof=of_part.dof,
            parts=tuple(p for p in of_part.parts if waves_within(p.order, float(ratios[of_part.dof]), turns)),
        )
        for of_part in loads
    ]


def harmonic_loads(
    loads: Sequence[PeriodicLoad], ratios: Array, turns: float, speed: float = 1.0
) -> dict[int, Complex]:
    """Complex load on all freedoms (n,) by harmonic of a period: the load is Re(value exp(i harmonic w t)).

    ratios : (n,) speed of each freedom per speed of the reference; turns : of the reference in the period; speed : of
    the reference [rad/s]. What does not fit the period is left out.
    """
    found: dict[int, Complex] = {}
    for of_part in loads:
        ratio = float(ratios[of_part.dof])
        for part in of_part.parts:
            harmonic = waves_within(part.order, ratio, turns)
            if harmonic:
                value = part.at_speed(ratio * speed) * np.exp(-1j * part.phase) * of_part.load
                found[harmonic] = found.get(harmonic, 0.0) + value
    return found


def left_out(loads: Sequence[PeriodicLoad], ratios: Array, turns: float) -> list[str]:
    """Names and orders that a period of so many turns of the reference cannot hold, each once."""
    missing = (
        f"{of_part.name} order {part.order:g}"
        for of_part in loads
        for part in of_part.parts
        if waves_within(part.order, float(ratios[of_part.dof]), turns) is None
    )
    return list(dict.fromkeys(missing))
