"""Natural frequencies, decrements and whirl over speed, each mode followed by its shape."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from dynamics.drivetrain.shaft import DrivetrainError
from dynamics.elastic_rig.damped_modes import DampedModes, damped_modes, mode_character
from dynamics.elastic_rig.reduction import ReducedElasticRig
from dynamics.elastic_rig.running_state import RunningState

Array = NDArray[np.float64]

RESERVE = 1.3
"""Modes are computed up to this times the highest frequency wanted, so that one that crosses it is not lost."""
WITHOUT_PEAK = math.sqrt(0.5)
"""Damping ratio from which a mode has no resonance peak, and no place in the diagram: journals in their films."""


@dataclass(frozen=True, kw_only=True)
class CampbellDiagram:
    """Modes over speed; a mode that is damped out or leaves the range has no value (nan) there.

    speeds : (s,) of the reference shaft [rad/s]; frequency : (s, m) damped [Hz]
    logarithmic_decrement : (s, m) [-]; whirl : (s, m) of the shaft that moves most, from -1 to 1
    names : (m,) at the speed at which the mode whirls most clearly
    """

    speeds: Array
    frequency: Array
    logarithmic_decrement: Array
    whirl: Array
    names: tuple[str, ...]

    def crossings(self, order: float) -> tuple[tuple[str, float, float], ...]:
        """Name, speed [rad/s] and decrement where ``order`` times the speed meets a mode, linear between speeds."""
        found: list[tuple[str, float, float]] = []
        for k, name in enumerate(self.names):
            gap = order * self.speeds / (2.0 * np.pi) - self.frequency[:, k]
            for i in np.flatnonzero(gap[:-1] * gap[1:] <= 0.0):
                t = gap[i] / (gap[i] - gap[i + 1]) if gap[i] != gap[i + 1] else 0.0
                values = [
                    a[i] + t * (a[i + 1] - a[i]) for a in (self.speeds, self.logarithmic_decrement[:, k])
                ]
                if not found or (name, values[0]) != found[-1][:2]:
                    found.append((name, float(values[0]), float(values[1])))
        return tuple(found)


def campbell_diagram(
    rig: ReducedElasticRig, state: Callable[[float], RunningState], speeds: Array, highest: float
) -> CampbellDiagram:
    """Modes up to ``highest`` [Hz] at ascending speeds (s,) [rad/s]; state : running state at a speed.

    Raises DrivetrainError for speeds that do not ascend.
    """
    if speeds.size < 1 or (np.diff(speeds) <= 0.0).any():
        raise DrivetrainError("Campbell diagram: speeds must ascend; sort them and remove equal ones")
    tracks: list[dict[int, tuple[complex, float]]] = []
    names: list[tuple[float, str]] = []
    before: DampedModes | None = None
    members: list[int] = []
    for i, speed in enumerate(speeds):
        modes = _with_peak(damped_modes(rig, state(float(speed)), RESERVE * highest))
        character = mode_character(rig, modes)
        lead = np.argmax(character.share[:, :-1, 2], axis=1)
        matches = {} if before is None else _matches(rig, before, modes)
        now = []
        for k in range(modes.poles.size):
            if k in matches:
                now.append(members[matches[k]])
            else:
                now.append(len(tracks))
                tracks.append({})
                names.append((-1.0, ""))
            whirl = float(character.whirl[k, lead[k]])
            tracks[now[-1]][i] = (complex(modes.poles[k]), whirl)
            names[now[-1]] = max(names[now[-1]], (round(abs(whirl), 3), character.names[k]))
        before, members = modes, now
    return _diagram(speeds, tracks, [name for _, name in names], highest)


def _with_peak(modes: DampedModes) -> DampedModes:
    keep = modes.damping_ratio < WITHOUT_PEAK
    return replace(modes, poles=modes.poles[keep], shapes=modes.shapes[:, keep])


def _matches(rig: ReducedElasticRig, before: DampedModes, after: DampedModes) -> dict[int, int]:
    """Mode before for each mode after: likeness of the states, displacement weighted by frequency and velocity."""
    if not (before.poles.size and after.poles.size):
        return {}
    scale = np.sqrt(rig.squared)[:, None]
    old, new = (np.vstack([scale * modes.shapes, modes.poles * modes.shapes]) for modes in (before, after))
    old, new = (states / np.linalg.norm(states, axis=0) for states in (old, new))
    likeness = np.abs(np.conj(old).T @ new)
    apart = np.abs(np.log(before.poles.imag[:, None] / after.poles.imag))
    rows, columns = linear_sum_assignment(apart - likeness)
    return {int(k): int(j) for j, k in zip(rows, columns) if likeness[j, k] > 0.1 or apart[j, k] < 0.1}


def _diagram(
    speeds: Array, tracks: list[dict[int, tuple[complex, float]]], names: list[str], highest: float
) -> CampbellDiagram:
    poles = np.full((speeds.size, len(tracks)), complex(np.nan, np.nan))
    whirl = np.full((speeds.size, len(tracks)), np.nan)
    for k, track in enumerate(tracks):
        for i, (pole, turning) in track.items():
            poles[i, k], whirl[i, k] = pole, turning
    frequency = poles.imag / (2.0 * np.pi)
    shown = np.flatnonzero(np.nanmin(frequency, axis=0) <= highest)
    return CampbellDiagram(
        speeds=speeds,
        frequency=frequency[:, shown],
        logarithmic_decrement=(-2.0 * np.pi * poles.real / poles.imag)[:, shown],
        whirl=whirl[:, shown],
        names=tuple(names[k] for k in shown),
    )
