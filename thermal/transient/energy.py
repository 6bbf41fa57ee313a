"""Energy over a time run: what every condition gave, what every body and volume stored."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from thermal.conduction.balance import HeatBalance
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import FloatArray

ROUNDING = 1e-12
"""Share of the heat content above 0 K up to which energies are rounding."""

Place = int | str
"""A connected piece of the mesh by number, a volume by name."""


@dataclass(frozen=True)
class EnergyBalance:
    """Energies [J] since the start, positive into the solid or volume."""

    rows: Mapping[tuple[str, str], float]
    """(surface, body or volume; kind) -> energy."""
    stored: Mapping[str, float]
    """Body or volume -> energy taken up."""
    gaps: Mapping[Place, float]
    """What came in less what was stored, for each connected piece and each volume."""
    rounding: float
    """Turnover up to which no heat flows but by rounding."""

    @property
    def turnover(self) -> float:
        """Half the sum of the sizes of all rows and stored energies [J]."""
        parts = [*self.rows.values(), *self.stored.values()]
        return 0.5 * float(np.abs(parts).sum()) if parts else 0.0

    @property
    def closure(self) -> float:
        """Greatest gap relative to the turnover [-]; 0 where no heat flows but by rounding."""
        worst = max((abs(gap) for gap in self.gaps.values()), default=0.0)
        return worst / self.turnover if self.turnover > self.rounding else 0.0


class EnergyAccount:
    """Adds up energies step by step.

    capacity : body -> density times specific heat [J/(m3 K)]; level : of the temperatures [K]
    """

    def __init__(self, elements: FiniteElements, capacity: Mapping[str, float], level: float) -> None:
        self._elements = elements
        self._capacity = capacity
        self._rows: dict[tuple[str, str], float] = {}
        self._stored: dict[str, float] = {}
        self._gaps: dict[Place, float] = {}
        content = sum(capacity[body] * elements.volume(body) * level for body in elements.mesh.bodies)
        self._rounding = ROUNDING * content
        self._piece = {body: elements.components[cells] for body, cells in elements.mesh.bodies.items()}

    def book(self, balance: HeatBalance, duration: float) -> None:
        """Add the heats of ``balance`` [W] over ``duration`` [s]."""
        n_pieces = int(self._elements.components.max()) + 1
        for row in balance.rows:
            place = row.piece if row.piece < n_pieces else row.surface
            self.give(row.surface, row.kind, place, duration * row.power)

    def give(self, surface: str, kind: str, place: Place, energy: float) -> None:
        """Add one energy [J] that enters a piece or volume."""
        key = (surface, kind)
        self._rows[key] = self._rows.get(key, 0.0) + energy
        self._add(place, energy)

    def store(self, rise: FloatArray, volumes: Mapping[str, float]) -> None:
        """Add what the bodies take up when the nodes warm by ``rise`` (n_nodes,) [K], and volumes [J]."""
        for body, cells in self._elements.mesh.bodies.items():
            at, weights = self._elements.at_points(rise, cells)
            order = np.sort(cells)
            per_cell = self._capacity[body] * (at * weights).reshape(len(order), -1).sum(axis=1)
            self._stored[body] = self._stored.get(body, 0.0) + float(per_cell.sum())
            by_piece = np.bincount(self._elements.components[order], per_cell)
            for piece in np.unique(self._piece[body]).tolist():
                self._add(piece, -float(by_piece[piece]))
        for name, energy in volumes.items():
            self._stored[name] = self._stored.get(name, 0.0) + energy
            self._add(name, -energy)

    def _add(self, place: Place, energy: float) -> None:
        self._gaps[place] = self._gaps.get(place, 0.0) + energy

    @property
    def balance(self) -> EnergyBalance:
        """What was added up so far."""
        return EnergyBalance(dict(self._rows), dict(self._stored), dict(self._gaps), self._rounding)
