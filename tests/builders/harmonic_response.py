"""Harmonic response of the elastic rig, for comparison: receptance at rows, and loads of the unbalance of a shaft.

The unbalance of a shaft turns with it, so the response has its speed as frequency, while every shaft keeps its own
speed in the gyroscopics. Both systems can be used: the reduced one, and all freedoms by a sparse solution.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.assembly import ElasticModel
from dynamics.rotor.shaft import DrivetrainError

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True, kw_only=True)
class Unbalance:
    """Mass times radius [kg m] at a place of the model, at an angle [rad] from +y in the sense of its shaft."""

    place: str
    moment: float
    angle: float = 0.0


class HarmonicSystem(Protocol):
    """A linear system at one running state: `FullMatrices` or `ReducedMatrices`."""

    def response(self, loads: Array | Complex, frequency: float) -> Complex:
        """Displacement (n, k) under harmonic loads (n, k) of an angular frequency above zero [rad/s]."""
        ...


def receptance(system: HarmonicSystem, rows: Array, frequencies: Array) -> Complex:
    """(f, m, m) motion at rows (m, n) per load on them at angular frequencies (f,) [rad/s].

    Raises DrivetrainError for a frequency that is not above zero: rigid motions have no answer at rest.
    """
    if not (frequencies > 0.0).all():
        raise DrivetrainError(
            f"receptance: lowest frequency = {frequencies.min()} rad/s: must be above 0; leave it out"
        )
    loads = np.asarray(rows.T)
    return np.array([rows @ system.response(loads, float(frequency)) for frequency in frequencies])


def unbalance_load(
    model: ElasticModel, unbalances: Sequence[Unbalance], speed: float
) -> tuple[Complex, float]:
    """Load (n,) [N] of unbalances of one shaft at a reference speed [rad/s], and its angular frequency [rad/s].

    Raises DrivetrainError for unbalances on shafts of different speed: their responses have different frequencies.
    """
    spins = [model.spins[model.freedoms.place(u.place).shaft] for u in unbalances]
    if np.ptp(np.abs(spins)) > 1e-12:
        raise DrivetrainError(
            f"unbalances at {', '.join(u.place for u in unbalances)}: speeds {np.abs(spins)} of the reference: must be "
            "equal; ask for the response to each shaft by itself"
        )
    turn = abs(spins[0]) * speed
    load = np.zeros(model.size, complex)
    for unbalance, spin in zip(unbalances, spins):
        rows = model.rows(unbalance.place)
        force = unbalance.moment * turn**2 * np.exp(1j * unbalance.angle)
        load += force * (rows[1] - 1j * np.sign(spin) * rows[2])
    return load, turn
