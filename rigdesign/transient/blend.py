"""Conditions between two operating points: films, flows, temperatures and powers in proportion."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TypeVar

from thermal.conditions.boundary import BodySource, Exchange, Film, SurfaceSource
from thermal.conditions.streams import Stream, StreamNetwork
from thermal.conduction.condition_checks import Condition, surfaces_of
from thermal.films.law import FilmCoefficient, FilmLaw

Item = TypeVar("Item")


def blended(first: Sequence[Condition], second: Sequence[Condition], share: float) -> tuple[Condition, ...]:
    """The conditions ``share`` of the way from the first to the second; both of one housing.

    A source or stream that one of them lacks counts as zero there; all others must be in both.
    """
    ours, theirs = ({_key(c): c for c in conditions} for conditions in (first, second))
    found = []
    for key in dict.fromkeys([*ours, *theirs]):
        a, b = ours.get(key), theirs.get(key)
        if a is None or b is None:
            found.append(_alone(b if a is None else a, share if a is None else 1.0 - share))
        else:
            found.append(_between(a, b, share))
    return tuple(found)


def _key(condition: Condition) -> tuple[str, ...]:
    match condition:
        case StreamNetwork():
            return "StreamNetwork", condition.volumes[0].name
        case BodySource():
            return "BodySource", condition.body, condition.kind
    kind = getattr(condition, "kind", "")
    return type(condition).__name__, *surfaces_of(condition), kind


def _alone(condition: Condition | None, share: float) -> Condition:
    if not isinstance(condition, SurfaceSource | BodySource):
        raise KeyError(f"{condition} has no partner at the other operating point")
    return replace(condition, power=share * condition.power)


def _between(a: Condition, b: Condition, share: float) -> Condition:
    match a, b:
        case Film(), Film():
            fluid = _mean(a.fluid_temperature, b.fluid_temperature, share)
            return replace(a, fluid_temperature=fluid, law=_law(a.law, b.law, share))
        case Exchange(), Exchange():
            return replace(a, law=_law(a.law, b.law, share))
        case SurfaceSource(), SurfaceSource():
            return replace(a, power=_mean(a.power, b.power, share))
        case BodySource(), BodySource():
            return replace(a, power=_mean(a.power, b.power, share))
        case StreamNetwork(), StreamNetwork():
            return _network(a, b, share)
    return a


def _network(a: StreamNetwork, b: StreamNetwork, share: float) -> StreamNetwork:
    volumes = _by(b.volumes, lambda v: v.name)
    supplies = _by(b.supplies, lambda s: s.name)
    films = _by(b.films, lambda f: (f.surface, f.kind))
    links = _by(b.links, lambda link: (link.a, link.b))
    return replace(
        a,
        specific_heat=_mean(a.specific_heat, b.specific_heat, share),
        volumes=tuple(
            replace(v, power=_mean(v.power, volumes[v.name].power, share)) for v in a.volumes
        ),
        supplies=tuple(
            replace(s, temperature=_mean(s.temperature, supplies[s.name].temperature, share))
            for s in a.supplies
        ),
        films=tuple(
            replace(
                film,
                law=_law(film.law, films[film.surface, film.kind].law, share),
                supply_share=_mean(
                    film.supply_share, films[film.surface, film.kind].supply_share, share
                ),
            )
            for film in a.films
        ),
        streams=_streams(a.streams, b.streams, share),
        links=tuple(
            replace(link, conductance=_mean(link.conductance, links[link.a, link.b].conductance, share))
            for link in a.links
        ),
    )  # fmt: skip


def _streams(a: Sequence[Stream], b: Sequence[Stream], share: float) -> tuple[Stream, ...]:
    ours, theirs = ({(s.source, s.target, s.kind): s for s in streams} for streams in (a, b))
    found = []
    for key in dict.fromkeys([*ours, *theirs]):
        flows = [s[key].mass_flow if key in s else 0.0 for s in (ours, theirs)]
        flow = _mean(flows[0], flows[1], share)
        if flow > 0.0:
            found.append(replace(ours.get(key) or theirs[key], mass_flow=flow))
    return tuple(found)


def _by(items: Sequence[Item], key: Callable[[Item], object]) -> Mapping[object, Item]:
    return {key(item): item for item in items}


def _mean(a: float, b: float, share: float) -> float:
    return (1.0 - share) * a + share * b


def _law(a: FilmLaw, b: FilmLaw, share: float) -> FilmLaw:
    def law(wall: float, fluid: float) -> FilmCoefficient:
        first, second = a(wall, fluid), b(wall, fluid)
        main = second if share > 0.5 else first
        return replace(main, value=_mean(first.value, second.value, share))

    return law
