"""Exact propagator of the linear drivetrain between its gear meshes, from its complex modes.

A step takes each mode exactly, so that overdamped joints with real poles of 1e7 1/s cost nothing; the torques of the
meshes are held by Numerov's method, all other inputs vary linearly. Angles and
approaches are integrals of the velocity outputs in the same sense, which keeps the small difference of two large
rotations. The modal state that is marched leaves out what follows the inputs at once, so that a step pushes each mode
by one number of each input.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import factorial
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.kernels import FOUR, WIDTH, DiscreteModes, DragModes, WrenchModes
from dynamics.rotor.graph import TorqueSection, TwistRows
from dynamics.rotor.linear_system import MeshWrench
from dynamics.vibration.modal_model import ModalModel

Array = NDArray[np.float64]


ComplexArray = NDArray[np.complex128]


# Tables of the tooth forces beside the ports for the compiled march (``dynamics.kernels.wrench``).

# Layout of the modes of a drivetrain for the compiled march: branch by branch, with the ports they meet.
#
# See ``dynamics.kernels.DiscreteModes`` for the tables that are filled here.

Integers = NDArray[np.int64]


class ModalLayout(NamedTuple):
    """Places in the marched state, see ``kernels.DiscreteModes``."""

    modes: Integers
    """(n_modes,) real part of each mode; its imaginary part stands WIDTH further."""
    starts: Integers
    """(n_branches + 1,) first state of each branch."""

    def lay(self, values: ComplexArray) -> Array:
        """Return modal (..., n_modes) as (..., n_states), zeros elsewhere."""
        laid = np.zeros((*values.shape[:-1], int(self.starts[-1])))
        laid[..., self.modes] = values.real
        laid[..., self.modes + WIDTH] = values.imag
        return laid


class StepResponse(NamedTuple):
    """How the modes and some outputs go over one step with inputs that vary linearly."""

    decay: ComplexArray
    """(n_modes,) modal state at the end per state at the start."""
    driven: ComplexArray
    """(n_modes, n_inputs) modal state at the end per input."""
    rows: ComplexArray
    """(n_rows, n_modes) outputs per modal state."""
    old: Array
    """(n_rows, n_inputs) outputs per input at the start of the step."""
    new: Array
    """(n_rows, n_inputs) outputs per input at its end."""


class PortBlocks(NamedTuple):
    """Tables of ``kernels.DiscreteModes`` with the same names."""

    blocks: Integers
    further: Integers
    bank: Array
    links: Integers
    through: Array


def branch_layout(branches: Integers) -> ModalLayout:
    """Return the places of modes on ``branches`` (n_modes,), not decreasing."""
    modes, starts = [], [0]
    for size in np.unique(branches, return_counts=True)[1]:
        own = np.arange(size)
        modes.append(starts[-1] + own // WIDTH * 2 * WIDTH + own % WIDTH)
        starts.append(starts[-1] + 2 * WIDTH * -(-int(size) // WIDTH))
    return ModalLayout(np.concatenate(modes), np.array(starts, np.int64))


def port_blocks(port_branches: Integers, layout: ModalLayout, response: StepResponse) -> PortBlocks:
    """Return the tables that take the modes over a step and give the outputs of the ports.

    port_branches : (n_ports,) branch of each mesh port
    response : to the torques at the ports, two outputs a port
    """
    decay, driven, rows, old, new = response
    n_ports = driven.shape[1]
    # zeros for the port that stands for none
    fades, pushes = layout.lay(decay), np.pad(layout.lay(driven.T), ((0, 1), (0, 0)))
    seen = np.pad(layout.lay(rows.conj()), ((0, 2), (0, 0)))
    through = np.pad(np.stack((old, new)), ((0, 0), (0, 2), (0, 1)))
    blocks: list[tuple[int, ...]] = []
    further: list[tuple[int, ...]] = []
    own: list[tuple[int, ...]] = []
    others: list[tuple[int, ...]] = []
    bank, linked = [np.zeros(0)], [np.zeros(0)]
    for branch, (start, stop) in enumerate(zip(layout.starts[:-1], layout.starts[1:])):
        ports = np.flatnonzero(port_branches == branch)
        pairs = np.append(ports, np.full(max(2 - len(ports), len(ports) % 2), n_ports)).reshape(-1, 2)
        home, groups = sum(map(len, bank)), (stop - start) // (2 * WIDTH)
        for number, pair in enumerate(pairs):
            outputs = [2 * pair[0], 2 * pair[0] + 1, 2 * pair[1], 2 * pair[1] + 1]
            for source, acting in enumerate(pairs):
                at = sum(map(len, linked))
                linked.append(through[:, outputs][:, :, acting].ravel())
                to_itself = source == number == 0
                (own if to_itself else others).append((*pair, *acting, at))
                if source == number:
                    bank_at = sum(map(len, bank))
                    (further if number else blocks).append((start, bank_at, home, groups, *pair, at))
            table = np.stack((np.zeros_like(fades), fades, *pushes[pair], *seen[outputs]))[:, start:stop]
            bank.append(table.reshape(-1, groups, 2 * WIDTH).swapaxes(0, 1).ravel())
    return PortBlocks(
        np.array(blocks, np.int64), np.array(further, np.int64).reshape(-1, len(blocks[0])), np.concatenate(bank),
        np.array(own + others, np.int64), np.concatenate(linked),
    )  # fmt: skip


Scalar = TypeVar("Scalar", np.float64, np.complex128)


def n_friction_rows(model: ModalModel) -> int:
    """Friction rows of all meshes, filled up to whole fours; 0 where gears only rotate."""
    return -(-2 * len(model.wrench_numbers) // FOUR) * FOUR


def wrench_columns(model: ModalModel, table: NDArray[Scalar]) -> NDArray[Scalar]:
    """Columns of a table (..., n_inputs) for the forces beside the ports, in the order of the march (..., n)."""
    n_meshes = len(model.wrench_numbers)
    own = table[..., table.shape[-1] - 3 * n_meshes :]
    none = np.zeros((*table.shape[:-1], n_friction_rows(model) - 2 * n_meshes), table.dtype)
    return np.concatenate((own[..., : 2 * n_meshes], none, own[..., 2 * n_meshes :]), axis=-1)


def wrench_inputs(model: ModalModel, forces: Array) -> Array:
    """Inputs (..., 3 n_meshes) of the modal model from forces (..., n) of the march."""
    return np.concatenate(
        (forces[..., : 2 * len(model.wrench_numbers)], forces[..., n_friction_rows(model) :]), axis=-1
    )


def parted_flanks(model: ModalModel, wrench: MeshWrench | None, angles: Array) -> Array:
    """By how much gears at ``angles`` (n,) stand closer on the other flanks than on those that carry [m], and by how
    much pinions turn from the centre line beyond their ports [rad], each with its rate, none: (4, n_meshes)."""
    parted = np.zeros((4, model.n_meshes))
    if wrench is not None:
        parted[2] = wrench.turns[:, 0] @ angles
        parted[0] = -model.wrench_numbers[:, 3] * (wrench.slide @ angles)
    return parted


def wrench_hold(model: ModalModel, interval: float) -> ComplexArray:
    """Part (n_modes, 3 n_meshes) of the modal state that follows at once what is linear over an interval [s]."""
    own = model.inputs[:, model.inputs.shape[1] - 3 * len(model.wrench_numbers) :]
    return np.asarray(interval * straight_line(model.eigenvalues * interval).state[:, None] * own)


def wrench_modes(
    model: ModalModel, layout: ModalLayout, hold: ComplexArray, step: float, every: int
) -> WrenchModes:
    """Tables for one step length [s] and intervals of ``every`` steps.

    hold : (n_modes, n_inputs) part of the modal state that follows the inputs at once
    """
    n_meshes, n, n_ports = len(model.wrench_numbers), n_friction_rows(model), 4 * model.n_meshes
    x = model.eigenvalues * step
    forcing = wrench_columns(model, model.inputs)
    held = wrench_columns(model, hold)
    through = wrench_columns(model, model.through[:n_ports]).real
    speed, turn = np.arange(0, n_ports, 2), np.arange(1, n_ports, 2)
    present, outputs = held, []
    for _ in range(every):
        one = np.zeros((n_ports, n + n_meshes))
        moved = step * phi(1, x)[:, None] * present + step**2 * phi(2, x)[:, None] * forcing
        one[turn] = (model.outputs[turn] @ moved).real + step * through[turn]
        present = np.exp(x)[:, None] * present + step * phi(1, x)[:, None] * forcing
        one[speed] = (model.outputs[speed] @ present).real + through[speed]
        outputs.append(one.T)
    push = layout.lay((present - held).T)
    pieces, flat = _pieces(push[:n], layout)
    seen, rate = model.wrench_outputs, model.wrench_through_rate / step
    new = (seen @ hold).real + model.wrench_through + rate
    n_fast = 2 * model.n_meshes
    # all in one order, with forces beside the ports and without: another one is compiled anew
    return WrenchModes(
        pieces=pieces,
        push=flat,
        slide_push=push[n:],
        held=np.ascontiguousarray(np.hstack(outputs)),
        rows=layout.lay(seen.conj()).ravel(),
        by_torque=np.ascontiguousarray(np.stack((-rate[:, :n_fast].T, new[:, :n_fast].T))),
        by_force=np.ascontiguousarray(wrench_columns(model, new - rate).T.real),
        numbers=model.wrench_numbers,
        n_rows=n,
        every=every,
    )


def _pieces(push: Array, layout: ModalLayout) -> tuple[NDArray[np.int64], Array]:
    """Groups of modes that each four of forces moves and their pushes, see ``kernels.wrench.WrenchModes``.

    push : (n, n_states)
    """
    found: list[tuple[int, int, int, int, int]] = []
    flat = [np.zeros(0)]
    for four in range(len(push) // FOUR):
        own = push[FOUR * four : FOUR * (four + 1)]
        for block, (start, stop) in enumerate(zip(layout.starts[:-1], layout.starts[1:])):
            groups = own[:, start:stop].reshape(FOUR, -1, 2 * WIDTH).swapaxes(0, 1)
            moved = np.flatnonzero(np.any(groups != 0.0, axis=(1, 2)))
            if moved.size:
                first, last = int(moved[0]), int(moved[-1]) + 1
                found.append((four, block, first, last - first, sum(map(len, flat))))
                flat.append(groups[first:last].ravel())
    return np.array(found, np.int64).reshape(-1, 5), np.concatenate(flat)


# What a torque gives to a mode within a step of the march, by its values at start and end of the step.
#
# A mode ``z' = lambda z + b u`` goes over a step h by ``z_1 = exp(x) z_0 + h b ((phi_1 - a) u_0 + a u_1)`` with ``x =
# lambda h``, and the integral of z by ``h^2 b ((phi_2 - t) u_0 + t u_1)`` beyond that of z_0. A constant torque is
# exact for any ``a`` and ``t``; two pairs of them are used:
#
# - the straight line between both values, ``a = phi_2`` and ``t = phi_3``: exact for slow inputs that are one, and
#   passive for torques that brake. Of second order: a mesh spring that it holds swings too slowly by (omega h)^2 / 24.
# - the method of Numerov on the matrix exponential, exact for a torque that is a parabola over two steps: of fourth
#   order in the displacements, so that meshes see where their bodies are. It uses both ends of a step alike, so that a
#   step back in time undoes a step forward and an undamped vibration on mesh springs neither grows nor decays, which
#   no polynomial through earlier values offers.
#
# Sources: phi_k as in exponential integrators (Hochbruck and Ostermann, Acta Numerica 19, 2010); Numerov's method and
# its exponential fitting: Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, III.10; time-symmetric
# steps: Hairer, Lubich and Wanner, Geometric Numerical Integration, XI and XIII.

FASTEST = 1.5
"""Modulus of x up to which a mode follows the torques of the meshes by Numerov's method; faster ones, which follow
almost at once, take the straight line."""
TERMS = 12
"""Terms of the series in x^2, which end far below rounding within `FASTEST`."""


class HeldInput(NamedTuple):
    """Weights (n_modes,) of the torque at the end of a step.

    state : a, of the mode at the end of the step; turn : t, of its integral over the step
    """

    state: ComplexArray
    turn: ComplexArray


def straight_line(x: ComplexArray) -> HeldInput:
    """Hold of an input that is linear between start and end of the step; x : (n_modes,) poles times step."""
    return HeldInput(phi(2, x), phi(3, x))


def numerov(x: ComplexArray) -> HeldInput:
    """Hold of the torques of the meshes; x : (n_modes,) poles times step."""
    line = straight_line(x)
    slow = np.abs(x) <= FASTEST
    y = np.where(slow, x, 0.0)
    outer = _even(y, [2.0 / factorial(2 * k + 4) for k in range(TERMS)])
    sinhc = _even(y, [1.0 / factorial(2 * k + 1) for k in range(TERMS)])
    # (cosh y - 1) / y^2, and the difference of that and half of sinhc, over y^2 as well
    bowed = _even(y, [1.0 / factorial(2 * k + 2) for k in range(TERMS)])
    apart = _even(y, [1.0 / factorial(2 * k + 4) - 0.5 / factorial(2 * k + 3) for k in range(TERMS)])
    turn = outer + y * (bowed * outer + apart) / sinhc
    return HeldInput(np.where(slow, 0.5 + y * turn, line.state), np.where(slow, turn, line.turn))


def _even(x: ComplexArray, coefficients: list[float]) -> ComplexArray:
    """Sum of coefficients times x^0, x^2, x^4, ..."""
    return np.asarray(np.polynomial.polynomial.polyval(x * x, coefficients))


def phi(k: int, x: ComplexArray) -> ComplexArray:
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


# Torque of shafts and joints read from the modal state of a march at every sample, and its envelopes.
#
# Exact for that state, tooth friction and every other load included, and cheap: one product with the modal state. What
# alternates within a sample is seen at the ends of the samples only: over a window of many samples their phases cover a
# vibration unless its frequency is a multiple of half the sample rate.


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
        modes, places = scaled @ model.to_scaled, propagator.layout.modes
        self._state = np.zeros((len(rows.rows), propagator.modes.rows.shape[1]))
        self._state[:, places], self._state[:, places + WIDTH] = modes.real, -modes.imag
        self._inputs = scaled @ model.scaled_through + (modes @ propagator.hold).real
        self._bracing = -rows.stiffness * rows.bracing
        self.sections = rows.sections

    def read(self, states: Array, inputs: Array, twist: Array) -> Array:
        """(r, n) torques [N m] at marched states.

        states : (n, n_states); inputs : (n, n_inputs) that act there (see ``propagator.modal_state``)
        twist : (n,) of the bracing [rad]
        """
        torque = self._state @ states.T + self._inputs @ inputs.T
        return np.asarray(torque + self._bracing[:, None] * twist)


@dataclass(frozen=True, kw_only=True)
class SectionEnvelopes:
    """Torque of r springs in the w windows of a run, in which its ``EnvelopeWindows`` stand.

    sections : (r,) of each; least, mean, greatest : (r, w) [N m], positive where the first end turns ahead
    """

    sections: tuple[TorqueSection, ...]
    least: Array
    mean: Array
    greatest: Array

    @property
    def half_peak_to_peak(self) -> Array:
        """(r, w) [N m]"""
        return 0.5 * (self.greatest - self.least)

    @property
    def peak(self) -> Array:
        """(r, w) largest amount [N m]"""
        return np.maximum(np.abs(self.least), np.abs(self.greatest))


class SectionStatistics:
    """Collect windows of ``per_window`` samples from consecutive blocks, each from a window boundary on."""

    def __init__(self, per_window: int) -> None:
        """Begin without a block."""
        self._per_window = per_window
        self._rows: list[Array] = []

    def add(self, torque: Array) -> None:
        """Add a block: torque (r, n_samples) [N m]."""
        starts = np.arange(0, torque.shape[1], self._per_window)
        lengths = np.diff(np.append(starts, torque.shape[1]))
        self._rows.append(
            np.stack(
                (
                    np.minimum.reduceat(torque, starts, axis=1),
                    np.add.reduceat(torque, starts, axis=1) / lengths,
                    np.maximum.reduceat(torque, starts, axis=1),
                )
            )
        )

    def envelopes(self, sections: Sequence[TorqueSection]) -> SectionEnvelopes:
        """All windows so far."""
        least, mean, greatest = np.concatenate(self._rows, axis=2)
        return SectionEnvelopes(sections=tuple(sections), least=least, mean=mean, greatest=greatest)
