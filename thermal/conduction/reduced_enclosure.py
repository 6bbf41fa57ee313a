"""Radiation between the surfaces of a chamber, projected on temperature shapes."""

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from thermal.conditions.enclosure import EnclosureTerms
from thermal.fe.mesh import FloatArray
from thermal.films.law import STEFAN_BOLTZMANN


class ShapesOnSurface(Protocol):
    """m shapes on a surface: values at its points (n, m), weights (n,) [m2], integrals (m,), area [m2]."""

    points: FloatArray
    weights: FloatArray
    load: FloatArray
    area: float


class ReducedEnclosure:
    """Heat of one enclosure by the coefficients of the shapes on its surfaces."""

    def __init__(self, terms: EnclosureTerms, surfaces: Sequence[ShapesOnSurface]) -> None:
        self.terms, self.surfaces = terms, tuple(surfaces)

    def heat_out(self, a: FloatArray) -> FloatArray:
        """(m,) heat that leaves with each shape [W]."""
        heat = np.zeros(len(a))
        for surface, e, arriving in zip(
            self.surfaces, self.terms.emissivity, self._irradiation(a), strict=True
        ):
            emitted = STEFAN_BOLTZMANN * (surface.points @ a) ** 4
            heat += e * ((surface.weights * emitted) @ surface.points - arriving * surface.load)
        return heat

    def slope(self, a: FloatArray) -> FloatArray:
        """(m, m) slope of `heat_out`."""
        jacobian = np.zeros((len(a), len(a)))
        emitted = []
        for surface, e in zip(self.surfaces, self.terms.emissivity, strict=True):
            local = 4.0 * STEFAN_BOLTZMANN * surface.weights * (surface.points @ a) ** 3
            jacobian += e * surface.points.T @ (local[:, None] * surface.points)
            emitted.append(local @ surface.points / surface.area)
        arriving = self.terms.transfer @ np.array(emitted)
        for surface, e, row in zip(self.surfaces, self.terms.emissivity, arriving, strict=True):
            jacobian -= e * np.outer(surface.load, row)
        return jacobian

    def powers(self, a: FloatArray) -> FloatArray:
        """(n,) heat into each surface [W]."""
        emitted = [
            STEFAN_BOLTZMANN * float(surface.weights @ (surface.points @ a) ** 4) for surface in self.surfaces
        ]
        area = np.array([surface.area for surface in self.surfaces])
        return np.asarray(self.terms.emissivity * (self._irradiation(a) * area - np.array(emitted)))

    def _irradiation(self, a: FloatArray) -> FloatArray:
        """(n,) [W/m2]"""
        emission = [
            STEFAN_BOLTZMANN * float(surface.weights @ (surface.points @ a) ** 4) / surface.area
            for surface in self.surfaces
        ]
        terms = self.terms
        return np.asarray(terms.transfer @ np.array(emission) + terms.from_opening * terms.opening_emission)
