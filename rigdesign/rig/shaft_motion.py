"""Motion of the axis of a shaft, and of the seats of its bearings, from all freedoms of the elastic rig."""

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.beam import DIRECTIONS
from dynamics.rotor.rotor_model import SEAT_DIRECTIONS
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]

SHIFTS = ("u_x", "u_y", "u_z")
"""Order of the rows here: along the shafts, across, up."""


def axis_rows(rig: Rig, shaft: str, position: float) -> Array:
    """(3, n_full) motion of a shaft along x, y and z at a distance from its start [m]; beyond its ends as if it went
    on."""
    model = rig.elastic.model
    inside = min(max(position, 0.0), float(model.freedoms.nodes[shaft].positions[-1]))
    node = model.freedoms.on_shaft(shaft, inside)
    rows = node.moved(rig.axes[shaft].place(position) - node.x).rows(model.size)
    return np.asarray(rows[[DIRECTIONS.index(shift) for shift in SHIFTS]])


def journal_rows(rig: Rig, bearing: str) -> Array:
    """(3, n_full) motion of a shaft in the bearing ``gearbox.bearing`` against the foundation."""
    model = rig.elastic.model
    rows = model.freedoms.place(bearing).rows(model.size)
    return np.asarray(rows[[DIRECTIONS.index(shift) for shift in SHIFTS]])


def seat_rows(rig: Rig, bearing: str) -> Array | None:
    """(3, n_full) motion of the housing under a bearing; zero along x where its support gives across only.

    None where the case has no support under the bearing: its seat stands still.
    """
    model = rig.elastic.model
    if bearing not in model.freedoms.seats:
        return None
    rows = np.zeros((len(SHIFTS), model.size))
    for direction, freedom in zip(SEAT_DIRECTIONS, model.freedoms.seats[bearing]):
        if direction in SHIFTS:
            rows[SHIFTS.index(direction), freedom] = 1.0
    return rows
