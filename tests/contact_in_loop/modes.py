"""Modes of a drivetrain over one step, under forces on some of its rows that are linear in it.

The modes of the linear part are taken over the step exactly; those above a cutoff follow their forces at once and with
their delay (`tests.contact_in_loop.integration`). The straight line is the hold here: the speeds at the ends of a step
are then exactly those of its forces, so that their power closes the books of the contact.
"""

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.linear_system import LinearSystem, ModalForm
from dynamics.vibration.propagator import phi, straight_line
from tests.contact_in_loop.integration import HeldModes

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

SLOW = 1.0
"""Pole below which a mode is a rigid motion that drag torques slow down [1/s]."""


class ModesOverStep:
    """Complex modes, one of each conjugate pair, and what forces on the rows do to them and to the rows in one step."""

    def __init__(self, form: ModalForm, rows: Array, step: float, cutoff: float) -> None:
        """Prepare.

        rows : (n_rows, n) on the freedoms of the form; step : [s]
        cutoff : modes above this frequency [Hz] are not marched
        """
        upper = form.poles.imag >= 0.0
        poles = form.poles[upper]
        seen = (rows @ form.velocity_shapes[:, upper]) * np.where(poles.imag > 0.0, 2.0, 1.0)
        self._loads, self._poles, self._seen, self._step = form.loads[upper], poles, seen, step
        self._kept = kept = np.abs(poles) <= 2.0 * np.pi * cutoff
        scaled = poles[kept] * step
        self._phi_1, self._phi_2, self._hold = phi(1, scaled), phi(2, scaled), straight_line(scaled)
        self._decay = np.exp(scaled)
        pushed = self._loads @ rows.T
        old, new = self._pushes(pushed[kept])
        self._pushed = _stacked(np.hstack([old, new]))
        moving, steady = seen[:, kept] * (step * self._phi_1), seen[:, kept] * self._decay
        self._rows = np.vstack([_seen(moving), _seen(steady)])
        self._given = np.block(
            [
                [part + late for part, late in zip(parts, lates)]
                for parts, lates in zip(self._by_kept(pushed[kept], old, new), self._by_others(pushed[~kept]))
            ]
        )

    def held(self, load: Array) -> HeldModes:
        """Tables with a load (n,) that stays."""
        pushed, kept = self._loads @ load, self._kept
        old, new = self._pushes(pushed[kept, None])
        moved, speed = self._by_kept(pushed[kept, None], old, new)
        moved_late, speed_late = self._by_others(pushed[~kept, None])
        whole = [sum(moved) + sum(moved_late), sum(speed) + sum(speed_late)]
        return HeldModes(
            decay=self._decay,
            pushed=self._pushed,
            seen=self._rows,
            given=self._given,
            constant=_stacked(old + new)[:, 0].copy(),
            given_constant=np.vstack(whole)[:, 0].copy(),
        )

    def at(self, system: LinearSystem, angles: Array, speeds: Array) -> Array:
        """Modes (2 n_kept,) of a state that elastic forces hold in uniform rotation: angles and speeds (n,)."""
        moving = self._loads @ (system.inertia @ speeds)
        held = self._loads @ (system.stiffness @ angles)
        fast = np.abs(self._poles) > SLOW
        found = moving - np.where(fast, held / np.where(fast, self._poles, 1.0), 0.0)
        return _stacked(found[self._kept, None])[:, 0].copy()

    def kicked(self, system: LinearSystem, speeds: Array) -> Array:
        """What a sudden change of all speeds (n,) adds to the modes (2 n_kept,)."""
        return _stacked((self._loads @ (system.inertia @ speeds))[self._kept, None])[:, 0].copy()

    def _pushes(self, pushed: Complex) -> tuple[Complex, Complex]:
        """Modes at the end per force at the start and at the end, from their forcing (n_kept, n)."""
        late = self._hold.state
        return pushed * (self._step * (self._phi_1 - late))[:, None], pushed * (self._step * late)[:, None]

    def _by_kept(
        self, pushed: Complex, old: Complex, new: Complex
    ) -> tuple[tuple[Array, ...], tuple[Array, ...]]:
        """Motion in the step and speed at its end per force at its start and its end, (n_rows, n) each."""
        seen, square, late = self._seen[:, self._kept], self._step**2, self._hold.turn
        return (
            ((seen * (square * (self._phi_2 - late)) @ pushed).real, (seen * (square * late) @ pushed).real),
            ((seen @ old).real, (seen @ new).real),
        )

    def _by_others(self, pushed: Complex) -> tuple[tuple[Array, ...], tuple[Array, ...]]:
        """The same by modes that are not marched, from their forcing (n_others, n)."""
        seen, poles, step = self._seen[:, ~self._kept], self._poles[~self._kept, None], self._step
        still, late = (seen @ (pushed / poles)).real, (seen @ (pushed / poles**2)).real
        return (
            (late - 0.5 * step * still, -late - 0.5 * step * still),
            (late / step, -still - late / step),
        )


def _stacked(modes: Complex) -> Array:
    """Real parts, then imaginary parts (2 n_modes, n)."""
    return np.ascontiguousarray(np.vstack([modes.real, modes.imag]))


def _seen(rows: Complex) -> Array:
    """Rows (n_rows, 2 n_modes) on modes that are stacked, of what is real."""
    return np.hstack([rows.real, -rows.imag])
