"""Exact propagator of the linear drivetrain between its gear meshes, from its complex modes.

Mesh torques are the cubics through their values at the end of a step, at its start, one and two steps before; motor,
bracing and drag torques vary linearly. A step with such inputs is exact for any step length: with
``z' = lambda z + b u`` and a polynomial ``u`` its powers give ``k! h phi_(k+1)(lambda h) b``, so that overdamped joints
with real poles of 1e7 1/s cost nothing. Angles and approaches are integrals of the velocity outputs, exact in the same
sense, which keeps the small difference of two large rotations.

The modal state that is marched leaves out what follows the torques at once,

    z = w + c tau_0 + d tau_-1 + e tau_-2 ,   w' = E w + p tau_0

with ``c``, ``d``, ``e`` and ``p`` from the cubic, so that a step pushes each mode by one torque of each port, as with a
straight line. Modes that fade within a step take the straight line: ``d`` and ``e`` would be far larger than what they
stand for.

Source: phi_k as in exponential integrators (Hochbruck and Ostermann, Acta Numerica 19, 2010), multistep as there in
section 2.5.
"""

from dataclasses import dataclass
from math import factorial

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.kernels import HELD, WIDTH, DiscreteModes, DragModes
from dynamics.response.modal_layout import ModalLayout, StepResponse, branch_layout, port_blocks
from dynamics.response.modal_model import ModalModel

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

CUBIC = np.array([1.0, 0.0, -1.0, -2.0])
"""Instants of the mesh torques that act in a step, in steps from its start."""
LINE = CUBIC[:2]
"""Those of all other inputs."""
FADED = -2.0
"""Real part of a pole, per step, below which a mode has faded within it."""


@dataclass(frozen=True, kw_only=True)
class Propagator:
    """The modal model at one step length [s], in the layout of ``dynamics.kernels``.

    hold : (n_modes, n_inputs + 2 n_ports) part of the modal state that follows the inputs at once: z = w + hold u, with
        the inputs of the model and the mesh torques one and two steps before
    layout : where each mode stands in the marched state
    """

    step: float
    modes: DiscreteModes
    hold: ComplexArray
    layout: ModalLayout


def discretise(model: ModalModel, step: float, *, substeps: int = 1, with_losses: bool = True) -> Propagator:
    """Return the propagator for one step length.

    Parameters
    ----------
    step : internal step, above 0 [s]
    substeps : steps over which the slow inputs are linear
    with_losses : False leaves out the rows of the joint losses

    Raises DynamicsInputError for a step that is not above 0.
    """
    if not step > 0.0:
        raise DynamicsInputError(f"step = {step} s must be positive")
    n_fast = 2 * model.n_meshes
    n_ports = 2 * n_fast
    n_rows = model.outputs.shape[0] if with_losses else n_ports + model.n_slow + model.n_drags
    layout = branch_layout(model.branches)
    ports = held_response(model, step, slice(0, n_fast), CUBIC)
    lines = held_response(model, step, slice(n_fast, None), LINE)
    tables = port_blocks(model.port_branches, layout, ports.first(n_ports))
    slow_outputs, slow_states = _slow_responses(lines.first(n_rows, model.n_slow), n_ports, substeps)
    # what is seen at the end of a step that is no port's, per torque of the ports and of the drags
    ends, drags = ports.given[:HELD, n_ports:n_rows], lines.given[:, :, model.n_slow :]
    braked = slice(n_ports + model.n_slow, n_ports + model.n_slow + model.n_drags)
    staying = drags.sum(axis=0)
    discrete = DiscreteModes(
        **tables._asdict(),
        port_new=np.ascontiguousarray(ports.given[0, :n_ports].T),
        rows=layout.lay(ports.rows[n_ports:n_rows].conj()),
        through_ends=np.vstack(
            (*ends.swapaxes(1, 2), *drags[:, n_ports:n_rows].swapaxes(1, 2)),
        ),
        slow_outputs=slow_outputs,
        slow_states=layout.lay(slow_states),
        drags=DragModes(
            branches=model.drag_branches,
            push=layout.lay(lines.driven[:, model.n_slow :].T),
            rows=layout.lay(ports.rows[braked].conj()),
            inputs=np.vstack((*ports.given[:HELD, braked].swapaxes(1, 2), staying[braked].T)),
            each_other=np.ascontiguousarray(drags[0, braked].T),
            ports_held=np.ascontiguousarray(staying[:n_ports].T),
            ports_new=np.ascontiguousarray(drags[0, :n_ports].T),
        ),
    )
    hold = np.hstack((ports.follow[0], lines.follow[0], *ports.follow[1:]))
    return Propagator(step=step, modes=discrete, hold=hold, layout=layout)


def held_response(model: ModalModel, step: float, inputs: slice, nodes: Array) -> StepResponse:
    """How modes and outputs go over a step with the polynomials through the values of some inputs at ``nodes``.

    nodes : in steps from the start of the step, its end first
    """
    scaled = model.eigenvalues * step
    decay = np.exp(scaled)
    faded = scaled.real < FADED
    forcing, n_ports = model.inputs[:, inputs], 4 * model.n_meshes
    driven = np.where(
        faded, _integrals(scaled, LINE, 1, len(nodes)), _integrals(scaled, nodes, 1, len(nodes))
    )
    turned = np.where(
        faded, _integrals(scaled, LINE, 2, len(nodes)), _integrals(scaled, nodes, 2, len(nodes))
    )
    of_state = step * driven[:, :, None] * forcing
    of_turn = step**2 * turned[:, :, None] * forcing
    # z = w + follow_0 u_1 + follow_1 u_0 + follow_2 u_-1, from the last value backwards
    follow = np.zeros((max(len(nodes) - 1, 1), *forcing.shape), complex)
    follow[0] = of_state[0]
    still = np.where(faded, 1.0, decay)[:, None]
    after = np.zeros_like(forcing)
    for node in range(len(nodes) - 1, 1, -1):
        after = np.where(faded[:, None], 0.0, (after - of_state[node]) / still)
        follow[node - 1] = after
    push = decay[:, None] * follow[0] + of_state[1] - after

    seen = model.outputs
    through, through_rate = model.through[:, inputs], model.through_rate[:, inputs]
    given = np.zeros((len(nodes), *through.shape))
    rows = seen.copy()
    speed, angle = np.arange(0, n_ports, 2), np.arange(1, n_ports, 2)
    others = np.arange(n_ports, len(seen))
    rows[speed] = seen[speed] * decay
    rows[angle] = seen[angle] * (step * _phi(1, scaled))
    held = _polynomial_means(nodes)
    for node in range(len(nodes)):
        before = follow[node - 1] if node > 0 else np.zeros_like(forcing)
        given[node, speed] = (seen[speed] @ (of_state[node] + decay[:, None] * before)).real
        given[node, angle] = (rows[angle] @ before + seen[angle] @ of_turn[node]).real
        given[node, angle] += step * held[node] * through[angle]
        if node < len(follow):
            given[node, others] = (seen[others] @ follow[node]).real
    # the dropped modes, which follow a change with some delay
    now = np.concatenate((speed, others))
    given[0, now] += through[now] + through_rate[now] / step
    given[1, now] -= through_rate[now] / step
    given[0, angle] += through_rate[angle]
    given[1, angle] -= through_rate[angle]
    return StepResponse(decay=decay, driven=push, rows=rows, given=given, follow=follow)


def _polynomials(nodes: Array) -> Array:
    """Coefficients (n_nodes, n_nodes), constant first, of polynomials that are 1 at one node and 0 at the others."""
    return np.asarray(np.linalg.inv(np.vander(nodes, increasing=True)).T, float)


def _polynomial_means(nodes: Array) -> Array:
    """Mean over the step of the polynomials of the nodes."""
    return np.asarray(_polynomials(nodes) @ (1.0 / np.arange(1, len(nodes) + 1)))


def _integrals(scaled: ComplexArray, nodes: Array, times: int, count: int) -> ComplexArray:
    """(count, n_modes): state of the modes after a unit step under the polynomials of the nodes, from rest, integrated
    so many times."""
    powers = np.array([factorial(k) * _phi(k + times, scaled) for k in range(len(nodes))])
    found = np.zeros((count, len(scaled)), complex)
    found[: len(nodes)] = _polynomials(nodes) @ powers
    return found


def _slow_responses(response: StepResponse, n_ports: int, substeps: int) -> tuple[Array, ComplexArray]:
    """Return what slow inputs give in every step of a sample (2 n_slow, substeps * n_rows), and to the modes by its
    end (2 n_slow, n_modes): in turn for an input held at one and for one that rises by one in each step.

    The first ``n_ports`` rows look at the modes before a step, the others after it.
    """
    decay, driven, rows = response.decay, response.driven, response.rows
    new, old = response.given
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


def modal_state(
    model: ModalModel, propagator: Propagator, angles: Array, speeds: Array, inputs: Array
) -> Array:
    """Return the marched state ``w`` (n_states,) of a drivetrain at ``angles`` and ``speeds``, both (n,).

    ``inputs`` (n_inputs + 2 n_ports,): mesh torques, slow inputs and drag torques that act at this instant, then the
    mesh torques one and two steps before.
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
    scaled: Array = (model.to_scaled @ z).real + model.scaled_through @ inputs[
        : model.scaled_through.shape[1]
    ]
    return scaled


def _phi(k: int, x: ComplexArray) -> ComplexArray:
    """Return phi_k(x) = sum_j x^j / (j + k)!, by series near zero and by recursion elsewhere."""
    small = np.abs(x) < 0.5
    near = np.where(small, x, 0.0)
    series = np.zeros_like(near)
    for j in range(18, -1, -1):
        series = series * near + 1.0 / factorial(j + k)
    far = np.where(small, 1.0, x)
    value = np.exp(far)
    for j in range(k):
        value = (value - 1.0 / factorial(j)) / far
    return np.where(small, series, value)
