"""Bearings that conduct heat to their seats, over time: each a volume between shaft, housing and its oil.

At a held stage the node has the temperature of the steady star; without oil it is left with its seats alone.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from dynamics.bearing.protocol import HeatStar
from rigdesign.coupling.bearing_heat import conductances, on_surface
from rigdesign.coupling.bearing_seats import bearing_seats
from rigdesign.coupling.housing_context import BEARING_FILM
from rigdesign.coupling.placed_loss import PlacedLoss
from rigdesign.coupling.point_losses import PointLosses
from rigdesign.rig.model import Rig
from thermal.conditions.streams import StreamNetwork, Volume, VolumeFilm, VolumeLink

BEARING_TO_OIL = "bearing to oil"
"""Kind of the links between bearings that are not fed and the oil of the chamber."""


@dataclass(frozen=True, kw_only=True)
class BearingNode:
    """One bearing with the films to its seats; oil : conductance to the oil that passes it [W/K]."""

    part: str
    volume: Volume
    films: tuple[VolumeFilm, ...]
    oil: float


def seated_bearings(rig: Rig, name: str) -> list[str]:
    """Bearings of the gearbox ``name`` that conduct heat to a seat, by their own names."""
    return [part for part in rig.case.gearboxes[name].bearings if bearing_seats(rig, f"{name}.{part}")]


def bearing_nodes(
    rig: Rig, name: str, state: PointLosses, losses: Sequence[PlacedLoss]
) -> dict[str, BearingNode]:
    """Nodes of the gearbox ``name`` by bearing."""
    nodes = {}
    for part in seated_bearings(rig, name):
        full = f"{name}.{part}"
        star = state.bearings[full].star
        assert star is not None
        kind = f"{BEARING_FILM}:{part}"
        friction = math.fsum(p.loss.power for p in losses if p.name == full and p.loss.kind == "bearing")
        nodes[part] = BearingNode(
            part=part,
            volume=Volume(name=kind, power=friction),
            films=tuple(
                VolumeFilm(
                    surface=seat.surface, volume=kind, kind=kind, law=on_surface(rig, full, seat, conductance)
                )
                for seat, conductance in conductances(rig, full, star)
            ),
            oil=star.oil,
        )
    return nodes


def with_nodes(network: StreamNetwork, nodes: Mapping[str, BearingNode], oil: str | None) -> StreamNetwork:
    """A network with bearings that live on its volume ``oil``; None where no oil reaches them."""
    links = (
        VolumeLink(a=node.volume.name, b=oil, conductance=node.oil, kind=BEARING_TO_OIL)
        for node in nodes.values()
        if oil is not None
    )
    return replace(
        network,
        volumes=(*network.volumes, *(node.volume for node in nodes.values())),
        films=(*network.films, *(film for node in nodes.values() for film in node.films)),
        links=(*network.links, *links),
    )


def between(first: HeatStar, second: HeatStar, share: float, *, oil: bool) -> HeatStar:
    """A bearing ``share`` of the way between two operating points; without its oil where none runs."""
    mixed = {
        key: (1.0 - share) * getattr(first, key) + share * getattr(second, key)
        for key in ("shaft", "housing", "oil", "oil_temperature", "heat")
    }
    return HeatStar(**mixed | ({} if oil else {"oil": 0.0}))
