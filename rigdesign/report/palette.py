"""The colours of page and figures: one list for both, chosen so that red-green blind readers can distinguish them.

Every colour has a second coding: line style and marker in figures, a word in badges. ``tests/…/test_palette`` holds
the distances under simulated deuteranopia and protanopia, and the contrast of verdict colours on white.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

INK = "#22303c"
GRID = "#d9dfe4"
MUTED = "#5d6b77"
SERIES = ("#0072b2", "#be4c00", "#03916e", "#781674", "#d38100", "#170f9a", "#b387a7", "#243536")
"""Curves and bars by number: the hues of Okabe and Ito (jfly.uni-koeln.de/color), darker where white is behind them."""
VERDICT_COLOURS = {"pass": "#0b8556", "open": "#6a4c93", "fail": "#930b16",
                   "advisory": "#9d6a09", "not applicable": "#697683"}  # fmt: skip
"""Text on white, or background of white text: contrast at least 4.5 (WCAG 2.1, 1.4.3)."""
WARM, COLD = SERIES[1], SERIES[0]
"""The two sides of a middle: above and below, warmer and colder."""
TEMPERATURE_COLOURS, DISPLACEMENT_COLOURS, HEAT_FLUX_COLOURS = "viridis", "cividis", "magma"
"""matplotlib's maps of the fields: perceptually uniform, readable in grey and by colour-blind readers."""

LineStyle = str | tuple[int, tuple[float, ...]]

LINES: tuple[LineStyle, ...] = (
    "-",
    (0, (6.0, 2.0)),
    (0, (1.2, 1.4)),
    (0, (7.0, 1.6, 1.4, 1.6)),
    (0, (3.0, 1.4)),
    (0, (7.0, 1.4, 1.4, 1.4, 1.4, 1.4)),
    (0, (10.0, 2.5)),
    (0, (2.6, 1.2, 1.0, 1.2)),
)
"""Solid, dashed, dotted and their mixtures, as matplotlib takes them."""
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")


@dataclass(frozen=True)
class CurveStyle:
    """How one of several curves is drawn: colour, line style and marker belong together."""

    colour: str
    line: LineStyle
    marker: str

    @property
    def drawn(self) -> dict[str, Any]:
        """Keywords of matplotlib's ``plot`` for a line without markers."""
        return {"color": self.colour, "linestyle": self.line}

    @property
    def marked(self) -> dict[str, Any]:
        """Keywords of matplotlib's ``plot`` for markers without a line."""
        return {"color": self.colour, "marker": self.marker, "linestyle": "none"}


def curve_style(number: int) -> CurveStyle:
    """The style of curve ``number``, counted from 0; after every eight the colours meet other line styles."""
    other = number + number // len(SERIES)
    return CurveStyle(SERIES[number % len(SERIES)], LINES[other % len(LINES)], MARKERS[other % len(MARKERS)])


def gearbox_colours(names: Iterable[str]) -> dict[str, CurveStyle]:
    """Gearbox -> style by the order of the names, so that a gearbox looks the same in every figure of a report.

    names : all gearboxes of the case, also those that a figure does not show
    """
    return {name: curve_style(number) for number, name in enumerate(sorted(set(names)))}
