"""Contact tables of a march at the speed at which it runs.

What the steps do not resolve of the path is filtered out of the tables (``dynamics.mesh.path_filter``): the faster, the
more. They are made for speeds on a geometric scale, so that marches share them.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from dynamics.kernels.contact_table import ContactTables
from dynamics.mesh.contact_table import MarchStep, contact_tables
from dynamics.mesh.law import MeshLaw
from dynamics.mesh.path_filter import RESOLVED

Array = NDArray[np.float64]

RUNG = 0.6
"""Ratio of the speeds of neighbouring tables, less one."""
CLOSING_RUNG = 0.05
"""Change of a speed after which dampers on the closing rate, which work as the speed, are tabulated anew [-]."""
CREEP = 0.1
"""Speed below which dampers on the closing rate of contacts find no path speed [rad/s]."""


class MarchTables:
    """Contact tables over the speed for the steps [s] of a march, which keeps those that serve again."""

    def __init__(self, laws: Sequence[MeshLaw], step: float, *, derivative_torques: bool = True) -> None:
        self._laws, self._step, self._derivative_torques = tuple(laws), step, derivative_torques
        self._closes = np.array([law.damping_acts_on == "contact_closing_rate" for law in laws])
        # slower than this all tables are alike, unless dampers know the speed
        unfiltered = np.array([law.base_pitch / (RESOLVED * law.base_radius_1 * step) for law in laws])
        self._slow = np.where(self._closes, CREEP, unfiltered)
        self._speeds: Array | None = None
        self._found: dict[tuple[float, ...], ContactTables] = {}

    def at(self, speeds: Array) -> ContactTables:
        """Tables for speeds of the pinions (n_meshes,) [rad/s], the last ones as long as they are good."""
        known = self._speeds
        if known is not None:
            wide = np.where(self._closes, CLOSING_RUNG, RUNG) * np.abs(known)
            if np.all(np.abs(speeds - known) <= np.where(known == 0.0, self._slow, wide)):
                return self._found[tuple(known.tolist())]
        rungs = np.round(np.log(np.maximum(np.abs(speeds), 1e-9)) / np.log1p(RUNG))
        known = np.where(self._closes, speeds, np.sign(speeds) * (1.0 + RUNG) ** rungs)
        known = np.where(np.abs(speeds) < self._slow, 0.0, known)
        self._speeds = known
        key = tuple(known.tolist())
        if key not in self._found:
            if self._closes.any():  # of too many speeds to keep
                self._found.clear()
            self._found[key] = contact_tables(
                self._laws,
                march=MarchStep(step=self._step, speeds=key) if known.any() else None,
                derivative_torques=self._derivative_torques,
            )
        return self._found[key]
