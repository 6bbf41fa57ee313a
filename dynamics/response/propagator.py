"""Exact propagator of the linear drivetrain between its gear meshes, from its complex modes.

A step takes each mode exactly, so that overdamped joints with real poles of 1e7 1/s cost nothing; the torques of the
meshes are held by Numerov's method, all other inputs vary linearly (``dynamics.response.step_hold``). Angles and
approaches are integrals of the velocity outputs in the same sense, which keeps the small difference of two large
rotations. The modal state that is marched leaves out what follows the inputs at once, so that a step pushes each mode
by one number of each input.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.kernels import FOUR, WIDTH, DiscreteModes, DragModes, WrenchModes
from dynamics.response.modal_layout import ModalLayout, StepResponse, branch_layout, port_blocks
from dynamics.response.modal_model import ModalModel
from dynamics.response.step_hold import FASTEST, numerov, phi, straight_line
from dynamics.response.wrench_modes import wrench_columns, wrench_hold, wrench_modes

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True, kw_only=True)
class Propagator:
    """The modal model at one step length [s], in the layout of ``dynamics.kernels``.

    hold : (n_modes, n_inputs) part of the modal state that follows the inputs at once: z = w + hold u
    layout : where each mode stands in the marched state
    """

    step: float
    modes: DiscreteModes
    wrench: WrenchModes
    hold: ComplexArray
    layout: ModalLayout


def discretise(
    model: ModalModel, step: float, *, substeps: int = 1, with_losses: bool = True, beside_every: int = 1
) -> Propagator:
    """Return the propagator for one step length.

    Parameters
    ----------
    step : internal step, above 0 [s]
    substeps : steps over which the slow inputs are linear
    with_losses : False leaves out the rows of the joint losses
    beside_every : steps in which tooth forces beside the ports are linear; ``substeps`` is a multiple of it

    Raises DynamicsInputError for a step that is not above 0.
    """
    if not step > 0.0:
        raise DynamicsInputError(f"step = {step} s must be positive")
    scaled = model.eigenvalues * step
    decay = np.exp(scaled)
    phi_1, phi_2 = phi(1, scaled)[:, None], phi(2, scaled)[:, None]
    n_fast = 2 * model.n_meshes
    of_mesh, of_line = numerov(scaled), straight_line(scaled)
    is_mesh = np.arange(model.inputs.shape[1]) < n_fast
    hold = step * np.where(is_mesh, of_mesh.state[:, None], of_line.state[:, None]) * model.inputs
    hold[:, hold.shape[1] - 3 * len(model.wrench_numbers) :] = wrench_hold(model, beside_every * step)
    turned = step**2 * np.where(is_mesh, of_mesh.turn[:, None], of_line.turn[:, None]) * model.inputs
    driven = decay[:, None] * hold + step * phi_1 * model.inputs - hold

    n_ports = 2 * n_fast
    n_driven = n_fast + model.n_slow
    of_drags = slice(n_driven, n_driven + model.n_drags)
    n_rows = model.outputs.shape[0] if with_losses else n_ports + model.n_slow + model.n_drags
    seen = model.outputs[:n_rows]
    through, through_rate = model.through[:n_rows], model.through_rate[:n_rows] / step
    rows = seen.copy()
    through_old = -through_rate
    through_new = (seen @ hold).real + through + through_rate
    speed, angle = np.arange(0, n_ports, 2), np.arange(1, n_ports, 2)
    rows[speed] = seen[speed] * decay
    through_old[speed] += (seen[speed] @ driven).real
    # the angle a port turns by is the integral of its speed over the step
    rows[angle] = seen[angle] * (step * phi_1[:, 0])
    integral = step * phi_1 * hold + step**2 * phi_2 * model.inputs - turned
    dropped, dropped_rate = 0.5 * step * model.through[angle], model.through_rate[angle]
    through_old[angle] = (seen[angle] @ integral).real + dropped - dropped_rate
    through_new[angle] = (seen[angle] @ turned).real + dropped + dropped_rate
    # of torques linear in the step the speeds are the trapezoid, less step^2 / 12 of the jerk (Euler and Maclaurin)
    jerked = _jerks(model, step, seen)
    through_old[:, :n_fast] += jerked / 12.0
    through_new[:, :n_fast] -= jerked / 12.0
    layout = branch_layout(model.branches)
    of_ports = StepResponse(
        decay=decay,
        driven=driven[:, :n_fast],
        rows=rows[:n_ports],
        old=through_old[:n_ports, :n_fast],
        new=through_new[:n_ports, :n_fast],
    )
    tables = port_blocks(model.port_branches, layout, of_ports)
    slow = slice(n_fast, n_driven)
    of_slow = StepResponse(
        decay=decay, driven=driven[:, slow], rows=rows, old=through_old[:, slow], new=through_new[:, slow]
    )
    slow_outputs, slow_states = _slow_responses(of_slow, n_ports, substeps)
    fast = np.r_[:n_fast, n_driven : n_driven + model.n_drags]
    end_old, end_new = (
        np.hstack((table[n_ports:, fast], wrench_columns(model, table[n_ports:])))
        for table in (through_old, through_new)
    )
    braked = slice(n_ports + model.n_slow, n_ports + model.n_slow + model.n_drags)
    discrete = DiscreteModes(
        **tables._asdict(),
        port_new=np.ascontiguousarray(through_new[:n_ports, :n_fast].T),
        rows=layout.lay(rows[n_ports:].conj()),
        circulating=model.n_circulating if with_losses else 0,
        through_old=np.ascontiguousarray(end_old.T),
        through_new=np.ascontiguousarray(end_new.T),
        slow_outputs=slow_outputs,
        slow_states=layout.lay(slow_states),
        drags=DragModes(
            branches=model.drag_branches,
            groups=_braked_groups(model, layout, driven[:, of_drags]),
            push=layout.lay(driven[:, of_drags].T),
            rows=layout.lay(rows[braked].conj()),
            inputs=np.ascontiguousarray(
                np.hstack(
                    (
                        through_old[braked, :n_fast],
                        through_new[braked, :n_fast],
                        (through_old + through_new)[braked, of_drags],
                    )
                ).T
            ),
            each_other=np.ascontiguousarray(through_new[braked, of_drags].T),
            ports_held=np.ascontiguousarray((through_old + through_new)[:n_ports, of_drags].T),
            ports_new=np.ascontiguousarray(through_new[:n_ports, of_drags].T),
        ),
    )
    wrench = wrench_modes(model, layout, hold, step, beside_every)
    return Propagator(step=step, modes=discrete, wrench=wrench, hold=hold, layout=layout)


def _jerks(model: ModalModel, step: float, seen: ComplexArray) -> Array:
    """Return (n_rows, 2 n_meshes) what a mesh torque adds to each speed in a step, by the modes that follow it by
    Numerov's method; nothing for angles and displacements."""
    slow = np.abs(model.eigenvalues * step) <= FASTEST
    jerks = step * (seen[:, slow] @ model.inputs[slow, : 2 * model.n_meshes]).real
    jerks[1 : 4 * model.n_meshes : 2] = 0.0
    n_displaced = len(seen) - (len(model.outputs) - model.n_circulating)
    jerks[len(seen) - max(n_displaced, 0) :][1::2] = 0.0
    return np.asarray(jerks)


def _slow_responses(response: StepResponse, n_ports: int, substeps: int) -> tuple[Array, ComplexArray]:
    """Return what slow inputs give in every step of a sample (2 n_slow, substeps * n_rows), and to the modes by its
    end (2 n_slow, n_modes): in turn for an input held at one and for one that rises by one in each step.

    The first ``n_ports`` rows look at the modes before a step, the others after it.
    """
    decay, driven, rows, old, new = response
    n_modes, n_slow = driven.shape
    outputs = np.zeros((n_slow, 2, substeps, len(rows)))
    modes = np.zeros((n_slow, 2, n_modes), complex)
    for step in range(substeps):
        start, end = np.array([1.0, step])[:, None], np.array([1.0, step + 1.0])[:, None]
        after = decay * modes + driven.T[:, None] * start
        outputs[:, :, step, :n_ports] = (modes @ rows[:n_ports].T).real
        outputs[:, :, step, n_ports:] = (after @ rows[n_ports:].T).real
        outputs[:, :, step] += old.T[:, None] * start + new.T[:, None] * end
        modes = after
    return outputs.reshape(2 * n_slow, -1), modes.reshape(2 * n_slow, -1)


def _braked_groups(model: ModalModel, layout: ModalLayout, driven: ComplexArray) -> NDArray[np.int64]:
    """Return (n_drags / 4,) groups of modes from the start of its branch on that each four of drag torques drives."""
    groups = np.zeros(len(model.drag_branches), np.int64)
    for four, branch in enumerate(model.drag_branches):
        driving = driven[:, FOUR * four : FOUR * (four + 1)]
        braked = layout.modes[np.any(driving != 0.0, axis=1)]
        groups[four] = (int(braked.max(initial=-1)) - int(layout.starts[branch])) // (2 * WIDTH) + 1
    return groups


def modal_state(
    model: ModalModel, propagator: Propagator, angles: Array, speeds: Array, inputs: Array
) -> Array:
    """Return the marched state ``w`` (n_states,) of a drivetrain at ``angles`` and ``speeds``, both (n,).

    ``inputs`` (n_inputs,): mesh torques, slow inputs and drag torques that act at this instant.
    """
    moved = model.shapes.T @ (model.inertia @ angles)
    scaled = np.concatenate(
        (model.shapes.T @ (model.inertia @ speeds), (model.frequencies * moved)[model.n_lines :])
    )
    return propagator.layout.lay(model.to_modes @ scaled - propagator.hold @ inputs)


def scaled_state(model: ModalModel, propagator: Propagator, state: Array, inputs: Array) -> Array:
    """Return the scaled coordinates (modal velocities, Omega eta); half their square is the energy [J]."""
    real = propagator.layout.modes
    z = state[real] + 1j * state[real + WIDTH] + propagator.hold @ inputs
    scaled: Array = (model.to_scaled @ z).real + model.scaled_through @ inputs
    return scaled
