"""results.json: every result but the nodal fields, the same bytes for the same case."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from rigdesign import __version__
from rigdesign.base.finite import finite
from rigdesign.results.result import CouplingHistory, RunResult

SCHEMA_VERSION = "1"
SIGNIFICANT_DIGITS = 10
"""Digits kept of every number: far beyond any model's accuracy, short of the last bits of round-off."""


def results_document(result: RunResult) -> dict[str, Any]:
    """Content of results.json as plain dicts, lists, strings and finite numbers.

    Units stand in the key (``_Nm``, ``_degC``) or in the field ``unit`` beside the value.

    Raises
    ------
    NonFiniteResultError
        If a number is NaN or infinite; names the key.
    """
    document: dict[str, Any] = {
        "schema_version": SCHEMA_VERSION,
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
        "growth": result.growth,
        "coupling": _coupling(result.coupling),
        "discretisation": result.discretisation,
        "reference_shift": result.reference_shift,
        "hand_checks": result.hand_checks,
        "assumptions": result.assumptions,
        "overrides": result.overrides,
        "not_modelled": result.not_modelled,
        "warnings": result.warnings,
        "timings_s": result.timings_s,
    }
    if result.ranges is not None:
        document["ranges"] = result.ranges
    if result.transient is not None:
        document["transient"] = result.transient
    plain: dict[str, Any] = to_plain(document)
    return plain


def to_text(document: Mapping[str, Any]) -> str:
    """JSON text with a final newline; keys keep their order."""
    return json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def to_plain(value: Any, path: str = "") -> Any:
    """Turn records, arrays and numpy scalars into what JSON knows; numbers keep ten significant digits.

    Raises
    ------
    NonFiniteResultError
        If a number is NaN or infinite; names the key.
    TypeError
        If a value has no JSON form; names the key.
    """
    if value is None or isinstance(value, str | bool):
        return value
    if isinstance(value, int | np.integer):
        return int(value)
    if isinstance(value, float | np.floating):
        return _rounded(float(value), path)
    if isinstance(value, np.bool_):
        return bool(value)
    if is_dataclass(value) and not isinstance(value, type):
        return {
            item.name: to_plain(getattr(value, item.name), _join(path, item.name)) for item in fields(value)
        }
    if isinstance(value, Mapping):
        return {str(key): to_plain(item, _join(path, str(key))) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        return to_plain(value.tolist(), path)
    if isinstance(value, Sequence):
        return [to_plain(item, f"{path}[{index}]") for index, item in enumerate(value)]
    raise TypeError(f"{path}: {type(value).__name__} has no JSON form")


def _rounded(value: float, path: str) -> float:
    return float(f"{finite(path, value):.{SIGNIFICANT_DIGITS}g}") + 0.0


def _join(path: str, key: str) -> str:
    return f"{path}.{key}" if path else key


def _coupling(histories: Sequence[CouplingHistory]) -> dict[str, Any]:
    """``iterations`` of the slowest stage and the residuals of every pass of every stage."""
    return {
        "iterations": max((history.iterations for history in histories), default=0),
        "residuals": [
            {"stage": history.stage, "pass": number, **residual}
            for history in histories
            for number, residual in enumerate(history.residuals, start=1)
        ],
    }
