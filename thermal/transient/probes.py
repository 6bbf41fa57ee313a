"""Named places whose temperature is kept over time."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from thermal.conditions.boundary import ConditionError
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import FloatArray, IndexArray

Reader = Callable[[FloatArray, Mapping[str, float]], float]
"""Temperature [K] from the field (n_nodes,) and the volumes."""


@dataclass(frozen=True, kw_only=True)
class Probe:
    """A surface, body or volume by name, or the node nearest to a point."""

    name: str
    place: str | tuple[float, float, float]
    """Surface, body or volume; or x, y, z [m]."""
    quantity: Literal["mean", "max", "min"] = "mean"
    """Of a surface (area mean) or body (volume mean)."""


def reader(elements: FiniteElements, probe: Probe) -> Reader:
    """How a probe is read. A name that is no surface or body is taken for a volume when it is read."""
    mesh, place = elements.mesh, probe.place
    if not isinstance(place, str):
        node = int(np.linalg.norm(mesh.points - np.array(place), axis=1).argmin())
        return lambda temperature, volumes: float(temperature[node])
    if place in mesh.surfaces:
        surface = elements.surfaces[place]
        if probe.quantity == "mean":
            return lambda temperature, volumes: surface.mean(temperature)
        return _extreme(surface.nodes, probe.quantity)
    if place in mesh.bodies:
        if probe.quantity == "mean":
            share = elements.body_load(place)
            share = share / share.sum()
            return lambda temperature, volumes: float(share @ temperature)
        return _extreme(np.unique(mesh.cells[mesh.bodies[place]]), probe.quantity)
    return _of_volume(probe.name, place)


def _extreme(nodes: IndexArray, quantity: str) -> Reader:
    take = np.max if quantity == "max" else np.min
    return lambda temperature, volumes: float(take(temperature[nodes]))


def _of_volume(name: str, place: str) -> Reader:
    def read(temperature: FloatArray, volumes: Mapping[str, float]) -> float:
        if place not in volumes:
            raise ConditionError(
                f"probe {name!r}: {place!r} is no surface, body or volume; volumes here: "
                f"{', '.join(sorted(volumes)) or 'none'}"
            )
        return volumes[place]

    return read
