"""The same answer some teeth later: complex orders turned by the angle that has passed."""

from collections.abc import Sequence
from math import cos, pi, sin

import numpy as np

from rigdesign.diagnosis.columns import Array
from rigdesign.prediction.model import Feature


def turned(features: Sequence[Feature], answers: Array, teeth: int, teeth_a_turn: int) -> Array:
    """(m, n) answers of a cause that sits ``teeth`` teeth further on its gear.

    teeth_a_turn : of the gear that counts; each tooth that passes turns order k by 2 pi k over them. Means and
        quantities without orders stay.
    """
    place = {feature: row for row, feature in enumerate(features)}
    found = answers.copy()
    for feature, row in place.items():
        if feature.part != "real":
            continue
        other = place.get(Feature(feature.channel, feature.setting, feature.order, "imaginary"))
        if other is None:
            continue
        angle = -2.0 * pi * feature.order * teeth / teeth_a_turn
        real, imaginary = answers[:, row], answers[:, other]
        found[:, row] = cos(angle) * real - sin(angle) * imaginary
        found[:, other] = sin(angle) * real + cos(angle) * imaginary
    return np.asarray(found)
