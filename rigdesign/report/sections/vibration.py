"""Vibration of the power circuit: modes over speed, dynamic torque, and at which speeds the rig may dwell."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from rigdesign.report.sections.section import Draw, ReportSection, Values, gearbox_styles
from rigdesign.results.housing import ROUND_OFF
from rigdesign.results.result import RunResult
from rigdesign.results.vibration import sense_of_whirl

if TYPE_CHECKING:
    from markupsafe import Markup


def held_speeds(result: RunResult) -> dict[str, float]:
    """Pinion speed of every held stage [rpm]."""
    torques = result.dynamics.section_torques if result.dynamics is not None else None
    return {row["stage"]: row["speed_rpm"] for row in torques["held"]} if torques else {}


def _vibration(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures.teeth import place
    from rigdesign.report.figures.vibration import campbell_diagram, dwell_figure, section_torque_figure

    dynamics = result.dynamics
    assert dynamics is not None and dynamics.campbell is not None
    held = held_speeds(result)
    torques = dynamics.section_torques
    shown: Values = {
        "dwell_figure": None,
        "campbell_figure": None,
        "torque_figure": None,
        "torques": _governing(torques["held"]) if torques else [],
        "roots": _roots(dynamics.dynamic_root["curves"], draw) if dynamics.dynamic_root else {},
        "gauge_label": place,
        "leading": leading,
        "modes": _modes(dynamics.campbell["modes"]),
        **_in_motion(result, draw),
    }
    if dynamics.dwell is not None:
        shown["dwell_figure"] = draw(
            dwell_figure(dynamics.dwell), "Dynamic shares over speed and the bands to avoid"
        )
    if dynamics.campbell["modes"]:
        shown["campbell_figure"] = draw(
            campbell_diagram(dynamics.campbell, held),
            "Modes of the closed loop and excitation orders over speed",
        )
    if torques:
        shown["torque_figure"] = draw(
            section_torque_figure(torques["over_speed"], held),
            "Half peak-to-peak torque in meshes, joints and shafts over speed",
        )
    return shown


def _modes(modes: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Of every mode of the Campbell diagram frequency and decrement over speed from least to most, and its whirl."""
    return [
        {
            "mode": mode["mode"],
            "shape": mode["shape"],
            "frequency": _span(mode["frequency_Hz"]),
            "decrement": _span(mode["logarithmic_decrement"]),
            "whirl": sense_of_whirl(mode["whirl"]),
        }
        for mode in modes
    ]


def _span(values: list[float | None]) -> tuple[float, float]:
    known = [value for value in values if value is not None]
    return min(known), max(known)


def _in_motion(result: RunResult, draw: Draw) -> Values:
    """Figures of spectra and contact."""
    from rigdesign.report.figures.teeth import pair_share_figure
    from rigdesign.report.figures.vibration import spectrum_figure, waterfall_figure

    dynamics = result.dynamics
    assert dynamics is not None
    styles = gearbox_styles(result)
    stages = dict.fromkeys(waterfall.stage for waterfall in dynamics.waterfalls)
    shown: Values = {"spectrum_figure": None, "share_figure": None}
    if dynamics.spectra:
        shown["spectrum_figure"] = draw(
            spectrum_figure(dynamics.spectra, styles), "Spectrum of the mesh torque at the held stages"
        )
    if dynamics.pair_shares:
        shown["share_figure"] = draw(
            pair_share_figure(dynamics.pair_shares, styles), "Share of a tooth pair over the rolling angle"
        )
    shown["waterfall_figures"] = {
        stage: draw(
            waterfall_figure(
                [waterfall for waterfall in dynamics.waterfalls if waterfall.stage == stage], styles
            ),
            f"Spectrum of the mesh torque over speed in stage {stage}",
        )
        for stage in stages
    }
    return shown


def _roots(curves: list[dict[str, Any]], draw: Draw) -> "dict[str, Markup]":
    """Figure of every gearbox: its gauges where it has some, else the most stressed points."""
    from rigdesign.report.figures.teeth import dynamic_root_figure

    found = {}
    for gearbox in dict.fromkeys(curve["gearbox"] for curve in curves):
        own = [curve for curve in curves if curve["gearbox"] == gearbox]
        gauged = [curve for curve in own if curve["gauge"]]
        found[gearbox] = draw(
            dynamic_root_figure(gauged or own),
            f"Root stress and strain rate in gearbox {gearbox} over the rolling angle",
        )
    return found


def _governing(rows: list[dict[str, object]]) -> list[dict[str, object]]:
    """Of every part the row with the highest peak, the first of several that agree, in the order of the list."""
    highest: dict[object, dict[str, object]] = {}
    for row in rows:
        key = row["kind"], row["part"]
        if key not in highest or float(str(row["peak_Nm"])) > (1.0 + ROUND_OFF) * float(
            str(highest[key]["peak_Nm"])
        ):
            highest[key] = row
    return list(highest.values())


def leading(band: dict[str, Any], most: int = 4) -> list[dict[str, Any]]:
    """Resonances that make a band: of every kind the strongest, then the strongest of the rest, by speed."""
    ranked = sorted(band["resonances"], key=lambda one: -(one["share"] or 0.0))
    first = {one["kind"]: one for one in reversed(ranked)}
    chosen = list(first.values())
    chosen += [one for one in ranked if one not in chosen][: max(0, most - len(chosen))]
    return sorted(chosen, key=lambda one: float(one["speed_rpm"]))


def _details(result: RunResult, draw: Draw) -> Values:
    dynamics = result.dynamics
    assert dynamics is not None
    run = dynamics.section_torques["time_run"] if dynamics.section_torques else []
    return {
        "run_torques": _run_torques(run),
        "press_fits": least_safe(dynamics.press_fits, "gear"),
        "splines": least_safe(dynamics.splines, "gear", "kind"),
    }


def _run_torques(rows: list[dict[str, Any]]) -> list[tuple[dict[str, Any], dict[str, Any]]]:
    """Of every place its rows in the time run with the highest torque, and with that which alternates most."""
    by_place: dict[str, list[dict[str, Any]]] = {}
    for row in rows:
        by_place.setdefault(row["place"], []).append(row)
    return [
        tuple(max(own, key=lambda row: float(row[key])) for key in ("peak_Nm", "half_peak_to_peak_Nm"))  # type: ignore[misc]
        for own in by_place.values()
    ]


class Rated(Protocol):
    """A record with a safety."""

    @property
    def safety(self) -> float | None:
        """None without torque or stress."""


R = TypeVar("R", bound=Rated)


def least_safe(records: Sequence[R], *names: str) -> list[R]:
    """Of the records that agree in some values that with the least safety; one without torque is the safest."""
    least: dict[tuple[object, ...], R] = {}
    for record in sorted(records, key=lambda record: math.inf if record.safety is None else record.safety):
        least.setdefault(tuple(getattr(record, name) for name in names), record)
    return sorted(least.values(), key=records.index)


def _turns(result: RunResult) -> bool:
    return result.dynamics is not None and result.dynamics.campbell is not None


VIBRATION = ReportSection(
    id="vibration", title="Vibration of the power circuit", template="vibration.html.j2", values=_vibration,
    applies=_turns,
)  # fmt: skip
VIBRATION_DETAILS = ReportSection(
    id="vibration_details", title="Dynamic torque by section", template="vibration_details.html.j2",
    values=_details, applies=_turns, place="appendix",
)  # fmt: skip
