"""diagnosis.json: what was found, how sure it is, what it depends on and what remains."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from math import isfinite
from typing import Any

import numpy as np

from rigdesign.base import units
from rigdesign.base.json_text import to_plain
from rigdesign.base.version import __version__
from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.decision.defaults import Calibration
from rigdesign.diagnosis.decision.naming import Names, Sized, Value, from_evidence, parameter_of, size_value
from rigdesign.diagnosis.document.advice import certainty, headline, steps
from rigdesign.diagnosis.document.outcome import Outcome, required_document
from rigdesign.diagnosis.residual.healthy import gauge_rows
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.detectability import Detectability
from rigdesign.diagnosis.statistics.heldout import Gap
from rigdesign.measurement import MeasurementSet
from rigdesign.measurement.comparison.compare import display_residual, sentence, significant
from rigdesign.measurement.comparison.locate import Located
from rigdesign.measurement.quantities import CHANNELS
from rigdesign.prediction.model import Feature

SCHEMA = 1
"""Of diagnosis.json."""


def diagnosis_document(outcome: Outcome) -> dict[str, Any]:
    """The document; plain values, numbers with ten significant digits at most.

    Raises
    ------
    NonFiniteResultError
        If a number is not finite; what does not exist is None.
    """
    result, diagnosis = outcome.result, outcome.result.diagnosis
    document = {
        "schema_version": SCHEMA,
        "tool_version": __version__,
        "case": {"name": result.case.name, "path": str(result.case.path), "hash": result.case.hash},
        "measurement": _measurement(result.measurement),
        "baseline": None if result.baseline is None else _measurement(result.baseline),
        "verdict": outcome.verdict,
        "strength": diagnosis.strength,
        "headline": headline(outcome),
        "certainty": certainty(outcome),
        "reason": diagnosis.decision.reason,
        "named": [{**_sized(sized), "posterior": _inclusion(outcome, sized)} for sized in outcome.named],
        "suspected": None if outcome.suspected is None else _sized(outcome.suspected),
        "suspects": [
            {
                "effect": suspect.name,
                "title": suspect.title,
                "posterior": suspect.inclusion,
                **(_NO_SIZE if suspect.size is None else _size_keys(suspect.size)),
            }
            for suspect in outcome.suspects
        ],
        "refused": refused_rows(outcome),
        "suspected_inputs": suspected_inputs(outcome),
        "picked": None if outcome.picked is None else _sized(outcome.picked),
        "alternatives": _alternatives(outcome),
        "detectability": detectability_rows(outcome),
        "aliases": _aliases(outcome),
        "gap": gap_document(outcome),
        "located": [_located(group, result.measurement) for group in outcome.before],
        "gauge_modes": gauge_mode_rows(outcome),
        "unexplained": _unexplained(outcome),
        "costs_stated": bool(result.measurement.costs),
        "next_measurements": [
            {
                "measurement": step.text,
                "why": step.why,
                "expected_evidence": step.expected_evidence,
                "expected_odds": step.odds,
                "cost": step.cost,
                "decides": step.decides,
            }
            for step in steps(outcome)
        ],
        "required_sizes": required_document(outcome),
        "data": {
            "findings": result.data.findings,
            "rejected_readings": _rejected(outcome),
            "numbers": len(diagnosis.kept),
            "points": [
                {
                    "point": setting.name,
                    "speed_rpm": units.display(setting.speed, "speed"),
                    "torque_Nm": setting.torque,
                    "held_out": setting.name in diagnosis.held_out_points,
                }
                for setting in result.data.settings
            ],
        },
        "patch": _patch(outcome),
        "calibration": _calibration(result.calibration),
        "seed": result.problem.seed,
    }
    plain = to_plain(document)
    assert isinstance(plain, dict)
    return plain


def suspected_inputs(outcome: Outcome) -> list[dict[str, Any]]:
    """What may be wrong with the data: stated doubts, and what the data checks found."""
    return [
        {
            "id": finding.id,
            "text": finding.text,
            "channels": list(finding.channels),
            "points": list(finding.points),
        }
        for finding in outcome.result.data.findings
        if finding.weight == "suspect"
    ]


def _measurement(measurement: MeasurementSet) -> dict[str, Any]:
    return {
        "title": measurement.title,
        "path": str(measurement.folder),
        "hash": measurement.hash,
        "points": len(measurement.points),
        "channels": list(measurement.channels),
    }


def _calibration(calibration: Calibration) -> dict[str, Any]:
    """Everything calibrated, by the keys of the contract."""
    document = asdict(calibration)
    for part in (document, document["drift"]):
        part["widening"] = part.pop("inflation")
    return document


def _inclusion(outcome: Outcome, sized: Sized) -> float:
    """Posterior mass of all explanations that hold the effect, in the look at the data that named it."""
    masses = [look.weights.inclusion.get(sized.name, 0.0) for look in outcome.result.diagnosis.evaluations]
    return max(masses)


def _sized(sized: Sized) -> dict[str, Any]:
    return {"effect": sized.name, "title": sized.title, **_size_keys(sized)}


_NO_SIZE: Mapping[str, Any] = {
    "explanation": None, "belongs_to": None, "tooth": None, "signature": None, "parameters": [],
}  # fmt: skip


def _size_keys(sized: Sized) -> dict[str, Any]:
    """Entry, tooth, and parameters as the contract has them."""
    effect = isinstance(sized.entry, Effect)
    return {
        "explanation": sized.explanation,
        "belongs_to": "case" if effect else "measurement",
        "tooth": sized.tooth,
        "signature": sized.entry.signature if isinstance(sized.entry, Effect) else None,
        "parameters": [_value(value) for value in sized.shown],
    }


def _value(value: Value) -> dict[str, Any]:
    return {
        "name": value.name,
        "value": value.value,
        "unit": value.unit,
        "interval_95": list(value.interval),
        "interval_open": value.open,
        "factor": value.factor,
    }


def _alternatives(outcome: Outcome) -> list[dict[str, Any]]:
    """Hypotheses with their posterior mass, none among them."""
    diagnosis = outcome.result.diagnosis
    evidence = {explanation.hypothesis.name: explanation for explanation in diagnosis.deciding.evidence}
    rows: list[dict[str, Any]] = [
        {"explanation": "none", "title": "nothing but the residual of a healthy rig", "family": "none", "effects": [],
         "posterior": diagnosis.deciding.weights.masses["none"], "gain": 0.0, "parameters": []}
    ]  # fmt: skip
    for alternative in diagnosis.alternatives:
        best = evidence[alternative.name]
        sized = outcome.names.entry(alternative.name) is not None
        size = (
            from_evidence(outcome.names, best, outcome.result.calibration.signature_error) if sized else None
        )
        rows.append(
            {
                "explanation": alternative.name,
                "title": outcome.names.title_of(best),
                "family": best.hypothesis.family,
                "effects": list(alternative.parts),
                "posterior": alternative.posterior,
                "gain": alternative.gain,
                "parameters": [] if size is None else [_value(value) for value in size.shown],
            }
        )
    return sorted(rows, key=lambda row: -row["posterior"])


def detectability_rows(outcome: Outcome) -> list[dict[str, Any]]:
    """One row an effect, of any tooth the one seen worst; sizes as values of the parameter, None where unbounded.

    The smallest ``isolable`` relative to its bound comes first.
    """
    names = outcome.names
    worst: dict[str, tuple[Detectability, int]] = {}
    for row in outcome.result.diagnosis.detectability:
        effect = names.plain(row.effect)
        kept, count = worst.get(effect, (row, 0))
        worst[effect] = (max(kept, row, key=lambda detectability: detectability.isolable), count + 1)
    rows = [
        _detectability(names, effect, row, count)
        for effect, (row, count) in sorted(
            worst.items(), key=lambda item: item[1][0].isolable / item[1][0].bound
        )
    ]
    seen = {row["effect"] for row in rows}
    missing = [effect for effect in outcome.result.effects if effect.name not in seen]
    return rows + [_unseen(effect) for effect in missing]


def _detectability(names: Names, effect: str, row: Detectability, count: int) -> dict[str, Any]:
    parameter = parameter_of(names, row.effect)
    return {
        "effect": effect,
        "title": names.title(effect),
        "parameter": None if parameter is None else parameter.name,
        "unit": None if parameter is None else parameter.unit,
        "factor": parameter is not None and parameter.factor,
        "teeth": count if count > 1 else None,
        "detectable": size_value(names, row.effect, row.detectable),
        "isolable": size_value(names, row.effect, row.isolable),
        "bound": size_value(names, row.effect, row.bound),
        "detectable_share_of_bound": row.detectable / row.bound if isfinite(row.detectable) else None,
        "isolable_share_of_bound": row.isolable / row.bound if isfinite(row.isolable) else None,
        "nearest_rival": row.rival,
        "rival_title": names.title(row.rival),
        "correlation": row.correlation,
        "verdict": row.verdict,
    }


def _unseen(effect: Effect) -> dict[str, Any]:
    """An effect that no sensor of the set answers to."""
    parameter = effect.parameters[0]
    return {
        "effect": effect.name, "title": effect.title, "parameter": parameter.name, "unit": parameter.unit,
        "factor": parameter.factor, "teeth": effect.any_tooth or None, "detectable": None, "isolable": None,
        "bound": parameter.high, "detectable_share_of_bound": None, "isolable_share_of_bound": None,
        "nearest_rival": None, "rival_title": None, "correlation": None, "verdict": "not testable here",
    }  # fmt: skip


def _aliases(outcome: Outcome) -> list[dict[str, Any]]:
    """Pairs of effects that look alike, teeth of one gear taken together."""
    names = outcome.names
    strongest: dict[tuple[str, str], float] = {}
    for first, second, correlation in outcome.result.diagnosis.aliases:
        pair = sorted((names.plain(first), names.plain(second)))
        key = (pair[0], pair[1])
        if key[0] != key[1]:
            strongest[key] = max(strongest.get(key, 0.0), correlation)
    return [
        {
            "effects": list(pair),
            "titles": [names.title(effect) for effect in pair],
            "correlation": correlation,
        }
        for pair, correlation in sorted(strongest.items(), key=lambda item: (-item[1], item[0]))
    ]


def _located(item: Located, measurement: MeasurementSet) -> dict[str, Any]:
    return {
        "group": item.group,
        "significant": significant(item),
        "sentence": sentence(item, measurement),
        "whitened_rms": item.rms,
        "by_chance": item.excess,
        "channels": list(item.channels),
        "points_off": list(item.points),
    }


def _unexplained(outcome: Outcome) -> dict[str, Any]:
    """What is left once the named effects are in the model."""
    diagnosis = outcome.result.diagnosis
    last = diagnosis.evaluations[-1]
    return {
        "verdict": last.decision.verdict,
        "reason": last.decision.reason,
        "groups": [
            _located(group, outcome.result.measurement) for group in outcome.after if significant(group)
        ],
    }


def _rejected(outcome: Outcome) -> list[dict[str, Any]]:
    result = outcome.result
    rows = []
    for row, deviation in result.diagnosis.rejected:
        feature = result.problem.residuals.features[row]
        entry = result.data.channels[feature.channel]
        kind = CHANNELS[entry.channel.quantity].kind
        value = float(result.problem.residuals.values[row])
        rows.append(
            {
                "channel": feature.channel, "point": feature.setting or None, "order": feature.order,
                "part": feature.part, "value": units.display(value, kind, entry.unit), "unit": entry.unit,
                "deviation": deviation,
            }
        )  # fmt: skip
    return rows


def _patch(outcome: Outcome) -> Mapping[str, Any]:
    written = outcome.case_patch is not None
    offered = outcome.offered is not None
    return {
        "case": "case.patch.json" if written else None,
        "variant": "patched/case.toml" if written else None,
        "refused": None if written else outcome.refused,
        "offered": "suspected.patch.json" if offered else None,
        "offered_variant": "suspected/case.toml" if offered else None,
        "picked_by_user": outcome.picked is not None,
        "measurement": "measurement.patch.json" if outcome.corrections else None,
    }


def measurement_patch(outcome: Outcome) -> dict[str, Any]:
    """measurement.patch.json: JSON Patch on measurement.toml, and corrections that no key of it says."""
    measurement = outcome.result.measurement
    plain = to_plain(
        {
            "schema_version": SCHEMA,
            "tool_version": __version__,
            "measurement": {
                "title": measurement.title,
                "path": str(measurement.folder),
                "hash": measurement.hash,
            },
            "operations": [
                operation for correction in outcome.corrections for operation in correction.operations
            ],
            "corrections": [
                {
                    "effect": correction.name,
                    "text": correction.text,
                    "parameters": []
                    if correction.size is None
                    else [_value(value) for value in correction.size.shown],
                }
                for correction in outcome.corrections
            ],
        }
    )
    assert isinstance(plain, dict)
    return plain


def sentences(items: Sequence[Located], measurement: MeasurementSet) -> list[str]:
    """Conspicuous groups in words."""
    return [sentence(item, measurement) for item in items if significant(item)]


def leading_sentences(outcome: Outcome) -> list[str]:
    """Groups that the named effects move most, or that hold most of the residual; where none betrays itself."""
    diagnosis = outcome.result.diagnosis
    values = outcome.answer if outcome.in_model else diagnosis.residual
    shares = (values / np.sqrt(np.diagonal(diagnosis.covariance.matrix))) ** 2
    whole = float(shares.sum())
    weights = [(float(shares[list(item.features)].sum()), item) for item in outcome.before]
    ordered = sorted(weights, key=lambda pair: -pair[0])
    reported = [item for weight, item in ordered if weight > 0.15 * whole]
    return [
        f"{sentence(item, outcome.result.measurement)} {item.rms:.2g} standard deviations of a healthy rig."
        for item in reported
    ]


# The residual of root gauges by mode over the face: a tilt that fades with torque says more than four gauges.

LEAST_GAUGES = 2
"""Gauges of a gear from which there is more than one mode."""


def gauge_mode_rows(outcome: Outcome) -> list[dict[str, Any]]:
    """By gear, window, point and mode: measured less simulated, and over what a healthy rig leaves.

    ``residual_um_per_m`` is the root mean square over the gauges of that mode, positive for tilt where the gauges to
    the rear read more than simulated; ``deviations`` is it over its standard deviation in a healthy rig.
    """
    diagnosis = outcome.result.diagnosis
    residuals = outcome.result.problem.residuals
    features = [residuals.features[row] for row in diagnosis.kept]
    matrix = diagnosis.covariance.matrix
    rows = []
    for gauge_row in gauge_rows(features, residuals.channels):
        gauges = np.array(gauge_row.rows, dtype=np.intp)
        if len(gauges) < LEAST_GAUGES:
            continue
        for mode, shape in gauge_row.shapes.items():
            size = float(shape @ diagnosis.residual[gauges])
            spread = float(np.sqrt(shape @ matrix[np.ix_(gauges, gauges)] @ shape))
            rows.append(
                {
                    "gear": gauge_row.gear, "window": gauge_row.window, "point": gauge_row.point, "mode": mode,
                    "residual_um_per_m": 1e6 * size / float(np.sqrt(len(gauges))), "deviations": size / spread,
                }
            )  # fmt: skip
    return rows


# The gap on points held out in diagnosis.json, with what is named or picked and with what is refused.


def gap_document(outcome: Outcome) -> dict[str, Any] | None:
    """On points the fit never saw; None without any. ``after`` equals ``before`` where no effect is in the model."""
    if outcome.gap is None:
        return None
    return {
        **_gap_numbers(outcome.gap),
        "floor": 1.0,
        "unit": "standard deviations of a healthy rig",
        "held_out_points": list(outcome.gap.points),
        "effects_added": list(outcome.in_model),
        "full_run": outcome.full_run,
        "channels": gap_rows(outcome),
    }


def _gap_numbers(gap: Gap) -> dict[str, Any]:
    """``fall`` is that of the whitened square, with its standard deviation."""
    return {
        "before": gap.before, "after": gap.after, "fall": gap.fall, "scatter": gap.scatter, "shrunk": gap.shrunk,
        "grown": gap.grown,
    }  # fmt: skip


def refused_rows(outcome: Outcome) -> list[dict[str, Any]]:
    """Names that the search gave and that are not claimed, with the gap that speaks against them."""
    return [
        {
            "effect": refusal.name,
            "title": outcome.names.title(refusal.explanation),
            "explanation": refusal.explanation,
            "reason": refusal.reason,
            "gap": None if refusal.gap is None else _gap_numbers(refusal.gap),
        }
        for refusal in outcome.result.diagnosis.refused
    ]


def gap_rows(outcome: Outcome) -> list[dict[str, Any]]:
    """Root mean square of measured minus simulated by channel on the held-out points, in the unit of the channel.

    Those that the named effects move most come first; ``moved`` is the change they make.
    """
    result, diagnosis = outcome.result, outcome.result.diagnosis
    features = kept_features(outcome)
    noise = result.problem.residuals.noise[list(diagnosis.kept)]
    spread = np.sqrt(np.diagonal(diagnosis.covariance.matrix))
    rows = []
    for name, entry in result.data.channels.items():
        held_out = np.array(
            [f.channel == name and f.setting in diagnosis.held_out_points for f in features], dtype=np.bool_
        )
        if not held_out.any():
            continue
        numbers = (diagnosis.residual, diagnosis.residual - outcome.answer, outcome.answer, noise)
        shown = [
            display_residual(_rms(values[held_out]), entry.channel.quantity, entry.unit) for values in numbers
        ]
        before, after, moved, floor = (value for value, _ in shown)
        rows.append(
            {
                "channel": name, "quantity": entry.channel.quantity, "unit": shown[0][1], "before": before,
                "after": after, "moved": moved, "noise": floor,
                "moved_over_spread": _rms(outcome.answer[held_out] / spread[held_out]), "numbers": int(held_out.sum()),
            }
        )  # fmt: skip
    return sorted(rows, key=lambda row: -row["moved_over_spread"])


def kept_features(outcome: Outcome) -> tuple[Feature, ...]:
    """The numbers that were kept, in the order of residual and answer."""
    return tuple(outcome.result.problem.residuals.features[row] for row in outcome.result.diagnosis.kept)


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))
