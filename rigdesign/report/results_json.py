"""results.json: every result but the nodal fields, the same bytes for the same case."""

from collections.abc import Sequence
from typing import Any

from rigdesign.base.json_text import to_plain
from rigdesign.base.version import RESULTS_SCHEMA_VERSION, __version__
from rigdesign.results.result import CouplingHistory, RunResult


def results_document(result: RunResult) -> dict[str, Any]:
    """Content of results.json as plain dicts, lists, strings and finite numbers.

    Units stand in the key (``_Nm``, ``_degC``) or in the field ``unit`` next to the value.

    Raises
    ------
    NonFiniteResultError
        If a number is NaN or infinite; names the key.
    """
    document: dict[str, Any] = {
        "schema_version": RESULTS_SCHEMA_VERSION,
        "tool_version": __version__,
        "case": result.case,
        "fidelity": result.fidelity,
        "verdict": result.verdict,
        "checks": result.checks,
        "dynamics": result.dynamics if result.dynamics is not None else {"gearboxes": {}},
        "losses": result.losses,
        "oil": result.oil,
        "cooler": result.cooler,
        "thermal": result.thermal,
        "growth": result.expansion,
        "coupling": _coupling(result.coupling),
        "discretisation": result.discretisation,
        "reference_shift": result.reference_shift,
        "hand_checks": result.hand_checks,
        "inputs": result.inputs,
        "assumptions": result.assumptions,
        "overrides": result.overrides,
        "not_modelled": result.not_modelled,
        "warnings": result.warnings,
        "flips": result.flips,
        "flip_search": result.flip_search,
        "timings_s": result.timings_s,
    }
    if result.events:
        document["events"] = result.events
    if result.rolling_bearings:
        document["rolling_bearings"] = result.rolling_bearings
    if result.lateral is not None:
        document["lateral"] = result.lateral
    if result.rig_heat:
        document["rig_heat"] = result.rig_heat
    if result.oil_circuits:
        document["oil_circuits"] = result.oil_circuits
    if result.ranges is not None:
        document["ranges"] = result.ranges
    if result.transient is not None:
        document["transient"] = result.transient
    plain: dict[str, Any] = to_plain(document)
    return plain


def _coupling(histories: Sequence[CouplingHistory]) -> dict[str, Any]:
    """``iterations`` of the slowest stage and the residuals of every iteration of every stage."""
    return {
        "iterations": max((history.iterations for history in histories), default=0),
        "residuals": [
            {"stage": history.stage, "pass": number, **residual}
            for history in histories
            for number, residual in enumerate(history.residuals, start=1)
        ],
    }
