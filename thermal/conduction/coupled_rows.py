"""Rows of the heat balance where places heat each other: contacts, enclosures, volumes of streams.

The radiosities and inlet temperatures are worked out here once more, from the conditions alone.
"""

import math
from collections.abc import Mapping

import numpy as np

from thermal.conditions.contact import Contact
from thermal.conditions.enclosure import Enclosure
from thermal.conditions.streams import StreamNetwork, inlet_share
from thermal.conditions.view_factor_closure import close_view_factors
from thermal.conduction.heat_rows import HeatFlow, surface_row
from thermal.conduction.setup import ConductionSetup
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import FloatArray
from thermal.films.law import STEFAN_BOLTZMANN


def contact_rows(setup: ConductionSetup, contact: Contact, temperature: FloatArray) -> list[HeatFlow]:
    """Both sides of a contact, from the jump over the joint; area and means are those of the joint."""
    joint = setup.joint(contact)
    at_a, at_b = joint.side_a @ temperature, joint.side_b @ temperature
    area = float(joint.weights.sum())
    mean_a, mean_b = float(joint.weights @ at_a) / area, float(joint.weights @ at_b) / area
    coefficient = contact.law(mean_a, mean_b)
    power = coefficient.value * float(joint.weights @ (at_b - at_a))
    rows = []
    for name, mean, sign in ((contact.surface_a, mean_a, 1.0), (contact.surface_b, mean_b, -1.0)):
        rows.append(
            HeatFlow(
                surface=name,
                kind=contact.kind,
                power=sign * power,
                area=area,
                mean_temperature=mean,
                piece=setup.elements.surfaces[name].piece,
                coefficient=coefficient,
            )
        )
    return rows


def enclosure_rows(elements: FiniteElements, enclosure: Enclosure, temperature: FloatArray) -> list[HeatFlow]:
    """Net radiation of each surface from the radiosities, as irradiation less radiosity."""
    surfaces = [elements.surfaces[name] for name in enclosure.surfaces]
    areas = np.array([surface.area for surface in surfaces])
    room = enclosure.opening_temperature
    factors = close_view_factors(
        np.array(enclosure.view_factors), areas, enclosure.surfaces, room is not None
    )
    emission = np.array(
        [STEFAN_BOLTZMANN * s.integral(s.at_points(temperature) ** 4) / s.area for s in surfaces]
    )
    outside = 0.0 if room is None else STEFAN_BOLTZMANN * room**4
    arriving_room = (1.0 - factors.sum(axis=1)) * outside
    e = np.array(enclosure.emissivities)
    radiosity = np.linalg.solve(
        np.eye(len(e)) - (1.0 - e)[:, None] * factors, e * emission + (1.0 - e) * arriving_room
    )
    net = areas * (factors @ radiosity + arriving_room - radiosity)
    return [
        surface_row(surface, name, enclosure.kind, float(power), temperature)
        for surface, name, power in zip(surfaces, enclosure.surfaces, net, strict=True)
    ]


def network_rows(
    elements: FiniteElements,
    network: StreamNetwork,
    temperature: FloatArray,
    volumes: Mapping[str, float],
    number: Mapping[str, int],
) -> list[HeatFlow]:
    """Films with both their sides, powers, streams into a volume and links.

    volumes : volume -> outlet temperature [K]; number : volume -> piece its rows count for
    """
    places = {**volumes, **{supply.name: supply.temperature for supply in network.supplies}}
    rows: list[HeatFlow] = []

    def book(volume: str, kind: str, power: float) -> None:
        rows.append(
            HeatFlow(
                surface=volume,
                kind=kind,
                power=power,
                area=0.0,
                mean_temperature=places[volume],
                piece=number[volume],
            )
        )

    for volume in network.volumes:
        surfaces = {f: elements.surfaces[f.surface] for f in network.films if f.volume == volume.name}
        laws = {f: f.law(s.mean(temperature), places[volume.name]) for f, s in surfaces.items()}
        conductance = math.fsum(laws[f].value * s.area for f, s in surfaces.items())
        fluid = _film_temperature(network, volume.name, places, conductance)
        for film, surface in surfaces.items():
            felt = fluid
            if film.supply is not None:
                felt = film.supply_share * places[film.supply] + (1.0 - film.supply_share) * fluid
            power = laws[film].value * surface.integral(felt - surface.at_points(temperature))
            rows.append(surface_row(surface, film.surface, film.kind, power, temperature, laws[film]))
            book(volume.name, film.kind, -power)
        if volume.power != 0.0:
            book(volume.name, "power", volume.power)
    for stream in network.streams:
        if stream.target is not None:
            rate = stream.mass_flow * network.specific_heat
            book(stream.target, stream.kind, rate * (places[stream.source] - places[stream.target]))
    for link in network.links:
        for here, there in ((link.a, link.b), (link.b, link.a)):
            if here in volumes:
                book(here, link.kind, link.conductance * (places[there] - places[here]))
    return rows


def _film_temperature(
    network: StreamNetwork, volume: str, places: Mapping[str, float], conductance: float
) -> float:
    """Temperature [K] that the films of a volume feel; conductance : sum of h A of its films [W/K]."""
    outlet = places[volume]
    if not next(v.plug_flow for v in network.volumes if v.name == volume):
        return outlet
    inflows = [(s.mass_flow, places[s.source]) for s in network.streams if s.target == volume]
    mass = math.fsum(flow for flow, _ in inflows)
    inlet = math.fsum(flow * value for flow, value in inflows) / mass
    share = inlet_share(conductance / (mass * network.specific_heat))
    return share * inlet + (1.0 - share) * outlet
