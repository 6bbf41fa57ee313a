"""Heat by named surface, each row integrated from its own law; what is left over is the closure error.

Nothing here is shared with the residual that `thermal.conduction.steady` drives to zero: no flow is booked as the
difference of others, so a sign or an area that is wrong in one place shows as a gap.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermal.conditions.boundary import (
    Adiabatic,
    BodySource,
    Exchange,
    Film,
    PrescribedTemperature,
    Radiation,
    SurfaceSource,
)
from thermal.conditions.contact import Contact
from thermal.conditions.enclosure import Enclosure
from thermal.conditions.streams import StreamNetwork, inlet_share
from thermal.conditions.view_factor_closure import close_view_factors
from thermal.conduction.capacity import StoredHeat
from thermal.conduction.setup import Condition, ConductionSetup
from thermal.fe.elements import FiniteElements, SurfaceElements
from thermal.fe.mesh import FloatArray
from thermal.films.law import STEFAN_BOLTZMANN, FilmCoefficient

# Rows of the heat balance: one condition at one place, integrated from its own law.


@dataclass(frozen=True, kw_only=True)
class HeatFlow:
    """Heat of one condition at one place."""

    surface: str
    """Surface, body for a source in a body, or volume."""
    kind: str
    power: float
    """[W], positive into the solid or volume."""
    area: float
    """[m2]; 0 for a source in a body and for a volume."""
    mean_temperature: float
    """Area mean of the surface, volume mean of the body, outlet temperature of the volume [K]."""
    piece: int
    """Number of the connected piece of the mesh that takes the heat; volumes count on from the last piece."""
    coefficient: FilmCoefficient | None = None


def surface_row(
    surface: SurfaceElements,
    name: str,
    kind: str,
    power: float,
    temperature: FloatArray,
    coefficient: FilmCoefficient | None = None,
) -> HeatFlow:
    """A row of a surface with its area and mean temperature; power [W] into the solid."""
    return HeatFlow(
        surface=name,
        kind=kind,
        power=power,
        area=surface.area,
        mean_temperature=surface.mean(temperature),
        piece=surface.piece,
        coefficient=coefficient,
    )


def film_row(surface: SurfaceElements, film: Film, temperature: FloatArray) -> HeatFlow:
    """Heat of a film, its coefficient at the mean wall temperature."""
    coefficient = film.law(surface.mean(temperature), film.fluid_temperature)
    power = coefficient.value * surface.integral(film.fluid_temperature - surface.at_points(temperature))
    return surface_row(surface, film.surface, film.kind, power, temperature, coefficient)


def radiation_row(surface: SurfaceElements, radiation: Radiation, temperature: FloatArray) -> HeatFlow:
    """Heat from large surroundings, integrated over T^4."""
    wall, room = surface.at_points(temperature), radiation.surroundings_temperature
    power = radiation.emissivity * STEFAN_BOLTZMANN * surface.integral(room**4 - wall**4)
    mean = surface.mean(temperature)
    coefficient = FilmCoefficient(
        value=radiation.emissivity * STEFAN_BOLTZMANN * (mean**2 + room**2) * (mean + room),
        formula="grey_radiation_to_surroundings",
        inputs={
            "emissivity": radiation.emissivity,
            "mean_temperature": mean,
            "surroundings_temperature": room,
        },
        valid_range="grey, diffuse surface that sees only its surroundings",
        source="Stefan-Boltzmann law, written as a coefficient at the mean temperature",
    )
    return surface_row(surface, radiation.surface, radiation.kind, power, temperature, coefficient)


def exchange_rows(elements: FiniteElements, exchange: Exchange, temperature: FloatArray) -> list[HeatFlow]:
    """Both sides of an exchange between area means."""
    a, b = elements.surfaces[exchange.surface_a], elements.surfaces[exchange.surface_b]
    mean_a, mean_b = a.mean(temperature), b.mean(temperature)
    coefficient = exchange.law(mean_a, mean_b)
    power = coefficient.value * a.area * (mean_b - mean_a)
    return [
        surface_row(a, exchange.surface_a, exchange.kind, power, temperature, coefficient),
        surface_row(b, exchange.surface_b, exchange.kind, -power, temperature, coefficient),
    ]


@dataclass(frozen=True)
class HeatBalance:
    """All rows; in a steady state they sum to zero on every connected piece."""

    rows: tuple[HeatFlow, ...]

    @property
    def imbalance(self) -> float:
        """Sum of all rows [W]."""
        return float(np.sum([row.power for row in self.rows]))

    @property
    def turnover(self) -> float:
        """Heat turned over: half the sum of the rows' sizes [W]."""
        return 0.5 * float(np.sum([abs(row.power) for row in self.rows]))

    @property
    def worst_piece(self) -> float:
        """Size of the largest sum of rows on one piece [W]; sees what an exchange cancels in the whole."""
        sums: dict[int, float] = {}
        for row in self.rows:
            sums[row.piece] = sums.get(row.piece, 0.0) + row.power
        return max((abs(power) for power in sums.values()), default=0.0)

    @property
    def closure(self) -> float:
        """The gap of the worst piece relative to the heat turned over [-]; 0 where no heat flows."""
        return self.worst_piece / self.turnover if self.turnover > 0.0 else 0.0

    def by_surface(self) -> dict[str, float]:
        """Surface or body -> power [W]."""
        return self._sums("surface")

    def by_kind(self) -> dict[str, float]:
        """Kind -> power [W]."""
        return self._sums("kind")

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the laws said about their range, each sentence once."""
        said = [text for row in self.rows if row.coefficient for text in row.coefficient.warnings]
        return tuple(dict.fromkeys(said))

    def _sums(self, field: str) -> dict[str, float]:
        sums: dict[str, float] = {}
        for row in self.rows:
            key = getattr(row, field)
            sums[key] = sums.get(key, 0.0) + row.power
        return sums


def heat_balance(
    setup: ConductionSetup,
    conditions: Sequence[Condition],
    temperature: FloatArray,
    reactions: FloatArray,
    volumes: Mapping[str, float] | None = None,
) -> HeatBalance:
    """Integrate every condition over its surface.

    temperature : (n_nodes,) [K]
    reactions : (n_nodes,) heat that holds the prescribed nodes at their temperature [W], zero elsewhere
    volumes : volume of a stream network -> outlet temperature [K]
    """
    elements = setup.elements
    holders = held_by(elements, conditions)
    numbers = _volume_numbers(elements, conditions)
    rows: list[HeatFlow] = []
    for condition in conditions:
        match condition:
            case Film():
                rows.append(film_row(elements.surfaces[condition.surface], condition, temperature))
            case Radiation():
                rows.append(radiation_row(elements.surfaces[condition.surface], condition, temperature))
            case Exchange():
                rows.extend(exchange_rows(elements, condition, temperature))
            case Contact():
                rows.extend(contact_rows(setup, condition, temperature))
            case Enclosure():
                rows.extend(enclosure_rows(elements, condition, temperature))
            case StreamNetwork():
                rows.extend(network_rows(elements, condition, temperature, volumes or {}, numbers))
            case PrescribedTemperature():
                surface = elements.surfaces[condition.surface]
                power = float(np.sum(reactions[surface.nodes] / holders[surface.nodes]))
                rows.append(surface_row(surface, condition.surface, condition.kind, power, temperature))
            case SurfaceSource():
                surface = elements.surfaces[condition.surface]
                rows.append(
                    surface_row(surface, condition.surface, condition.kind, condition.power, temperature)
                )
            case BodySource():
                rows.append(
                    HeatFlow(
                        surface=condition.body,
                        kind=condition.kind,
                        power=condition.power,
                        area=0.0,
                        mean_temperature=elements.body_mean(temperature, condition.body),
                        piece=int(elements.components[elements.mesh.bodies[condition.body][0]]),
                    )
                )
            case StoredHeat():
                rows.extend(_stored_rows(setup, condition, temperature))
            case Adiabatic():
                pass
    return HeatBalance(tuple(rows))


def _stored_rows(setup: ConductionSetup, condition: StoredHeat, temperature: FloatArray) -> list[HeatFlow]:
    """What every body takes up per time, as heat that leaves it."""
    elements, capacity = setup.elements, setup.heat_capacity(condition.capacity)
    rise = temperature - condition.start
    return [
        HeatFlow(
            surface=body,
            kind=condition.kind,
            power=-capacity.stored(rise, body) / condition.time,
            area=0.0,
            mean_temperature=elements.body_mean(temperature, body),
            piece=int(elements.components[cells[0]]),
        )
        for body, cells in elements.mesh.bodies.items()
    ]


def held_by(elements: FiniteElements, conditions: Sequence[Condition]) -> FloatArray:
    """(n_nodes,) number of prescribed surfaces that hold each node, at least 1."""
    count = np.zeros(len(elements.mesh.points))
    for condition in conditions:
        if isinstance(condition, PrescribedTemperature):
            count[elements.surfaces[condition.surface].nodes] += 1.0
    return np.maximum(count, 1.0)


def _volume_numbers(elements: FiniteElements, conditions: Sequence[Condition]) -> dict[str, int]:
    """Number of each volume, counted on from the last piece of the mesh."""
    networks = [c for c in conditions if isinstance(c, StreamNetwork)]
    names = [volume.name for network in networks for volume in network.volumes]
    first = int(elements.components.max()) + 1
    return {name: first + k for k, name in enumerate(names)}


# Rows of the heat balance where places heat each other: contacts, enclosures, volumes of streams.
#
# The radiosities and inlet temperatures are worked out here once more, from the conditions alone.


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
