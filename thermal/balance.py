"""Heat by named surface, each row integrated from its own law; what is left over is the closure error.

Nothing here is shared with the residual that `thermal.conduction` drives to zero: no flow is booked as the
difference of others, so a sign or an area that is wrong in one place shows as a gap.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermal.boundary import (
    STEFAN_BOLTZMANN,
    Adiabatic,
    BodySource,
    BoundaryCondition,
    Exchange,
    Film,
    FilmCoefficient,
    PrescribedTemperature,
    Radiation,
    SurfaceSource,
)
from thermal.fe.elements import FiniteElements, SurfaceElements
from thermal.fe.mesh import FloatArray


@dataclass(frozen=True, kw_only=True)
class HeatRow:
    """Heat of one condition at one place."""

    surface: str
    """Surface, or body for a source in a body."""
    kind: str
    power: float
    """[W], positive into the solid."""
    area: float
    """[m2]; 0 for a source in a body."""
    mean_temperature: float
    """Area mean of the surface, volume mean of the body [K]."""
    piece: int
    """Number of the connected piece of the mesh that takes the heat."""
    coefficient: FilmCoefficient | None = None


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

    def _sums(self, field: str) -> dict[str, float]:
        sums: dict[str, float] = {}
        for row in self.rows:
            key = getattr(row, field)
            sums[key] = sums.get(key, 0.0) + row.power
        return sums


def heat_balance(
    elements: FiniteElements,
    conditions: Sequence[BoundaryCondition],
    temperature: FloatArray,
    reactions: FloatArray,
) -> HeatBalance:
    """Integrate every condition over its surface.

    temperature : (n_nodes,) [K]
    reactions : (n_nodes,) heat that holds the prescribed nodes at their temperature [W], zero elsewhere
    """
    held = _holders(elements, conditions)
    rows: list[HeatRow] = []
    for condition in conditions:
        match condition:
            case Film():
                rows.append(_film(elements.surfaces[condition.surface], condition, temperature))
            case Radiation():
                rows.append(_radiation(elements.surfaces[condition.surface], condition, temperature))
            case Exchange():
                rows.extend(_exchange(elements, condition, temperature))
            case PrescribedTemperature():
                surface = elements.surfaces[condition.surface]
                power = float(np.sum(reactions[surface.nodes] / held[surface.nodes]))
                rows.append(_row(surface, condition.surface, condition.kind, power, temperature))
            case SurfaceSource():
                surface = elements.surfaces[condition.surface]
                rows.append(_row(surface, condition.surface, condition.kind, condition.power, temperature))
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
            case Adiabatic():
                pass
    return HeatBalance(tuple(rows))


def _holders(elements: FiniteElements, conditions: Sequence[BoundaryCondition]) -> FloatArray:
    """(n_nodes,) number of prescribed surfaces that hold each node, at least 1."""
    count = np.zeros(len(elements.mesh.points))
    for condition in conditions:
        if isinstance(condition, PrescribedTemperature):
            count[elements.surfaces[condition.surface].nodes] += 1.0
    return np.maximum(count, 1.0)


def _row(
    surface: SurfaceElements,
    name: str,
    kind: str,
    power: float,
    temperature: FloatArray,
    coefficient: FilmCoefficient | None = None,
) -> HeatRow:
    return HeatRow(
        surface=name,
        kind=kind,
        power=power,
        area=surface.area,
        mean_temperature=surface.mean(temperature),
        piece=surface.piece,
        coefficient=coefficient,
    )


def _film(surface: SurfaceElements, film: Film, temperature: FloatArray) -> HeatRow:
    coefficient = film.law(surface.mean(temperature), film.fluid_temperature)
    power = coefficient.value * surface.integral(film.fluid_temperature - surface.at_points(temperature))
    return _row(surface, film.surface, film.kind, power, temperature, coefficient)


def _radiation(surface: SurfaceElements, radiation: Radiation, temperature: FloatArray) -> HeatRow:
    wall, room = surface.at_points(temperature), radiation.surroundings_temperature
    power = radiation.emissivity * STEFAN_BOLTZMANN * surface.integral(room**4 - wall**4)
    mean = surface.mean(temperature)
    coefficient = FilmCoefficient(
        value=radiation.emissivity * STEFAN_BOLTZMANN * (mean**2 + room**2) * (mean + room),
        formula="grey_radiation_to_surroundings",
        inputs={
            "emissivity": radiation.emissivity,
            "mean_temperature": mean,
            "surroundings_temperature": room,
        },
        valid_range="grey, diffuse surface that sees only its surroundings",
        source="Stefan-Boltzmann law, written as a coefficient at the mean temperature",
    )
    return _row(surface, radiation.surface, radiation.kind, power, temperature, coefficient)


def _exchange(elements: FiniteElements, exchange: Exchange, temperature: FloatArray) -> list[HeatRow]:
    a, b = elements.surfaces[exchange.surface_a], elements.surfaces[exchange.surface_b]
    mean_a, mean_b = a.mean(temperature), b.mean(temperature)
    coefficient = exchange.law(mean_a, mean_b)
    power = coefficient.value * a.area * (mean_b - mean_a)
    return [
        _row(a, exchange.surface_a, exchange.kind, power, temperature, coefficient),
        _row(b, exchange.surface_b, exchange.kind, -power, temperature, coefficient),
    ]
