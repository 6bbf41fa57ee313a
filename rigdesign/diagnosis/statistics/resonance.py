"""How steep orders are where they are read: near a natural frequency they follow what a per cent does to it.

What excites an order passes through the circuit, H ~ 1 / (1 - f/f_i) near the natural frequency f_i; a relative change
of the speed, or of f_i, changes it by 1 / |1 - f/f_i| times as much. Neither where the rig ran nor where the model has
its natural frequencies is known better than to a per cent or so.
"""

from collections.abc import Sequence

import numpy as np

from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.prediction.model import Feature, OperatingCondition

BLURRED = 0.04
"""Relative distance from a natural frequency below which an order gets no steeper: the model has it that far off."""


def steepness(features: Sequence[Feature], settings: Sequence[OperatingCondition], modes: Array) -> Array:
    """(n,) relative change of an order by the logarithm of its frequency; zero for means and all other numbers.

    modes : natural frequencies [rad/s]
    """
    speeds = {setting.name: setting.speed for setting in settings}
    frequencies = np.array([one.order * speeds.get(one.setting, 0.0) for one in features])
    if not modes.size:
        return np.zeros(len(features))
    away = np.abs(1.0 - frequencies[:, None] / modes).min(axis=1)
    return np.where(frequencies > 0.0, 1.0 / np.hypot(away, BLURRED), 0.0)
