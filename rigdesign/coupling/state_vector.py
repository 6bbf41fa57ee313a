"""The coupling state as a vector in comparable sizes, for accelerations and sensitivities of the loop."""

from dataclasses import fields

import numpy as np
from numpy.typing import NDArray

from rigdesign.coupling.state import CouplingState

FloatArray = NDArray[np.float64]

SCALES = {
    "gear_temperature": 1.0,
    "oil_outlet": 1.0,
    "oil_supply": 1.0,
    "centre_distance": 1e-6,
    "bearing_clearance": 1e-6,
    "axial_expansion": 1e-6,
    "bearing_heat": 10.0,
    "wall_heat": 10.0,
    "mesh_torque": 1.0,
    "seat_temperature": 1.0,
    "flank_approach": 1e-6,
    "axis_tilt": 1e-6,
    "coupling_offset": 1e-6,
    "coupling_angle": 1e-6,
}
"""Unit of each field of the coupling state in the vector [K, m, W, N m, rad]."""

SHARES = {"bearing_heat": 1e-3, "wall_heat": 1e-3, "mesh_torque": 1e-3}
"""Of fields that grow with the rig: share of a value that counts as one where it is above its unit."""


def scaled(state: CouplingState) -> FloatArray:
    """(n,) the coupling state in units of `SCALES`, fields and names in their order."""
    parts = [
        np.fromiter(getattr(state, entry.name).values(), dtype=np.float64) / SCALES[entry.name]
        for entry in fields(state)
    ]
    return np.concatenate(parts)


def unscaled(vector: FloatArray, like: CouplingState) -> CouplingState:
    """The coupling state of a vector (n,), with the names of another."""
    found: dict[str, dict[str, float]] = {}
    start = 0
    for entry in fields(like):
        names = getattr(like, entry.name)
        part = vector[start : start + len(names)] * SCALES[entry.name]
        found[entry.name] = dict(zip(names, part.tolist()))
        start += len(names)
    return CouplingState(**found)


def ordered(state: CouplingState, like: CouplingState) -> CouplingState:
    """The coupling state with its names in the order of another."""
    return CouplingState(
        **{
            entry.name: {name: getattr(state, entry.name)[name] for name in getattr(like, entry.name)}
            for entry in fields(like)
        }
    )


def scaled_change(old: CouplingState, new: CouplingState) -> float:
    """Largest change between two iterations in units of `SCALES`, of large heats and torques by `SHARES` [-]."""
    changes = (
        abs(getattr(new, name)[part] - value) / max(scale, SHARES.get(name, 0.0) * abs(value))
        for name, scale in SCALES.items()
        for part, value in getattr(old, name).items()
    )
    return max(changes, default=0.0)


def numbering(state: CouplingState) -> dict[tuple[str, str], int]:
    """(field, name) -> place in the vector."""
    names = [(entry.name, name) for entry in fields(state) for name in getattr(state, entry.name)]
    return {name: number for number, name in enumerate(names)}
