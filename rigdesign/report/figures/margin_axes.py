"""Axes of the figures of a study: a margin that stays readable near its limit, and the varied input."""

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rigdesign.report.figures.drawing import plain
from rigdesign.report.palette import INK, VERDICT_COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from rigdesign.report.margins.axis import StudyAxis

LINEAR_TO = 50.0
"""Margins below minus this are drawn ever closer [% of the limit]."""
BEND = 25.0
"""How far below that the scale takes to become logarithmic [%]."""
BELOW = (-100, -200, -500, -1000, -2000, -5000, -10_000, -100_000)
"""Ticks where the scale is no longer linear [%]."""
MARGIN_LABEL = "distance to the limit [%]"
SHORT_LABEL = "distance [%]"
"""For small plots beside or below one with the long label."""
MOST_NAMES = 12
"""Names along an axis that are written level."""


def margin_axis(
    axes: "Axes", margins: Iterable[float], *, label: str = MARGIN_LABEL, upright: bool = True
) -> None:
    """Scale an axis to all ``margins`` [%], zero included; the side below zero is shaded.

    Linear down to -50 %, logarithmic below, so that a check that fails by far leaves room for those near their limit.
    """
    known = np.asarray([margin for margin in margins if np.isfinite(margin)] or [0.0])
    low, high = min(float(known.min()), 0.0), max(float(known.max()), 0.0)
    far = low < -2.0 * LINEAR_TO
    along = axes.yaxis if upright else axes.xaxis
    if far:
        rescale = axes.set_yscale if upright else axes.set_xscale
        rescale("function", functions=(_drawn, _margin))
    span = float(_drawn(np.array(high)) - _drawn(np.array(low))) or 1.0
    bottom, top = float(_margin(_drawn(np.array(low)) - 0.06 * span)), high + 0.08 * span
    (axes.set_ylim if upright else axes.set_xlim)(bottom, top)
    if far:
        ticks = [*(tick for tick in BELOW if tick >= bottom), -50, 0, 50, 100]
        along.set_ticks([tick for tick in ticks if tick <= top])
    along.set_label_text(f"{label}\nlogarithmic below −50 %" if far else label)
    along.set_major_formatter(lambda value, _: f"{value:,.0f}".replace("-", "\u2212").replace(",", "\u202f"))
    axes.minorticks_off()
    shade, line = (axes.axhspan, axes.axhline) if upright else (axes.axvspan, axes.axvline)
    shade(bottom, 0.0, color=VERDICT_COLOURS["fail"], alpha=0.06, linewidth=0)
    line(0.0, color=INK, linewidth=1.2, zorder=2.5)


def input_axis(axes: "Axes", axis: "StudyAxis", *, upright: bool = False, unit: bool = True) -> None:
    """Ticks and label of a varied input; names stand at their places."""
    along = axes.yaxis if upright else axes.xaxis
    along.set_label_text(plain(axis.label if unit else axis.name))
    low, high = min(axis.positions), max(axis.positions)
    if axis.numeric:
        room = 0.03 * (high - low) or abs(low) * 0.05 or 1.0
    else:
        room = 0.5
        turned = not upright and len("".join(axis.texts)) > 6 * MOST_NAMES
        along.set_ticks(
            list(axis.positions), [plain(text) for text in axis.texts], rotation=30 if turned else 0,
            ha="right" if turned or upright else "center",
        )  # fmt: skip
    (axes.set_ylim if upright else axes.set_xlim)(low - room, high + room)


def mark_failed(axes: "Axes", positions: Iterable[float]) -> None:
    """A cross on the limit where a point has no result, on a dotted line where they are few."""
    found = sorted(set(positions))
    few = len(found) <= MOST_NAMES
    for position in found if few else ():
        axes.axvline(position, color=INK, linewidth=0.8, linestyle=":", zorder=1.2)
    size, width = (8.0, 2.0) if few else (4.0, 1.0)
    if found:
        axes.plot(found, [0.0] * len(found), "x", color=INK, markersize=size, markeredgewidth=width, zorder=4,
                  clip_on=False, label="no result")  # fmt: skip


def _drawn(margin: NDArray[np.float64]) -> NDArray[np.float64]:
    """Place on the scale: the margin itself, below -50 % with the slope of a logarithm that goes on smoothly."""
    far = np.maximum(-np.asarray(margin, dtype=float) - LINEAR_TO, 0.0)
    return np.where(far > 0.0, -LINEAR_TO - BEND * np.log1p(far / BEND), margin)


def _margin(drawn: NDArray[np.float64]) -> NDArray[np.float64]:
    far = np.maximum(-np.asarray(drawn, dtype=float) - LINEAR_TO, 0.0)
    return np.where(far > 0.0, -LINEAR_TO - BEND * np.expm1(far / BEND), drawn)
