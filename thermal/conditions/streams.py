"""Air, mist and oil as unknowns: volumes of one temperature, the surfaces that heat them, streams between them.

A network of volumes carries one fluid. Mass is conserved at every volume; its heat balance is

    C dV/dt = sum over films h A (T_mean - T_film) + sum over inflows m c (T_source - V)
              + sum over links G (T_other - V) + power,

with V the temperature at which the fluid leaves. The volume is either stirred (its films feel V) or a stream
that warms up on its way (plug flow): its films then feel T_film = w T_in + (1 - w) V with
w = 1/N - 1/(e^N - 1) and N = sum h A / (m c), which is the exact mean of T_in .. V along walls of one
temperature. Source: Incropera et al., Fundamentals of Heat and Mass Transfer, 7th ed., eq. 8.41b to 8.44.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from thermal.conditions.boundary import ConditionError
from thermal.films.law import FilmLaw

BALANCED = 1e-9
"""Allowed gap between mass flows in and out of a volume, relative to the greater."""

SMALL = 1e-3
"""Transfer units below which the share of the inlet is taken from its series."""


@dataclass(frozen=True, kw_only=True)
class Volume:
    """Fluid of one temperature, or a stream with an inlet and an outlet temperature."""

    name: str
    power: float = 0.0
    """Heat set free in the fluid (windage, friction in a film) [W]."""
    heat_capacity: float = 0.0
    """Mass times specific heat [J/K]; only a transient asks for it, 0 follows without delay."""
    plug_flow: bool = False
    """True for a stream that warms up along its surfaces."""


@dataclass(frozen=True, kw_only=True)
class Supply:
    """A place of given temperature: oil from the cooler, the room."""

    name: str
    temperature: float
    """[K]"""


@dataclass(frozen=True, kw_only=True)
class VolumeFilm:
    """Convection between a surface and a volume: q = h(T_mean, V) (T_film - T) into the surface."""

    surface: str
    volume: str
    kind: str
    """Row name in the heat balance."""
    law: FilmLaw
    """Coefficient from the mean wall temperature and the temperature V of the volume [K]."""
    supply: str | None = None
    """Supply whose temperature the film feels in part: oil half warmed up, or still as it was injected."""
    supply_share: float = 0.0
    """Its share w: the film feels w T_supply + (1 - w) T_film."""


@dataclass(frozen=True, kw_only=True)
class Stream:
    """A mass flow from a supply or volume to a volume, or out of the model."""

    source: str
    target: str | None
    """None for a stream that leaves with the temperature of its source."""
    mass_flow: float
    """[kg/s]"""
    kind: str = "stream"


@dataclass(frozen=True, kw_only=True)
class VolumeLink:
    """A conductance between a volume and a supply or another volume, be it of another network."""

    a: str
    b: str
    conductance: float
    """[W/K]"""
    kind: str = "link"


@dataclass(frozen=True, kw_only=True)
class StreamNetwork:
    """Volumes of one fluid with everything that gives them heat. Volume names are unique in the whole model."""

    specific_heat: float
    """[J/(kg K)]"""
    volumes: tuple[Volume, ...]
    films: tuple[VolumeFilm, ...] = ()
    supplies: tuple[Supply, ...] = ()
    streams: tuple[Stream, ...] = ()
    links: tuple[VolumeLink, ...] = ()

    @property
    def places(self) -> tuple[str, ...]:
        """Names of all volumes and supplies."""
        return (*(volume.name for volume in self.volumes), *(supply.name for supply in self.supplies))


def inlet_share(transfer_units: float) -> float:
    """Weight w of the inlet in the mean temperature of a plug flow: 1/2 for N -> 0, 1/N for N -> infinity."""
    n = transfer_units
    if n < SMALL:
        return 0.5 - n / 12.0 + n**3 / 720.0
    return 1.0 / n - math.exp(-n) / -math.expm1(-n)


def inlet_share_slope(transfer_units: float) -> float:
    """dw/dN of `inlet_share`."""
    n = transfer_units
    if n < SMALL:
        return -1.0 / 12.0 + n**2 / 240.0
    return -1.0 / n**2 + math.exp(-n) / math.expm1(-n) ** 2


def check_networks(networks: Sequence[StreamNetwork]) -> None:
    """Check names, values and mass flows of all networks of a model.

    Raises ConditionError for a name that is unknown or occurs twice, an impossible value, and a volume whose
    inflows and outflows differ. Surfaces are checked with the other conditions, heat paths in the solver.
    """
    names: set[str] = set()
    volumes = {volume.name for network in networks for volume in network.volumes}
    for network in networks:
        _check_number("network", "specific_heat", network.specific_heat, above=0.0)
        for name in network.places:
            if name in names:
                raise ConditionError(f"volume or supply {name!r} occurs twice; give each its own name")
            names.add(name)
        for volume in network.volumes:
            _check_number(volume.name, "power", volume.power)
            _check_number(volume.name, "heat_capacity", volume.heat_capacity, least=0.0)
        for supply in network.supplies:
            _check_number(supply.name, "temperature", supply.temperature, above=0.0)
        _check_ends(network)
        _check_links(network, volumes)
        _check_flows(network)


def _require_place(label: str, name: str, among: set[str]) -> None:
    if name not in among:
        raise ConditionError(f"{label}: unknown place {name!r}; known: {', '.join(sorted(among))}")


def _check_ends(network: StreamNetwork) -> None:
    volumes = {volume.name for volume in network.volumes}
    places = volumes | {supply.name for supply in network.supplies}
    for film in network.films:
        label = f"film {film.kind!r} on {film.surface}"
        _require_place(label, film.volume, volumes)
        if film.supply is not None:
            _require_place(label, film.supply, places - volumes)
        if not 0.0 <= film.supply_share <= (0.0 if film.supply is None else 1.0):
            raise ConditionError(
                f"{label}: supply_share = {film.supply_share:g} must lie within 0 and 1, and be 0 without a supply"
            )
    for stream in network.streams:
        label = f"{stream.kind} from {stream.source} to {stream.target}"
        _require_place(label, stream.source, places)
        if stream.target is not None:
            _require_place(label, stream.target, volumes)
        if stream.source == stream.target:
            raise ConditionError(f"{label}: needs two different places")
        _check_number(label, "mass_flow", stream.mass_flow, above=0.0)


def _check_links(network: StreamNetwork, volumes: set[str]) -> None:
    """volumes : of all networks"""
    places = volumes | {supply.name for supply in network.supplies}
    for link in network.links:
        label = f"link of {link.a} and {link.b}"
        _require_place(label, link.a, places)
        _require_place(label, link.b, places)
        if link.a == link.b or not {link.a, link.b} & volumes:
            raise ConditionError(f"{label}: needs a volume and another place")
        _check_number(label, "conductance", link.conductance, least=0.0)


def _check_flows(network: StreamNetwork) -> None:
    for volume in network.volumes:
        into = math.fsum(s.mass_flow for s in network.streams if s.target == volume.name)
        out = math.fsum(s.mass_flow for s in network.streams if s.source == volume.name)
        if abs(into - out) > BALANCED * max(into, out):
            raise ConditionError(
                f"volume {volume.name!r}: {into:g} kg/s in and {out:g} kg/s out; make the mass flows equal, "
                "with a stream to None for what leaves the model"
            )
        if volume.plug_flow and into == 0.0:
            raise ConditionError(f"volume {volume.name!r} is a plug flow without inflow; give it a stream")


def _check_number(
    place: str, field: str, value: float, *, above: float | None = None, least: float | None = None
) -> None:
    if not math.isfinite(value):
        raise ConditionError(f"{place}: {field} = {value} is no finite number")
    if above is not None and value <= above:
        raise ConditionError(f"{place}: {field} = {value:g} must be above {above:g}")
    if least is not None and value < least:
        raise ConditionError(f"{place}: {field} = {value:g} must be at least {least:g}")


def volume_links(networks: Sequence[StreamNetwork]) -> Iterator[tuple[str, str | None]]:
    """Pairs of volumes that exchange heat by a stream or link; None for a volume that a supply reaches."""
    for network in networks:
        supplies = {supply.name for supply in network.supplies}
        for stream in network.streams:
            if stream.target is not None:
                yield stream.target, None if stream.source in supplies else stream.source
        for link in network.links:
            if link.conductance > 0.0:
                volume, other = (link.b, link.a) if link.a in supplies else (link.a, link.b)
                yield volume, None if other in supplies else other
