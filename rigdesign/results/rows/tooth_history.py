"""Root stress over a turn of a gear as a row of the result."""

import math

from rigdesign.results.dynamics import ToothTurnHistory
from rigdesign.results.tooth_history import ToothHistory
from rigdesign.results.units import MPA


def tooth_history_row(history: ToothHistory, *, rated: bool) -> ToothTurnHistory:
    """Curves of both fillets with what the root holds all the time.

    rated : whether the root safety of the gear takes R and mean stress
    """
    mean = history.mean
    return ToothTurnHistory(
        gear=history.gear,
        stage=history.stage,
        meshes=list(history.meshes),
        rotation_deg=[math.degrees(angle) for angle in history.turn.angle],
        leading_MPa=[MPA * (stress + mean.total) for stress in history.turn.leading.tolist()],
        trailing_MPa=[MPA * (stress + mean.total) for stress in history.turn.trailing.tolist()],
        mean_MPa={
            "centrifugal": MPA * mean.centrifugal,
            "press_fit": MPA * mean.press_fit,
            "total": MPA * mean.total,
        },
        fillet=history.fillet,
        highest_MPa=MPA * history.highest,
        lowest_MPa=MPA * history.lowest,
        R=history.stress_ratio,
        Y_M=history.mean_stress_factor,
        rated=rated,
        source=history.source,
    )
