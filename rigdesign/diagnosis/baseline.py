"""What a set leaves given a healthy set of the same rig.

What both share (the model's errors, the sensors) is known from the healthy one; what remains is noise, scatter of the
settings, and a drift.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from rigdesign.diagnosis.amplitudes import Amplitudes
from rigdesign.diagnosis.columns import Array
from rigdesign.diagnosis.covariance import Covariance, Whitened
from rigdesign.diagnosis.healthy import own_spread
from rigdesign.diagnosis.subject import Comparison

TWINS = 10.0
"""How much more two readings of one number may share than each is off by itself: what the model has wrong there in a
way that no column spans is taken from the healthy set number by number."""


@dataclass(frozen=True, kw_only=True)
class Drift:
    """What a healthy rig changes from one set to the next: shares of what both sets share.

    widening : likeness of an effect -> spread of its coordinate from set to set that healthy pairs asked for
    """

    shared: float
    """Of everything."""
    shaft: float
    """Of shaft orders and sidebands, from point to point."""
    mesh: float
    """Of the orders of the meshes, from point to point."""
    amplitude: float
    """Of the amplitude of each order at each point, as the healthy set reads it: near a resonance it follows the speed,
    whatever excites it and whether the model knows of it or not."""
    widening: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Change:
    """What one set leaves given a healthy one, and of what it may consist.

    expected : (n,) residual that the healthy set foretells; known : (n, n) its covariance, with noise and scatter
    shared : (n, n) covariance of what both sets share; amplitude : (n,) of the orders in the healthy set, else zero
    """

    subject: Comparison
    expected: Array
    known: Array
    shared: Array
    amplitude: Array

    @classmethod
    def of(cls, subject: Comparison, baseline: Comparison, amplitudes: Amplitudes) -> "Change":
        """By the columns both have: what they span is known from it, and errors number by number."""
        here, there = subject.covariance(amplitudes), baseline.covariance(amplitudes)
        after, before = here.deviations, _matched(there, here)
        own = own_spread(subject.library, subject.channels, subject.mesh_orders, amplitudes)
        other = own_spread(baseline.library, baseline.channels, baseline.mesh_orders, amplitudes)
        twins = _same_numbers(subject, baseline)
        cross = after @ before.T + TWINS**2 * own[:, None] * twins * other[None, :]
        known = before @ before.T + TWINS**2 * np.diag(other**2)
        noise_before = np.diag(baseline.noise**2) + baseline.scatter
        both = after @ after.T
        expected, covariance = _given(
            known, cross, both + TWINS**2 * np.diag(own**2), noise_before, baseline.residual
        )
        alone = np.diag(subject.noise**2) + subject.scatter
        return cls(
            subject=subject,
            expected=expected,
            known=covariance + alone,
            shared=both + np.diag(own**2),
            amplitude=twins @ _amplitudes(baseline),
        )

    def covariance(self, drift: Drift) -> Array:
        """(n, n) of the change in a rig that stayed healthy."""
        by_point = self.shared * _by_point(self.subject, drift.shaft, drift.mesh)
        alone = np.diag((drift.amplitude * self.amplitude) ** 2) + self.subject.widened(drift.widening)
        return np.asarray(self.known + drift.shared**2 * self.shared + by_point + alone)

    def whitened(self, drift: Drift) -> Whitened:
        """The change where a healthy rig is white noise."""
        total = Covariance(base=self.covariance(drift), columns=(), amplitudes={})
        return Whitened.of(total, self.subject.residual - self.expected)


def differenced(subject: Comparison, baseline: Comparison, amplitudes: Amplitudes, drift: Drift) -> Whitened:
    """The residual of a set given a healthy set of the same rig.

    What both share is the covariance of the columns at either set's numbers; noise, the settings' scatter and a
    drift of the shared part are each set's own. Orders change with each point by itself: near a resonance what
    healthy teeth excite follows a speed that was met to a per cent only.
    """
    return Change.of(subject, baseline, amplitudes).whitened(drift)


def _matched(there: Covariance, here: Covariance) -> Array:
    """Deviations of the other set in the order of the columns of this one; zero where it has none."""
    place = {column.name: number for number, column in enumerate(there.columns)}
    deviations = there.deviations
    rows = [
        deviations[:, place[column.name]] if column.name in place else np.zeros(len(deviations))
        for column in here.columns
    ]
    return np.stack(rows, axis=1)


def _same_numbers(subject: Comparison, baseline: Comparison) -> Array:
    """(n, m) one where two numbers are the same channel, order and operating point (by its place in the plan)."""
    first = {setting.name: i for i, setting in enumerate(subject.library.settings)}
    second = {setting.name: i for i, setting in enumerate(baseline.library.settings)}
    keys = [(f.channel, first.get(f.setting, -1), f.order, f.part) for f in subject.features]
    others = {
        (f.channel, second.get(f.setting, -1), f.order, f.part): j for j, f in enumerate(baseline.features)
    }
    found = np.zeros((len(keys), len(baseline.features)))
    for row, key in enumerate(keys):
        if key in others:
            found[row, others[key]] = 1.0
    return found


def _amplitudes(comparison: Comparison) -> Array:
    """(n,) amplitude of the order that a number is part of, as measured; zero for all other numbers."""
    squares: dict[tuple[str, str, float], float] = {}
    keys = [(one.channel, one.setting, one.order) for one in comparison.features]
    for key, value in zip(keys, comparison.values, strict=True):
        squares[key] = squares.get(key, 0.0) + float(value) ** 2
    return np.array([squares[key] ** 0.5 if key[2] else 0.0 for key in keys])


def _by_point(subject: Comparison, shaft: float, mesh: float) -> Array:
    """(n, n) product of the drifts of two orders read at the same operating point; zero for all other numbers."""
    names = {setting.name: number for number, setting in enumerate(subject.library.settings)}
    points = np.array([names[feature.setting] if feature.order else -1 for feature in subject.features])
    drift = np.array(
        [mesh if feature.order in subject.mesh_orders else shaft for feature in subject.features]
    )
    return np.asarray(np.outer(drift, drift) * ((points[:, None] == points) & (points[:, None] >= 0)))


def _given(known: Array, cross: Array, own: Array, noise: Array, residual: Array) -> tuple[Array, Array]:
    """Mean (n,) and covariance (n, n) of the shared part given another set's residual (m,)."""
    solved = cho_solve(cho_factor(known + noise), np.column_stack([residual, cross.T]), check_finite=False)
    return np.asarray(cross @ solved[:, 0]), np.asarray(own - cross @ solved[:, 1:])
