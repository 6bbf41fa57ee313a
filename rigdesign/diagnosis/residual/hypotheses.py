"""All explanations of one residual, in the space where a healthy rig is white noise."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.library.library import Response
from rigdesign.diagnosis.residual.sensors import SensorError
from rigdesign.diagnosis.residual.unmodelled_cause import UNKNOWN, UnmodelledCause
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.covariance import Covariance
from rigdesign.diagnosis.statistics.hypothesis import Curve, Hypothesis
from rigdesign.diagnosis.statistics.phase_shift import Turning
from rigdesign.prediction.model import Feature

SIGMAS = 12.0
"""Half width of the prior of an unmodelled cause in its own standard deviations: as far as that of an effect that is
seen well; its size has no bound."""

INVISIBLE = 1e-3
"""Whitened length of an effect at its bound below which these sensors do not answer to it at all."""


def physical(
    covariance: Covariance | None,
    features: Sequence[Feature],
    effects: Sequence[Effect],
    responses: Mapping[str, Response],
    teeth_a_turn: int,
    least: float = INVISIBLE,
) -> list[Hypothesis]:
    """Effects of the catalogue that the sensors answer to; of a tooth that may be any, one explanation each.

    covariance : None leaves the answers in the units of the features
    least : whitened length of an effect at its bound below which it is left out
    """
    turning = Turning.of(features)
    known = [(effect, responses[effect.name]) for effect in effects if effect.name in responses]
    copies = [
        (effect, response, f"{effect.name}/{tooth}" if effect.any_tooth else effect.name, tooth)
        for effect, response in known
        for tooth in range(max(effect.any_tooth, 1))
    ]
    runs = []
    for _, response, _, tooth in copies:
        rows = response.answers if response.nonlinear else response.sensitivity().T
        runs.append(turning.turned(rows, tooth, teeth_a_turn) if tooth else rows)
    found = [
        _curve(effect, response, name, white) if response.nonlinear else _plane(effect, name, white)
        for (effect, response, name, _), white in zip(copies, whitened(covariance, runs), strict=True)
    ]
    return [one for one in found if _reach(one) > least]


def whitened(covariance: Covariance | None, rows: Sequence[Array]) -> list[Array]:
    """Blocks (m, n) of answers in the space of the covariance; all in one solve, which is what takes the time."""
    if not rows or covariance is None:
        return list(rows)
    white = covariance.whiten(np.concatenate(rows).T).T
    return np.split(white, np.cumsum([len(block) for block in rows])[:-1])


def _curve(effect: Effect, response: Response, name: str, white: Array) -> Hypothesis:
    return Hypothesis(
        name=name,
        family="physical",
        parts=(effect.claim,),
        curve=Curve.of(response.coordinates[:, 0], white, effect.parameters[0].bounds),
        own=(effect.name,),
    )


def _plane(effect: Effect, name: str, white: Array) -> Hypothesis:
    return Hypothesis(
        name=name,
        family="physical",
        parts=(effect.claim,),
        columns=white.T,
        half=effect.reach,
        own=(effect.name,),
    )


def _reach(hypothesis: Hypothesis) -> float:
    """Whitened length of the answer at the bound."""
    if hypothesis.curve is not None:
        return float(np.linalg.norm(hypothesis.curve.answers, axis=1).max())
    assert hypothesis.columns is not None
    return float(np.linalg.norm(hypothesis.columns) * hypothesis.half)


def sensor(covariance: Covariance | None, errors: Sequence[SensorError]) -> list[Hypothesis]:
    """Sensors and settings that may be in error; without a covariance in the units of the features."""
    columns = whitened(covariance, [error.values[None, :] for error in errors])
    return [
        Hypothesis(
            name=error.name,
            family="sensor",
            parts=(error.name,),
            columns=white.T,
            half=error.bound,
            own=(error.name,),
        )
        for error, white in zip(errors, columns, strict=True)
    ]


def without_a_name(covariance: Covariance, causes: Iterable[UnmodelledCause]) -> list[Hypothesis]:
    """Unmodelled causes, of any size; the prior of the size is as wide as that of something seen at `SIGMAS`."""
    causes = list(causes)
    found = []
    columns = whitened(covariance, [columns.T for _, _, columns in causes])
    for (family, name, _), white in zip(causes, columns, strict=True):
        longest = float(np.linalg.norm(white, axis=1).max())
        if longest <= 1e-9:
            continue
        found.append(
            Hypothesis(
                name=f"{UNKNOWN}{name}",
                family=family,
                parts=(f"{UNKNOWN}{name}",),
                columns=white.T / longest,
                half=SIGMAS,
                unit=longest,
                limits=(np.full(white.shape[0], -np.inf), np.full(white.shape[0], np.inf)),
            )
        )
    return found
