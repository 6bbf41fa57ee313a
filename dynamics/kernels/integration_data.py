"""What a time integration reads and writes: commands, the state from call to call, scratch arrays."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dynamics.kernels.drag import DragLaws, DragWork
from dynamics.kernels.flank_lookup import FlankRows
from dynamics.kernels.integrator_state import Meshes

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


N_PORTS = 12
"""Numbers of a mesh that go from call to call."""


class Commands(NamedTuple):
    """Commands, values at the end of each sample."""

    given: Array
    """(n_samples, 4 + n_given) motor torque, twist, speed of the drive, torque of the first mesh, then the other slow
    inputs."""
    offsets: Array
    """(n_samples, n_meshes) imposed approach."""
    control: Array
    """Proportional gain, integral gain per sample, torque limit (0: no control), share of the averaged speed;
    bracing gain per sample (0: no control), share of the averaged torque."""
    drags: DragLaws


class Carried(NamedTuple):
    """State from call to call; every array is written."""

    state: Array
    """(n_states,) modal state."""
    ports: Array
    """(n_meshes, N_PORTS) tau_1, tau_2, both one and two steps earlier, approach, pinion angle, parts of the approach
    that bodies outside the table gave in the last two steps, speeds of pinion and wheel."""
    slow: Array
    """(n_slow,) motor torque, twist, torques that are given."""
    drags: Array
    """(n_drags,) drag torques."""
    offset: Array
    """(n_meshes,) imposed approach."""
    controller: Array
    """Integral of the speed controller, correction of the twist, then averages: torque, speed, asked torque."""
    speeds: Array
    """(n_slow + n_drags,) speed of the load of every slow input and drag."""
    powers: Array
    """(3, n) powers at the end of the last three steps, the last first: friction and damping of each mesh, every slow
    input, every drag, joints, skew stiffness; NaN where there was no step; n = 0 without accounts."""
    work: Array
    """(n,) their integrals."""
    wrench: Array
    """Forces beside the ports, see ``kernels.wrench``; none where gears only rotate."""
    apart: Array
    """(4, n_meshes) how much closer the gears stand on the other flanks, and its rate; turn of the pinion from the
    centre line beyond that of its port, and what it gains in a step."""


class Steps(NamedTuple):
    """Steps of a time integration."""

    step: float
    """[s]"""
    substeps: int
    """Steps in a sample."""


class Histories(NamedTuple):
    """What a time integration writes down."""

    history: Array
    """(n_meshes, 2 or 7, steps): front - back force at full resolution, that of the filtered tables [, approach, pinion
    angle, approach rate, pinion speed, tau_1]."""
    samples: Array
    """(n_samples, 2 n_slow + n_drags + 1): slow inputs, their speeds, drag torques, angle of the first pinion."""
    states: Array
    """(n_samples, n_states + 2 n_meshes + n): modal state, mesh torques and forces beside the ports at the end of each
    sample; no rows where nobody reads them."""


class Workspace(NamedTuple):
    """Scratch arrays of a time integration."""

    record: Histories
    flanks: FlankRows
    bank: Array
    """That of the modes with the state in it."""
    slow_outputs: Array
    """Flat (substeps, n_outputs + n_rows): what the slow inputs give in each step of the sample."""
    ends: Array
    """(n_rows,) the outputs of no port; without accounts those of the slow inputs alone."""
    torques: Array
    """(2, n_ports + n_drags) at start and end of the step."""
    give: Array
    """Flat (n_meshes, n_meshes, 4): reach of another mesh per torque of both ports of one at the end of the step,
    then its rate."""
    meshes: Meshes
    target: Array
    """(n_slow,) slow inputs at the end of the sample."""
    fresh: Array
    """Powers at the end of the step."""
    beside: Array
    """(every 2 n_ports,) what forces beside the ports give to them in the steps of the interval."""
    mean_forces: Array
    """Sum of these forces over the steps of their interval."""
    drags: DragWork
