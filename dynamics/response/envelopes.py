"""Envelopes and loss of contact of a long run, slot by slot, from its internal steps."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dynamics.mesh.law import MeshLaw

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Slots:
    """Envelope of the dynamic torque: arrays (n_meshes, n_slots) [N m], time (n_slots,) at slot ends [s].

    out_of_contact : share of each slot without any contact [-]; longest_gap : longest time without contact
        [s]
    speed : (n_slots,) of the first pinion at the slot end [rad/s]
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


def split_lift_off(slots: Slots, intervals: Sequence[LiftOff], times: ArrayLike) -> tuple[LiftOff, ...]:
    """Intervals cut at ``times`` [s], share and longest gap taken afresh for every piece.

    A slot belongs to the piece in which its middle lies; a cut within a slot moves to the nearer slot end.
    """
    cuts = np.sort(np.asarray(times, float))
    middle = slots.time - 0.5 * slots.duration
    piece = np.searchsorted(cuts, middle, side="right")
    found = []
    for whole in intervals:
        inside = (middle > whole.start) & (middle < whole.end)
        for part in np.unique(piece[inside]):
            own = np.flatnonzero(inside & (piece == part))
            found.append(
                LiftOff(
                    mesh=whole.mesh,
                    start=float(slots.time[own[0]] - slots.duration),
                    end=float(slots.time[own[-1]]),
                    out_of_contact=float(slots.out_of_contact[whole.mesh, own].mean()),
                    longest_gap=float(slots.longest_gap[whole.mesh, own].max()),
                )
            )
    return tuple(found)


class SlotStatistics:
    """Collect slots of ``per_slot`` internal steps of ``step`` seconds from consecutive blocks.

    pinion_ratios : (n_meshes,) speed of the pinion of each mesh per speed of the first pinion; 1 when left out
    """

    def __init__(
        self,
        laws: Sequence[MeshLaw],
        per_slot: int,
        step: float,
        lift_off_share: float,
        pinion_ratios: ArrayLike = 1.0,
    ) -> None:
        teeth = np.array([law.teeth_1 for law in laws])
        self._meshes_per_turn = teeth * np.abs(np.broadcast_to(np.asarray(pinion_ratios, float), teeth.shape))
        self._per_slot = per_slot
        self._step = step
        self._share = lift_off_share
        self._rows: list[Array] = []
        self._speed: list[Array] = []
        self._open = np.zeros(len(laws))

    def add(self, torque: Array, speed: Array) -> None:
        """Add a block: torque (n_meshes, steps) from a slot boundary on, speed (n_samples,) at its samples."""
        starts = np.arange(0, torque.shape[1], self._per_slot)
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

    def slots(self, start: float) -> Slots:
        """Return all slots of a run that began at ``start`` [s]."""
        rows = np.concatenate(self._rows, axis=2)
        duration = self._per_slot * self._step
        return Slots(
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
        """Return intervals of slots whose longest gap exceeds the asked share of the mesh period."""
        slots = self.slots(start)
        found = []
        for mesh, meshes_per_turn in enumerate(self._meshes_per_turn):
            with np.errstate(divide="ignore"):
                mesh_period = 2.0 * pi / (np.abs(slots.speed) * meshes_per_turn)
            lost = np.concatenate(([False], slots.longest_gap[mesh] > self._share * mesh_period, [False]))
            edges = np.flatnonzero(np.diff(lost.astype(int)))
            for a, b in zip(edges[::2], edges[1::2]):
                found.append(
                    LiftOff(
                        mesh=mesh,
                        start=start + float(a) * slots.duration,
                        end=start + float(b) * slots.duration,
                        out_of_contact=float(slots.out_of_contact[mesh, a:b].mean()),
                        longest_gap=float(slots.longest_gap[mesh, a:b].max()),
                    )
                )
        return tuple(sorted(found, key=lambda one: (one.start, one.mesh)))

    def _gaps(self, mesh: int, free: NDArray[np.bool_], starts: NDArray[np.int64]) -> Array:
        """Longest time without contact that ends in, or runs through, each slot; carried over from block to block."""
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
