"""What deviations of the teeth take from the rotation and give back: torques on the gears from energy.

The march lets a tooth force act at the base radius whatever the teeth look like. Without friction a mesh is a
potential U of the angles of its gears, so the torque on each is its derivative: besides the base radius it has the
lever of an eccentric gear, and what pairs take up or give back that change their stiffness and gaps as they pass. It is
1e-4 of the torque in the mesh, but nothing holds the common running of the loop except its inertia.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tests.virtual_rig import loop_march as kernel
from tests.virtual_rig.loop_model import Circuit
from tests.virtual_rig.teeth import Teeth


@dataclass(frozen=True)
class Rotation:
    """Torques of the rotation over a cycle, and the circuit with its meshes closed that answers to them."""

    spectrum: np.ndarray
    """(2 n_meshes, n_cycle // 2 + 1): one-sided amplitude of the torque on pinion and wheel of each mesh [N m]."""
    ports: np.ndarray
    """(2 n_meshes, n): freedoms on which they act."""
    closed: Circuit

    def answer(self, at: int, frequency: float) -> np.ndarray:
        """Motion (n,) of the circuit in bin ``at`` of the cycle, which turns at ``frequency`` [rad/s]."""
        return self.closed.receptance(frequency, self.ports.T @ self.spectrum[:, at])


def rotation_of(
    circuit: Circuit,
    meshes: Sequence[Teeth],
    tables: tuple[np.ndarray, ...],
    stiffness: Sequence[float],
    levers: np.ndarray,
    record: np.ndarray,
    angle: float,
) -> Rotation:
    """From a recorded cycle.

    stiffness : mean of each mesh [N/m]
    levers (n_meshes, 2, n_cycle): change of the approach by the eccentricity of each gear per its angle [m]
    record (4 n_meshes, n_cycle): of `loop_march.march`
    angle : turn of the pinions in a step [rad]
    """
    n = len(meshes)
    numbers = tables[0]
    torques = np.zeros((2 * n, record.shape[1]))
    ports = np.zeros((2 * n, circuit.size))
    damping, stiff = circuit.damping.copy(), circuit.stiffness.copy()
    for m, (mesh, row) in enumerate(zip(meshes, circuit.approach)):
        for side in (0, 1):
            ports[2 * m + side, circuit.gears[mesh.gears[side]]] = 1.0
            torques[2 * m + side] = -record[3 * m] * levers[m, side]
        torques[2 * m] -= kernel.taken_up(record[3 * n + m], m, *tables) / angle
        stiff += stiffness[m] * np.outer(row, row)
        damping += numbers[m, kernel.DAMP] * stiffness[m] * np.outer(row, row)
    return Rotation(
        2.0 * np.fft.rfft(torques, axis=1) / record.shape[1],
        ports,
        replace(circuit, stiffness=stiff, damping=damping),
    )
