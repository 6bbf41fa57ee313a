"""Damped modes of the elastic rig at one running state: poles, decrements, whirl, and where a mode moves.

The eigenproblem is solved in the reduced coordinates, displacements scaled by the undamped frequencies so that all
states have the unit of a velocity. A coordinate that no stiffness touches (the rigid motions) has no displacement
state, so no defective double zero arises: its velocity is the state, with a pole of exactly zero without drag.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import qr

from dynamics.elastic_rig.assembly import ElasticModel
from dynamics.elastic_rig.freedoms import FAMILIES
from dynamics.elastic_rig.location import unresisted
from dynamics.elastic_rig.reduction import ReducedElasticRig
from dynamics.elastic_rig.running_state import RunningState

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

OSCILLATING = 1e-8
"""Imaginary part over magnitude above which a pole oscillates."""


@dataclass(frozen=True, kw_only=True)
class DampedModes:
    """Oscillating modes in order of frequency, and the real poles of the rest.

    poles : (m,) with positive imaginary part [1/s]; shapes : (n, m) displacement in the coordinates of the rig
    real_poles : (k,) overdamped motions and rigid velocities [1/s], ascending magnitude
    """

    poles: Complex
    shapes: Complex
    real_poles: Array

    @property
    def frequency(self) -> Array:
        """(m,) damped natural frequency [Hz]."""
        return np.asarray(self.poles.imag / (2.0 * np.pi))

    @property
    def damping_ratio(self) -> Array:
        """(m,) share of critical damping -Re / |pole| [-]."""
        return np.asarray(-self.poles.real / np.abs(self.poles))

    @property
    def logarithmic_decrement(self) -> Array:
        """(m,) decay of one period to the next, -2 pi Re / Im [-]; negative is unstable."""
        return np.asarray(-2.0 * np.pi * self.poles.real / self.poles.imag)

    @property
    def amplification(self) -> Array:
        """(m,) 1 / (2 damping ratio) at resonance [-], infinite without damping."""
        ratio = np.abs(self.damping_ratio)
        return np.divide(0.5, ratio, where=ratio > 0.0, out=np.full_like(ratio, np.inf))


@dataclass(frozen=True, kw_only=True)
class ModeCharacter:
    """Where modes move.

    share : (m, n_shafts + 1, 4) of the kinetic energy in each shaft (last: housing) and family of `FAMILIES`
    whirl : (m, n_shafts) from -1 (backward circle) over 0 (line) to 1 (forward), in each shaft's own sense
    names : (m,) shaft and family that move most, with the direction of whirl if they whirl
    """

    share: Array
    whirl: Array
    names: tuple[str, ...]

    def lateral_whirl(self, least_share: float) -> tuple[float | None, ...]:
        """Whirl of the shaft that moves most sideways; None where lateral motion of shafts has less than a share."""
        lateral = self.share[:, :-1, FAMILIES.index("lateral")]
        leading = np.argmax(lateral, axis=1)
        return tuple(
            float(self.whirl[k, shaft]) if lateral[k].sum() >= least_share else None
            for k, shaft in enumerate(leading)
        )


def damped_modes(rig: ReducedElasticRig, state: RunningState, highest: float | None = None) -> DampedModes:
    """Modes of a rig at a state, up to a frequency [Hz] if given; raises DrivetrainError as `RunningState.check`."""
    matrices = rig.matrices(state)
    turned, stiffness, free = _free_first(matrices.stiffness, rig.n_rigid)
    n, held = rig.size, slice(free, rig.size)
    scale = np.sqrt(np.maximum(np.diag(stiffness)[held], 1.0))
    size = n - free
    system = np.zeros((size + n, size + n))
    system[np.arange(size), size + free + np.arange(size)] = scale
    system[size:, :size] = -stiffness[:, held] / scale
    system[size:, size:] = -(turned.T @ matrices.damping @ turned)
    poles, vectors = np.linalg.eig(system)
    oscillating = poles.imag > OSCILLATING * np.abs(poles)
    real = poles[np.abs(poles.imag) <= OSCILLATING * np.abs(poles)].real
    if highest is not None:
        oscillating &= poles.imag <= 2.0 * np.pi * highest
    index = np.flatnonzero(oscillating)
    index = index[np.argsort(poles[index].imag, kind="stable")]
    shapes = turned @ (vectors[size:, index] / poles[index])
    return DampedModes(
        poles=poles[index],
        shapes=np.asarray(shapes / np.linalg.norm(shapes, axis=0)),
        real_poles=real[np.argsort(np.abs(real), kind="stable")],
    )


def _free_first(stiffness: Array, n_rigid: int) -> tuple[Array, Array, int]:
    """Orthogonal change of coordinates that puts the motions without stiffness first: it, the stiffness, their number.

    Mesh springs leave one combination of the turns of the lines they join free; its row and column become exact zeros.
    """
    free = unresisted(stiffness[:, :n_rigid])
    count = free.shape[1]
    turned = np.eye(stiffness.shape[0])
    if 0 < count < n_rigid:
        turned[:n_rigid, :n_rigid] = qr(free)[0]
        stiffness = turned.T @ stiffness @ turned
    stiffness[:count] = 0.0
    stiffness[:, :count] = 0.0
    return turned, stiffness, count


def mode_character(rig: ReducedElasticRig, modes: Complex) -> ModeCharacter:
    """Energy shares, whirl and names of mode shapes (n, m) in the coordinates of the rig."""
    model = rig.model
    shapes = rig.basis @ modes
    energy = np.maximum(np.real(np.conj(shapes) * (model.mass @ shapes)), 0.0)
    shafts = [shaft.name for shaft in model.rig.drivetrain.shafts]
    owner = np.array(model.freedoms.shaft_of)
    family = np.array(model.freedoms.family)
    share = np.zeros((shapes.shape[1], len(shafts) + 1, len(FAMILIES)))
    for i in range(-1, len(shafts)):
        for j in range(len(FAMILIES)):
            share[:, i, j] = energy[(owner == i) & (family == j)].sum(axis=0)
    share /= share.sum(axis=(1, 2), keepdims=True)
    whirl = np.column_stack([_whirl(model, shaft, shapes) for shaft in shafts])
    return ModeCharacter(
        share=share,
        whirl=whirl,
        names=tuple(_name([*shafts, "housing"], share[k], whirl[k]) for k in range(shapes.shape[1])),
    )


def _whirl(model: ElasticModel, shaft: str, shapes: Complex) -> Array:
    """(m,) signed ratio of the areas of the orbits of a shaft to those of circles of their size."""
    nodes = model.freedoms.nodes[shaft]
    base = nodes.first + 6 * np.arange(nodes.x.size)
    across, up = shapes[base + 1], shapes[base + 2]
    area = -2.0 * np.imag(np.conj(across) * up).sum(axis=0)
    size = (np.abs(across) ** 2 + np.abs(up) ** 2).sum(axis=0)
    sense = np.sign(model.spins[shaft])
    return np.asarray(sense * np.divide(area, size, where=size > 0.0, out=np.zeros_like(area)))


def _name(bodies: list[str], share: Array, whirl: Array) -> str:
    body, family = np.unravel_index(int(np.argmax(share)), share.shape)
    name = bodies[body] if FAMILIES[family] == "housing" else f"{bodies[body]} {FAMILIES[family]}"
    if FAMILIES[family] != "lateral" or abs(whirl[body]) < 0.1:
        return name
    return f"{name} {'forward' if whirl[body] > 0.0 else 'backward'}"
