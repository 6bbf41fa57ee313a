"""results.json: every result but the nodal fields, the same bytes for the same case; and read again."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, get_type_hints

from rigdesign.base.errors import WIDEST_PLACE, NotConvergedError, UsageError, shortened
from rigdesign.base.json_text import to_plain, to_text
from rigdesign.base.output_folder import write_whole
from rigdesign.base.version import RESULTS_SCHEMA_VERSION, __version__
from rigdesign.results.check import Check, Checks
from rigdesign.results.result import CouplingHistory, RunResult
from rigdesign.studies.stored_results import AGAIN, read_document

WITHOUT_DYNAMICS: Mapping[str, Any] = {"gearboxes": {}}
"""What stands for the dynamics of a rig without drivetrain."""


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
        "dynamics": result.dynamics if result.dynamics is not None else WITHOUT_DYNAMICS,
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


def read_result(path: Path) -> tuple[RunResult, Path]:
    """The result that a folder of `rigdesign check --out`, or its results.json, holds; and that file.

    Numbers have the ten digits of the file. ``fields`` holds those whose .vtu files stand beside it.

    Raises
    ------
    UsageError
        If there is none, it is damaged or of another schema version; says what to do.
    """
    from pydantic import TypeAdapter, ValidationError

    from rigdesign.report.fields import read_fields

    file, document = read_document(
        path, "report takes a folder that `rigdesign check --out` wrote, or its results.json"
    )
    try:
        values = {
            **document,
            "dynamics": None if document["dynamics"] == WITHOUT_DYNAMICS else document["dynamics"],
            "expansion": document["growth"],
            "coupling": _histories(document["coupling"]["residuals"]),
        }
        own = {
            name: TypeAdapter(kind).validate_python(values[name])
            for name, kind in get_type_hints(RunResult).items()
            if name in values and name not in ("checks", "fields")
        }
        checks = Checks(TypeAdapter(list[Check]).validate_python(values["checks"]))
        return RunResult(**own, checks=checks, fields=read_fields(document["fields"], file.parent)), file
    except (KeyError, TypeError, ValidationError) as error:
        what = shortened(f"{type(error).__name__}: {error}".replace("\n", " "))
        raise UsageError(f"{shortened(str(file), WIDEST_PLACE)}: is damaged ({what}); {AGAIN}") from None


def _histories(rows: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Residuals of every iteration by stage."""
    by_stage: dict[str, list[dict[str, float]]] = {}
    for row in rows:
        residuals = {key: value for key, value in row.items() if key not in ("stage", "pass")}
        by_stage.setdefault(row["stage"], []).append(residuals)
    return [{"stage": stage, "iterations": len(own), "residuals": own} for stage, own in by_stage.items()]


# failure.json: what a run without convergence leaves to look at.

FAILURE = "failure.json"
"""Written next to the files of an earlier run, which stay; a run that ends well removes it."""


def write_failure(error: NotConvergedError, out: Path) -> Path | None:
    """Write what an iteration went through to ``out``/failure.json; its path, None where the error holds nothing.

    Raises
    ------
    OutputError
        If the folder cannot be written.
    """
    if not error.history:
        return None
    document = {"tool_version": __version__, "error": str(error), "history": _finite(error.history)}
    write_whole(out / FAILURE, to_text(to_plain(document)))
    return out / FAILURE


def _finite(value: Any) -> Any:
    """The same with texts for numbers that JSON has no form for: a run that diverges may end in them."""
    if isinstance(value, Mapping):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value
