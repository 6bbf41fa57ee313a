"""Standing force and moment of couplings whose axes were set up out of line, on both of their shafts.

A coupling presses with its stiffness times what the shafts do not give way of the offset and angle: with bearings at
the reference stiffness of the reduced rig, as the load decides on their own. Both act at the middle of the coupling.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from dynamics.elastic_rig.rotating_loads import misalignment_load
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]

ARM = 1.0
"""Distance of the two forces that stand for a moment [m]."""


def coupling_forces(rig: Rig, shaft: str) -> Iterator[tuple[float, Array]]:
    """Forces (2,) in the plane (y, z) [N] on a shaft that bends, each with its place on it [m].

    A moment is two opposite forces; places may lie beyond the ends of the shaft.
    """
    power = rig.case.drivetrain
    if rig.shaft_model == "torsional" or power is None or not rig.elastic.rig.misalignments:
        return
    pressed = reactions(rig)
    for name, coupling in power.couplings.items():
        if shaft not in coupling.shafts:
            continue
        push = 1.0 if shaft == coupling.shafts[0] else -1.0
        axis, at = rig.axes[shaft], _middle(rig, name)
        force, couple = push * pressed[name][:2], push * pressed[name][2:] / ARM
        place = axis.direction * (at - axis.start)
        yield place, force - couple
        yield place + axis.direction * ARM, couple


def standing_load(rig: Rig) -> Array:
    """(n,) load of axes out of line on the coordinates of the reduced rig."""
    elastic = rig.elastic
    return elastic.reduced.rows(misalignment_load(elastic.model, elastic.rig.misalignments))


def reactions(rig: Rig) -> dict[str, Array]:
    """Of every coupling on its first shaft: force along y and z [N], moment along the slopes of y and z [N m]."""
    elastic = rig.elastic
    reduced, load = elastic.reduced, standing_load(rig)
    bent = np.zeros(reduced.size)
    bent[reduced.n_rigid :] = load[reduced.n_rigid :] / reduced.squared[reduced.n_rigid :]
    found = {}
    for joint in elastic.model.joints:
        if joint.kind != "coupling":
            continue
        gap = np.zeros(len(joint.directions))
        for part in elastic.rig.misalignments:
            if part.coupling == joint.name:
                built_in = dict(zip(SLOPES, (*part.offset, part.slope[0], -part.slope[1]), strict=True))
                gap = np.array([built_in.get(direction, 0.0) for direction in joint.directions])
        pressed = dict(
            zip(joint.directions, -joint.stiffness @ (gap + reduced.rows(joint.rows) @ bent), strict=True)
        )
        force_y, force_z, about_z, about_y = (pressed.get(direction, 0.0) for direction in SLOPES)
        found[joint.name] = np.array([force_y, force_z, about_z, -about_y])
    return found


SLOPES = ("u_y", "u_z", "theta_z", "theta_y")
"""Across a coupling; the slopes over x are theta_z of y and -theta_y of z."""


def _middle(rig: Rig, coupling: str) -> float:
    """x of the middle between the two ends [m]."""
    assert rig.case.drivetrain is not None and rig.drivetrain is not None
    entry = rig.case.drivetrain.couplings[coupling]
    ends = [
        rig.axes[shaft].place(0.0 if end == "start" else rig.drivetrain.shaft(shaft).length)
        for shaft, end in zip(entry.shafts, entry.ends, strict=True)
    ]
    return 0.5 * sum(ends)
