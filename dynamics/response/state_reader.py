"""Torque of shafts and joints read from the modal state of a march at every sample, and its envelopes.

Exact for that state, tooth friction and every other load included, and cheap: one product with the modal state. What
alternates within a sample is seen at the ends of the samples only: over a window of many samples their phases cover a
vibration unless its frequency is a multiple of half the sample rate.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.graph import TorqueSection, TwistRows
from dynamics.kernels import WIDTH
from dynamics.response.modal_model import ModalModel
from dynamics.response.propagator import Propagator

Array = NDArray[np.float64]


class StateReader:
    """Torques of r springs on the modal state of one model and step."""

    def __init__(self, rows: TwistRows, model: ModalModel, propagator: Propagator) -> None:
        """Prepare; the rows are on the freedoms of the model."""
        rigid = model.n_lines
        turning, bent = rows.rows @ model.shapes, rows.rows @ model.shapes[:, rigid:]
        turning[:, :rigid] = 0.0  # a rigid rotation twists nothing
        scaled = np.hstack(
            (rows.damping[:, None] * turning, rows.stiffness[:, None] * bent / model.frequencies[rigid:])
        )
        modes, places = scaled @ model.to_scaled, propagator.layout.modes
        self._state = np.zeros((len(rows.rows), propagator.modes.rows.shape[1]))
        self._state[:, places], self._state[:, places + WIDTH] = modes.real, -modes.imag
        self._inputs = scaled @ model.scaled_through + (modes @ propagator.hold).real
        self._bracing = -rows.stiffness * rows.bracing
        self.sections = rows.sections

    def read(self, states: Array, inputs: Array, twist: Array) -> Array:
        """(r, n) torques [N m] at marched states.

        states : (n, n_states); inputs : (n, n_inputs) that act there (see ``propagator.modal_state``)
        twist : (n,) of the bracing [rad]
        """
        torque = self._state @ states.T + self._inputs @ inputs.T
        return np.asarray(torque + self._bracing[:, None] * twist)


@dataclass(frozen=True, kw_only=True)
class SectionEnvelopes:
    """Torque of r springs in the w windows of a run, in which its ``EnvelopeWindows`` stand.

    sections : (r,) of each; least, mean, greatest : (r, w) [N m], positive where the first end turns ahead
    """

    sections: tuple[TorqueSection, ...]
    least: Array
    mean: Array
    greatest: Array

    @property
    def half_peak_to_peak(self) -> Array:
        """(r, w) [N m]"""
        return 0.5 * (self.greatest - self.least)

    @property
    def peak(self) -> Array:
        """(r, w) largest amount [N m]"""
        return np.maximum(np.abs(self.least), np.abs(self.greatest))


class SectionStatistics:
    """Collect windows of ``per_window`` samples from consecutive blocks, each from a window boundary on."""

    def __init__(self, per_window: int) -> None:
        """Begin without a block."""
        self._per_window = per_window
        self._rows: list[Array] = []

    def add(self, torque: Array) -> None:
        """Add a block: torque (r, n_samples) [N m]."""
        starts = np.arange(0, torque.shape[1], self._per_window)
        lengths = np.diff(np.append(starts, torque.shape[1]))
        self._rows.append(
            np.stack(
                (
                    np.minimum.reduceat(torque, starts, axis=1),
                    np.add.reduceat(torque, starts, axis=1) / lengths,
                    np.maximum.reduceat(torque, starts, axis=1),
                )
            )
        )

    def envelopes(self, sections: Sequence[TorqueSection]) -> SectionEnvelopes:
        """All windows so far."""
        least, mean, greatest = np.concatenate(self._rows, axis=2)
        return SectionEnvelopes(sections=tuple(sections), least=least, mean=mean, greatest=greatest)
