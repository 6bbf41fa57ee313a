"""What heats and cools the housings at any time of a phase: every operating point computed once."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TypeAlias, TypeVar

from dynamics.rotor.bearing import HeatStar
from rigdesign.base.part_name import BearingName, OilStreamName
from rigdesign.base.units import ZERO_CELSIUS
from rigdesign.coupling.bearing_seats import WarmBearing, bearings_between
from rigdesign.coupling.housing_context import BEARING_OIL, GEAR_OIL
from rigdesign.coupling.located_loss import PointLosses
from rigdesign.coupling.loop import PointResult, governing_point
from rigdesign.coupling.loop_over_speed import stage_losses
from rigdesign.coupling.oil import OilStream
from rigdesign.coupling.oil_circuits import wall_slopes
from rigdesign.coupling.state import OperatingPoint
from rigdesign.rig.model import Rig
from rigdesign.transient.oil import between, oil_conditions, supplied
from rigdesign.transient.oil_supply import SupplyHistory, WallAnswer
from rigdesign.transient.phases import Phase
from thermal.conditions.boundary import BodySource, Exchange, Film, SurfaceSource
from thermal.conditions.streams import Stream, StreamNetwork
from thermal.conduction.setup import Condition, surfaces_of
from thermal.films.law import FilmCoefficient, FilmLaw
from thermal.transient.history import ThermalStage

LEVEL = 20.0
"""Distance of the supply temperatures at which films are computed [K]; between them they are interpolated."""
Supplies: TypeAlias = tuple[tuple[str, float], ...]
"""(``gearbox.stream``, supply temperature [K])."""


class Heating:
    """Conditions of every housing over the phases; at held points those of the coupled run."""

    def __init__(self, rig: Rig, points: Sequence[PointResult]) -> None:
        self._rig = rig
        self._test = governing_point(points)
        self._states: dict[OperatingPoint, PointLosses] = {
            solved.point: PointLosses(
                point=solved.point,
                coupling_state=solved.last.coupling_state,
                bearings=solved.last.bearings,
                losses=solved.last.losses,
            )
            for solved in points
        }
        self._conditions: dict[tuple[str, OperatingPoint, bool, Supplies], tuple[Condition, ...]] = {}

    @cached_property
    def answers(self) -> Mapping[str, WallAnswer]:
        """Stream -> how the walls of its housing answer its supply temperature, about."""
        return {stream.name: self._answer(stream) for stream in self._test.last.streams}

    def _answer(self, stream: OilStream) -> WallAnswer:
        prompt, lasting = wall_slopes(self._rig, self._test.last, stream)
        box = stream.name.gearbox
        if not prompt or box not in self._rig.models:
            return WallAnswer(prompt=prompt)
        elements = self._rig.conduction[box].elements
        capacity = math.fsum(
            material.density * material.heat_capacity * elements.volume(body)
            for body, material in self._rig.body_materials(box).items()
            if body != "field"
        )
        return WallAnswer(prompt=prompt, lasting=lasting, capacity=capacity)

    def at(
        self, name: str, point: OperatingPoint, *, oil: bool, supplies: Supplies = ()
    ) -> tuple[Condition, ...]:
        """Conditions of the housing of gearbox ``name`` at an operating point.

        supplies : supply temperature [K] of its streams that oil circuits feed; those of the point when left out.
            Films and oils are those of these temperatures; the losses stay those of the point
        """
        key = name, point, oil, supplies
        if key not in self._conditions:
            state = supplied(self.state(point), dict(supplies))
            self._conditions[key] = oil_conditions(self._rig, name, state, oil=oil)
        return self._conditions[key]

    def fed_at(
        self, name: str, point: OperatingPoint, phase: Phase, supplies: Mapping[str, float]
    ) -> tuple[Condition, ...]:
        """Conditions of a housing at an operating point of a phase, its oil fed at given temperatures [K].

        They are interpolated between supply temperatures `LEVEL` apart.
        """
        streams = (OilStreamName(name, kind) for kind in (GEAR_OIL, BEARING_OIL))
        of_housing = {stream: supplies[stream] for stream in streams if stream in supplies}
        if not (of_housing and phase.oil):
            return self.at(name, point, oil=phase.oil)
        low = {
            stream: ZERO_CELSIUS + LEVEL * ((value - ZERO_CELSIUS) // LEVEL)
            for stream, value in of_housing.items()
        }
        first = self.at(name, point, oil=True, supplies=tuple(low.items()))
        warmer = tuple((stream, value + LEVEL) for stream, value in low.items())
        second = self.at(name, point, oil=True, supplies=warmer)
        share = {stream.part: (value - low[stream]) / LEVEL for stream, value in of_housing.items()}
        networks = {c.volumes[0].name: c for c in second if isinstance(c, StreamNetwork)}
        conditions: list[Condition] = []
        for condition in first:
            kind = condition.volumes[0].name if isinstance(condition, StreamNetwork) else ""
            if kind in share:
                conditions += blended([condition], [networks[kind]], share[kind])
            else:
                conditions.append(condition)
        return tuple(conditions)

    def state(self, point: OperatingPoint) -> PointLosses:
        """What heats the rig at an operating point."""
        if point not in self._states:
            heats = self._rig.case.losses.mesh_damping_heats_oil
            self._states[point] = stage_losses(self._rig, point, self._test, dynamic=heats)
        return self._states[point]

    def seated_bearings(
        self, name: str, phase: Phase, time: float, seats: Mapping[str, float]
    ) -> dict[str, WarmBearing]:
        """Bearings of gearbox ``name`` that conduct heat to their seats, ``time`` [s] into a phase.

        seats : their temperatures [K], by ``gearbox.bearing.seat``
        """
        before, after, share = phase.between(time)
        first, second = (self.state(knot.point).bearings for knot in (before, after))
        stars: dict[str, HeatStar] = {
            full: between(old.star, new.star, share, oil=phase.oil)
            for full in (BearingName(name, part) for part in self._rig.case.gearboxes[name].bearings)
            if (old := first[full]).star is not None and (new := second[full]).star is not None
        }
        return bearings_between(stars, seats)

    def stage(
        self, name: str, phase: Phase, start: float = 0.0, supply: SupplyHistory | None = None
    ) -> ThermalStage:
        """A phase as the heat model of gearbox ``name`` takes it.

        start : of the phase, since the start of the schedule [s]
        supply : supply temperatures of the oil circuits over time; None without circuits
        """
        if supply is not None and phase.oil:

            def fed(time: float) -> Sequence[Condition]:
                before, after, share = phase.between(time)
                temperatures = supply.at(start + time)
                first = self.fed_at(name, before.point, phase, temperatures)
                if share == 0.0:
                    return first
                return blended(first, self.fed_at(name, after.point, phase, temperatures), share)

            return ThermalStage(name=phase.name, duration=phase.duration, conditions=fed)
        if len(phase.knots) == 1:
            fixed = self.at(name, phase.knots[0].point, oil=phase.oil)
            return ThermalStage(name=phase.name, duration=phase.duration, conditions=fixed)

        def conditions(time: float) -> Sequence[Condition]:
            before, after, share = phase.between(time)
            first, second = (self.at(name, knot.point, oil=phase.oil) for knot in (before, after))
            return blended(first, second, share)

        return ThermalStage(name=phase.name, duration=phase.duration, conditions=conditions)


# Conditions between two operating points: films, flows, temperatures and powers in proportion.

Item = TypeVar("Item")


def blended(first: Sequence[Condition], second: Sequence[Condition], share: float) -> tuple[Condition, ...]:
    """The conditions ``share`` of the way from the first to the second; both of one housing.

    A source or stream that one of them lacks counts as zero there; all others must be in both.
    """
    ours, theirs = ({_key(c): c for c in conditions} for conditions in (first, second))
    mixed = []
    for key in dict.fromkeys([*ours, *theirs]):
        a, b = ours.get(key), theirs.get(key)
        if a is None or b is None:
            mixed.append(_alone(b if a is None else a, share if a is None else 1.0 - share))
        else:
            mixed.append(_between(a, b, share))
    return tuple(mixed)


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
    mixed = []
    for key in dict.fromkeys([*ours, *theirs]):
        flows = [s[key].mass_flow if key in s else 0.0 for s in (ours, theirs)]
        flow = _mean(flows[0], flows[1], share)
        if flow > 0.0:
            mixed.append(replace(ours.get(key) or theirs[key], mass_flow=flow))
    return tuple(mixed)


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
