"""Thermal expansion of a housing as a linear map of its reduced basis: clearances without an elastic solve.

Expansion is linear in the temperature and the clearances are read from displacements a thousand times smaller than
the rig, so that a clearance follows each basis vector in proportion to nanometres. Each is expanded once.
"""

from dataclasses import replace
from functools import partial

import numpy as np

from rigdesign.coupling.expansion import HousingExpansion, named_expansion
from rigdesign.prediction.parallel_fields import fields_in_parallel
from rigdesign.rig.model import Rig
from thermal.expansion.expansion import read_expansion
from thermal.fe.mesh import FloatArray

AMPLITUDE = 10.0
"""Temperature [K] with which a basis vector is expanded."""
EXACT = 1e-8
"""Relative residual of the expansion of the field the map starts from."""
ENOUGH = 1e-3
"""Relative residual of the expansion of a basis vector that reaches 1 K: ten nanometres of a clearance."""
LEAST = 0.1
"""Temperature [K] a basis vector has to reach to be expanded: 0.1 K moves a clearance by a tenth of a micrometre."""


class ExpansionMap:
    """Clearances of one housing by the coefficients of its reduced basis.

    basis : (n_nodes, m); sizes : (m,) temperature [K] that each reaches, strongest first; base : (m,)
        coefficients of a warm field near which the map is made
    """

    def __init__(self, rig: Rig, name: str, basis: FloatArray, sizes: FloatArray, base: FloatArray) -> None:
        setup, reference = rig.expansion[name], rig.case.ambient.reference_temperature
        self._base = base
        field = basis @ base
        start = setup.elastic.solve(field, reference, EXACT).values

        def read(temperature: FloatArray, supported: FloatArray) -> HousingExpansion:
            return named_expansion(rig, name, read_expansion(setup, temperature, reference, supported))

        self.expansion = read(field, start)
        """At the base."""
        first = numbers_of(self.expansion)

        def derivative(vector: FloatArray, size: float) -> FloatArray:
            if size < LEAST:
                return np.zeros_like(first)
            bent = setup.elastic.solve(AMPLITUDE * vector, 0.0, min(1e-2, ENOUGH / size)).values
            moved = read(field + AMPLITUDE * vector, start + bent)
            return np.asarray((numbers_of(moved) - first) / AMPLITUDE)

        works = [partial(derivative, vector, size) for vector, size in zip(basis.T, sizes.tolist())]
        self.first, self.derivative = first, np.array(fields_in_parallel(len(field), works)).T
        """Numbers of the thermal expansion at the base, and (k, m) how they follow the coefficients [m/K]."""

    def at(self, coefficients: FloatArray) -> HousingExpansion:
        """Thermal expansion of the field with these coefficients (m,)."""
        return with_numbers(self.expansion, self.first + self.derivative @ (coefficients - self._base))


def numbers_of(expansion: HousingExpansion) -> FloatArray:
    """Bores and journals, seal gaps, centre distances, axial travels, in this order [m]."""
    shape = expansion.deformed
    parts = [np.array([(b.bore_expansion, b.journal_expansion) for b in shape.bearings.values()]).ravel()]
    parts += [seal.gaps.ravel() for seal in shape.seals.values()]
    parts.append(np.array([*expansion.centre_distance.values(), *expansion.axial_expansion.values()]))
    return np.concatenate(parts)


def with_numbers(expansion: HousingExpansion, numbers: FloatArray) -> HousingExpansion:
    """The thermal expansion with other numbers; displacements and what else depends on them stay those of the base."""
    remaining = numbers

    def take(count: int) -> FloatArray:
        nonlocal remaining
        taken, remaining = remaining[:count], remaining[count:]
        return taken

    bearings = {}
    for name, bearing in expansion.deformed.bearings.items():
        bore, journal = map(float, take(2))
        bearings[name] = replace(bearing, bore_expansion=bore, journal_expansion=journal)
    seals = {
        name: replace(seal, gaps=take(seal.gaps.size).reshape(seal.gaps.shape))
        for name, seal in expansion.deformed.seals.items()
    }
    distance = dict(zip(expansion.centre_distance, map(float, take(len(expansion.centre_distance)))))
    travel = dict(zip(expansion.axial_expansion, map(float, take(len(expansion.axial_expansion)))))
    return replace(
        expansion,
        deformed=replace(expansion.deformed, bearings=bearings, seals=seals),
        centre_distance=distance,
        axial_expansion=travel,
    )
