"""Residual and Jacobian of films, radiation to surroundings and exchange between area means.

A film's coefficient follows the area mean of its own surface, an exchange the means of both: each adds one
rank to the Jacobian in addition to the local slope of the heat flux.
"""

from collections.abc import Sequence

import numpy as np

from thermal.conditions.boundary import Exchange, Film, Radiation
from thermal.conduction.law_values import checked_value
from thermal.fe.elements import FiniteElements, SurfaceElements
from thermal.fe.low_rank import DIFFERENCE, Column, combined, mean_of
from thermal.fe.mesh import FloatArray
from thermal.films.law import STEFAN_BOLTZMANN


class SurfaceTerms:
    """All conditions of these three kinds."""

    def __init__(
        self,
        elements: FiniteElements,
        films: Sequence[Film],
        radiations: Sequence[Radiation],
        exchanges: Sequence[Exchange],
    ) -> None:
        self._surfaces = elements.surfaces
        self.films, self.radiations, self.exchanges = films, radiations, exchanges

    def heat_out(self, temperature: FloatArray) -> tuple[FloatArray, float]:
        """Heat (n_nodes,) that leaves every node; sum of the flows' sizes [W]."""
        out = np.zeros(len(temperature))
        turned = 0.0
        for film in self.films:
            surface = self._surfaces[film.surface]
            mean = surface.mean(temperature)
            value = _film_value(film, mean)
            out += value * surface.load(surface.at_points(temperature) - film.fluid_temperature)
            turned += value * surface.area * abs(mean - film.fluid_temperature)
        for radiation in self.radiations:
            surface = self._surfaces[radiation.surface]
            excess = surface.at_points(temperature) ** 4 - radiation.surroundings_temperature**4
            part = radiation.emissivity * STEFAN_BOLTZMANN * surface.load(excess)
            out += part
            turned += abs(float(part.sum()))
        for exchange in self.exchanges:
            a, b, mean_a, mean_b = self._sides(exchange, temperature)
            into_a = _exchange_value(exchange, mean_a, mean_b) * a.area * (mean_b - mean_a)
            out += into_a * (b.shares / b.area - a.shares / a.area)
            turned += 2.0 * abs(into_a)
        return out, turned

    def slopes(self, temperature: FloatArray) -> dict[str, FloatArray]:
        """Surface -> (n_f, n_q) slope of the local heat flux [W/(m2 K)]: films and 4 eps sigma T^3."""
        slopes: dict[str, FloatArray] = {}
        for film in self.films:
            surface = self._surfaces[film.surface]
            value = np.full_like(surface.weights, _film_value(film, surface.mean(temperature)))
            slopes[film.surface] = slopes.get(film.surface, 0.0) + value
        for radiation in self.radiations:
            wall = self._surfaces[radiation.surface].at_points(temperature)
            value = 4.0 * radiation.emissivity * STEFAN_BOLTZMANN * wall**3
            slopes[radiation.surface] = slopes.get(radiation.surface, 0.0) + value
        return slopes

    def columns(self, temperature: FloatArray) -> list[tuple[Column, Column]]:
        """Left and right columns of what comes from mean temperatures."""
        columns: list[tuple[Column, Column]] = []
        for film in self.films:
            surface = self._surfaces[film.surface]
            mean = surface.mean(temperature)
            slope = _film_value(film, mean + DIFFERENCE) - _film_value(film, mean - DIFFERENCE)
            if slope != 0.0:
                excess = surface.load(surface.at_points(temperature) - film.fluid_temperature)
                left = (surface.nodes, slope / (2.0 * DIFFERENCE) * excess[surface.nodes])
                columns.append((left, mean_of(surface)))
        for exchange in self.exchanges:
            a, b, mean_a, mean_b = self._sides(exchange, temperature)
            by_a, by_b = _exchange_slopes(exchange, mean_a, mean_b)
            left = combined([(1.0, mean_of(b)), (-1.0, mean_of(a))])
            columns.append((left, combined([(a.area * by_b, mean_of(b)), (a.area * by_a, mean_of(a))])))
        return columns

    def links(self, temperature: FloatArray) -> dict[tuple[str, str], float]:
        """Pairs of surfaces that exchange heat -> coefficient [W/(m2 K)], zeros left out."""
        values = {
            (e.surface_a, e.surface_b): _exchange_value(e, *self._sides(e, temperature)[2:])
            for e in self.exchanges
        }
        return {pair: value for pair, value in values.items() if value > 0.0}

    def _sides(
        self, exchange: Exchange, temperature: FloatArray
    ) -> tuple[SurfaceElements, SurfaceElements, float, float]:
        """Both surfaces of an exchange and their mean temperatures [K]."""
        a, b = self._surfaces[exchange.surface_a], self._surfaces[exchange.surface_b]
        return a, b, a.mean(temperature), b.mean(temperature)


def _film_value(film: Film, mean: float) -> float:
    return checked_value(film.law(mean, film.fluid_temperature).value, film.surface, film.kind)


def _exchange_value(exchange: Exchange, mean_a: float, mean_b: float) -> float:
    return checked_value(exchange.law(mean_a, mean_b).value, exchange.surface_a, exchange.kind)


def _exchange_slopes(exchange: Exchange, mean_a: float, mean_b: float) -> tuple[float, float]:
    """Slopes of the heat flux h (Tb - Ta) by both mean temperatures [W/(m2 K)]."""
    value = _exchange_value(exchange, mean_a, mean_b)
    slopes = []
    for da, db in ((DIFFERENCE, 0.0), (0.0, DIFFERENCE)):
        above = _exchange_value(exchange, mean_a + da, mean_b + db)
        below = _exchange_value(exchange, mean_a - da, mean_b - db)
        slopes.append((above - below) / (2.0 * DIFFERENCE) * (mean_b - mean_a))
    return slopes[0] - value, slopes[1] + value
