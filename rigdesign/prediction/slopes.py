"""First-order answers of a settled point: what a small change anywhere does once the loop has followed.

With the feedback x of a point, the passes x -> g(x) and the readings y(x), a change that moves g by dg and the
readings by dy at a fixed x moves the settled readings by dy + Y (1 - G)^-1 dg, G and Y the slopes of g and y by x.
These come from one pass per number of the feedback; what is changed in the housings (conductances, sources) is
answered on the temperature shapes.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from dynamics.response_curve import CurvePoint
from rigdesign.drags import drag_shafts
from rigdesign.flank_heat import rim_surfaces
from rigdesign.loads import MeshModel
from rigdesign.loads import Setting as Bracing
from rigdesign.passes import Parts, PassResult, one_pass
from rigdesign.prediction.growth_map import GrowthMap
from rigdesign.prediction.housings import ReducedField, ReducedHousings
from rigdesign.prediction.memory import balanced
from rigdesign.prediction.model import ORDER_QUANTITIES, Channel
from rigdesign.prediction.readings import Reading, Settled
from rigdesign.prediction.settle import SCALES, SettledPoint, flat, raw, unflat
from rigdesign.rig.boundary import BEARING_FILM, BEARING_OIL, GEAR_OIL
from rigdesign.rig.model import Rig
from rigdesign.state import Feedback, OperatingPoint
from thermal.boundary import Exchange, Film, Radiation
from thermal.contact import Contact
from thermal.fe.mesh import FloatArray
from thermal.reduced import Link, Projection

STEP = 0.3
"""Step of a difference in the sizes of the feedback: 0.3 K, 0.3 um, 3 W, 0.3 N m."""
OF_BEARINGS = ("bearing_clearance", "bearing_heat")
"""Arrows that reach the loop only as drag."""

Named = Sequence[tuple[Channel, Reading]]


@dataclass(frozen=True)
class Directions:
    """How feedback and readings follow the temperature shapes of a housing, the same at all points."""

    feedback: FloatArray
    """(n, m)"""
    readings: FloatArray
    """(f, m)"""


class PointSlopes:
    """First-order answers of one settled point.

    reads : readings of the channels; directions : by gearbox, see `directions_of`
    """

    def __init__(
        self,
        rig: Rig,
        settled: SettledPoint,
        housings: ReducedHousings,
        parts: Parts,
        reads: Named,
        directions: Mapping[str, Directions],
    ) -> None:
        self.rig, self.settled, self._housings, self._parts, self._reads = (
            rig,
            settled,
            housings,
            parts,
            reads,
        )
        self._directions = directions
        self.feedback = settled.last.feedback
        self._g = flat(raw(rig, settled.last, parts, self.feedback))
        self._y = self._read(settled.last)
        x = flat(self.feedback)
        slopes, readings = [], []
        self.index = _index(self.feedback)
        for (arrow, _), number in self.index.items():
            moved = x.copy()
            moved[number] += STEP
            light = replace(parts, response=self._drag_only) if arrow in OF_BEARINGS else parts
            done = self._pass(rig, unflat(moved, self.feedback), light)
            slopes.append((flat(raw(rig, done, parts, self.feedback)) - self._g) / STEP)
            readings.append((self._read(done) - self._y) / STEP)
        self.loop = np.array(slopes).T
        """(n, n) slope of a pass by its feedback."""
        self.follow = np.array(readings).T
        """(f, n) slope of the readings by the feedback."""
        self.inverse = np.linalg.inv(np.eye(len(x)) - self.loop)
        """(n, n) how far the feedback moves until the loop has settled, per change of what a pass hands on."""
        self._closed = self.follow @ self.inverse
        """(f, n) settled readings per change of what a pass hands on."""

    @property
    def readings(self) -> FloatArray:
        """(f,) settled readings."""
        return self._y

    def answer(self, handed: FloatArray, read: FloatArray) -> FloatArray:
        """(f, ...) settled answer to changes of what a pass hands on (n, ...) and of the readings (f, ...)."""
        return np.asarray(read + self._closed @ handed)

    def corrected(self, point: SettledPoint) -> FloatArray:
        """(f,) what the readings of a point nearby lack: its last step of the loop, beyond that of the point here."""
        return np.asarray(self._closed @ (point.left - self.settled.left))

    def changed(self, rig: Rig, point: OperatingPoint, bracing: Bracing | None) -> FloatArray:
        """(f,) settled readings of a rig or setting nearby, from one pass of it."""
        last = self.settled.last
        done = one_pass(rig, point, self.feedback, bracing, last, parts=self._parts)
        handed = flat(raw(rig, done, self._parts, self.feedback)) - self._g
        settled = Settled(point, done, bracing)
        read = np.array([number for _, reading in self._reads for number in reading(rig, settled)])
        return self._y + self.answer(handed, read - self._y)

    def links(self) -> dict[str, FloatArray]:
        """Name -> (f,) answer to the logarithm of every local conductance of the housings."""
        found: dict[str, FloatArray] = {}
        for name, field in self._fields():
            system = Projection(self._housings.bases[name].reduced, field.conditions)
            links = system.links(field.coefficients)
            answers = -system.answers(field.coefficients, np.array([link.column for link in links]).T)
            handed = self._handed(name, links) @ answers
            for number, link in enumerate(links):
                heat = self._heat_of(name, link)
                if heat is not None:
                    handed[heat, number] += link.heat / _scale(heat, self.index)
            read = self._directions[name].readings @ answers
            whole = self.answer(handed, read)
            for number, link in enumerate(links):
                label = link_name(name, link)
                found[label] = found.get(label, 0.0) + whole[:, number]
        return found

    def sources(self) -> dict[str, FloatArray]:
        """Name -> (f,) answer per watt put in: bodies, rims, bearing bores and journals, films, oil streams."""
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

    def _fields(self) -> list[tuple[str, ReducedField]]:
        fields = self.settled.last.fields
        return [(name, field) for name, field in fields.items() if isinstance(field, ReducedField)]

    def _handed(self, name: str, links: Sequence[Link]) -> FloatArray:
        """(n, m) what a pass hands on by the coefficients of a housing: growth, gear bulk, heats of its films."""
        handed = self._directions[name].feedback.copy()
        for link in links:
            heat = self._heat_of(name, link)
            if heat is not None:
                handed[heat] += link.heat_slope / _scale(heat, self.index)
        return handed

    def _heat_of(self, name: str, link: Link) -> int | None:
        """Number of the feedback that counts the heat of a film."""
        if not isinstance(link.condition, Film):
            return None
        kind, _, part = link.condition.kind.partition(":")
        if kind == BEARING_FILM:
            return self.index.get(("bearing_heat", f"{name}.{part}"))
        return self.index.get(("wall_heat", f"{name}.{kind}")) if kind in (GEAR_OIL, BEARING_OIL) else None

    def _pass(self, rig: Rig, feedback: Feedback, parts: Parts) -> PassResult:
        last = self.settled.last
        return one_pass(rig, last.point, feedback, self.settled.bracing, last, parts=parts)

    def _read(self, done: PassResult) -> FloatArray:
        """(f,) readings of a pass; of orders those of the point where the meshes are its own.

        The drag of a bearing then moves no mean torque of a coupling: it would do so by its share of a per mille.
        """
        same = done.models is self.settled.last.models
        settled = self.settled if same else Settled(done.point, done, self.settled.bracing)
        fresh = Settled(done.point, done, self.settled.bracing)
        return np.array(
            [
                number
                for channel, reading in self._reads
                for number in reading(self.rig, settled if channel.quantity in ORDER_QUANTITIES else fresh)
            ]
        )

    def _drag_only(
        self,
        rig: Rig,
        point: OperatingPoint,
        models: tuple[MeshModel, ...],
        drags: Mapping[str, float],
        setting: Bracing,
    ) -> CurvePoint:
        """The response with other drags: the motor pays, the loop hardly feels it."""
        last = self.settled.last
        assert last.response is not None and rig.drivetrain is not None
        shafts = drag_shafts(rig.drivetrain)
        braked = sum(
            (drag - last.drags.get(place, 0.0)) * rig.shaft_speed(shafts[place], point.speed)
            for place, drag in drags.items()
        )
        return balanced(last.response, rig, point.speed, braked)


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
    rig: Rig, settled: SettledPoint, housings: ReducedHousings, parts: Parts, reads: Named
) -> dict[str, Directions]:
    """How feedback and readings follow the shapes of every housing; heats of films are left out."""
    last = settled.last
    like = last.feedback
    first = flat(raw(rig, last, parts, like))

    def readings(done: PassResult) -> FloatArray:
        settled_there = Settled(done.point, done, settled.bracing)
        return np.array(
            [number for channel, read in reads for number in _of_field(channel, read, rig, settled_there)]
        )

    here = readings(last)
    found = {}
    for name, field in last.fields.items():
        assert isinstance(field, ReducedField)
        shapes = housings.bases[name].reduced.shapes
        growth: GrowthMap | None = housings.growths.get(name)
        by_feedback, by_readings = [], []
        for number in range(shapes.shape[1]):
            coefficients = field.coefficients.copy()
            coefficients[number] += STEP
            temperature = field.temperature + STEP * shapes[:, number]
            moved = replace(
                field, coefficients=coefficients, solution=replace(field.solution, temperature=temperature)
            )
            grown = last.growth if growth is None else {**last.growth, name: growth.at(coefficients)}
            done = replace(last, fields={**last.fields, name: moved}, growth=grown)
            by_feedback.append((flat(raw(rig, done, parts, like)) - first) / STEP)
            by_readings.append((readings(done) - here) / STEP)
        found[name] = Directions(np.array(by_feedback).T, np.array(by_readings).T)
    return found


def _of_field(channel: Channel, read: Reading, rig: Rig, settled: Settled) -> Sequence[float]:
    """Readings that hang on a field itself; zeros for the others, which follow the feedback."""
    if channel.quantity in ("temperature", "seal_gap"):
        return read(rig, settled)
    return [0.0] * (sum(2 if order else 1 for order in channel.orders) if channel.orders else 1)


def _index(feedback: Feedback) -> dict[tuple[str, str], int]:
    """(arrow, place) -> number in the flat feedback."""
    names = [(arrow, place) for arrow in feedback.__dataclass_fields__ for place in getattr(feedback, arrow)]
    return {name: number for number, name in enumerate(names)}


def _scale(number: int, index: Mapping[tuple[str, str], int]) -> float:
    """Size of a number of the feedback [W for a heat]."""
    return SCALES[list(index)[number][0]]
