"""Loads that alternate with a shaft at the start of a march, and the motion with which they are in balance there.

A bow or run-out that acts at once on a rig at rest is a blow that no rig gets. The march therefore starts bent as they
bend it, and at a speed in the motion that they force: by the dynamic stiffness with mean tooth stiffness.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.mesh.law import MeshLaw
from dynamics.response.initial_state import pinion_ratios

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True, kw_only=True)
class TurningStart:
    """At the angle 0 of all shafts.

    values : (n_periodic_loads,) of ``system.periodic_loads``
    load : (n,) load on each freedom that holds the displacement in static balance: the loads themselves at rest, with
        inertia and damping of the forced motion at a speed; what accelerates all lines together is left to them
    speeds : (n,) of the forced motion [rad/s]
    """

    values: Array
    load: Array
    speeds: Array


def turning_start(system: LinearSystem, laws: Sequence[MeshLaw], speed: float) -> TurningStart:
    """Start at a speed of the first pinion [rad/s]; raises DynamicsInputError as `pinion_ratios`."""
    ratios = pinion_ratios(system, laws)
    n = len(ratios)
    values, load, speeds = [], np.zeros(n), np.zeros(n)
    for one in system.periodic_loads:
        own = float(ratios[one.dof]) * speed
        values.append(float(one.at(np.zeros(1), own)[0]))
        for part in one.parts:
            force = part.at_speed(own) * np.exp(-1j * part.phase) * _balanced(system, ratios, one.load)
            omega = part.order * own
            motion = _forced(system, laws, ratios, force, omega) if omega else np.zeros(n)
            held = force + omega**2 * system.inertia @ motion - 1j * omega * system.damping @ motion
            load += held.real
            speeds += (1j * omega * motion).real
    return TurningStart(values=np.array(values), load=load, speeds=speeds)


def _balanced(system: LinearSystem, ratios: Array, load: Array) -> Array:
    """A load (n,) less what accelerates all lines together."""
    still = system.inertia @ ratios
    return np.asarray(load - still * (ratios @ load) / (ratios @ still))


def _forced(
    system: LinearSystem, laws: Sequence[MeshLaw], ratios: Array, force: Complex, omega: float
) -> Complex:
    """Motion (n,) under Re(force exp(i omega t)) with the meshes closed, without rotation of the whole rig."""
    stiffness = system.stiffness.copy()
    for law, (pinion, wheel) in zip(laws, system.mesh_ports):
        row = np.zeros(len(ratios))
        row[pinion], row[wheel] = law.base_radius_1, -law.base_radius_2
        stiffness += law.mean_stiffness * np.outer(row, row)
    still = system.inertia @ ratios
    scale = np.abs(stiffness).max() / np.abs(np.outer(still, still)).max()
    held = stiffness + scale * np.outer(still, still)
    return np.asarray(np.linalg.solve(held - omega**2 * system.inertia + 1j * omega * system.damping, force))
