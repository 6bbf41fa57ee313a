"""Search for a steady state in time: mean speed and mean torque held by corrections between blocks of periods."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.drivetrain.loop_load import LoopLoad
from dynamics.drivetrain.periodic_load import within_period
from dynamics.response.held_speed import HeldSpeed
from dynamics.response.initial_state import WoundLoop
from dynamics.response.march_inputs import DragTables
from dynamics.response.time_march import Block, TimeMarch

Array = NDArray[np.float64]


SMALL = 1e-9
"""Difference in speed from which two marches part, over the speed [-]."""
AT_ONCE = 50
"""Periods that are marched at once where their extremes alone are kept."""


@dataclass(frozen=True, kw_only=True)
class PeriodGrid:
    """One period: mean speed of the first pinion [rad/s], its turns, length [s] and internal steps."""

    speed: float
    turns: float
    length: float
    steps: int


class SteadySearch:
    """March blocks, hold mean speed and mean torque by corrections between them, and test for the steady state."""

    def __init__(
        self,
        march: TimeMarch,
        system: LinearSystem,
        load: LoopLoad,
        wound: WoundLoop,
        period: PeriodGrid,
        tolerance: float,
    ) -> None:
        self.march, self.speed, self.torque, self.tolerance = march, period.speed, load.torque, tolerance
        self.drive, self.twist = wound.drive_torque, wound.state.twist
        self.balanced_drive = self.drive
        self.steady, self.residual = False, float("inf")
        self._stiffness, self._period = wound.loop_stiffness, period
        self._held = HeldSpeed(system, march.laws, period.speed)
        self._ratios = self._held.ratios
        self._loads = within_period(system.periodic_loads, self._ratios, period.turns)
        self._last: Array | None = None
        self._change = float("inf")
        self._quiet = 0

    def block(self, periods: int, tables: Array) -> Block:
        """March some periods with constant drag torques (n_drags, 2), correct, and return what was marched."""
        march = self.march
        steps = self._period.steps
        before = march.pinion_angle()
        result = march.advance(self._given(periods), drags=DragTables(torque=tables))
        span = periods * self._period.length
        mean_speed = (march.pinion_angle() - before) / span
        radius = np.array([law.base_radius_1 for law in march.laws])
        wave = radius[:, None] * result.force[:, -steps:]
        mean = float(radius[0] * result.force[0].mean())
        torque_error = 0.0 if self.torque is None else self.torque - mean
        self.balanced_drive = self.drive - self._held.inertia * self._held.drift(mean_speed, span)
        self._test(wave, mean, torque_error, mean_speed)
        if not self.steady:
            self._correct(mean_speed, span, torque_error)
        return result

    def held(self, periods: int, tables: Array) -> Block:
        """March some periods without corrections."""
        return self.march.advance(self._given(periods), drags=DragTables(torque=tables))

    def parting(self, periods: int, tables: Array) -> Array:
        """Distance from a march that starts with a small difference, by period, over the peak force (periods,) [-]."""
        given, drags = self._given(periods), DragTables(torque=tables)
        other = self.march.continued(self.march.system, self.march.model)
        other.kick(SMALL * self.speed * np.cos(np.arange(len(self._ratios))))
        first, second = (march.advance(given, drags=drags).force for march in (self.march, other))
        apart = (np.abs(first - second) / np.abs(first).max(axis=1, keepdims=True)).max(axis=0)
        return np.asarray(apart.reshape(periods, -1).max(axis=1))

    def extremes(self, periods: int, tables: Array) -> Array:
        """Least and greatest force (n_meshes, periods, 2) in each of so many periods further on [N]; the march itself
        stays where it is."""
        march, drags = self.march.continued(self.march.system, self.march.model), DragTables(torque=tables)
        found = []
        for first in range(0, periods, AT_ONCE):
            given = self._given(min(AT_ONCE, periods - first), march)
            waves = march.advance(given, drags=drags).force.reshape(len(march.laws), -1, self._period.steps)
            found.append(np.stack((waves.min(axis=2), waves.max(axis=2)), axis=2))
        return np.concatenate(found, axis=1)

    def _given(self, periods: int, marched: TimeMarch | None = None) -> Array:
        """Commands over some periods: drive torque and twist as they are."""
        march = marched or self.march
        samples = periods * self._period.steps // march.substeps
        given = np.zeros((samples, 4 + len(self._loads)))
        given[:, 0], given[:, 1] = self.drive, self.twist
        angle = march.pinion_angle() + self.speed * march.step * march.substeps * np.arange(1, samples + 1)
        for i, load in enumerate(self._loads):
            ratio = float(self._ratios[load.dof])
            given[:, 4 + i] = load.at(np.asarray(ratio * angle, float), ratio * self.speed)
        return given

    def _test(self, wave: Array, mean: float, torque_error: float, mean_speed: float) -> None:
        if self._last is not None:
            dynamic = np.ptp(wave, axis=1)
            scale = np.maximum(dynamic, 1e-3 * np.abs(wave).max(axis=1)) + 1e-300
            change = float(np.max(np.abs(wave - self._last).max(axis=1) / scale))
            decay = min(change / self._change, 0.95) if self._change > 0.0 else 0.0
            self._change = change
            self.residual = max(change, change * decay / (1.0 - decay))
            held = (
                abs(torque_error) <= 1e-4 * abs(mean)
                and abs(mean_speed / self.speed - 1.0) <= 1e-6
                and abs(self.balanced_drive - self.drive) <= 1e-4 * abs(self.drive)
            )
            self._quiet = self._quiet + 1 if self.residual <= self.tolerance and held else 0
            self.steady = self._quiet >= 2
        self._last = wave

    def _correct(self, mean_speed: float, span: float, torque_error: float) -> None:
        change = self._held.correction(mean_speed, span)
        self.drive += change.drive_torque
        self.march.kick(change.kick)
        self.twist += 0.5 * torque_error / self._stiffness
        self.march.set_slow(self.drive, self.twist)
