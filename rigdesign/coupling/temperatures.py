"""Steady temperature fields of the housings at one operating point, and the heat they give to the oil."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.coupling.bearing_seats import bearing_seats
from rigdesign.coupling.boundary import CHAMBER_RADIATION, boundary_conditions
from rigdesign.coupling.housing_context import AIR, BEARING_FILM, BEARING_OIL, GEAR_OIL
from rigdesign.coupling.placed_loss import STORED, PointLosses
from rigdesign.rig.model import Rig
from thermal.conduction.condition_checks import Condition
from thermal.conduction.steady import TemperatureSolution, solve_steady

TOLERANCE = 1e-9
"""Heat left over at the nodes, relative to the heat turned over, at which a field is solved."""


@dataclass(frozen=True)
class HousingField:
    """Temperatures of one housing with the conditions they answer to."""

    gearbox: str
    conditions: tuple[Condition, ...]
    solution: TemperatureSolution

    @property
    def temperature(self) -> NDArray[np.float64]:
        """(n_nodes,) [K]"""
        return self.solution.temperature


def solve_housing(
    rig: Rig,
    name: str,
    losses: PointLosses,
    start: HousingField | None = None,
    *,
    radiation_included: bool | None = None,
    tolerance: float = TOLERANCE,
) -> HousingField:
    """Temperature field of the housing of gearbox ``name``.

    start : field of an earlier iteration, a good first guess
    radiation_included : reading of the film to room air; that of the case when left out
    tolerance : of the heat left over, relative to the heat turned over

    Raises
    ------
    ConditionError
        Conditions that cannot be computed.
    NotConverged
        Newton's method stalls.
    """
    housing = rig.case.gearboxes[name].housing
    assert housing is not None
    included = housing.radiation_included if radiation_included is None else radiation_included
    conditions = boundary_conditions(rig, name, losses, radiation_included=included)
    setup = rig.conduction[name]
    solution = solve_steady(
        setup, conditions, near=None if start is None else start.solution, tolerance=tolerance
    )
    return HousingField(gearbox=name, conditions=tuple(conditions), solution=solution)


def heat_into_oil(field: HousingField) -> dict[str, float]:
    """Heat solids and linked volumes give to each oil stream of the gearbox [W], bearing films left out."""
    return {
        f"{field.gearbox}.{kind}": -math.fsum(
            row.power
            for row in field.solution.balance.rows
            if row.kind == kind and row.surface != GEAR_OIL  # the sump itself, where it is an unknown
        )
        for kind in (GEAR_OIL, BEARING_OIL)
    }


def sump_temperatures(rig: Rig, fields: Mapping[str, HousingField]) -> dict[str, float]:
    """Gearbox -> temperature of its sump [K]: the held one, or that of the temperature field it belongs to."""
    return {
        name: box.gear_oil_temperature or fields[name].solution.volumes[GEAR_OIL]
        for name, box in rig.case.gearboxes.items()
        if box.jets is None
    }


def heat_into_films(field: HousingField) -> dict[str, float]:
    """Heat that journal and bore give to each bearing film [W], by ``gearbox.bearing``."""
    heat: dict[str, float] = {}
    for row in field.solution.balance.rows:
        kind, _, part = row.kind.partition(":")
        if kind == BEARING_FILM and row.area > 0.0:  # of an unfed bearing the sump has a row as well
            name = f"{field.gearbox}.{part}"
            heat[name] = heat.get(name, 0.0) - row.power
    return heat


def heat_to_room(field: HousingField) -> float:
    """Heat to room air, to walls of the room and through openings of chambers that radiate [W]."""
    kinds = AIR, "radiation", CHAMBER_RADIATION
    return -math.fsum(row.power for row in field.solution.balance.rows if row.kind in kinds)


def heat_stored(field: HousingField) -> float:
    """Heat that bodies which are not steady yet take up [W]."""
    return -math.fsum(row.power for row in field.solution.balance.rows if row.kind == STORED)


def body_mean(rig: Rig, field: HousingField, body: str) -> float:
    """Volume mean temperature of a body [K]."""
    return rig.conduction[field.gearbox].elements.body_mean(field.temperature, body)


def seat_temperatures(rig: Rig, fields: Mapping[str, HousingField]) -> dict[str, float]:
    """Mean temperature of every seat that takes heat of a bearing [K], by ``gearbox.bearing.seat``."""
    return {
        key: value
        for name, field in fields.items()
        for key, value in seat_means(rig, name, field.temperature).items()
    }


def seat_means(rig: Rig, name: str, temperature: NDArray[np.float64]) -> dict[str, float]:
    """Of one housing; temperature : (n_nodes,) [K]."""
    surfaces = rig.conduction[name].elements.surfaces
    return {
        f"{name}.{part}.{seat}": surfaces[found.surface].mean(temperature)
        for part in rig.case.gearboxes[name].bearings
        for seat, found in bearing_seats(rig, f"{name}.{part}").items()
    }
