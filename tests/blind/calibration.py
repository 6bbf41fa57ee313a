"""The shipped constants of the diagnosis from healthy sets of several rigs: amplitudes, drift and inflation."""

from collections.abc import Sequence
from dataclasses import replace

from rigdesign.diagnosis.residual.baseline import Change, Drift, fit_amplitudes, fit_drift, group_of
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem
from rigdesign.diagnosis.statistics.amplitudes import Amplitudes
from tests.blind.covariance_inflation import inflate

ROUNDS = 2
"""Fits one after the other, each with the constants bent at the amplitudes of the one before."""


def calibrate(
    alike: Sequence[Sequence[ResidualProblem]],
    start: Amplitudes,
    fixed: frozenset[str] = frozenset(),
    larger: Sequence[ResidualProblem] = (),
) -> tuple[Amplitudes, dict[str, float]]:
    """Amplitudes and inflation of healthy sets, in lists of the same features.

    The inflation takes over what amplitudes had to stretch for, so both are found again in turn.

    larger : sets with too many numbers for the amplitudes; the inflation counts them too
    """
    found, inflation = start, dict[str, float]()
    for _ in range(ROUNDS):
        groups = [group_of(sets, found, inflation) for sets in alike]
        values = fit_amplitudes(groups, found, fixed, start).values
        found = found.with_values(dict(values))
        inflation = inflate((*(one for sets in alike for one in sets), *larger), found)
    return found, inflation


def calibrate_drift(
    pairs: Sequence[tuple[ResidualProblem, ResidualProblem]], amplitudes: Amplitudes, start: Drift
) -> Drift:
    """What a healthy rig changes from set to set, from pairs of healthy sets (the second is the baseline).

    The shares maximise the likelihood of all changes; `inflate_drift` finds the inflation.
    """
    changes = [Change.of(residuals, baseline, amplitudes) for residuals, baseline in pairs]
    still = replace(start, inflation={})
    return still.with_scales(fit_drift(changes, still).values)
