"""Grey diffuse radiation between named surfaces that see each other.

Each surface has one radiosity J and one irradiation G, its emission follows the local temperature:

    J_i = e_i sigma <T^4>_i + (1 - e_i) G_i,   G_i = sum_j F_ij J_j + F_i,opening sigma T_opening^4,
    q_i = e_i (sigma T^4 - G_i) away from surface i, with <> the area mean.

View factors are made exactly reciprocal and complete, so that what the surfaces give off adds up to what
leaves through the opening. Source: Siegel, Howell, Thermal Radiation Heat Transfer, 4th ed., ch. 7.
"""

from dataclasses import dataclass

import numpy as np

from thermal.conditions.boundary import ConditionError
from thermal.conditions.view_factor_closure import close_view_factors
from thermal.fe.arrays import FloatArray
from thermal.fe.elements import FiniteElements, SurfaceElements
from thermal.fe.solver import Column, combined
from thermal.films.law import STEFAN_BOLTZMANN


@dataclass(frozen=True, kw_only=True)
class Enclosure:
    """Surfaces that radiate at each other, and at an opening if there is one."""

    name: str
    surfaces: tuple[str, ...]
    emissivities: tuple[float, ...]
    """One per surface, 0 to 1 [-]; 0 re-radiates what arrives and keeps no heat, one at least is above it."""
    view_factors: tuple[tuple[float, ...], ...]
    """Row i: share of the radiation of surface i that reaches each surface; given, or from ray_view_factors()."""
    opening_temperature: float | None = None
    """Surroundings that take what the rows leave to one [K]; None for a closed enclosure."""
    kind: str = "enclosure"
    """Row name in the heat balance."""


def check_enclosure(enclosure: Enclosure) -> None:
    """Check names and numbers of an enclosure (ConditionError); surfaces are checked with the others."""
    place = f"enclosure {enclosure.name!r}"
    if len(set(enclosure.surfaces)) != len(enclosure.surfaces) or not enclosure.surfaces:
        raise ConditionError(f"{place}: needs at least one surface, each listed once")
    if len(enclosure.emissivities) != len(enclosure.surfaces):
        raise ConditionError(
            f"{place}: {len(enclosure.emissivities)} emissivities for {len(enclosure.surfaces)} surfaces"
        )
    for name, value in zip(enclosure.surfaces, enclosure.emissivities, strict=True):
        if not 0.0 <= value <= 1.0:
            raise ConditionError(f"{place}, {name}: emissivity = {value:g} is outside of 0 to 1")
    if not any(enclosure.emissivities):
        raise ConditionError(f"{place}: every emissivity is 0, nothing radiates; give one above 0")
    room = enclosure.opening_temperature
    if room is not None and not (np.isfinite(room) and room > 0.0):
        raise ConditionError(f"{place}: opening_temperature = {room:g} K must be above 0 K; give kelvin")


class EnclosureTerms:
    """Residual and Jacobian of one enclosure."""

    def __init__(self, elements: FiniteElements, enclosure: Enclosure) -> None:
        self.enclosure = enclosure
        self.surfaces: list[SurfaceElements] = [elements.surfaces[name] for name in enclosure.surfaces]
        self.area = np.array([surface.area for surface in self.surfaces])
        self.emissivity = np.array(enclosure.emissivities)
        room = enclosure.opening_temperature
        self.factors = close_view_factors(
            np.array(enclosure.view_factors), self.area, enclosure.surfaces, room is not None
        )
        """(n, n) closed view factors."""
        self.opening = 1.0 - self.factors.sum(axis=1) if room is not None else np.zeros(len(self.area))
        """(n,) view factor to the opening."""
        self.opening_emission = 0.0 if room is None else STEFAN_BOLTZMANN * room**4
        reflected = np.eye(len(self.area)) - (1.0 - self.emissivity)[:, None] * self.factors
        solved = np.linalg.solve(
            reflected,
            np.column_stack([np.diag(self.emissivity), (1.0 - self.emissivity) * self.opening]),
        )
        arriving = self.factors @ solved
        self.transfer = arriving[:, :-1]
        """(n, n) irradiation of each surface per emission sigma <T^4> of each [-]."""
        self.from_opening = arriving[:, -1] + self.opening
        """(n,) irradiation of each surface per emission of the opening [-]."""

    @property
    def grounded(self) -> list[str]:
        """Surfaces that the opening reaches."""
        seen = zip(self.enclosure.surfaces, self.from_opening, strict=True)
        return [
            name for name, share in seen if self.enclosure.opening_temperature is not None and share > 1e-12
        ]

    @property
    def links(self) -> list[tuple[str, str]]:
        """Pairs of surfaces that exchange heat."""
        names = self.enclosure.surfaces
        pairs = np.argwhere(self.transfer > 1e-12)
        return [(names[i], names[j]) for i, j in pairs if i != j]

    def irradiation(self, temperature: FloatArray) -> FloatArray:
        """(n,) G [W/m2]"""
        fourth = [s.integral(s.at_points(temperature) ** 4) / s.area for s in self.surfaces]
        emission = STEFAN_BOLTZMANN * np.array(fourth)
        return np.asarray(self.transfer @ emission + self.from_opening * self.opening_emission)

    def heat_out(self, temperature: FloatArray) -> tuple[FloatArray, float]:
        """Heat (n_nodes,) that leaves every node; sum of the surfaces' net heats, all taken positive [W]."""
        out = np.zeros(len(temperature))
        turned = 0.0
        arriving = self.irradiation(temperature)
        for surface, e, g in zip(self.surfaces, self.emissivity, arriving, strict=True):
            part = e * surface.load(STEFAN_BOLTZMANN * surface.at_points(temperature) ** 4 - g)
            out += part
            turned += abs(float(part.sum()))
        return out, turned

    def slopes(self, temperature: FloatArray) -> dict[str, FloatArray]:
        """Surface -> (n_f, n_q) local slope 4 e sigma T^3 [W/(m2 K)]."""
        parts = zip(self.enclosure.surfaces, self.surfaces, self.emissivity, strict=True)
        return {
            name: 4.0 * e * STEFAN_BOLTZMANN * surface.at_points(temperature) ** 3
            for name, surface, e in parts
        }

    def columns(self, temperature: FloatArray) -> list[tuple[Column, Column]]:
        """What the irradiation adds to the Jacobian: one rank a surface."""
        emitted = []
        for surface in self.surfaces:
            load = surface.load(4.0 * STEFAN_BOLTZMANN * surface.at_points(temperature) ** 3)
            emitted.append((surface.nodes, load[surface.nodes] / surface.area))
        pairs = []
        for i, (surface, e) in enumerate(zip(self.surfaces, self.emissivity, strict=True)):
            left = (surface.nodes, -float(e) * surface.shares[surface.nodes])
            pairs.append((left, combined(list(zip(self.transfer[i].tolist(), emitted, strict=True)))))
        return pairs
