"""Modes of the closed loop followed over speed by their shapes.

A mode at one speed is the one at the speed before whose shape is most alike: modal assurance criterion (Allemang and
Brown, Proc. 1st IMAC, 1982, 110) with the inertia as weight, one partner each (linear assignment).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.drivetrain.modes import Describe, LoopMode, ModeShape, modes_of_loop
from dynamics.mesh.law import MeshLaw

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

ALIKE = 0.3
"""Assurance from which two shapes are one mode [-]; neighbours of one frequency mix, and still share this much."""


@dataclass(frozen=True, kw_only=True)
class ShapedModes:
    """Oscillating modes at one speed with their shapes.

    speed : stated speed [rad/s]; modes : by frequency; shapes : (n, m) in the freedoms of the system
    """

    speed: float
    modes: tuple[LoopMode, ...]
    shapes: Complex


@dataclass(frozen=True)
class TrackedMode:
    """One mode over speed; None where it is damped out or beyond the range."""

    modes: tuple[LoopMode | None, ...]

    @property
    def strongest(self) -> LoopMode:
        """Where a mesh excites it most."""
        return max((mode for mode in self.modes if mode), key=lambda mode: float(mode.mesh_gain.max()))


def shaped_modes(
    system: LinearSystem,
    laws: Sequence[MeshLaw],
    describe: Describe,
    speed: float,
    highest_frequency: float,
) -> ShapedModes:
    """Oscillating modes of the closed loop up to a frequency [Hz], meshes at their mean stiffness.

    system, laws : as of `modes_of_loop`; speed : at which the matrices hold [rad/s]
    """
    shapes: list[Complex] = []

    def keep(shape: Complex, mesh_energy: Array) -> ModeShape:
        shapes.append(shape)
        return describe(shape, mesh_energy)

    found = modes_of_loop(system, laws, highest_frequency, keep)
    modes = tuple(mode for mode in found if mode.frequency > 0.0)
    size = len(system.inertia)
    columns = np.array(shapes).T if shapes else np.zeros((size, 0), complex)
    return ShapedModes(speed=speed, modes=modes, shapes=columns)


def tracked(found: Sequence[ShapedModes], inertia: Array) -> tuple[TrackedMode, ...]:
    """Every mode over the speeds of ``found``, in the order of their first frequency.

    inertia : (n, n) of the system, the same at all speeds
    """
    root = np.linalg.cholesky(inertia).T
    rows: list[list[LoopMode | None]] = []
    members: list[int] = []
    before: Complex | None = None
    for number, at in enumerate(found):
        shapes = root @ at.shapes
        shapes = shapes / np.linalg.norm(shapes, axis=0)
        partners = {} if before is None else _partners(before, shapes, found[number - 1], at)
        now = []
        for k, mode in enumerate(at.modes):
            if k in partners:
                row = members[partners[k]]
            else:
                row = len(rows)
                rows.append([None] * len(found))
            rows[row][number] = mode
            now.append(row)
        before, members = shapes, now
    return tuple(TrackedMode(tuple(row)) for row in sorted(rows, key=_first))


def _first(row: Sequence[LoopMode | None]) -> float:
    return next(mode.frequency for mode in row if mode)


def _partners(old: Complex, new: Complex, before: ShapedModes, after: ShapedModes) -> dict[int, int]:
    """Mode before for each mode after."""
    if not (old.size and new.size):
        return {}
    assurance = np.abs(np.conj(old).T @ new) ** 2
    frequencies = [np.array([mode.frequency for mode in at.modes]) for at in (before, after)]
    apart = np.abs(np.log(frequencies[0][:, None] / frequencies[1]))
    rows, columns = linear_sum_assignment(apart - assurance)
    return {int(k): int(j) for j, k in zip(rows, columns) if assurance[j, k] >= ALIKE}
