"""Heat by named surface, each row integrated from its own law; what is left over is the closure error.

Nothing here is shared with the residual that `thermal.conduction.steady` drives to zero: no flow is booked as the
difference of others, so a sign or an area that is wrong in one place shows as a gap.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermal.conditions.boundary import (
    Adiabatic,
    BodySource,
    Exchange,
    Film,
    PrescribedTemperature,
    Radiation,
    SurfaceSource,
)
from thermal.conditions.contact import Contact
from thermal.conditions.enclosure import Enclosure
from thermal.conditions.streams import StreamNetwork
from thermal.conduction.capacity import StoredHeat
from thermal.conduction.condition_checks import Condition
from thermal.conduction.coupled_rows import contact_rows, enclosure_rows, network_rows
from thermal.conduction.heat_rows import HeatFlow as HeatRow
from thermal.conduction.heat_rows import exchange_rows, film_row, radiation_row, surface_row
from thermal.conduction.setup import ConductionSetup
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import FloatArray


@dataclass(frozen=True)
class HeatBalance:
    """All rows; in a steady state they sum to zero on every connected piece."""

    rows: tuple[HeatRow, ...]

    @property
    def imbalance(self) -> float:
        """Sum of all rows [W]."""
        return float(np.sum([row.power for row in self.rows]))

    @property
    def turnover(self) -> float:
        """Heat turned over: half the sum of the rows' sizes [W]."""
        return 0.5 * float(np.sum([abs(row.power) for row in self.rows]))

    @property
    def worst_piece(self) -> float:
        """Size of the largest sum of rows on one piece [W]; sees what an exchange cancels in the whole."""
        sums: dict[int, float] = {}
        for row in self.rows:
            sums[row.piece] = sums.get(row.piece, 0.0) + row.power
        return max((abs(power) for power in sums.values()), default=0.0)

    @property
    def closure(self) -> float:
        """The gap of the worst piece relative to the heat turned over [-]; 0 where no heat flows."""
        return self.worst_piece / self.turnover if self.turnover > 0.0 else 0.0

    def by_surface(self) -> dict[str, float]:
        """Surface or body -> power [W]."""
        return self._sums("surface")

    def by_kind(self) -> dict[str, float]:
        """Kind -> power [W]."""
        return self._sums("kind")

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the laws said about their range, each sentence once."""
        said = [text for row in self.rows if row.coefficient for text in row.coefficient.warnings]
        return tuple(dict.fromkeys(said))

    def _sums(self, field: str) -> dict[str, float]:
        sums: dict[str, float] = {}
        for row in self.rows:
            key = getattr(row, field)
            sums[key] = sums.get(key, 0.0) + row.power
        return sums


def heat_balance(
    setup: ConductionSetup,
    conditions: Sequence[Condition],
    temperature: FloatArray,
    reactions: FloatArray,
    volumes: Mapping[str, float] | None = None,
) -> HeatBalance:
    """Integrate every condition over its surface.

    temperature : (n_nodes,) [K]
    reactions : (n_nodes,) heat that holds the prescribed nodes at their temperature [W], zero elsewhere
    volumes : volume of a stream network -> outlet temperature [K]
    """
    elements = setup.elements
    held = held_by(elements, conditions)
    numbers = _volume_numbers(elements, conditions)
    rows: list[HeatRow] = []
    for condition in conditions:
        match condition:
            case Film():
                rows.append(film_row(elements.surfaces[condition.surface], condition, temperature))
            case Radiation():
                rows.append(radiation_row(elements.surfaces[condition.surface], condition, temperature))
            case Exchange():
                rows.extend(exchange_rows(elements, condition, temperature))
            case Contact():
                rows.extend(contact_rows(setup, condition, temperature))
            case Enclosure():
                rows.extend(enclosure_rows(elements, condition, temperature))
            case StreamNetwork():
                rows.extend(network_rows(elements, condition, temperature, volumes or {}, numbers))
            case PrescribedTemperature():
                surface = elements.surfaces[condition.surface]
                power = float(np.sum(reactions[surface.nodes] / held[surface.nodes]))
                rows.append(surface_row(surface, condition.surface, condition.kind, power, temperature))
            case SurfaceSource():
                surface = elements.surfaces[condition.surface]
                rows.append(
                    surface_row(surface, condition.surface, condition.kind, condition.power, temperature)
                )
            case BodySource():
                rows.append(
                    HeatRow(
                        surface=condition.body,
                        kind=condition.kind,
                        power=condition.power,
                        area=0.0,
                        mean_temperature=elements.body_mean(temperature, condition.body),
                        piece=int(elements.components[elements.mesh.bodies[condition.body][0]]),
                    )
                )
            case StoredHeat():
                rows.extend(_stored_rows(setup, condition, temperature))
            case Adiabatic():
                pass
    return HeatBalance(tuple(rows))


def _stored_rows(setup: ConductionSetup, condition: StoredHeat, temperature: FloatArray) -> list[HeatRow]:
    """What every body takes up per time, as heat that leaves it."""
    elements, capacity = setup.elements, setup.heat_capacity(condition.capacity)
    rise = temperature - condition.start
    return [
        HeatRow(
            surface=body,
            kind=condition.kind,
            power=-capacity.stored(rise, body) / condition.time,
            area=0.0,
            mean_temperature=elements.body_mean(temperature, body),
            piece=int(elements.components[cells[0]]),
        )
        for body, cells in elements.mesh.bodies.items()
    ]


def held_by(elements: FiniteElements, conditions: Sequence[Condition]) -> FloatArray:
    """(n_nodes,) number of prescribed surfaces that hold each node, at least 1."""
    count = np.zeros(len(elements.mesh.points))
    for condition in conditions:
        if isinstance(condition, PrescribedTemperature):
            count[elements.surfaces[condition.surface].nodes] += 1.0
    return np.maximum(count, 1.0)


def _volume_numbers(elements: FiniteElements, conditions: Sequence[Condition]) -> dict[str, int]:
    """Number of each volume, counted on from the last piece of the mesh."""
    networks = [c for c in conditions if isinstance(c, StreamNetwork)]
    names = [volume.name for network in networks for volume in network.volumes]
    first = int(elements.components.max()) + 1
    return {name: first + k for k, name in enumerate(names)}
