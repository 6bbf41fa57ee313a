"""The look of every figure and its way into the page as inline SVG."""

import io
import re
import warnings
from base64 import b64decode, b64encode
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rigdesign.report.numbers import NARROW_SPACE, unit_text
from rigdesign.report.palette import GRID, INK, MUTED, VERDICT_COLOURS, CurveStyle

if TYPE_CHECKING:
    from markupsafe import Markup
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.ticker import ScalarFormatter

    from rigdesign.report.margins.table import StudyAxis

WIDTH = 9.2
"""Width of a full figure [in]; the page scales it to its text width."""

STYLE: dict[Any, Any] = {
    "svg.hashsalt": "rigdesign",
    "svg.fonttype": "none",
    "font.family": "DejaVu Sans",
    "font.size": 8.5,
    "mathtext.fontset": "dejavusans",
    "axes.edgecolor": MUTED,
    "axes.labelcolor": INK,
    "axes.titlesize": 9,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.titley": 1.0,
    "axes.linewidth": 0.7,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.color": GRID,
    "grid.linewidth": 0.6,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "text.color": INK,
    "legend.fontsize": 8,
    "legend.frameon": False,
    "lines.linewidth": 1.2,
    "path.simplify": True,
    "path.simplify_threshold": 0.3,
    "figure.facecolor": "white",
    "image.composite_image": False,
}
"""matplotlib settings of every figure; text stays text, so that it can be searched and copied. Titles stand at the
top of the axes: to search a place for them takes a tenth of the drawing."""

SUBSCRIPT = re.compile(r"\b([KYfnσ])_([A-Z]|z)\b")
"""Symbols of the field with their index."""
DATA = "data:image/png;base64,"
PNG = re.compile(DATA + r"([A-Za-z0-9+/=\s]+)")
"""A picture inside a figure: facets and colour fields, which are drawn as pixels."""
NO_METADATA = {"Date": None, "Creator": None, "Format": None, "Type": None}
SAMPLE_ROOM = "\u2003" * 3
"""In front of a title, as wide as the piece of line there."""
FONT_STACK = "'DejaVu Sans', Verdana, Geneva, sans-serif"


@contextmanager
def drawing_style() -> Iterator[None]:
    """Apply ``STYLE`` while figures are made and drawn; matplotlib's global settings come back afterwards."""
    import matplotlib as mpl

    with warnings.catch_warnings(), mpl.rc_context():
        warnings.filterwarnings("ignore", message="Glyph .* missing from")
        mpl.rcdefaults()
        mpl.rcParams.update(STYLE)
        yield


def new_figure(height: float, width: float = WIDTH) -> "Figure":
    """A white figure of the given size [in] without a window."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height))


def inline_svg(figure: "Figure", name: str, description: str) -> str:
    """The figure as an <svg> element for an HTML page.

    name : prefix of every id in it, unique on the page
    description : text for screen readers (plain text; escaped here)
    """
    from html import escape

    buffer = io.StringIO()
    figure.savefig(buffer, format="svg", metadata=NO_METADATA, dpi=160)
    svg = buffer.getvalue()
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg, count=1, flags=re.DOTALL)
    svg = re.sub(r'( id="|xlink:href="#|url\(#)', rf"\g<1>{name}-", svg)
    svg = svg.replace("'DejaVu Sans'", FONT_STACK)
    svg = re.sub(r"(?<=>)[^<>]*[A-Za-zσ]_(?:[A-Z]|z)\b[^<>]*(?=</text>)", lambda m: _lowered(m[0]), svg)
    svg = PNG.sub(lambda found: _leaner(found[1]), svg)
    label = escape(description, quote=True)
    return svg.replace("<svg ", f'<svg role="img" aria-label="{label}" ', 1)


class NumberedFigures:
    """Turns the figures of one page into inline SVG and numbers them, so that ids stay unique on the page.

    prefix : of the numbers, one for each part of a page that numbers its own
    """

    def __init__(self, prefix: str = "f") -> None:
        self._prefix, self._count = prefix, 0

    def __call__(self, figure: "Figure", description: str) -> "Markup":
        """The figure as an <svg> element; ``description`` is read to those who cannot see it."""
        from markupsafe import Markup

        self._count += 1
        return Markup(inline_svg(figure, f"{self._prefix}{self._count}", description))


def _leaner(picture: str) -> str:
    """A PNG in base64 on white with 256 colours, a third of its size, as an address of the page."""
    from PIL import Image

    found = Image.open(io.BytesIO(b64decode(picture))).convert("RGBA")
    white = Image.new("RGBA", found.size, "white")
    few = Image.alpha_composite(white, found).convert("RGB").quantize(256, dither=Image.Dither.NONE)
    buffer = io.BytesIO()
    few.save(buffer, format="png")
    return f"{DATA}{b64encode(buffer.getvalue()).decode('ascii')}"


def _lowered(text: str) -> str:
    """Text of an SVG element in which K_V, f_z and the like carry a subscript, as in the text of the page."""
    parts = SUBSCRIPT.split(text)
    found = [parts[0]]
    for symbol, index, rest in zip(parts[1::3], parts[2::3], parts[3::3], strict=True):
        found.append(f'{symbol}<tspan dy=".22em" style="font-size:70%">{index}</tspan>')
        found.append(f'<tspan dy="-.154em">{rest}</tspan>' if rest else "")
    return "".join(found)


def plain(text: str) -> str:
    """A user's text for matplotlib: a dollar sign is a dollar sign, not the start of a formula."""
    return text.replace("$", r"\$")


def words(name: str) -> str:
    """A name of the case as it reads: ``test.pinion_rear`` -> ``test pinion rear``."""
    return plain(re.sub(r"_|(?<=\D)\.(?=\D)", " ", name))


def stated_quantity(text: str) -> str:
    """A quantity as the case writes it, its unit as printed: ``180 Nm``."""
    value, _, unit = text.rpartition(" ")
    return f"{value} {unit_text(unit)}" if value else plain(text)


def finish(axes: "Axes", xlabel: str = "", ylabel: str = "", title: str = "") -> None:
    """Labels (with unit and convention) and title of one plot; large ticks in groups of three digits."""
    from matplotlib.ticker import ScalarFormatter

    axes.set_xlabel(xlabel)
    axes.set_ylabel(ylabel)
    if title:
        axes.set_title(title)
    for axis in (axes.xaxis, axes.yaxis):
        if type(axis.get_major_formatter()) is ScalarFormatter:
            axis.set_major_formatter(_grouped_digits()())


@cache
def _grouped_digits() -> "type[ScalarFormatter]":
    """Ticks as matplotlib writes them, from 10 000 on in groups, as in tables."""
    from matplotlib.ticker import ScalarFormatter

    class GroupedDigits(ScalarFormatter):
        """Ticks of a linear axis."""

        def __call__(self, x: float, pos: int | None = None) -> str:
            text = str(super().__call__(x, pos))
            return f"{x:,.0f}".replace(",", NARROW_SPACE) if abs(x) >= 10000 and text.isdigit() else text

    return GroupedDigits


def panels_in_pairs(height: float, count: int, parts: int = 1) -> tuple["Figure", Any]:
    """A figure with two panels side by side and as many lines of them, height [inch] each, as ``count`` needs, and its
    axes (count, parts), the parts of a panel below each other."""
    lines = -(-count // 2)
    figure = new_figure(height * lines)
    axes = figure.subplots(lines * parts, min(2, count), squeeze=False)
    panels = axes.reshape(lines, parts, -1).swapaxes(1, 2).reshape(-1, parts)
    for spare in panels[count:].ravel():
        spare.set_axis_off()
    return figure, panels[:count]


def gearbox_title(axes: "Axes", text: str, style: CurveStyle) -> None:
    """The title of a plot that shows one gearbox, behind a piece of line in the style of that gearbox."""
    from matplotlib.lines import Line2D
    from matplotlib.transforms import ScaledTranslation

    axes.set_title(f"{SAMPLE_ROOM}{text}")
    figure: Any = axes.get_figure()
    onto_axes: Any = axes.transAxes
    corner = figure.dpi_scale_trans + ScaledTranslation(0.0, 1.0, onto_axes)
    sample = Line2D(
        [0.0, 0.32], [0.115, 0.115], transform=corner, clip_on=False, linewidth=2.0, **style.drawn
    )
    axes.add_artist(sample)


def legend_right(axes: "Axes") -> None:
    """A legend outside, to the right of the plot, where it hides no curve."""
    if axes.get_legend_handles_labels()[1]:
        axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.02), borderaxespad=0.0)


# Axes of the figures of a study: a margin that stays readable near its limit, and the varied input.

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
