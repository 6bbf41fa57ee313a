"""Journals in an event: do their films still hold where the linear coefficients send them?

A march has every film as stiffness and damping about the place of the journal under the load before the event. Where
the load vanishes or turns round, a film is softer than that towards the bore centre and far stiffer near
its wall; the forces of such an event are those of the linear film. How far the journal goes is compared with its
clearance.
"""

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from dynamics.bearing.lateral import LateralCoefficients
from dynamics.elastic_rig.seen_system import SeenRig
from dynamics.response.event_channels import Channel
from dynamics.response.event_march import EventHistory
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]

LINEAR_FILMS = (
    "films of plain bearings are linearised about the journal position before the event; where the load vanishes or "
    "reverses they are too stiff near the bore centre and too soft near the bore wall"
)
"""What of films an event leaves out, for its notes."""


def journal_channels(seen: SeenRig, films: Sequence[str]) -> tuple[Channel, ...]:
    """Travel along y and z [m] of journals in films, ``gearbox.bearing``, against their seats: two channels each."""
    found = []
    for name in films:
        rows = seen.on_freedoms(seen.reduced.model.ports[name])[:2]
        found += [
            Channel(place=name, kind="journal travel", angle=row[None], speed=np.zeros_like(row[None]))
            for row in rows
        ]
    return tuple(found)


def largest_travels(
    channels: Sequence[Channel], history: EventHistory, coefficients: Mapping[str, LateralCoefficients]
) -> dict[str, float]:
    """Largest distance of every journal from the middle of its bore [m], by ``gearbox.bearing``.

    Its place under the load before the event, and what the march moves it from there.

    channels : those of ``history``; coefficients : of every bearing before the event
    """
    moved: dict[str, list[Array]] = {}
    for channel, values, before in zip(channels, history.values, history.before, strict=True):
        if channel.kind == "journal travel":
            moved.setdefault(channel.place, []).append(values - before)
    return {
        name: float(np.hypot(*(place[:, None] + np.array(way))).max())
        for name, way in moved.items()
        for place in [np.asarray(coefficients[name].position)]
    }


def travel_warnings(rig: Rig, travels: Mapping[str, float], clearances: Mapping[str, float]) -> Iterator[str]:
    """Of every journal that would pass its clearance: the film is stiffer than the linear one.

    clearances : on the diameter as they run, by ``gearbox.bearing`` [m]
    """
    for name, travel in travels.items():
        limit = 0.5 * clearances[name]
        if rig.bearing(name).has_film and travel > limit and math.isfinite(travel):
            yield (
                f"bearing {name}: journal displacement {1e6 * travel:.0f} um exceeds the radial clearance "
                f"{1e6 * limit:.0f} um: the linear film is too soft there; treat the force as a lower bound, or lower "
                "the torque of the event"
            )
