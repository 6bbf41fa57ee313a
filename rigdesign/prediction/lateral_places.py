"""Where accelerometers and proximity probes read shafts that bend.

A proximity probe in a bearing sits in its seat and reads the journal against it; one at a place of a shaft stands on
the foundation. An accelerometer reads the housing under the bearing where the case gives it a support
(``support_stiffness`` of the bearing, or ``bearing_seats = "elastic"`` of the housing); where it does not, the model
has no motion of the housing, and the acceleration is that of the shaft in the bearing: an upper bound of what a stiff
housing passes on.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.errors import UsageError
from rigdesign.prediction.model import Channel
from rigdesign.rig.model import Rig
from rigdesign.rig.shaft_motion import axis_rows, journal_rows, seat_rows

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

STILL = 1e-12
"""Norm of a row below which nothing that the model moves is read."""


@dataclass(frozen=True, kw_only=True)
class LateralMotion:
    """Motion of one place in one direction.

    row : (n,) of it per freedom; accelerates : its second derivative is read
    """

    row: Array
    accelerates: bool

    def mean(self, windup: Array, twist: float) -> float:
        """Zero: a probe is set to zero, an accelerometer has no mean."""
        return 0.0

    def amplitude(self, motion: Complex, omega: float, torques: object = ()) -> complex:
        """Complex displacement [m], or acceleration - omega^2 of it [m/s2], of the motion of all freedoms (n,)."""
        moved = complex(self.row @ motion)
        return -(omega**2) * moved if self.accelerates else moved


def lateral_motion(rig: Rig, channel: Channel) -> LateralMotion:
    """Where an accelerometer or a proximity probe reads.

    Raises
    ------
    UsageError
        Shafts that only twist, no direction, a place that the case does not have, a direction in which it stands
        still.
    """
    require_bending(rig, channel)
    if channel.direction is None:
        raise UsageError(
            f"channel {channel.name!r}: {channel.quantity} has no direction; give a unit vector (x, y, z) in the frame "
            "of the case"
        )
    full = np.asarray(channel.direction) @ _rows(rig, channel)
    if float(np.linalg.norm(full)) < STILL:
        raise UsageError(
            f"channel {channel.name!r}: {channel.place} stands still along {channel.direction} in this model: a "
            "support gives across the shafts only; read it along y or z"
        )
    row = rig.elastic.seen.on_freedoms(full)
    return LateralMotion(row=row, accelerates=channel.quantity == "acceleration")


def require_bending(rig: Rig, channel: Channel) -> None:
    """Refuse a lateral channel of shafts that only twist (UsageError)."""
    if rig.shaft_model == "torsional":
        raise UsageError(
            f"channel {channel.name!r}: {channel.quantity} needs shafts that bend, and this prediction has shafts that "
            'only twist; ask for PredictionModel(shafts="elastic"), for a measurement set shaft_model = "elastic" '
            "under drivetrain in its case, or leave the channel out (torque, angle and torsional natural frequencies "
            "need no bending)"
        )


def _rows(rig: Rig, channel: Channel) -> Array:
    """(3, n_full) motion along x, y and z that the channel reads a component of."""
    bearings = [name for name, _, _ in rig.bearings()]
    if channel.place in bearings:
        journal, seat = journal_rows(rig, channel.place), seat_rows(rig, channel.place)
        if channel.quantity == "acceleration":
            return journal if seat is None else seat
        return journal if seat is None else journal - seat
    if channel.quantity == "acceleration":
        raise UsageError(
            f"channel {channel.name!r}: {channel.place!r} is no bearing; there are {', '.join(bearings)}"
        )
    shafts = list(rig.elastic.model.freedoms.nodes)
    if channel.place not in shafts:
        raise UsageError(
            f"channel {channel.name!r}: {channel.place!r} is neither a bearing ({', '.join(bearings)}) nor a shaft "
            f"({', '.join(shafts)})"
        )
    length = float(rig.elastic.model.freedoms.nodes[channel.place].positions[-1])
    if channel.position is None or not 0.0 <= channel.position <= length:
        said = "no position" if channel.position is None else f"position = {1e3 * channel.position:.6g} mm"
        raise UsageError(
            f"channel {channel.name!r}: {said} on shaft {channel.place!r}; give one from 0 to {1e3 * length:.6g} mm "
            "from its start"
        )
    return axis_rows(rig, channel.place, channel.position)
