"""Envelopes and loss of contact of a long run, window by window, from its internal steps."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dynamics.tooth.law import MeshLaw

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class EnvelopeWindows:
    """Envelope of the dynamic torque: arrays (n_meshes, n_windows) [N m], time (n_windows,) at window ends [s].

    out_of_contact : share of each window without any contact [-]; longest_gap : longest time without contact
        [s]
    speed : (n_windows,) of the first pinion at the window end [rad/s]
    """

    duration: float
    time: Array
    speed: Array
    least: Array
    mean: Array
    greatest: Array
    out_of_contact: Array
    longest_gap: Array


@dataclass(frozen=True, kw_only=True)
class LiftOff:
    """Interval in which a mesh kept losing contact: mesh index, start and end [s], share and longest gap [s]."""

    mesh: int
    start: float
    end: float
    out_of_contact: float
    longest_gap: float


def split_lift_off(
    windows: EnvelopeWindows, intervals: Sequence[LiftOff], times: ArrayLike
) -> tuple[LiftOff, ...]:
    """Intervals cut at ``times`` [s], share and longest gap taken afresh for every piece.

    A window belongs to the piece in which its middle lies; a cut within a window moves to the nearer window end.
    """
    cuts = np.sort(np.asarray(times, float))
    middle = windows.time - 0.5 * windows.duration
    piece = np.searchsorted(cuts, middle, side="right")
    found = []
    for whole in intervals:
        inside = (middle > whole.start) & (middle < whole.end)
        for part in np.unique(piece[inside]):
            own = np.flatnonzero(inside & (piece == part))
            found.append(
                LiftOff(
                    mesh=whole.mesh,
                    start=float(windows.time[own[0]] - windows.duration),
                    end=float(windows.time[own[-1]]),
                    out_of_contact=float(windows.out_of_contact[whole.mesh, own].mean()),
                    longest_gap=float(windows.longest_gap[whole.mesh, own].max()),
                )
            )
    return tuple(found)


class WindowStatistics:
    """Collect windows of ``per_window`` internal steps of ``step`` seconds from consecutive blocks.

    pinion_ratios : (n_meshes,) speed of the pinion of each mesh per speed of the first pinion; 1 when left out
    """

    def __init__(
        self,
        laws: Sequence[MeshLaw],
        per_window: int,
        step: float,
        lift_off_share: float,
        pinion_ratios: ArrayLike = 1.0,
    ) -> None:
        teeth = np.array([law.teeth_1 for law in laws])
        self._meshes_per_turn = teeth * np.abs(np.broadcast_to(np.asarray(pinion_ratios, float), teeth.shape))
        self._per_window = per_window
        self._step = step
        self._share = lift_off_share
        self._rows: list[Array] = []
        self._speed: list[Array] = []
        self._open = np.zeros(len(laws))

    def add(self, torque: Array, speed: Array) -> None:
        """Add a block: torque (n_meshes, steps) from a window boundary on, speed (n_samples,) at its samples."""
        starts = np.arange(0, torque.shape[1], self._per_window)
        lengths = np.diff(np.append(starts, torque.shape[1]))
        free = torque == 0.0
        longest = np.stack([self._gaps(mesh, row, starts) for mesh, row in enumerate(free)])
        self._rows.append(
            np.stack(
                (
                    np.minimum.reduceat(torque, starts, axis=1),
                    np.add.reduceat(torque, starts, axis=1) / lengths,
                    np.maximum.reduceat(torque, starts, axis=1),
                    np.add.reduceat(free.astype(float), starts, axis=1) / lengths,
                    longest,
                )
            )
        )
        samples_per_step = len(speed) / torque.shape[1]
        ends = np.minimum(np.rint((starts + lengths) * samples_per_step).astype(int), len(speed)) - 1
        self._speed.append(speed[ends])

    def windows(self, start: float) -> EnvelopeWindows:
        """Return all windows of a run that began at ``start`` [s]."""
        rows = np.concatenate(self._rows, axis=2)
        duration = self._per_window * self._step
        return EnvelopeWindows(
            duration=duration,
            time=start + duration * np.arange(1, rows.shape[2] + 1),
            speed=np.concatenate(self._speed),
            least=rows[0],
            mean=rows[1],
            greatest=rows[2],
            out_of_contact=rows[3],
            longest_gap=rows[4],
        )

    def lift_off(self, start: float) -> tuple[LiftOff, ...]:
        """Return intervals of windows whose longest gap exceeds the asked share of the mesh period."""
        windows = self.windows(start)
        found = []
        for mesh, meshes_per_turn in enumerate(self._meshes_per_turn):
            with np.errstate(divide="ignore"):
                mesh_period = 2.0 * pi / (np.abs(windows.speed) * meshes_per_turn)
            lost = np.concatenate(([False], windows.longest_gap[mesh] > self._share * mesh_period, [False]))
            edges = np.flatnonzero(np.diff(lost.astype(int)))
            for a, b in zip(edges[::2], edges[1::2]):
                found.append(
                    LiftOff(
                        mesh=mesh,
                        start=start + float(a) * windows.duration,
                        end=start + float(b) * windows.duration,
                        out_of_contact=float(windows.out_of_contact[mesh, a:b].mean()),
                        longest_gap=float(windows.longest_gap[mesh, a:b].max()),
                    )
                )
        return tuple(sorted(found, key=lambda one: (one.start, one.mesh)))

    def _gaps(self, mesh: int, free: NDArray[np.bool_], starts: NDArray[np.int64]) -> Array:
        """Longest time without contact that ends in, or runs through, each window; carried over from block to block."""
        longest = np.zeros(len(starts))
        edges = np.flatnonzero(np.diff(np.concatenate(([False], free, [False])).astype(int)))
        carried = self._open[mesh]
        self._open[mesh] = 0.0
        for a, b in zip(edges[::2], edges[1::2]):
            length = (b - a) * self._step + (carried if a == 0 else 0.0)
            if b == len(free):
                self._open[mesh] = length
            first, last = (int(np.searchsorted(starts, at, side="right")) - 1 for at in (a, b - 1))
            longest[first : last + 1] = np.maximum(longest[first : last + 1], length)
        return longest
