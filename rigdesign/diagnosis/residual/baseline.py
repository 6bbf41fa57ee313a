"""What a set leaves given a healthy set of the same rig.

What both share (the model's errors, the sensors) is known from the healthy one; what remains is noise, scatter of the
settings, and a drift.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from rigdesign.diagnosis.residual.residual_problem import ResidualProblem, plain
from rigdesign.diagnosis.statistics.amplitudes import Amplitudes, Fit, Group, fit
from rigdesign.diagnosis.statistics.columns import Array, amplitudes_of
from rigdesign.diagnosis.statistics.covariance import Covariance, Whitened
from rigdesign.diagnosis.statistics.resonance import Resonances
from rigdesign.prediction.model import met_again

TWINS = 10.0
"""How much more two readings of one number may share than each is off by itself: what the model has wrong there in a
way that no column spans is taken from the healthy set number by number."""


@dataclass(frozen=True, kw_only=True)
class Drift:
    """What a healthy rig changes from one set to the next.

    A point is met again at a speed a little off, and orders follow it, whatever excites them and whether the model
    knows of it or not.

    inflation : likeness of an effect -> spread of its coordinate from set to set that healthy pairs asked for
    """

    shared: float
    """Share of all errors that two sets have in common which each has anew."""
    slope: float
    """Share of what the model says that an order changes with the speed from one set to the other."""
    shaft: float
    """Share of what the natural frequencies make of a shaft order or sideband that the healthy set reads
    (`rigdesign.diagnosis.statistics.resonance`)."""
    mesh: float
    """Share of what the natural frequencies make of an order of the meshes."""
    amplitude: float
    """Share of an order of the meshes that the healthy set reads, at the same speed: torque and oil differ as well."""
    sensors: float
    """Share of its stated uncertainty that every sensor and setting has anew, as one shift of all its numbers."""
    constants: float
    """Logarithm by which every loss and film changes."""
    inflation: Mapping[str, float] = field(default_factory=dict)
    channels: Mapping[str, float] = field(default_factory=dict)
    """Channel -> standard deviation of a shift of all its numbers together from set to set, over their level
    (`Change.shift`); from a rig's own healthy sets."""

    @property
    def scales(self) -> dict[str, float]:
        """What scales the parts of a change by name: shares, and ``channel NAME``."""
        shares = {name: getattr(self, name) for name in SHARES}
        return shares | {CHANNEL + name: size for name, size in self.channels.items()}

    def with_scales(self, scales: Mapping[str, float]) -> "Drift":
        """Some of them changed, or channels added."""
        shares: dict[str, Any] = {name: scales[name] for name in SHARES if name in scales}
        channels = {name.removeprefix(CHANNEL): size for name, size in scales.items() if name not in SHARES}
        return replace(self, **shares, channels={**self.channels, **channels})


SHARES = ("shared", "slope", "shaft", "mesh", "amplitude", "sensors", "constants")
"""Numbers of a drift that scale what two sets share, what their orders do, what sensors state, losses and films."""

CHANNEL = "channel "
"""Before the name of a channel that has a shift of its own."""


@dataclass(frozen=True, kw_only=True)
class Change:
    """What one set leaves given a healthy one, and of what it may consist.

    expected : (n,) residual that the healthy set foretells; known : (n, n) its covariance, with noise and scatter
    shared : (n, n) covariance of what both sets share
    slope, steep : (n,) what speeds met differently make of an order, by the model's derivative and by the natural
        frequencies near it; amplitude : (n,) of the orders in the healthy set; all zero for all other numbers
    """

    residuals: ResidualProblem
    expected: Array
    known: Array
    shared: Array
    slope: Array
    steep: Array
    amplitude: Array

    @classmethod
    def of(cls, residuals: ResidualProblem, baseline: ResidualProblem, amplitudes: Amplitudes) -> "Change":
        """By the columns both have: what they span is known from it, and errors number by number."""
        residuals = residuals.on_the_scale_of(baseline)
        here, there = residuals.covariance(amplitudes), baseline.covariance(amplitudes)
        after, before = here.deviations, _matched(there, here)
        spread, spread_before = residuals.own_spread(amplitudes), baseline.own_spread(amplitudes)
        again = met_again(residuals.library.settings, baseline.library.settings)
        twins, step = _same_numbers(residuals, baseline, again), _speed_steps(residuals, baseline, again)
        amplitude = twins @ amplitudes_of(baseline.features, baseline.values)
        cross = after @ before.T + TWINS**2 * spread[:, None] * twins * spread_before[None, :]
        known = before @ before.T + TWINS**2 * np.diag(spread_before**2)
        noise_before = np.diag(baseline.noise**2) + baseline.scatter
        both = after @ after.T
        expected, covariance = _given(
            known, cross, both + TWINS**2 * np.diag(spread**2), noise_before, baseline.residual
        )
        alone = np.diag(residuals.noise**2) + residuals.scatter
        return cls(
            residuals=residuals,
            expected=expected,
            known=covariance + alone,
            shared=both + np.diag(spread**2),
            slope=step * amplitudes_of(residuals.features, _by_speed(residuals)),
            steep=step * _resonances(residuals, baseline).change(amplitude),
            amplitude=amplitude,
        )

    def covariance(self, drift: Drift) -> Array:
        """(n, n) of the change in a rig that stayed healthy."""
        scaled = sum(drift.scales[name] ** 2 * part for name, part in self.parts(drift).items())
        return np.asarray(self.known + self.residuals.inflated(drift.inflation) + scaled)

    def parts(self, drift: Drift) -> dict[str, Array]:
        """Name of a scale of the drift -> (n, n) covariance of what it scales, at one."""
        mesh, moved, daily = (
            self.residuals.of_mesh,
            self.residuals.sensor_shifts,
            self.residuals.daily_changes,
        )
        shares = {
            "shared": self.shared,
            "slope": np.diag(self.slope**2),
            "shaft": np.diag(np.where(mesh, 0.0, self.steep) ** 2),
            "mesh": np.diag(np.where(mesh, self.steep, 0.0) ** 2),
            "amplitude": np.diag(np.where(mesh, self.amplitude, 0.0) ** 2),
            "sensors": moved @ moved.T,
            "constants": daily @ daily.T,
        }
        shifts = {name: self.shift(name) for name in drift.channels}
        return shares | {CHANNEL + name: np.outer(shift, shift) for name, shift in shifts.items()}

    def shift(self, channel: str) -> Array:
        """(n,) all numbers of a channel moved together, as by its level: by one temperature, or in proportion.

        Orders are no part of it.
        """
        residuals = self.residuals
        of_channel = np.array(
            [feature.channel == channel and not feature.order for feature in residuals.features], dtype=bool
        )
        if not of_channel.any():
            return np.zeros(len(of_channel))
        level = residuals.level[of_channel]
        if "temperature" in residuals.channels[channel].quantity:
            level = np.full_like(level, np.sqrt(np.mean(level**2)))
        moved = np.zeros(len(of_channel))
        moved[of_channel] = level
        return moved

    def whitened(self, drift: Drift) -> Whitened:
        """The change where a healthy rig is white noise."""
        total = Covariance(base=self.covariance(drift), columns=(), amplitudes={})
        return Whitened.of(total, self.residuals.residual - self.expected)


def differenced(
    residuals: ResidualProblem, baseline: ResidualProblem, amplitudes: Amplitudes, drift: Drift
) -> Whitened:
    """The residual of a set given a healthy set of the same rig.

    What both share is the covariance of the columns at either set's numbers; noise, the settings' scatter and a
    drift are each set's own.
    """
    return Change.of(residuals, baseline, amplitudes).whitened(drift)


def _resonances(residuals: ResidualProblem, baseline: ResidualProblem) -> Resonances:
    """Natural frequencies near the orders of a set, those measured on the healthy rig among them."""
    resonances = residuals.resonances
    return replace(resonances, modes=np.concatenate([resonances.modes, baseline.resonances.modes]))


def _matched(there: Covariance, here: Covariance) -> Array:
    """Deviations of the other set in the order of the columns of this one; zero where it has none."""
    place = {column.name: number for number, column in enumerate(there.columns)}
    deviations = there.deviations
    rows = [
        deviations[:, place[column.name]] if column.name in place else np.zeros(len(deviations))
        for column in here.columns
    ]
    return np.stack(rows, axis=1)


def _same_numbers(residuals: ResidualProblem, baseline: ResidualProblem, again: Mapping[str, str]) -> Array:
    """(n, m) one where two numbers are the same channel and order at a point that was met again."""
    others = {(f.channel, f.setting, f.order, f.part): j for j, f in enumerate(baseline.features)}
    same = np.zeros((len(residuals.features), len(baseline.features)))
    for row, f in enumerate(residuals.features):
        twin = others.get((f.channel, again[f.setting], f.order, f.part)) if f.setting in again else None
        if twin is not None:
            same[row, twin] = 1.0
    return same


def _speed_steps(residuals: ResidualProblem, baseline: ResidualProblem, again: Mapping[str, str]) -> Array:
    """(n,) by how much each number's point was met at another speed: logarithm of the ratio, without sign."""
    before = {setting.name: setting.speed for setting in baseline.library.settings}
    steps = {
        setting.name: abs(float(np.log(setting.speed / before[again[setting.name]])))
        for setting in residuals.library.settings
        if setting.name in again
    }
    return np.array([steps.get(feature.setting, 0.0) for feature in residuals.features])


def _by_speed(residuals: ResidualProblem) -> Array:
    """(n,) derivative of the prediction by the logarithm of the speed of its point."""
    speeds = {setting.name: setting.speed for setting in residuals.library.settings}
    slope = np.zeros(len(residuals.features))
    for (kind, _, point), values in residuals.library.inputs.items():
        if kind == "speed":
            slope += speeds[point] * values
    return slope


def _given(known: Array, cross: Array, shared: Array, noise: Array, residual: Array) -> tuple[Array, Array]:
    """Mean (n,) and covariance (n, n) of the shared part given another set's residual (m,)."""
    solved = cho_solve(cho_factor(known + noise), np.column_stack([residual, cross.T]), check_finite=False)
    return np.asarray(cross @ solved[:, 0]), np.asarray(shared - cross @ solved[:, 1:])


# Amplitudes of a healthy rig's covariance and its drift from healthy sets, by marginal likelihood.
#
# The covariance is a sum over kinds of cause; the amplitudes maximise the likelihood of all groups of sets together,
# held by a wide prior around their starting values (`rigdesign.diagnosis.statistics.amplitudes`).

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
    spaces = [plain(residuals, amplitudes, inflation) for residuals in sets]
    parts: dict[str, Array] = {}
    for column in spaces[0].covariance.columns:
        values = column.spread * column.values
        parts[column.kind] = parts.get(column.kind, 0.0) + np.outer(values, values)
    parts["answer"] = first.answer_error
    nothing = Amplitudes(**dict.fromkeys((*OWN_KINDS, "answer"), 0.0))
    for kind in OWN_KINDS:
        alone = nothing.with_values({kind: 1.0})
        spread = first.own_spread(alone)
        if spread.any():
            parts[kind] = np.diag(spread**2)
    return Group(
        noise=np.mean([residuals.base_noise(nothing) for residuals in sets], axis=0),
        parts=parts,
        residuals=np.stack([space.raw for space in spaces], axis=1),
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
