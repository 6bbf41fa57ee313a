"""First-order response to what happens in a housing: its conductances, heat sources and the mixing of its oil.

The change is solved in the reduced basis of the housing; the coupling loop follows by the sensitivities of the point.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rigdesign.coupling.flank_heat import rim_surfaces
from rigdesign.coupling.housing_context import BEARING_FILM, BEARING_OIL, GEAR_OIL
from rigdesign.coupling.iteration import IterationResult
from rigdesign.prediction.converged_point import ConvergedPoint, unrelaxed_vector
from rigdesign.prediction.housings import ExpansionMap, ReducedField, ReducedHousings
from rigdesign.prediction.model import Channel
from rigdesign.prediction.readings import Reading, Readings, count_of
from rigdesign.prediction.sensitivities import STEP, PointSensitivities
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import gear_feed
from thermal.conditions.boundary import Exchange, Film, Radiation
from thermal.conditions.contact import Contact
from thermal.conditions.enclosure import Enclosure
from thermal.conduction.reduced import Link, Projection, ReducedConduction
from thermal.fe.mesh import FloatArray

ROTATING = ("gear_", "shaft_")
"""How the surfaces of rotating parts begin."""


@dataclass(frozen=True)
class FieldDerivatives:
    """Derivatives by the coefficients of a housing's reduced basis (m), the same at all points."""

    unrelaxed: FloatArray
    """(n, m) of what an iteration hands on, heats of films left out."""
    readings: FloatArray
    """(f, m)"""


def field_derivatives(
    converged: ConvergedPoint, housings: ReducedHousings, reads: Readings
) -> dict[str, FieldDerivatives]:
    """`FieldDerivatives` of every housing."""
    problem, last = converged.problem, converged.last
    like = last.coupling_state
    first = unrelaxed_vector(problem.rig, last, problem.parts, like)

    def readings(done: IterationResult) -> FloatArray:
        return np.array(
            [number for channel, read in reads for number in _of_field(channel, read, problem.rig, done)]
        )

    here = readings(last)
    found = {}
    for name, field in last.fields.items():
        assert isinstance(field, ReducedField)
        basis = housings.bases[name].reduced.shapes
        expansion: ExpansionMap | None = housings.expansions.get(name)
        by_coefficient, by_readings = [], []
        for number in range(basis.shape[1]):
            moved = _moved(field, number, basis[:, number])
            expanded = dict(last.expansion)
            if expansion is not None:
                expanded[name] = expansion.at(moved.coefficients)
            done = replace(last, fields={**last.fields, name: moved}, expansion=expanded)
            by_coefficient.append((unrelaxed_vector(problem.rig, done, problem.parts, like) - first) / STEP)
            by_readings.append((readings(done) - here) / STEP)
        found[name] = FieldDerivatives(np.array(by_coefficient).T, np.array(by_readings).T)
    return found


def _moved(field: ReducedField, number: int, vector: FloatArray) -> ReducedField:
    """The field with one coefficient moved by `STEP`; vector : (n_nodes,) its basis vector."""
    coefficients = field.coefficients.copy()
    coefficients[number] += STEP
    solution = replace(field.solution, temperature=field.temperature + STEP * vector)
    return replace(field, coefficients=coefficients, solution=solution)


def _of_field(channel: Channel, read: Reading, rig: Rig, done: IterationResult) -> Sequence[float]:
    """Readings that depend on a field itself; zeros for the others, which follow the coupling state."""
    if channel.quantity in ("temperature", "seal_gap"):
        return read(rig, done)
    return [0.0] * count_of(channel)


@dataclass(frozen=True)
class HeatResponses:
    """What one watt on each vector of the basis (m) does at a fixed coupling state."""

    coefficients: FloatArray
    """(m, m) [K/W]"""
    unrelaxed: FloatArray
    """(n, m) of what an iteration hands on."""
    readings: FloatArray
    """(f, m)"""


class HousingSensitivities:
    """First-order response of a converged point to changes in one housing.

    field : of the housing at the point; reduced : its basis; derivatives : by its coefficients
    """

    def __init__(
        self,
        point: PointSensitivities,
        field: ReducedField,
        reduced: ReducedConduction,
        derivatives: FieldDerivatives,
    ) -> None:
        self._point, self._field, self._reduced, self._derivatives = point, field, reduced, derivatives
        self._name = field.gearbox
        self._projection = Projection(reduced, field.conditions)
        self._links = self._projection.links(field.coefficients)

    @property
    def coefficients(self) -> FloatArray:
        """(m,) of the field at the point."""
        return self._field.coefficients

    def uniform(self, temperature: float) -> FloatArray:
        """(m,) coefficients of a housing of one temperature [K]; the first vector of the basis is the constant."""
        found = np.zeros(self._reduced.size)
        found[0] = temperature
        return found

    def capacity(self) -> FloatArray:
        """(m, m) heat capacities of the bodies [J/K]."""
        materials = self._point.problem.rig.body_materials(self._name)
        return self._reduced.capacity_of({b: m.density * m.heat_capacity for b, m in materials.items()})

    def heat_responses(self) -> HeatResponses:
        """Responses to heat on each vector of the basis."""
        changes = self._projection.answers(self._field.coefficients, np.eye(self._reduced.size))
        return HeatResponses(changes, self._by_coefficients() @ changes, self._derivatives.readings @ changes)

    def links(self) -> dict[str, FloatArray]:
        """Name -> (f,) derivative by the logarithm of every local conductance, and by how oil mixes."""
        found: dict[str, FloatArray] = {}
        changes = -self._projection.answers(
            self._field.coefficients, np.array([link.column for link in self._links]).T
        )
        by_field = self._by_coefficients()
        unrelaxed = by_field @ changes
        for number, link in enumerate(self._links):
            heat = self._heat_of(link)
            if heat is not None:
                unrelaxed[heat, number] += link.heat / self._point.scale(heat)
        whole = self._point.followed(unrelaxed, self._derivatives.readings @ changes)
        for number, link in enumerate(self._links):
            label = link_name(self._name, link)
            found[label] = found.get(label, 0.0) + whole[:, number]
        found[f"mixing:{self._name}.{GEAR_OIL}"] = self._unmixed(by_field)
        return found

    def _unmixed(self, by_field: FloatArray) -> FloatArray:
        """(f,) response where rotating parts are wetted by gear oil as it leaves the teeth, not by its mean.

        by_field : (n, m) what an iteration hands on by the coefficients
        """
        name, field, point = self._name, self._field, self._point
        hotter = _fresh_over_mean(point.problem.rig, name, point.last)
        load, taken = np.zeros(self._reduced.size), 0.0
        for condition in field.conditions:
            if (
                isinstance(condition, Film)
                and condition.kind == GEAR_OIL
                and condition.surface.startswith(ROTATING)
            ):
                surface = self._reduced.surface(condition.surface)
                wall = float(surface.mean @ field.coefficients)
                heat = condition.law(wall, condition.fluid_temperature).value * surface.area * hotter
                load += heat * surface.mean
                taken += heat
        changes = self._projection.answers(field.coefficients, load[:, None])
        unrelaxed = (by_field @ changes)[:, 0]
        oil = point.index.get(("wall_heat", f"{name}.{GEAR_OIL}"))
        if oil is not None:
            unrelaxed[oil] -= taken / point.scale(oil)
        return point.followed(unrelaxed, (self._derivatives.readings @ changes)[:, 0])

    def sources(self, reads: Readings) -> dict[str, FloatArray]:
        """Name -> (f,) response per watt put in: bodies, rims, bearing bores, thermocouples."""
        name, reduced = self._name, self._reduced
        loads = {f"body:{name}.{body}": reduced.body(body) for body in reduced.setup.mesh.bodies}
        box = self._point.problem.rig.case.gearboxes[name]
        for gear, surface in rim_surfaces(box).items():
            loads[f"rim:{name}.{gear}"] = reduced.surface(surface).mean
        for bearing, entry in box.bearings.items():
            surface = f"bearing_bore_{entry.shaft}_{entry.side}"
            if surface in reduced.setup.mesh.surfaces:
                loads[f"bore:{name}.{bearing}"] = reduced.surface(surface).mean
        loads |= self._at_sensors(reads)
        changes = self._projection.answers(self._field.coefficients, np.array(list(loads.values())).T)
        unrelaxed = self._by_coefficients() @ changes
        whole = self._point.followed(unrelaxed, self._derivatives.readings @ changes)
        return {label: whole[:, number] for number, label in enumerate(loads)}

    def _at_sensors(self, reads: Readings) -> dict[str, FloatArray]:
        """Source -> (m,) load of a watt at each thermocouple of the housing: as the basis is read there."""
        found = {}
        row = 0
        for channel, _ in reads:
            if channel.quantity == "temperature" and channel.place == self._name:
                found[f"near:{channel.name}"] = self._derivatives.readings[row]
            row += count_of(channel)
        return found

    def _by_coefficients(self) -> FloatArray:
        """(n, m) what an iteration hands on by the coefficients: thermal expansion, gear bulk, heats of its films."""
        by_field = self._derivatives.unrelaxed.copy()
        for link in self._links:
            heat = self._heat_of(link)
            if heat is not None:
                by_field[heat] += link.heat_slope / self._point.scale(heat)
        return by_field

    def _heat_of(self, link: Link) -> int | None:
        """Number of the coupling state that counts the heat of a film."""
        if not isinstance(link.condition, Film):
            return None
        kind, _, part = link.condition.kind.partition(":")
        if kind == BEARING_FILM:
            return self._point.index.get(("bearing_heat", f"{self._name}.{part}"))
        if kind in (GEAR_OIL, BEARING_OIL):
            return self._point.index.get(("wall_heat", f"{self._name}.{kind}"))
        return None


def stream_sources(point: PointSensitivities) -> dict[str, FloatArray]:
    """Name -> (f,) response per watt put into bearing films and oil streams."""
    found = {}
    for (arrow, place), number in point.index.items():
        kind = {"bearing_heat": "film", "wall_heat": "oil"}.get(arrow)
        if kind is not None:
            followed = point.followed(point.loop[:, number], point.by_state[:, number])
            found[f"{kind}:{place}"] = followed / point.scale(number)
    return found


def _fresh_over_mean(rig: Rig, name: str, last: IterationResult) -> float:
    """Gear oil as it leaves the teeth, warmed by all losses and not yet cooled by walls, over its mean [K]."""
    own = [placed for placed in last.losses if placed.gearbox == name]
    heat = sum(placed.into_oil - placed.into_bearing_oil for placed in own)
    chamber = next(stream.chamber for stream in last.streams if stream.name == f"{name}.{GEAR_OIL}")
    feed = gear_feed(rig, name, chamber, last.coupling_state.oil_supply)
    if feed.flow == 0.0:
        return 0.0
    return heat / feed.capacity_rate - 0.5 * (chamber - feed.inlet)


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
        case Enclosure(name=name):
            return f"enclosure:{gearbox}.{name}"
    raise TypeError(f"no link: {type(link.condition).__name__}")
