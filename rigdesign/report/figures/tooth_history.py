"""Figure of the root stress in both fillets of a tooth over a turn of its gear."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rigdesign.report.figures.drawing import finish, new_figure, words
from rigdesign.report.palette import INK, LINES, MUTED, curve_style
from rigdesign.results.dynamics import ToothTurnHistory

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SIGMA_F = "σ_F"
TURN = (0.0, 90.0, 180.0, 270.0, 360.0)
HEIGHT = 2.3
"""Of a row of gears [in]."""


def tooth_history_figure(histories: Sequence[ToothTurnHistory]) -> "Figure":
    """Stress over rotation, a row for each gear: the leading and the trailing flank, and the mean stress at rest."""
    figure = new_figure(HEIGHT * len(histories))
    style = curve_style(0)
    for axes, history in zip(figure.subplots(len(histories), 1, squeeze=False)[:, 0], histories, strict=True):
        turned = history.rotation_deg
        axes.plot(turned, history.leading_MPa, **style.drawn, label="fillet of the leading flank")
        axes.plot(
            turned,
            history.trailing_MPa,
            color=INK,
            linewidth=0.9,
            linestyle=LINES[1],
            label="fillet of the trailing flank",
        )
        axes.axhline(0.0, color=INK, linewidth=0.4)
        if history.mean_MPa["total"] > 0.0:
            axes.axhline(
                history.mean_MPa["total"], color=MUTED, linewidth=0.7, linestyle=LINES[2], label="mean stress"
            )
        axes.set_xlim(0.0, 360.0)
        axes.set_xticks(TURN)
        finish(axes, "rotation of the gear [°]", f"root stress {SIGMA_F} [N/mm²]", _title(history))
        axes.legend(loc="best")
    height = HEIGHT * len(histories)
    figure.subplots_adjust(left=0.09, right=0.985, top=1.0 - 0.25 / height, bottom=0.45 / height, hspace=0.42)
    return figure


def _title(history: ToothTurnHistory) -> str:
    return (
        f"{words(history.gear)}, stage {words(history.stage)}: R = {history.R:.2f}, Y_M = {history.Y_M:.3f}"
    )
