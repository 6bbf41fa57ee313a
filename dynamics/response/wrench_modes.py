"""Tables of the tooth forces beside the ports for the compiled march (``dynamics.kernels.wrench``)."""

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.mesh_wrench import MeshWrench
from dynamics.kernels import FOUR, WIDTH, WrenchModes
from dynamics.response.modal_layout import ModalLayout
from dynamics.response.modal_model import ModalModel
from dynamics.response.step_hold import phi, straight_line

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
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
