"""The housings of a rig in the reduced thermal model: parts of an iteration that take the place of the full ones."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from rigdesign.coupling.boundary import boundary_conditions
from rigdesign.coupling.expansion import HousingExpansion
from rigdesign.coupling.iteration import IterationParts
from rigdesign.coupling.point_losses import PointLosses
from rigdesign.coupling.temperatures import HousingField
from rigdesign.prediction.expansion_map import ExpansionMap
from rigdesign.prediction.places import Weights
from rigdesign.prediction.reduced_basis import Basis, build_basis
from rigdesign.rig.model import Rig
from thermal.conduction.condition_checks import Condition
from thermal.conduction.reduced import Factor, ReducedConduction
from thermal.conduction.steady import TemperatureSolution
from thermal.fe.mesh import FloatArray

HousingNumbers = tuple[FloatArray, FloatArray, float, ExpansionMap | None, FloatArray]
"""Basis vectors, their sizes, error, thermal expansion and start of a housing, for another process."""


@dataclass(frozen=True)
class ReducedField(HousingField):
    """A projected field with its coefficients."""

    coefficients: FloatArray
    factor: Factor
    """Of the Jacobian it was found with."""


class ReducedHousings:
    """Reduced basis and thermal expansion of every housing of a rig; valid for every case with these housings.

    states : by gearbox, conditions of some operating points among which those wanted lie
    readers : by gearbox, sensors at points
    """

    def __init__(
        self,
        rig: Rig,
        states: Mapping[str, Sequence[Sequence[Condition]]],
        readers: Mapping[str, Sequence[Weights]],
    ) -> None:
        self.bases: dict[str, Basis] = {}
        self.expansions: dict[str, ExpansionMap] = {}
        self._start: dict[str, FloatArray] = {}
        for name, conditions in states.items():
            basis = build_basis(rig.conduction[name], conditions, readers.get(name, ()))
            start = np.zeros(basis.reduced.size)
            start[0] = rig.case.ambient.temperature + 30.0
            start = basis.reduced.solve(conditions[0], start).coefficients
            self.bases[name], self._start[name] = basis, start
            if not rig.models[name].no_expansion:
                self.expansions[name] = ExpansionMap(rig, name, basis.reduced.shapes, basis.sizes, start)

    def numbers(self) -> dict[str, HousingNumbers]:
        """Basis vectors, their sizes, error, thermal expansion and start by gearbox: what another process needs."""
        return {
            name: (
                basis.reduced.shapes,
                basis.sizes,
                basis.error,
                self.expansions.get(name),
                self._start[name],
            )
            for name, basis in self.bases.items()
        }

    @classmethod
    def of_numbers(
        cls,
        rig: Rig,
        numbers: Mapping[str, HousingNumbers],
    ) -> "ReducedHousings":
        """The housings of the same rig from their numbers."""
        made = cls(rig, {}, {})
        for name, (vectors, sizes, error, expansion, start) in numbers.items():
            made.bases[name] = Basis(ReducedConduction(rig.conduction[name], vectors), sizes, error)
            made._start[name] = start
            if expansion is not None:
                made.expansions[name] = expansion
        return made

    @property
    def error(self) -> float:
        """Stated error of a temperature against the full model [K]."""
        return max((basis.error for basis in self.bases.values()), default=0.0)

    def field(
        self,
        rig: Rig,
        name: str,
        losses: PointLosses,
        start: HousingField | None = None,
        **_: Any,
    ) -> ReducedField:
        """Field of a housing as `rigdesign.coupling.temperatures.solve_housing` gives it, projected."""
        housing = rig.case.gearboxes[name].housing
        assert housing is not None
        conditions = tuple(
            boundary_conditions(rig, name, losses, radiation_included=housing.radiation_included)
        )
        return self.solved(name, conditions, start if isinstance(start, ReducedField) else None)

    def solved(
        self, name: str, conditions: tuple[Condition, ...], near: ReducedField | None = None
    ) -> ReducedField:
        """Field of a housing under conditions."""
        reduced = self.bases[name].reduced
        if near is None:
            found = reduced.solve(conditions, self._start[name])
        else:
            found = reduced.solve(conditions, near.coefficients, near.factor)
        solution = TemperatureSolution(
            temperature=reduced.field(found.coefficients),
            balance=found.balance,
            residuals=(),
            linear_iterations=(),
            warnings=(),
            volumes={},
            preconditioner=None,
        )
        return ReducedField(name, conditions, solution, found.coefficients, found.factor)

    def expansion(
        self, _: Rig, field: HousingField, start: HousingExpansion | None = None
    ) -> HousingExpansion:
        """Thermal expansion of a projected field; ``start`` is not needed."""
        assert isinstance(field, ReducedField)
        return self.expansions[field.gearbox].at(field.coefficients)

    def bulk(self, _: Rig, field: HousingField, body: str) -> float:
        """Volume mean of a body [K]."""
        assert isinstance(field, ReducedField)
        return float(self.bases[field.gearbox].reduced.body(body) @ field.coefficients)

    def parts(self, others: IterationParts) -> IterationParts:
        """Parts of an iteration with the fields and thermal expansion of these housings."""
        return replace(others, field=self.field, expansion=self.expansion, bulk=self.bulk)
