"""Lateral vibration at one running state: modes with decrement and amplification, whirl and forces under loads once a
turn."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.elastic_rig.damped_modes import DampedModes, damped_modes, mode_character
from dynamics.elastic_rig.freedoms import FAMILIES
from dynamics.elastic_rig.reduction import ReducedElasticRig
from dynamics.elastic_rig.rotating_loads import line_loads
from dynamics.elastic_rig.rotating_parts import SpeedPower
from dynamics.elastic_rig.running_state import RunningState

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
AT_REST = 0.01
"""Share of the speed of the reference shaft below which a pole is no oscillation: a shaft that moves freely in the play
of unloaded bearings, whose linear stiffness is zero."""
LineLoads = Mapping[tuple[str, SpeedPower], Complex]
"""Loads once a turn (n,) on the reduced coordinates, by line and power of its speed."""


@dataclass(frozen=True, kw_only=True)
class Orbit:
    """Ellipse of a lateral motion: half axes [m], the minor negative for backward whirl; angle of the major [rad]."""

    major: float
    minor: float
    angle: float


def orbit(across: complex, up: complex, sense: float = 1.0) -> Orbit:
    """Ellipse of u_y = Re(across e^{iwt}), u_z = Re(up e^{iwt}) on a shaft that turns about ``sense`` x."""
    forward = 0.5 * (across + 1j * sense * up)
    backward = 0.5 * np.conj(across - 1j * sense * up)
    angle = sense * 0.5 * (np.angle(forward) + np.angle(backward))
    return Orbit(
        major=float(abs(forward) + abs(backward)),
        minor=float(abs(forward) - abs(backward)),
        angle=float(angle),
    )


@dataclass(frozen=True, kw_only=True)
class RigMode:
    """One oscillating mode of the running rig.

    frequency : damped [Hz]; logarithmic_decrement : [-], negative is unstable; family : of `FAMILIES`, with most of its
    kinetic energy; shaft : that moves most, empty for the housing; whirl : of that shaft, -1 backward to 1 forward
    elastic_share : strain energy in shafts and couplings over the kinetic energy, 0 where shafts move as rigid bodies
    """

    name: str
    family: str
    shaft: str
    frequency: float
    logarithmic_decrement: float
    whirl: float
    elastic_share: float = 1.0

    @property
    def damping_ratio(self) -> float:
        """Share of critical damping [-]."""
        return self.logarithmic_decrement / math.hypot(2.0 * math.pi, self.logarithmic_decrement)

    @property
    def amplification(self) -> float:
        """AF = 1 / (2 damping ratio) [-]; infinite without damping or unstable."""
        return 0.5 / self.damping_ratio if self.damping_ratio > 0.0 else math.inf


def rig_modes(rig: ReducedElasticRig, state: RunningState, highest: float) -> tuple[RigMode, ...]:
    """Oscillating modes at a running state up to a frequency [Hz], by frequency.

    Springs of the state stand for the meshes. Raises DrivetrainError as `RunningState.check`.
    """
    modes = damped_modes(rig, state, highest)
    character = mode_character(rig, modes.shapes)
    elastic = _elastic_shares(rig, modes)
    shafts = [shaft.name for shaft in rig.model.rig.drivetrain.shafts]
    slowest = AT_REST * abs(state.speed) / (2.0 * math.pi)
    found = []
    for i in range(modes.poles.size):
        if modes.frequency[i] <= slowest:
            continue
        body, family = np.unravel_index(int(np.argmax(character.share[i])), character.share[i].shape)
        on_shaft = body < len(shafts)
        found.append(
            RigMode(
                name=character.names[i],
                family=FAMILIES[int(family)],
                shaft=shafts[int(body)] if on_shaft else "",
                frequency=float(modes.frequency[i]),
                logarithmic_decrement=float(modes.logarithmic_decrement[i]),
                whirl=float(character.whirl[i, body]) if on_shaft else 0.0,
                elastic_share=float(elastic[i]),
            )
        )
    return tuple(found)


def _elastic_shares(rig: ReducedElasticRig, modes: DampedModes) -> Array:
    """(m,) as `RigMode.elastic_share`; bearings, meshes and housings are no part of the strain."""
    model = rig.model
    shapes = rig.basis @ modes.shapes
    on_shafts = np.flatnonzero(np.array(model.freedoms.shaft_of) >= 0)
    moved = shapes[on_shafts]
    strain = np.real(np.sum(np.conj(moved) * (model.stiffness[on_shafts][:, on_shafts] @ moved), axis=0))
    kinetic = np.real(np.sum(np.conj(shapes) * (model.mass @ shapes), axis=0)) * np.abs(modes.poles) ** 2
    return np.asarray(np.maximum(strain, 0.0) / kinetic)


@dataclass(frozen=True, kw_only=True)
class LineWhirl:
    """Motion once a turn of one shaft line: frequency [rad/s], complex coordinates (n,) of the reduced rig."""

    line: str
    frequency: float
    motion: Complex


def reduced_line_loads(rig: ReducedElasticRig) -> LineLoads:
    """What turns with every line, for all speeds."""
    return {
        key: rig.rows(load.real) + 1j * rig.rows(load.imag) for key, load in line_loads(rig.model).items()
    }


def line_whirls(rig: ReducedElasticRig, state: RunningState, loads: LineLoads) -> tuple[LineWhirl, ...]:
    """Response to the loads once a turn of every line that has some; what shakes one line moves the others as well.

    Raises DrivetrainError as `RunningState.check`.
    """
    matrices = rig.matrices(state)
    speeds = {name: abs(rig.model.spins[name]) * state.speed for name, _ in loads}
    found = []
    for name, speed in speeds.items():
        if not speed > 0.0:
            continue
        load = sum(
            (speed**power * own for (line, power), own in loads.items() if line == name),
            np.zeros(rig.size, complex),
        )
        motion = matrices.response(np.asarray(load)[:, None], speed)[:, 0]
        found.append(LineWhirl(line=name, frequency=speed, motion=motion))
    return tuple(found)


def whirl_at(whirls: tuple[LineWhirl, ...], rows: Array, sense: float) -> dict[str, Orbit]:
    """Orbit of a place by line, from the rows (2, n) of its motion along y and z on the reduced coordinates."""
    found = {}
    for whirl in whirls:
        across, up = rows @ whirl.motion
        found[whirl.line] = orbit(complex(across), complex(up), sense)
    return found


def bearing_forces(
    rig: ReducedElasticRig, state: RunningState, whirls: tuple[LineWhirl, ...], bearing: str
) -> dict[str, Orbit]:
    """Force [N] that turns once with a line in a bearing, K w + C w', by line: half axes of its ellipse."""
    stiffness, damping = (matrix[:2] for matrix in state.bearings[bearing].padded())
    found = {}
    for whirl in whirls:
        motion = rig.ports[bearing] @ whirl.motion
        force = stiffness @ motion + 1j * whirl.frequency * damping @ motion
        found[whirl.line] = orbit(complex(force[0]), complex(force[1]))
    return found
