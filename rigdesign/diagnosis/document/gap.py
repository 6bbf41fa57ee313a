"""The gap on points held out in diagnosis.json, with what is named or picked and with what is refused."""

from typing import Any

import numpy as np

from rigdesign.diagnosis.document.outcome import Outcome
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.heldout import Gap
from rigdesign.measurement.comparison.compare import display_residual
from rigdesign.prediction.model import Feature


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
            "effect": one.name,
            "title": outcome.names.title(one.explanation),
            "explanation": one.explanation,
            "reason": one.reason,
            "gap": None if one.gap is None else _gap_numbers(one.gap),
        }
        for one in outcome.result.diagnosis.refused
    ]


def gap_rows(outcome: Outcome) -> list[dict[str, Any]]:
    """Root mean square of measured minus simulated by channel on the held-out points, in the unit of the channel.

    Those that the named effects move most come first; ``moved`` is the change they make.
    """
    result, found = outcome.result, outcome.result.diagnosis
    features = kept_features(outcome)
    noise = result.problem.residuals.noise[list(found.kept)]
    spread = np.sqrt(np.diagonal(found.covariance.matrix))
    rows = []
    for name, entry in result.data.channels.items():
        own = np.array(
            [f.channel == name and f.setting in found.held_out_points for f in features], dtype=np.bool_
        )
        if not own.any():
            continue
        numbers = (found.residual, found.residual - outcome.answer, outcome.answer, noise)
        shown = [display_residual(_rms(one[own]), entry.channel.quantity, entry.unit) for one in numbers]
        before, after, moved, floor = (value for value, _ in shown)
        rows.append(
            {
                "channel": name, "quantity": entry.channel.quantity, "unit": shown[0][1], "before": before,
                "after": after, "moved": moved, "noise": floor,
                "moved_over_spread": _rms(outcome.answer[own] / spread[own]), "numbers": int(own.sum()),
            }
        )  # fmt: skip
    return sorted(rows, key=lambda row: -row["moved_over_spread"])


def kept_features(outcome: Outcome) -> tuple[Feature, ...]:
    """The numbers that were kept, in the order of residual and answer."""
    return tuple(outcome.result.problem.residuals.features[row] for row in outcome.result.diagnosis.kept)


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))
