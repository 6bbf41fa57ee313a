"""Layout of the modes of a drivetrain for the compiled march: branch by branch, with the ports they meet.

See ``dynamics.kernels.DiscreteModes`` for the tables that are filled here.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dynamics.kernels import WIDTH

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Integers = NDArray[np.int64]


class Layout(NamedTuple):
    """Places in the marched state, see ``kernels.DiscreteModes``."""

    modes: Integers
    """(n_modes,) real part of each mode; its imaginary part stands WIDTH further."""
    slots: Integers
    """(n_ports,) old torque of each port."""
    starts: Integers
    """(n_branches + 1,) first state of each branch."""

    def lay(self, values: ComplexArray) -> Array:
        """Return modal (..., n_modes) as (..., n_states), zeros elsewhere."""
        laid = np.zeros((*values.shape[:-1], int(self.starts[-1])))
        laid[..., self.modes] = values.real
        laid[..., self.modes + WIDTH] = values.imag
        return laid


def branch_layout(branches: Integers, port_branches: Integers) -> Layout:
    """Return the places of modes on ``branches`` (n_modes,), not decreasing, and of ports on ``port_branches``."""
    modes = []
    slots = np.zeros(len(port_branches), np.int64)
    starts = [0]
    for branch, size in zip(*np.unique(branches, return_counts=True)):
        own = np.arange(size)
        modes.append(starts[-1] + own // WIDTH * 2 * WIDTH + own % WIDTH)
        slot = starts[-1] + -(-size // WIDTH) * 2 * WIDTH
        ports = np.flatnonzero(port_branches == branch)
        slots[ports] = slot + 2 * np.arange(len(ports))
        starts.append(slot + 8 * -(-(2 * len(ports) + 3) // 8))
    return Layout(np.concatenate(modes), slots, np.array(starts, np.int64))


def port_blocks(
    port_branches: Integers, layout: Layout, decay: ComplexArray, driven: ComplexArray, rows: ComplexArray, old: Array,
    new: Array,
) -> tuple[Integers, Array, Array]:  # fmt: skip
    """Return ``DiscreteModes.blocks``, ``tables`` and ``port_rows``.

    decay : (n_modes,); driven : (n_modes, n_ports); rows : (2 n_ports, n_modes), conjugated; old, new : (2
    n_ports, n_ports) outputs of the ports per torque at start and end of the step
    """
    n_ports = driven.shape[1]
    seen = layout.lay(rows)
    seen[:, layout.slots] = old
    seen[:, layout.slots + 1] = new
    # a last row of zeros for the port that stands for none
    seen = np.vstack((seen, np.zeros((2, seen.shape[1]))))
    pushes = np.vstack((layout.lay(driven.T), np.zeros(seen.shape[1])))
    fades = layout.lay(decay), layout.lay(np.ones_like(decay))
    blocks: list[tuple[int, ...]] = []
    tables, port_rows = [np.zeros(0)], [np.zeros(0)]
    for branch, (start, stop) in enumerate(zip(layout.starts[:-1], layout.starts[1:])):
        ports = np.flatnonzero(port_branches == branch)
        clock = stop - 8 * -(-(2 * len(ports) + 3) // 8) + 2 * len(ports)
        groups = (clock - 2 * len(ports) - start) // (2 * WIDTH)
        modes = slice(start, start + 2 * WIDTH * groups)
        spare = max(2 - len(ports), len(ports) % 2)
        filled = np.append(ports, np.full(spare, n_ports))
        for a, b in filled.reshape(-1, 2):
            first = not blocks or blocks[-1][0] != start
            slot_a, slot_b = (layout.slots[port] if port < n_ports else clock + 2 for port in (a, b))
            at = sum(map(len, tables)), sum(map(len, port_rows))
            blocks.append((start, groups, (stop - start) // 8, a, b, slot_a, slot_b, clock, *at, first))
            table = np.array([part[modes] for part in (fades[0 if first else 1], pushes[a], pushes[b])])
            tables.append(table.reshape(3, groups, 2 * WIDTH).swapaxes(0, 1).ravel())
            port_rows.append(seen[[2 * a, 2 * a + 1, 2 * b, 2 * b + 1], start:stop].ravel())
    return np.array(blocks, np.int64), np.concatenate(tables), np.concatenate(port_rows)
