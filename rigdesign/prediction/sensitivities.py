"""First-order answers of a settled point: what a small change anywhere does once the loop has followed.

With the coupling state x of a point, the iterations x -> g(x) and the readings y(x), a change that moves g by dg and
the readings by dy at a fixed x moves the settled readings by dy + Y (1 - G)^-1 dg, G and Y the slopes of g and y by
x. These come from one iteration per number of the coupling state; what is changed in the housings (conductances,
sources) is answered on the temperature shapes.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from dynamics.response.speed_sweep import CurvePoint
from rigdesign.coupling.boundary import BEARING_FILM, BEARING_OIL, GEAR_OIL
from rigdesign.coupling.flank_heat import rim_surfaces
from rigdesign.coupling.iteration import IterationParts, IterationResult, run_iteration
from rigdesign.coupling.loads import BracingState as Bracing
from rigdesign.coupling.loads import MeshModel
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.prediction.expansion_map import ExpansionMap
from rigdesign.prediction.fixed_point import SCALES, SettledPoint, flat, raw, unflat
from rigdesign.prediction.housings import ReducedField, ReducedHousings
from rigdesign.prediction.linearised_drag import Cause, LinearisedDrag
from rigdesign.prediction.model import ORDER_QUANTITIES, Channel
from rigdesign.prediction.orders import Orders, is_ideal, shaft_orders
from rigdesign.prediction.orders import numbers as order_numbers
from rigdesign.prediction.readings import Reading, Settled
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import gear_oil
from thermal.conditions.boundary import Exchange, Film, Radiation
from thermal.conditions.contact import Contact
from thermal.conduction.reduced import Link, Projection
from thermal.fe.mesh import FloatArray

STEP = 0.3
"""Step of a difference in the sizes of the coupling state: 0.3 K, 0.3 um, 3 W, 0.3 N m."""

Named = Sequence[tuple[Channel, Reading]]


@dataclass(frozen=True)
class Directions:
    """How coupling state and readings follow the temperature shapes of a housing, the same at all points."""

    coupling_state: FloatArray
    """(n, m)"""
    readings: FloatArray
    """(f, m)"""


@dataclass(frozen=True)
class SensitivityNumbers:
    """What the iterations of a point found out: plain numbers, so that another process can send them.

    loop : (n, n) slope of an iteration by its coupling state; follow : (f, n) of the readings; near : answers of
    `LinearisedDrag`
    """

    loop: FloatArray
    follow: FloatArray
    near: Mapping[Cause, FloatArray]


@dataclass(frozen=True)
class Answer:
    """What an iteration near a settled point gives.

    readings : (f,); handed : (n,) what it hands on, in sizes of `SCALES`
    same_loop : whether the loop is that of the point but for its drags and the friction of its teeth
    """

    readings: FloatArray
    handed: FloatArray
    same_loop: bool


class PointSensitivities:
    """First-order answers of one settled point.

    reads : readings of the channels; directions : by gearbox, see `directions_of`; known : the slopes, where they
    were found before
    """

    def __init__(
        self,
        rig: Rig,
        settled: SettledPoint,
        housings: ReducedHousings,
        parts: IterationParts,
        reads: Named,
        directions: Mapping[str, Directions],
        known: SensitivityNumbers | None = None,
    ) -> None:
        self.rig, self.settled, self._housings, self._parts, self._reads = (
            rig,
            settled,
            housings,
            parts,
            reads,
        )
        self._directions = directions
        self.coupling_state = settled.last.coupling_state
        self.near = LinearisedDrag(rig, settled, parts, reads, None if known is None else known.near)
        self._g = flat(raw(rig, settled.last, parts, self.coupling_state))
        self._y = np.array([number for _, reading in reads for number in reading(rig, settled)])
        self.index = _index(self.coupling_state)
        numbers = known or self._found()
        self.loop = numbers.loop
        """(n, n) slope of an iteration by its coupling state."""
        self.follow = numbers.follow
        """(f, n) slope of the readings by the coupling state."""
        self.inverse = np.linalg.inv(np.eye(len(self._g)) - self.loop)
        """(n, n) how far the coupling state moves until the loop has settled, per change of what an iteration hands
        on."""
        self._closed = self.follow @ self.inverse
        """(f, n) settled readings per change of what an iteration hands on."""

    @property
    def numbers(self) -> SensitivityNumbers:
        """The slopes."""
        return SensitivityNumbers(self.loop, self.follow, self.near.slopes)

    def _found(self) -> SensitivityNumbers:
        """The slopes, from one iteration per number of the coupling state."""
        x = flat(self.coupling_state)
        slopes, readings = [], []
        for number in self.index.values():
            moved = x.copy()
            moved[number] += STEP
            done = self._pass(
                self.rig, self.settled.point, unflat(moved, self.coupling_state), self.settled.bracing
            )
            slopes.append((done.handed - self._g) / STEP)
            readings.append((done.readings - self._y) / STEP)
        return SensitivityNumbers(np.array(slopes).T, np.array(readings).T, self.near.slopes)

    @property
    def readings(self) -> FloatArray:
        """(f,) settled readings."""
        return self._y

    def answer(self, handed: FloatArray, read: FloatArray) -> FloatArray:
        """(f, ...) settled answer to changes of what an iteration hands on (n, ...) and of the readings (f, ...)."""
        return np.asarray(read + self._closed @ handed)

    def corrected(self, point: SettledPoint) -> FloatArray:
        """(f,) what the readings of a point nearby lack: its last step of the loop, beyond that of the point here."""
        return np.asarray(self._closed @ (point.left - self.settled.left))

    def changed(self, rig: Rig, point: OperatingPoint, bracing: Bracing | None) -> Answer:
        """Settled readings of a rig or setting nearby, from one iteration of it."""
        done = self._pass(rig, point, self.coupling_state, bracing)
        return replace(done, readings=self._y + self.answer(done.handed - self._g, done.readings - self._y))

    def links(self) -> dict[str, FloatArray]:
        """Name -> (f,) answer to the logarithm of every local conductance of the housings, and to how oil mixes."""
        found: dict[str, FloatArray] = {}
        for name, field in self._fields():
            system = Projection(self._housings.bases[name].reduced, field.conditions)
            links = system.links(field.coefficients)
            answers = -system.answers(field.coefficients, np.array([link.column for link in links]).T)
            by_field = self._handed(name, links)
            handed = by_field @ answers
            for number, link in enumerate(links):
                heat = self._heat_of(name, link)
                if heat is not None:
                    handed[heat, number] += link.heat / _scale(heat, self.index)
            read = self._directions[name].readings @ answers
            whole = self.answer(handed, read)
            for number, link in enumerate(links):
                label = link_name(name, link)
                found[label] = found.get(label, 0.0) + whole[:, number]
            found[f"mixing:{name}.{GEAR_OIL}"] = self._unmixed(name, field, system, by_field)
        return found

    def _unmixed(
        self, name: str, field: ReducedField, system: Projection, by_field: FloatArray
    ) -> FloatArray:
        """(f,) answer where turning parts are wetted by gear oil as it leaves the teeth, not by its mean.

        by_field : (n, m) what an iteration hands on by the coefficients of the housing
        """
        reduced = self._housings.bases[name].reduced
        hotter = _fresh_over_mean(self.rig, name, self.settled.last)
        load, taken = np.zeros(reduced.size), 0.0
        for condition in field.conditions:
            if (
                isinstance(condition, Film)
                and condition.kind == GEAR_OIL
                and condition.surface.startswith(TURNING)
            ):
                surface = reduced.surface(condition.surface)
                wall = float(surface.mean @ field.coefficients)
                heat = condition.law(wall, condition.fluid_temperature).value * surface.area * hotter
                load += heat * surface.mean
                taken += heat
        answers = system.answers(field.coefficients, load[:, None])
        handed = (by_field @ answers)[:, 0]
        oil = self.index.get(("wall_heat", f"{name}.{GEAR_OIL}"))
        if oil is not None:
            handed[oil] -= taken / _scale(oil, self.index)
        return self.answer(handed, (self._directions[name].readings @ answers)[:, 0])

    def sources(self) -> dict[str, FloatArray]:
        """Name -> (f,) answer per watt put in: bodies, rims, bearings, films, oil streams, sensors."""
        found: dict[str, FloatArray] = {}
        for name, field in self._fields():
            reduced = self._housings.bases[name].reduced
            system = Projection(reduced, field.conditions)
            loads = {f"body:{name}.{body}": reduced.body(body) for body in reduced.setup.mesh.bodies}
            box = self.rig.case.gearboxes[name]
            for gear, surface in rim_surfaces(box).items():
                loads[f"rim:{name}.{gear}"] = reduced.surface(surface).mean
            for bearing, entry in box.bearings.items():
                surface = f"bearing_bore_{entry.shaft}_{entry.side}"
                if surface in reduced.setup.mesh.surfaces:
                    loads[f"bore:{name}.{bearing}"] = reduced.surface(surface).mean
            loads |= self._at_sensors(name)
            answers = system.answers(field.coefficients, np.array(list(loads.values())).T)
            handed = self._handed(name, system.links(field.coefficients)) @ answers
            whole = self.answer(handed, self._directions[name].readings @ answers)
            found |= {label: whole[:, number] for number, label in enumerate(loads)}
        for (arrow, place), number in self.index.items():
            kind = {"bearing_heat": "film", "wall_heat": "oil"}.get(arrow)
            if kind is not None:
                scale = _scale(number, self.index)
                answer = self.answer(self.loop[:, number], self.follow[:, number])
                found[f"{kind}:{place}"] = answer / scale
        return found

    def _at_sensors(self, name: str) -> dict[str, FloatArray]:
        """Source -> (m,) load of a watt at each thermocouple of a housing: as the shapes are read there."""
        found = {}
        row = 0
        for channel, _ in self._reads:
            if channel.quantity == "temperature" and channel.place == name:
                found[f"near:{channel.name}"] = self._directions[name].readings[row]
            row += numbers_of(channel)
        return found

    def _fields(self) -> list[tuple[str, ReducedField]]:
        fields = self.settled.last.fields
        return [(name, field) for name, field in fields.items() if isinstance(field, ReducedField)]

    def _handed(self, name: str, links: Sequence[Link]) -> FloatArray:
        """(n, m) what an iteration hands on by the coefficients of a housing: thermal expansion, gear bulk, heats of
        its films."""
        handed = self._directions[name].coupling_state.copy()
        for link in links:
            heat = self._heat_of(name, link)
            if heat is not None:
                handed[heat] += link.heat_slope / _scale(heat, self.index)
        return handed

    def _heat_of(self, name: str, link: Link) -> int | None:
        """Number of the coupling state that counts the heat of a film."""
        if not isinstance(link.condition, Film):
            return None
        kind, _, part = link.condition.kind.partition(":")
        if kind == BEARING_FILM:
            return self.index.get(("bearing_heat", f"{name}.{part}"))
        return self.index.get(("wall_heat", f"{name}.{kind}")) if kind in (GEAR_OIL, BEARING_OIL) else None

    def _pass(
        self, rig: Rig, point: OperatingPoint, coupling_state: CouplingState, bracing: Bracing | None
    ) -> Answer:
        """An iteration with what it hands on and what is read of it; the loop to first order where it is nearly the
        same."""
        causes: dict[Cause, float] | None = None

        def response(
            rig: Rig,
            point: OperatingPoint,
            models: tuple[MeshModel, ...],
            drags: Mapping[str, float],
            setting: Bracing,
        ) -> CurvePoint:
            nonlocal causes
            causes = self.near.causes(rig, point, models, drags, setting)
            if causes is None:
                return self._parts.response(rig, point, models, drags, setting)
            return self.near.response(causes)

        parts = replace(self._parts, response=response)
        done = run_iteration(rig, point, coupling_state, bracing, self.settled.last, parts=parts)
        settled = Settled(point, done, bracing)
        near = None if causes is None else iter(self.near.orders(causes).tolist())
        orders = {} if near is not None else self._orders(rig, done, bracing)
        read: list[float] = []
        for channel, reading in self._reads:
            if channel.quantity not in ORDER_QUANTITIES:
                read += reading(rig, settled)
            elif near is not None:
                read += islice(near, numbers_of(channel))
            else:
                read += order_numbers(channel, orders)
        handed = flat(raw(rig, done, self._parts, self.coupling_state))
        return Answer(readings=np.array(read), handed=handed, same_loop=near is not None)

    def _orders(self, rig: Rig, done: IterationResult, bracing: Bracing | None) -> Orders:
        """Orders after an iteration. Raises NotConverged where contacts would have to be followed exactly."""
        read = [channel for channel, _ in self._reads if channel.quantity in ORDER_QUANTITIES]
        if not read:
            return {}
        assert bracing is not None
        ideal = done.response if is_ideal(rig) else None
        return shaft_orders(rig, done.point, done.models, done.drags, bracing, read, base=ideal, exact=False)


TURNING = ("gear_", "shaft_")
"""How the surfaces of turning parts begin."""


def _fresh_over_mean(rig: Rig, name: str, last: IterationResult) -> float:
    """Gear oil as it leaves the teeth, warmed by all losses and not yet cooled by walls, over its mean [K]."""
    own = [placed for placed in last.losses if placed.gearbox == name]
    heat = sum(placed.into_oil - placed.into_bearing_oil for placed in own)
    box, oil = rig.case.gearboxes[name], gear_oil(rig, name)
    inlet = box.oil.inlet_temperature
    rise = heat / (oil.density(inlet) * oil.heat_capacity(inlet) * box.oil.flow * len(box.meshes))
    chamber = next(stream.chamber for stream in last.streams if stream.name == f"{name}.{GEAR_OIL}")
    return rise - 0.5 * (chamber - inlet)


def link_name(gearbox: str, link: Link) -> str:
    """How a conductance is called: kind, gearbox, surface or pair of surfaces."""
    match link.condition:
        case Film(surface=surface):
            bearing = link.condition.kind.startswith(BEARING_FILM)
            return f"{'bearing_film' if bearing else 'film'}:{gearbox}.{surface}"
        case Radiation(surface=surface):
            return f"radiation:{gearbox}.{surface}"
        case Exchange(surface_a=first, surface_b=second):
            return f"exchange:{gearbox}.{first}|{second}"
        case Contact(surface_a=first, surface_b=second):
            return f"contact:{gearbox}.{first}|{second}"
    raise TypeError(f"no link: {type(link.condition).__name__}")


def directions_of(
    rig: Rig, settled: SettledPoint, housings: ReducedHousings, parts: IterationParts, reads: Named
) -> dict[str, Directions]:
    """How coupling state and readings follow the shapes of every housing; heats of films are left out."""
    last = settled.last
    like = last.coupling_state
    first = flat(raw(rig, last, parts, like))

    def readings(done: IterationResult) -> FloatArray:
        settled_there = Settled(done.point, done, settled.bracing)
        return np.array(
            [number for channel, read in reads for number in _of_field(channel, read, rig, settled_there)]
        )

    here = readings(last)
    found = {}
    for name, field in last.fields.items():
        assert isinstance(field, ReducedField)
        shapes = housings.bases[name].reduced.shapes
        expansion: ExpansionMap | None = housings.expansions.get(name)
        by_feedback, by_readings = [], []
        for number in range(shapes.shape[1]):
            coefficients = field.coefficients.copy()
            coefficients[number] += STEP
            temperature = field.temperature + STEP * shapes[:, number]
            moved = replace(
                field, coefficients=coefficients, solution=replace(field.solution, temperature=temperature)
            )
            expanded = (
                last.expansion if expansion is None else {**last.expansion, name: expansion.at(coefficients)}
            )
            done = replace(last, fields={**last.fields, name: moved}, expansion=expanded)
            by_feedback.append((flat(raw(rig, done, parts, like)) - first) / STEP)
            by_readings.append((readings(done) - here) / STEP)
        found[name] = Directions(np.array(by_feedback).T, np.array(by_readings).T)
    return found


def _of_field(channel: Channel, read: Reading, rig: Rig, settled: Settled) -> Sequence[float]:
    """Readings that depend on a field itself; zeros for the others, which follow the coupling state."""
    if channel.quantity in ("temperature", "seal_gap"):
        return read(rig, settled)
    return [0.0] * numbers_of(channel)


def numbers_of(channel: Channel) -> int:
    """How many numbers a channel gives at a point."""
    return sum(2 if order else 1 for order in channel.orders) if channel.orders else 1


def _index(coupling_state: CouplingState) -> dict[tuple[str, str], int]:
    """(arrow, place) -> number in the flat coupling state."""
    names = [
        (arrow, place)
        for arrow in coupling_state.__dataclass_fields__
        for place in getattr(coupling_state, arrow)
    ]
    return {name: number for number, name in enumerate(names)}


def _scale(number: int, index: Mapping[tuple[str, str], int]) -> float:
    """Size of a number of the coupling state [W for a heat]."""
    return SCALES[list(index)[number][0]]
