"""The thermal history in the report: figures of every branch."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from rigdesign.results.transient import TransientResult

if TYPE_CHECKING:
    from markupsafe import Markup
    from matplotlib.figure import Figure


def transient_figures(
    result: TransientResult | None, draw: Callable[["Figure", str], "Markup"]
) -> dict[str, Any]:
    """Figures of every course by its title; none without a thermal course."""
    if result is None:
        return {}
    from rigdesign.report.figures.transient import transient_figure

    return {
        f"{curve.gearbox}, {curve.branch.replace('_', ' ')}": draw(
            transient_figure(result, curve),
            f"Temperatures and clearances of gearbox {curve.gearbox} over the course {curve.branch}",
        )
        for curve in result.curves
    }


def oil_power_figures(
    result: TransientResult | None, draw: Callable[["Figure", str], "Markup"]
) -> dict[str, Any]:
    """Heaters and cooler of every course by its title; none without a thermal course."""
    if result is None:
        return {}
    from rigdesign.report.figures.transient import oil_power_figure

    return {
        curve.branch.replace("_", " "): draw(
            oil_power_figure(result, curve), f"Power of heaters and cooler over the course {curve.branch}"
        )
        for curve in result.oil_power
    }
