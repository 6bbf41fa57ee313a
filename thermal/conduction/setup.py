"""Conduction on one mesh before it is solved: conditions checked against the mesh; matrices, joints."""

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from difflib import get_close_matches

import numpy as np
from scipy import sparse

from thermal.conditions.boundary import (
    Adiabatic,
    BodySource,
    BoundaryCondition,
    ConditionError,
    Exchange,
    Film,
    PrescribedTemperature,
    Radiation,
    SurfaceSource,
)
from thermal.conditions.contact import Contact, SurfaceJoint, covered, join
from thermal.conditions.enclosure import Enclosure, check_enclosure
from thermal.conditions.streams import StreamNetwork, check_networks
from thermal.conduction.capacity import Conductivity, HeatCapacity, StoredHeat, VariableConduction
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import FloatArray, NamedMesh
from thermal.films.law import STEFAN_BOLTZMANN, FilmCoefficient, FilmLaw, not_negative, positive

# Conditions checked against a mesh: names, values, open surfaces, bodies that cannot lose heat.

Condition = BoundaryCondition | Contact | Enclosure | StreamNetwork | StoredHeat
"""Everything that the conduction problem takes."""


def surfaces_of(condition: Condition) -> tuple[str, ...]:
    """Surfaces a condition acts on; none for a body source and for stored heat."""
    match condition:
        case BodySource() | StoredHeat():
            return ()
        case Exchange() | Contact():
            return (condition.surface_a, condition.surface_b)
        case Enclosure():
            return condition.surfaces
        case StreamNetwork():
            return tuple(film.surface for film in condition.films)
    return (condition.surface,)


def check_conditions(elements: FiniteElements, conditions: Sequence[Condition]) -> None:
    """Check ``conditions`` against the mesh.

    Raises ConditionError for unknown names (nearest ones offered), impossible values, surfaces without any
    condition, contradicting or repeated conditions, prescribed surfaces that meet at different temperatures,
    and networks or enclosures that do not hold together.
    """
    mesh = elements.mesh
    for condition in conditions:
        for name in surfaces_of(condition):
            _require_known("surface", name, mesh.surfaces)
        if isinstance(condition, BodySource):
            _require_known("body", condition.body, mesh.bodies)
        if isinstance(condition, Enclosure):
            check_enclosure(condition)
        _check_values(condition)
    networks = [c for c in conditions if isinstance(c, StreamNetwork)]
    check_networks(networks)
    _check_places(networks, {*mesh.surfaces, *mesh.bodies})
    _check_combinations(conditions)
    _check_open(elements, conditions)
    _check_prescribed(elements, conditions)


def _check_places(networks: Sequence[StreamNetwork], taken: Collection[str]) -> None:
    for network in networks:
        for place in network.places:
            if place in taken:
                raise ConditionError(
                    f"volume or supply {place!r} has the name of a surface or body; rename it, rows of the "
                    "heat balance go by name"
                )


def check_conductivity(bodies: Collection[str], conductivity: Mapping[str, Conductivity]) -> None:
    """Check that every body has a conductivity and no other is named (ConditionError).

    Numbers [W/(m K)] must be positive; laws are checked at the temperatures that occur.
    """
    for name in conductivity:
        _require_known("body", name, bodies)
    missing = sorted(set(bodies) - set(conductivity))
    if missing:
        raise ConditionError(f"no conductivity for body {', '.join(missing)}; give one for every body")
    for name, value in conductivity.items():
        if not callable(value) and not (math.isfinite(value) and value > 0.0):
            raise ConditionError(f"conductivity of body {name!r} is {value} W/(m K); it must be positive")


def check_heat_paths(
    elements: FiniteElements,
    grounded: Collection[str],
    links: Sequence[tuple[str, str]],
    volumes: Sequence[str] = (),
) -> None:
    """Check that the temperature of every connected piece and every volume is determined.

    grounded : surfaces with a positive film, radiation or a prescribed temperature; volumes with a supply
    links : pairs of surfaces or volumes that pass heat
    Raises ConditionError naming the bodies and volumes whose temperature nothing determines.
    """
    mesh = elements.mesh
    n = int(elements.components.max()) + 1
    number = {name: surface.piece for name, surface in elements.surfaces.items()}
    number |= {name: n + k for k, name in enumerate(volumes)}
    ground = n + len(volumes)
    pairs = [(number[name], ground) for name in grounded] + [(number[a], number[b]) for a, b in links]
    rows, columns = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
    graph = sparse.coo_array((np.ones(len(rows)), (rows, columns)), shape=(ground + 1, ground + 1))
    _, label = sparse.csgraph.connected_components(graph, directed=False)
    lost = np.flatnonzero(label[:ground] != label[ground])
    if not len(lost):
        return
    bodies = [b for b, cells in mesh.bodies.items() if np.isin(elements.components[cells], lost).any()]
    fluids = [name for k, name in enumerate(volumes) if n + k in lost]
    where = [f"body {', '.join(bodies)}"] * bool(bodies) + [f"volume {', '.join(fluids)}"] * bool(fluids)
    raise ConditionError(
        f"no way for the heat of {' and '.join(where)}: no film, radiation, prescribed temperature, contact or "
        "exchange above zero and no supply reaches it; give it such a condition"
    )


def _require_known(kind: str, name: str, known: Collection[str]) -> None:
    if name not in known:
        near = get_close_matches(name, known, n=3, cutoff=0.4) or sorted(known)[:5]
        raise ConditionError(f"unknown {kind} {name!r}; nearest: {', '.join(near)}")


def _values(condition: Condition) -> Iterator[tuple[str, float, bool]]:
    """Numbers of a condition as (field, value, is it an absolute temperature)."""
    if isinstance(condition, Film):
        yield "fluid_temperature", condition.fluid_temperature, True
    elif isinstance(condition, Radiation):
        yield "surroundings_temperature", condition.surroundings_temperature, True
        yield "emissivity", condition.emissivity, False
    elif isinstance(condition, PrescribedTemperature):
        yield "temperature", condition.temperature, True
    elif isinstance(condition, SurfaceSource | BodySource):
        yield "power", condition.power, False


def _check_values(condition: Condition) -> None:
    place = condition.body if isinstance(condition, BodySource) else " and ".join(surfaces_of(condition))
    for field, value, absolute in _values(condition):
        if not math.isfinite(value):
            raise ConditionError(f"{place}: {field} = {value} is no finite number")
        if absolute and value <= 0.0:
            raise ConditionError(f"{place}: {field} = {value:g} K must be above 0 K; give kelvin")
        if field == "emissivity" and not -1.0 <= value <= 1.0:
            raise ConditionError(
                f"{place}: emissivity = {value:g} is outside of 0 to 1, or of -1 to 0 with a film that holds more"
            )
    if isinstance(condition, Exchange | Contact) and condition.surface_a == condition.surface_b:
        name = type(condition).__name__.lower()
        raise ConditionError(f"{name} of {place}: needs two different surfaces")


def _check_combinations(conditions: Sequence[Condition]) -> None:
    """Refuse a second condition in addition to `Adiabatic` or a prescribed temperature, and repeated kinds.

    A surface of prescribed temperature may radiate in an enclosure: what holds it takes the heat.
    """
    on: dict[str, list[Condition]] = {}
    for condition in conditions:
        for name in surfaces_of(condition):
            on.setdefault(name, []).append(condition)
    for name, on_surface in on.items():
        alone = [c for c in on_surface if isinstance(c, Adiabatic | PrescribedTemperature)]
        if alone and isinstance(alone[0], PrescribedTemperature):
            on_surface = [c for c in on_surface if not isinstance(c, Enclosure)]
        if alone and len(on_surface) > 1:
            others = ", ".join(type(c).__name__ for c in on_surface if c is not alone[0])
            raise ConditionError(
                f"surface {name!r} is {type(alone[0]).__name__} and carries {others} as well; keep one"
            )
    seen: set[tuple[object, ...]] = set()
    for booked, place, kind in _rows(conditions):
        if (booked, place, kind) in seen:
            raise ConditionError(f"{place}: two {booked} of kind {kind!r}; give each a kind of its own")
        seen.add((booked, place, kind))


def _rows(conditions: Sequence[Condition]) -> Iterator[tuple[str, str, str]]:
    """What each condition books in the heat balance: type, place, kind."""
    for condition in conditions:
        name = type(condition).__name__
        match condition:
            case Adiabatic():
                pass
            case StreamNetwork():
                yield from (("VolumeFilm", film.surface, film.kind) for film in condition.films)
            case Enclosure():
                yield from ((name, surface, condition.kind) for surface in condition.surfaces)
            case BodySource():
                yield name, condition.body, condition.kind
            case _:
                yield name, " and ".join(surfaces_of(condition)), condition.kind


def _check_open(elements: FiniteElements, conditions: Sequence[Condition]) -> None:
    covered = {name for condition in conditions for name in surfaces_of(condition)}
    missing = sorted(set(elements.mesh.surfaces) - covered - elements.interfaces)
    if not missing:
        return
    notes = []
    for name in missing:
        near = get_close_matches(name, covered, n=1, cutoff=0.6)
        notes.append(f"{name} (next to {near[0]}, which has one)" if near else name)
    raise ConditionError(
        f"surfaces without a boundary condition: {'; '.join(notes)}; give each a film, a temperature, "
        "an exchange or Adiabatic"
    )


def _check_prescribed(elements: FiniteElements, conditions: Sequence[Condition]) -> None:
    prescribed: dict[int, tuple[str, float]] = {}
    for condition in conditions:
        if not isinstance(condition, PrescribedTemperature):
            continue
        for node in elements.surfaces[condition.surface].nodes.tolist():
            name, value = prescribed.setdefault(node, (condition.surface, condition.temperature))
            if value != condition.temperature:
                raise ConditionError(
                    f"surfaces {name!r} at {value:g} K and {condition.surface!r} at "
                    f"{condition.temperature:g} K meet; make them equal or use a film on one"
                )


# Audits of a housing's heat: what cannot be, what was assumed otherwise, what was counted twice.
#
# Pure functions on numbers; each returns a sentence for the report, or None when there is nothing to say. They
# judge solved fields and published numbers alike (thermal sheet, seed thermal case, section 2).

ROUNDING = 1e-3
"""Relative shortfall of radiation that is taken for rounding of printed numbers."""


def least_radiation(emissivity: float, ambient: float, film: float, convection: float) -> float:
    """Least heat [W] that a surface radiates while it gives off ``convection`` [W] through its film.

    emissivity : eps [-]
    ambient : T0 of air and surroundings [K]
    film : h [W/(m2 K)], the same all over the surface

    T^4 is convex, so that T^4 - T0^4 >= 4 T0^3 (T - T0) at every point whatever the field; integrated over
    one surface in one ambient, Q_rad >= (4 eps sigma T0^3 / h) Q_conv.
    """
    not_negative("emissivity", emissivity, "")
    positive("ambient temperature", ambient, "K")
    positive("film coefficient", film, "W/(m2 K)")
    return 4.0 * emissivity * STEFAN_BOLTZMANN * ambient**3 / film * convection


def radiation_too_small(
    surface: str,
    *,
    convection: float,
    radiation: float,
    emissivity: float,
    film: float,
    ambient: float,
) -> str | None:
    """Whether a surface radiates less than any temperature field allows; heats [W] positive to the room."""
    if convection <= 0.0:
        return None
    least = least_radiation(emissivity, ambient, film, convection)
    if radiation >= least * (1.0 - ROUNDING):
        return None
    area = f" ({least / radiation:.3g} times the radiating one would explain it)" if radiation > 0.0 else ""
    return (
        f"{surface}: radiation = {radiation:.4g} W is below {least:.4g} W, the least that any temperature "
        f"field gives with {convection:.4g} W of convection at h = {film:.4g} W/(m2 K), "
        f"eps = {emissivity:.3g} and {ambient:.4g} K; check the convective area{area}, emissivity and the "
        "temperature of the surroundings"
    )


def assumed_difference(
    surface: str,
    *,
    assumed: float,
    solved: float,
    law: FilmLaw | None = None,
    fluid_temperature: float | None = None,
    tolerance: float = 0.1,
) -> str | None:
    """Whether a film was taken at another temperature difference [K] than the one that came out.

    law, fluid_temperature : the film law and its fluid [K]; given both, the sentence says what the
        coefficient would have been at the solved difference
    tolerance : relative deviation from the assumed difference that is let pass
    """
    positive("assumed temperature difference", assumed, "K")
    if abs(solved - assumed) <= tolerance * assumed:
        return None
    effect = ""
    if law is not None and fluid_temperature is not None:
        taken = law(fluid_temperature + assumed, fluid_temperature).value
        right = law(fluid_temperature + solved, fluid_temperature).value
        change = f" ({100.0 * (right / taken - 1.0):+.0f} %)" if taken > 0.0 else ""
        effect = f", where the coefficient is {right:.4g} instead of {taken:.4g} W/(m2 K){change}"
    return (
        f"{surface}: assumed temperature difference = {assumed:.4g} K, solved {solved:.4g} K{effect}; the "
        f"limit is {100.0 * tolerance:.0f} % of the assumed one; let the film follow the wall temperature"
    )


def radiation_counted_twice(surface: str, film: FilmCoefficient, radiating: bool) -> str | None:
    """Whether a surface radiates explicitly although its film contains radiation already."""
    if not radiating or not film.radiation_included:
        return None
    return (
        f"{surface}: film {film.formula} is of the size of convection and radiation together, and the surface "
        "radiates as well; verdicts should depend on one of them (radiation_included = true drops the explicit "
        "radiation)"
    )


def audit_conditions(conditions: Iterable[Condition], wall_excess: float = 50.0) -> tuple[str, ...]:
    """Double counting in a list of boundary conditions, one sentence a surface, in order of the films.

    wall_excess : wall above fluid [K] at which the film laws are evaluated
    """
    listed = list(conditions)
    radiating = {c.surface for c in listed if isinstance(c, Radiation) and c.emissivity > 0.0}
    sentences = []
    for film in listed:
        if isinstance(film, Film):
            text = radiation_counted_twice(
                film.surface, film.coefficient_at(wall_excess), film.surface in radiating
            )
            if text is not None:
                sentences.append(text)
    return tuple(sentences)


USUAL = 293.15
"""Temperature [K] at which a conductivity law gives the size of its matrix entries."""


class ConductionSetup:
    """Conduction matrices of a mesh, assembled once and used for every stage and iteration of the coupling.

    conductivity : body -> k [W/(m K)], a number or a law of the temperature
    elements : share the spaces of an earlier setup on the same mesh
    Raises MeshError for a bad mesh and ConditionError for missing, unknown or impossible conductivities.
    """

    def __init__(
        self,
        mesh: NamedMesh,
        conductivity: Mapping[str, Conductivity],
        elements: FiniteElements | None = None,
    ) -> None:
        check_conductivity(mesh.bodies, conductivity)
        self.mesh = mesh
        self.conductivity = dict(conductivity)
        self.elements = FiniteElements(mesh) if elements is None else elements
        laws = {name: k for name, k in self.conductivity.items() if callable(k)}
        constant = {name: 0.0 if callable(k) else float(k) for name, k in self.conductivity.items()}
        per_cell = self.elements.per_cell(constant)
        self.fine = self.elements.fine.conduction(per_cell)
        """(nnz,) values of the second-order matrix [W/K], bodies with a law left out."""
        self.coarse = self.elements.coarse.conduction(per_cell)
        """Values of the linear matrix [W/K], bodies with a law left out."""
        self.variable = VariableConduction(self.elements, laws) if laws else None
        """The bodies with a law."""
        size = self.fine
        if self.variable is not None:
            usual = np.full(len(mesh.points), USUAL)
            size = size + self.variable.fine_values(usual)
        self.size = self.elements.fine.row_sizes(size)
        """(n_nodes,) sum of the sizes of each row's entries [W/K], for the rounding error of the residual."""
        self._capacities: dict[tuple[tuple[str, float], ...], HeatCapacity] = {}
        self._joints: dict[tuple[str, str, float | None, float], SurfaceJoint] = {}

    def notes(self, conditions: Sequence[Condition]) -> tuple[str, ...]:
        """What is to be said of the joints among ``conditions``: surfaces that touch and give heat to others."""
        others = {
            name for c in conditions if not isinstance(c, Contact | Adiabatic) for name in surfaces_of(c)
        }
        contacts = (c for c in conditions if isinstance(c, Contact))
        return tuple(text for c in contacts for text in covered(c, self.joint(c), others))

    def heat_capacity(self, capacity: Mapping[str, float]) -> HeatCapacity:
        """Capacity matrices for body -> density times specific heat [J/(m3 K)], assembled once."""
        key = tuple(sorted(capacity.items()))
        if key not in self._capacities:
            self._capacities[key] = HeatCapacity(self.elements, capacity)
        return self._capacities[key]

    def joint(self, contact: Contact) -> SurfaceJoint:
        """Common part of the surfaces of a contact, found once."""
        key = (contact.surface_a, contact.surface_b, contact.reach, contact.least_coverage)
        if key not in self._joints:
            self._joints[key] = join(self.elements, contact)
        return self._joints[key]


# Heat flux at the nodes, for pictures and files: what a cell conducts on average, spread to its nodes.


def heat_flux(setup: ConductionSetup, temperature: FloatArray) -> FloatArray:
    """Heat flux -k grad T (n_nodes, 3) [W/m2] of a nodal ``temperature`` (n_nodes,) [K].

    The mean of the cells round a node, weighted by their volumes. Where two bodies meet it is the mean over
    both: what flows along a joint may jump there.
    """
    mesh, level = setup.mesh, setup.elements.fine
    flux, weight = np.zeros((len(mesh.points), 3)), np.zeros(len(mesh.points))
    for body, members in mesh.bodies.items():
        cells = np.unique(members).astype(np.int32)
        law = setup.conductivity[body]
        at_points = level.at_points(temperature, cells)
        value = np.broadcast_to(law(at_points) if callable(law) else float(law), at_points.shape)
        volumes = level.volumes[cells]
        conducted = -np.einsum("eq,eqi->ei", value * volumes, level.gradient(temperature, cells))
        nodes, shares = mesh.cells[cells].ravel(), mesh.cells.shape[1]
        for axis in range(3):
            flux[:, axis] += np.bincount(nodes, np.repeat(conducted[:, axis], shares), minlength=len(flux))
        weight += np.bincount(nodes, np.repeat(volumes.sum(axis=1), shares), minlength=len(flux))
    return flux / weight[:, None]
