"""Boundary conditions held against a mesh: names, values, open surfaces, bodies that cannot lose heat."""

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from difflib import get_close_matches

import numpy as np
from scipy import sparse

from thermal.boundary import (
    Adiabatic,
    BodySource,
    BoundaryCondition,
    Exchange,
    Film,
    PrescribedTemperature,
    Radiation,
    SurfaceSource,
)
from thermal.fe.elements import FiniteElements


class ConditionError(ValueError):
    """A boundary condition that cannot be computed; the message names place, value, limit and remedy."""


def surfaces_of(condition: BoundaryCondition) -> tuple[str, ...]:
    """Surfaces a condition acts on: one, two for an exchange, none for a body source."""
    if isinstance(condition, BodySource):
        return ()
    if isinstance(condition, Exchange):
        return (condition.surface_a, condition.surface_b)
    return (condition.surface,)


def check_conditions(elements: FiniteElements, conditions: Sequence[BoundaryCondition]) -> None:
    """Check ``conditions`` against the mesh.

    Raises ConditionError for unknown names (nearest ones offered), impossible values, surfaces without any
    condition, contradicting or repeated conditions, prescribed surfaces that meet at different temperatures.
    """
    mesh = elements.mesh
    for condition in conditions:
        for name in surfaces_of(condition):
            _require_known("surface", name, mesh.surfaces)
        if isinstance(condition, BodySource):
            _require_known("body", condition.body, mesh.bodies)
        _check_values(condition)
    _check_combinations(conditions)
    _check_open(elements, conditions)
    _check_prescribed(elements, conditions)


def check_conductivity(bodies: Collection[str], conductivity: Mapping[str, float]) -> None:
    """Check that every body has a positive conductivity [W/(m K)] and no other is named (ConditionError)."""
    for name in conductivity:
        _require_known("body", name, bodies)
    missing = sorted(set(bodies) - set(conductivity))
    if missing:
        raise ConditionError(f"no conductivity for body {', '.join(missing)}; give one for every body")
    for name, value in conductivity.items():
        if not (math.isfinite(value) and value > 0.0):
            raise ConditionError(f"conductivity of body {name!r} is {value} W/(m K); it must be positive")


def check_heat_paths(
    elements: FiniteElements, grounded: Collection[str], links: Sequence[tuple[str, str]]
) -> frozenset[int]:
    """Check that every body can give its heat away; return the pieces that can do so by exchange only.

    grounded : surfaces with a positive film, radiation or a prescribed temperature
    links : pairs of surfaces with a positive exchange
    Raises ConditionError naming the bodies whose temperature nothing determines.
    """
    mesh = elements.mesh
    piece = {name: surface.piece for name, surface in elements.surfaces.items()}
    n = int(elements.components.max()) + 1
    pairs = [(piece[name], n) for name in grounded] + [(piece[a], piece[b]) for a, b in links]
    rows, columns = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
    graph = sparse.coo_array((np.ones(len(rows)), (rows, columns)), shape=(n + 1, n + 1))
    _, label = sparse.csgraph.connected_components(graph, directed=False)
    lost = np.flatnonzero(label[:n] != label[n])
    if len(lost):
        names = [b for b, cells in mesh.bodies.items() if np.isin(elements.components[cells], lost).any()]
        raise ConditionError(
            f"no way for the heat of body {', '.join(names)}: no film, radiation, prescribed temperature or "
            "exchange above zero reaches it; give one of its surfaces such a condition"
        )
    return frozenset(range(n)) - {piece[name] for name in grounded}


def _require_known(what: str, name: str, known: Collection[str]) -> None:
    if name not in known:
        near = get_close_matches(name, known, n=3, cutoff=0.4) or sorted(known)[:5]
        raise ConditionError(f"unknown {what} {name!r}; nearest: {', '.join(near)}")


def _values(condition: BoundaryCondition) -> Iterator[tuple[str, float, bool]]:
    """Numbers of a condition as (field, value, is it an absolute temperature)."""
    if isinstance(condition, Film):
        yield "fluid_temperature", condition.fluid_temperature, True
    elif isinstance(condition, Radiation):
        yield "surroundings_temperature", condition.surroundings_temperature, True
        yield "emissivity", condition.emissivity, False
    elif isinstance(condition, PrescribedTemperature):
        yield "temperature", condition.temperature, True
    elif isinstance(condition, SurfaceSource | BodySource):
        yield "power", condition.power, False


def _check_values(condition: BoundaryCondition) -> None:
    place = condition.body if isinstance(condition, BodySource) else " and ".join(surfaces_of(condition))
    for field, value, absolute in _values(condition):
        if not math.isfinite(value):
            raise ConditionError(f"{place}: {field} = {value} is no finite number")
        if absolute and value <= 0.0:
            raise ConditionError(f"{place}: {field} = {value:g} K must be above 0 K; give kelvin")
        if field == "emissivity" and not 0.0 <= value <= 1.0:
            raise ConditionError(f"{place}: emissivity = {value:g} is outside of 0 to 1")
    if isinstance(condition, Exchange) and condition.surface_a == condition.surface_b:
        raise ConditionError(f"exchange of {place}: needs two different surfaces")


def _check_combinations(conditions: Sequence[BoundaryCondition]) -> None:
    """Refuse a second condition beside `Adiabatic` or a prescribed temperature, and repeated kinds."""
    on: dict[str, list[BoundaryCondition]] = {}
    for condition in conditions:
        for name in surfaces_of(condition):
            on.setdefault(name, []).append(condition)
    for name, found in on.items():
        alone = [c for c in found if isinstance(c, Adiabatic | PrescribedTemperature)]
        if alone and len(found) > 1:
            others = ", ".join(type(c).__name__ for c in found if c is not alone[0])
            raise ConditionError(
                f"surface {name!r} is {type(alone[0]).__name__} and carries {others} as well; keep one"
            )
    seen: set[tuple[object, ...]] = set()
    for condition in conditions:
        if isinstance(condition, Adiabatic):
            continue
        place = (condition.body,) if isinstance(condition, BodySource) else surfaces_of(condition)
        key = (type(condition), *place, condition.kind)
        if key in seen:
            raise ConditionError(
                f"{' and '.join(place)}: two {type(condition).__name__} of kind {condition.kind!r}; "
                "give each a kind of its own"
            )
        seen.add(key)


def _check_open(elements: FiniteElements, conditions: Sequence[BoundaryCondition]) -> None:
    covered = {name for condition in conditions for name in surfaces_of(condition)}
    missing = sorted(set(elements.mesh.surfaces) - covered - elements.interfaces)
    if not missing:
        return
    notes = []
    for name in missing:
        near = get_close_matches(name, covered, n=1, cutoff=0.6)
        notes.append(f"{name} (beside {near[0]}, which has one)" if near else name)
    raise ConditionError(
        f"surfaces without a boundary condition: {'; '.join(notes)}; give each a film, a temperature, "
        "an exchange or Adiabatic"
    )


def _check_prescribed(elements: FiniteElements, conditions: Sequence[BoundaryCondition]) -> None:
    held: dict[int, tuple[str, float]] = {}
    for condition in conditions:
        if not isinstance(condition, PrescribedTemperature):
            continue
        for node in elements.surfaces[condition.surface].nodes.tolist():
            name, value = held.setdefault(node, (condition.surface, condition.temperature))
            if value != condition.temperature:
                raise ConditionError(
                    f"surfaces {name!r} at {value:g} K and {condition.surface!r} at "
                    f"{condition.temperature:g} K meet; make them equal or use a film on one"
                )
