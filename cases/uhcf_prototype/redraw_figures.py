"""Draw P2's Figures 7 and 8 with ours: figures_7_8.svg of the README.

`python -m cases.uhcf_prototype.redraw_figures [FILE]` from the root of the source tree; half a minute. Of P2's curves
only what it prints in words is shown.
"""

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from rigdesign.case.shipped import case_folder
from rigdesign.report.figures.drawing import STYLE, new_figure
from tests.published.decomposition import part_sweeps
from tests.published.prototype import Prototype
from tests.published.speed_sweeps import MAIN, SUBCRITICAL, TOP_SPEED, SpeedSweep

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SHOWN = {
    "torsion": ("shafts that only twist", "#8c8c8c", "-"),
    "bending": ("six degrees of freedom, Table 1", "#1f4e79", "-"),
    "corner-2": ("the same, twice the corner gap", "#c55a11", "-"),
    "corner-3": ("three times", "#c55a11", "--"),
    "corner-2-closing-rate": ("twice, damper on the closing rate", "#2e7d32", "-"),
}
"""Parts of the decomposition: label, colour, line."""
GEARS = ("test gear", "reference gear")
PRINTED_FACTORS = (
    ((SUBCRITICAL, 1.5, "> 1.5"), (MAIN, 1.3, "1.3"), ((4500.0, TOP_SPEED), 1.2, "1.2")),
    (((4500.0, TOP_SPEED), 1.008, "1.008"),),
)
"""K_V of P2's simulation for both gears: speeds, value, as printed."""
PRINTED_AMPLITUDES = (
    (((750.0, 3000.0), 150.0, "up to 150"), ((3000.0, TOP_SPEED), 50.0, "50")),
    (((750.0, TOP_SPEED), 50.0, "below 50"),),
)
"""Torque amplitudes [N m], as above."""


def draw(axes: "Axes", sweeps: dict[str, SpeedSweep], mesh: int, *, amplitude: bool) -> None:
    """K_V (max/mean), or the largest less the mean torque, of one mesh over speed."""
    for name, (label, colour, line) in SHOWN.items():
        sweep = sweeps[name]
        value = sweep.factor[:, mesh]
        if amplitude:
            value = (value - 1.0) * sweep.mean[:, mesh]
        axes.plot(sweep.speed, value, line, color=colour, linewidth=1.1, label=label)
    printed = (PRINTED_AMPLITUDES if amplitude else PRINTED_FACTORS)[mesh]
    for (low, high), value, text in printed:
        axes.plot([low, high], [value, value], color="black", linewidth=1.6)
        axes.annotate(
            f"P2: {text}", (high, value), xytext=(0, 3), textcoords="offset points", fontsize=8, ha="right"
        )
    axes.set_xlim(0.0, TOP_SPEED)
    axes.grid(alpha=0.3)


def main(file: Path) -> None:
    """Write the picture."""
    import matplotlib as mpl

    sweeps = part_sweeps(Prototype(case_folder()))
    with mpl.rc_context(STYLE):
        figure = new_figure(6.0)
        axes = figure.subplots(2, 2, sharex=True)
        for mesh, gear in enumerate(GEARS):
            draw(axes[0, mesh], sweeps, mesh, amplitude=True)
            draw(axes[1, mesh], sweeps, mesh, amplitude=False)
            axes[0, mesh].set_title(gear, fontsize=10)
            axes[1, mesh].set_xlabel("speed of the test pinion [rpm]")
        axes[0, 0].set_ylabel("largest less mean torque [N m] (Figure 7)")
        axes[1, 0].set_ylabel("K_V, max/mean (Figure 8)")
        figure.tight_layout(rect=(0.0, 0.07, 1.0, 1.0))
        figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="lower center", ncols=3, fontsize=8)
        figure.savefig(file, metadata={"Date": None} if file.suffix == ".svg" else None)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).with_name("figures_7_8.svg"))
