"""Residual and Jacobian of the volumes of thermal.conditions.streams, as part of the conduction problem.

Volumes are few: their block of the Jacobian is a small dense matrix that is eliminated, so that the nodes
feel them as one rank for every film. Names in formulas: films i = 1..s on surfaces with mean temperature t_i,
volumes v = 1..m with temperature V_v.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from thermal.conditions.boundary import ConditionError
from thermal.conditions.streams import StreamNetwork, VolumeFilm, inlet_share, inlet_share_slope
from thermal.fe.elements import FiniteElements, SurfaceElements
from thermal.fe.mesh import FloatArray
from thermal.fe.solver import DIFFERENCE, Column, combined, mean_of
from thermal.films.law import FilmLaw


@dataclass(frozen=True)
class FilmState:
    """Coefficients (s,) [W/(m2 K)], film temperatures (s,) and inlet temperatures (m,) [K], transfer units."""

    coefficient: FloatArray
    film: FloatArray
    inlet: FloatArray
    share: FloatArray
    """(m,) weight of the inlet in the film temperature [-]."""
    units: FloatArray
    """(m,) N = sum h A / (m c), 0 for a stirred volume."""


@dataclass(frozen=True)
class Slopes:
    """Derivatives of film coefficients and film temperatures by surface means (., s) and volumes (., m)."""

    coefficient_by_mean: FloatArray
    coefficient_by_volume: FloatArray
    film_by_mean: FloatArray
    film_by_volume: FloatArray


class VolumeTerms:
    """All volumes of the networks of a model (checked ones)."""

    def __init__(self, elements: FiniteElements, networks: Sequence[StreamNetwork]) -> None:
        self.volumes = [volume for network in networks for volume in network.volumes]
        self.films: list[VolumeFilm] = [film for network in networks for film in network.films]
        self.index = {volume.name: v for v, volume in enumerate(self.volumes)}
        self.surfaces: list[SurfaceElements] = [elements.surfaces[film.surface] for film in self.films]
        self.of_film = np.array([self.index[film.volume] for film in self.films], dtype=np.int64)
        """(s,) volume of each film."""
        self.area = np.array([surface.area for surface in self.surfaces])
        m = len(self.volumes)
        self.power = np.array([volume.power for volume in self.volumes])
        self.capacity = np.array([volume.heat_capacity for volume in self.volumes])
        self.plug = np.array([volume.plug_flow for volume in self.volumes], dtype=np.bool_)
        self.rate = np.zeros(m)
        """(m,) sum of m c over the inflows [W/K]."""
        self.inlet_matrix = np.zeros((m, m))
        """Weights of the volumes in the inlet temperature of each volume [-]."""
        self.inlet_given = np.zeros(m)
        """What supplies add to the inlet temperatures [K]."""
        self.links = np.zeros((m, m))
        """Conductances between volumes and to supplies [W/K]."""
        self.links_given = np.zeros(m)
        """What supplies give through links [W]."""
        for network in networks:
            self._add_flows(network)
        supplied = {s.name: s.temperature for network in networks for s in network.supplies}
        self.supply_share = np.array([film.supply_share for film in self.films])
        """(s,) share of a supply in the temperature each film feels [-]."""
        self.supplied = np.array(
            [f.supply_share * supplied[f.supply] if f.supply else 0.0 for f in self.films]
        )
        """(s,) what it adds to that temperature [K]."""
        self.given = [supply.temperature for network in networks for supply in network.supplies]

    def _add_flows(self, network: StreamNetwork) -> None:
        supplies = {supply.name: supply.temperature for supply in network.supplies}
        for stream in network.streams:
            if stream.target is None:
                continue
            v, heat = self.index[stream.target], stream.mass_flow * network.specific_heat
            self.rate[v] += heat
            if stream.source in supplies:
                self.inlet_given[v] += heat * supplies[stream.source]
            else:
                self.inlet_matrix[v, self.index[stream.source]] += heat
        for volume in network.volumes:
            v = self.index[volume.name]
            if self.rate[v] > 0.0:
                self.inlet_matrix[v] /= self.rate[v]
                self.inlet_given[v] /= self.rate[v]
        for link in network.links:
            for here, there in ((link.a, link.b), (link.b, link.a)):
                if here in supplies:
                    continue
                v = self.index[here]
                self.links[v, v] += link.conductance
                if there in supplies:
                    self.links_given[v] += link.conductance * supplies[there]
                else:
                    self.links[v, self.index[there]] -= link.conductance

    def __len__(self) -> int:
        return len(self.volumes)

    @cached_property
    def member(self) -> FloatArray:
        """(m, s) 1 where a film belongs to a volume."""
        member = np.zeros((len(self.volumes), len(self.films)))
        member[self.of_film, np.arange(len(self.films))] = 1.0
        return member

    def means(self, temperature: FloatArray) -> FloatArray:
        """(s,) area means of the surfaces [K]."""
        return np.array([surface.mean(temperature) for surface in self.surfaces])

    def state(self, means: FloatArray, volumes: FloatArray) -> FilmState:
        """Films at surface means (s,) and volume temperatures (m,) [K]."""
        value = np.array(
            [_value(f, t, v) for f, t, v in zip(self.films, means, volumes[self.of_film], strict=True)]
        )
        inlet = np.where(self.rate > 0.0, self.inlet_matrix @ volumes + self.inlet_given, volumes)
        transfer = self.member @ (value * self.area)
        units = np.where(self.plug, transfer / np.where(self.plug, self.rate, 1.0), 0.0)
        share = np.array([inlet_share(n) if p else 0.0 for n, p in zip(units, self.plug, strict=True)])
        film = (share * inlet + (1.0 - share) * volumes)[self.of_film]
        film = (1.0 - self.supply_share) * film + self.supplied
        return FilmState(value, film, inlet, share, units)

    def heat_out(self, temperature: FloatArray, volumes: FloatArray) -> tuple[FloatArray, FloatArray, float]:
        """Heat that leaves the nodes (n_nodes,) and the volumes (m,), and the sum of the flows' sizes [W]."""
        means = self.means(temperature)
        state = self.state(means, volumes)
        nodes = np.zeros(len(temperature))
        for surface, h, film in zip(self.surfaces, state.coefficient, state.film, strict=True):
            nodes += h * surface.load(surface.at_points(temperature) - film)
        given = state.coefficient * self.area * (state.film - means)
        carried = self.rate * (volumes - state.inlet)
        linked = self.links @ volumes - self.links_given
        out = self.member @ given + carried + linked - self.power
        turned = 2.0 * np.abs(given).sum() + sum(np.abs(part).sum() for part in (carried, linked, self.power))
        return nodes, out, float(turned)

    def slopes(self, means: FloatArray, volumes: FloatArray, state: FilmState) -> Slopes:
        """Derivatives at a state."""
        s, m = len(self.films), len(self.volumes)
        by_mean, by_volume = np.zeros((s, s)), np.zeros((s, m))
        for i, (film, t, v) in enumerate(zip(self.films, means, volumes[self.of_film], strict=True)):
            for target, column, dt, dv in (
                (by_mean, i, DIFFERENCE, 0.0),
                (by_volume, int(self.of_film[i]), 0.0, DIFFERENCE),
            ):
                rise = _value(film, t + dt, v + dv) - _value(film, t - dt, v - dv)
                target[i, column] = rise / (2.0 * DIFFERENCE)
        slope = np.array([inlet_share_slope(n) if p else 0.0 for n, p in zip(state.units, self.plug)])
        per_unit = slope * (state.inlet - volumes) / np.where(self.plug, self.rate, 1.0)
        heated = per_unit[:, None] * (self.member * self.area)
        local = state.share[:, None] * self.inlet_matrix + np.diag(1.0 - state.share)
        unsupplied = (1.0 - self.supply_share)[:, None]
        return Slopes(
            by_mean,
            by_volume,
            unsupplied * (heated @ by_mean)[self.of_film],
            unsupplied * (heated @ by_volume + local)[self.of_film],
        )

    def volume_block(
        self, state: FilmState, slopes: Slopes, means: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Derivatives of the heat that leaves the volumes by surface means (m, s) and volumes (m, m) [W/K]."""
        excess = (self.area * (state.film - means))[:, None]
        weight = (self.area * state.coefficient)[:, None]
        by_mean = self.member @ (excess * slopes.coefficient_by_mean + weight * slopes.film_by_mean)
        by_mean -= self.member * weight[:, 0]
        by_volume = self.member @ (excess * slopes.coefficient_by_volume + weight * slopes.film_by_volume)
        carried = self.rate[:, None] * (np.eye(len(self.volumes)) - self.inlet_matrix)
        return by_mean, by_volume + carried + self.links

    def node_columns(self, temperature: FloatArray, state: FilmState) -> list[Column]:
        """2 s columns: load of T - T_film on each film's surface, then minus h times its shares."""
        excess = []
        for surface, film in zip(self.surfaces, state.film, strict=True):
            load = surface.load(surface.at_points(temperature) - film)
            excess.append((surface.nodes, load[surface.nodes]))
        shares = [
            (surface.nodes, -h * surface.shares[surface.nodes])
            for surface, h in zip(self.surfaces, state.coefficient, strict=True)
        ]
        return excess + shares


@dataclass(frozen=True)
class Elimination:
    """Volumes taken out of one Newton step."""

    columns: list[tuple[Column, Column]]
    """What the volumes add to the Jacobian of the nodes: left and right columns."""
    right_columns: list[Column]
    left_columns: list[Column]
    by_mean: FloatArray
    """(m, s)"""
    by_volume: FloatArray
    """(m, m), capacities included"""
    node_by_volume: FloatArray
    """(2 s, m) weights of the node columns"""

    def node_load(self, residual: FloatArray) -> Column:
        """What the residual (m,) of the volumes adds to the residual of the nodes."""
        weights = -self.node_by_volume @ np.linalg.solve(self.by_volume, residual)
        return combined(list(zip(weights.tolist(), self.left_columns, strict=True)))

    def volume_step(self, residual: FloatArray, step: FloatArray) -> FloatArray:
        """(m,) step of the volumes [K] that belongs to the step (n_nodes,) of the nodes."""
        means = np.array([values @ step[nodes] for nodes, values in self.right_columns])
        return np.asarray(np.linalg.solve(self.by_volume, -residual - self.by_mean @ means))


def eliminate(
    terms: VolumeTerms, temperature: FloatArray, volumes: FloatArray, storage: FloatArray
) -> Elimination:
    """Linearise around a state and take the volumes out; storage : (m,) heat capacity over time step [W/K]."""
    means = terms.means(temperature)
    state = terms.state(means, volumes)
    slopes = terms.slopes(means, volumes, state)
    by_mean, by_volume = terms.volume_block(state, slopes, means)
    by_volume = by_volume + np.diag(storage)
    node_by_mean = np.vstack([slopes.coefficient_by_mean, slopes.film_by_mean])
    node_by_volume = np.vstack([slopes.coefficient_by_volume, slopes.film_by_volume])
    weights = node_by_mean - node_by_volume @ np.linalg.solve(by_volume, by_mean)
    left = terms.node_columns(temperature, state)
    right = [mean_of(surface) for surface in terms.surfaces]
    columns = [
        (combined([(float(w), c) for w, c in zip(weights[:, i], left, strict=True) if w != 0.0]), right[i])
        for i in range(len(right))
    ]
    return Elimination(columns, right, left, by_mean, by_volume, node_by_volume)


def _value(film: VolumeFilm, wall: float, fluid: float) -> float:
    law: FilmLaw = film.law
    return checked_value(law(float(wall), float(fluid)).value, film.surface, film.kind)


# What a law of a film, an exchange or a contact must give.


def checked_value(value: float, surface: str, kind: str) -> float:
    """The coefficient [W/(m2 K)] if it is a number of at least zero, else ConditionError."""
    if not (math.isfinite(value) and value >= 0.0):
        raise ConditionError(
            f"{surface}: coefficient of {kind!r} is {value} W/(m2 K); a film law must give a number >= 0"
        )
    return value
