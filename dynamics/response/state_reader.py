"""Torque of shafts and joints read from the modal state of a march at an instant, and densely over a short stretch.

Exact for that state, tooth friction and every other load included, and cheap: one product with the modal state. A march
hands out its state between its segments alone, at phases of the vibration that come as they happen to. Those instants
tell where a torque alternates most; a stretch from there is marched again, with readings every few samples, for how
much. A resonance that is passed between two of those instants is missed: what comes out is a lower bound.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dynamics import kernels
from dynamics.drivetrain.twist_rows import TwistRows
from dynamics.kernels import WIDTH
from dynamics.kernels.contact_table import ContactTables
from dynamics.response.modal_model import ModalModel
from dynamics.response.propagator import Propagator

Array = NDArray[np.float64]

STRETCH, READ_ON = 400, 4
"""Samples over which torques are read on from an instant, and from one reading to the next."""
MOST = 2
"""Instants at which a torque is furthest from its mean, from which it is read on."""


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
        self._modes = scaled @ model.to_scaled
        self._inputs = scaled @ model.scaled_through + (self._modes @ propagator.hold).real
        self._places = propagator.layout.modes
        self._bracing = -rows.stiffness * rows.bracing

    def read(self, state: Array, inputs: Array, twist: float) -> Array:
        """(r,) torques [N m] at a marched state under its inputs (see `modal_state`) and a bracing twist [rad]."""
        modes = state[self._places] + 1j * state[self._places + WIDTH]
        return np.asarray((self._modes @ modes).real + self._inputs @ inputs + self._bracing * twist)


def inputs_of(carried: kernels.Carried) -> Array:
    """Inputs (n_inputs,) that act at an instant of a march: mesh torques, slow inputs and drag torques."""
    return np.concatenate((carried.ports[:, :2].ravel(), carried.slow, carried.drags))


class Stretch(NamedTuple):
    """What a march goes on with from an instant, see ``kernels.march``."""

    tables: ContactTables
    modes: kernels.DiscreteModes
    commands: kernels.Commands
    carried: kernels.Carried
    steps: kernels.Steps


class Glance:
    """Torques of springs at one instant of a march, and after it.

    time : [s]; torque : (r,) [N m]
    """

    def __init__(self, time: float, reader: StateReader, stretch: Stretch, history_rows: int = 2) -> None:
        """Read now, and keep what ``again`` needs; history_rows : that a march records of every mesh."""
        commands = stretch.commands
        self.time, self._reader, self._rows = time, reader, history_rows
        self._stretch = stretch._replace(
            carried=_copied(stretch.carried),
            commands=commands._replace(
                given=commands.given[:STRETCH].copy(), offsets=commands.offsets[:STRETCH].copy()
            ),
        )
        self.torque = self._read(stretch.carried)

    def again(self) -> Array:
        """(n_readings, r) torques over ``STRETCH`` samples from the instant on, at every ``READ_ON`` of them [N m]."""
        tables, modes, commands, before, steps = self._stretch
        carried = _copied(before)
        n_slow, n_drags = len(carried.slow), len(carried.drags)
        found = []
        for first in range(0, len(commands.given), READ_ON):
            own = slice(first, first + READ_ON)
            asked = commands._replace(given=commands.given[own], offsets=commands.offsets[own])
            count = len(asked.given)
            record = kernels.MarchRecord(
                np.empty((len(carried.ports), self._rows, count * steps.substeps)),
                np.empty((count, 2 * n_slow + n_drags + 1)),
            )
            kernels.march(tables, modes, asked, carried, steps, record)
            found.append(self._read(carried))
        return np.array(found)

    def _read(self, carried: kernels.Carried) -> Array:
        return self._reader.read(carried.state, inputs_of(carried), float(carried.slow[1]))


def _copied(carried: kernels.Carried) -> kernels.Carried:
    return kernels.Carried(*(part.copy() for part in carried))


@dataclass(frozen=True, kw_only=True)
class SectionPeaks:
    """Where and how far each of r springs alternates most: half its peak-to-peak torque in a stretch.

    half_peak_to_peak : (r,) [N m]; mean : (r,) then [N m]; time : (r,) [s]
    """

    half_peak_to_peak: Array
    mean: Array
    time: Array


def section_peaks(glances: Sequence[Glance], slow: Array) -> SectionPeaks:
    """Peaks of a march from its glances.

    slow : (k, n) torques of the meshes and the motor at those instants, without vibration. The share of them that a
        spring carries in the mean is the one that fits all glances best; the rest alternates.
    """
    torque = np.array([glance.torque for glance in glances])
    apart = np.abs(torque - slow @ np.linalg.lstsq(slow, torque, rcond=1e-9)[0])
    best = np.argsort(apart, axis=0)[-MOST:]
    half, mean, time = np.zeros((3, torque.shape[1]))
    for at in np.unique(best):
        course = glances[at].again()
        larger = 0.5 * np.ptp(course, axis=0) > half
        half[larger] = 0.5 * np.ptp(course, axis=0)[larger]
        mean[larger] = course.mean(axis=0)[larger]
        time[larger] = glances[at].time
    return SectionPeaks(half_peak_to_peak=half, mean=mean, time=time)
