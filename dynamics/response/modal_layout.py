"""Layout of the modes of a drivetrain for the compiled march: branch by branch, with the ports they meet.

See ``dynamics.kernels.DiscreteModes`` for the tables that are filled here.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dynamics.kernels import WIDTH, port_place

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
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
            to = tuple(map(port_place, pair))
            for source, acting in enumerate(pairs):
                at = sum(map(len, linked))
                linked.append(through[:, outputs][:, :, acting].ravel())
                to_itself = source == number == 0
                (own if to_itself else others).append((*to, *map(port_place, acting), at))
                if source == number:
                    bank_at = sum(map(len, bank))
                    (further if number else blocks).append((start, bank_at, home, groups, *to, at))
            table = np.stack((np.zeros_like(fades), fades, *pushes[pair], *seen[outputs]))[:, start:stop]
            bank.append(table.reshape(-1, groups, 2 * WIDTH).swapaxes(0, 1).ravel())
    return PortBlocks(
        np.array(blocks, np.int64), np.array(further, np.int64).reshape(-1, len(blocks[0])), np.concatenate(bank),
        np.array(own + others, np.int64), np.concatenate(linked),
    )  # fmt: skip
