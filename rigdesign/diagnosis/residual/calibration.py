"""Amplitudes of a healthy rig's covariance and its drift from healthy sets, by marginal likelihood.

The covariance is a sum over kinds of cause; the amplitudes maximise the likelihood of all groups of sets together, held
by a wide prior around their starting values (`rigdesign.diagnosis.statistics.marginal_likelihood`).
"""

from collections.abc import Mapping, Sequence

import numpy as np

from rigdesign.diagnosis.residual.baseline import Change, Drift
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem, plain
from rigdesign.diagnosis.statistics.amplitudes import Amplitudes
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.marginal_likelihood import Fit, Group, fit

HANDBOOK = 2.5
"""Factor within which the healthy spreads of constants, the error of their answers and local conductances stay, which
are stated with their sources: what two models disagree on beyond that is no constant of the rig."""

OWN_KINDS = ("point", "series_mesh_point", "series_shaft_point", "frequency")
"""Amplitudes of what each number is off by itself."""


def group_of(
    sets: Sequence[ResidualProblem], amplitudes: Amplitudes, inflation: Mapping[str, float]
) -> Group:
    """Healthy sets of one rig with the same features in the same order.

    amplitudes : at which the constants are bent to the data (`residuals.plain`): columns are those of the first
        set, residuals each set's own
    """
    first = sets[0]
    spaces = [plain(one, amplitudes, inflation) for one in sets]
    parts: dict[str, Array] = {}
    for column in spaces[0].covariance.columns:
        values = column.spread * column.values
        parts[column.kind] = parts.get(column.kind, 0.0) + np.outer(values, values)
    parts["answer"] = first.answer_error
    nothing = Amplitudes(**dict.fromkeys((*OWN_KINDS, "answer"), 0.0))
    for kind in OWN_KINDS:
        alone = nothing.with_values({kind: 1.0})
        own = first.own_spread(alone)
        if own.any():
            parts[kind] = np.diag(own**2)
    return Group(
        noise=np.mean([one.base_noise(nothing) for one in sets], axis=0),
        parts=parts,
        residuals=np.stack([one.raw for one in spaces], axis=1),
    )


def fit_amplitudes(
    groups: Sequence[Group],
    start: Amplitudes,
    fixed: frozenset[str] = frozenset(),
    prior: Amplitudes | None = None,
) -> Fit:
    """The amplitudes of the parts of the groups that make the healthy sets most likely.

    fixed : amplitudes that stay as they are: sensors and inputs are what the measurement states
    prior : centre of their wide prior; ``start`` when left out
    """
    first = start.as_dict()
    names = {kind for group in groups for kind in group.parts} - fixed
    return fit(
        groups,
        start={name: first[name] for name in names},
        prior=(prior or start).as_dict(),
        reach={name: float(np.log(HANDBOOK)) for name in names if name.startswith(STATED)},
        fixed={kind: value for kind, value in first.items() if kind not in names},
    )


STATED = ("constant", "link", "answer")
"""Beginnings of amplitudes on spreads that are stated with their sources (`HANDBOOK`)."""


def fit_drift(changes: Sequence[Change], start: Drift, weight: float = 1.0) -> Fit:
    """The scales of a drift that make changes of a healthy rig most likely; its inflation stays.

    weight : of each change in the likelihood, below one where they are not independent
    """
    groups = [_change_group(change, start, weight) for change in changes]
    return fit(groups, start=start.scales, prior=start.scales, reach={}, fixed={})


def _change_group(change: Change, drift: Drift, weight: float) -> Group:
    """One change, with what the scales of its drift scale."""
    left = change.residuals.residual - change.expected
    return Group(
        noise=change.covariance(drift.with_scales(dict.fromkeys(drift.scales, 0.0))),
        parts=change.parts(drift),
        residuals=left[:, None],
        weight=weight,
    )
