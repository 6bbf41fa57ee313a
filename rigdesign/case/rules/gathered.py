"""Rules that span several keys, gathered: each yields the faults it finds."""

from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING

from rigdesign.base.errors import Fault
from rigdesign.base.units import show
from rigdesign.case.component_limits import PLACES, has_result
from rigdesign.case.faults import unknown, written
from rigdesign.case.films import ROOM
from rigdesign.case.geometry import housing_geometry
from rigdesign.case.housing import Housing
from rigdesign.case.paths import known_paths, nearest_paths, slot_at
from rigdesign.case.rotation import Rotation, mesh_shafts, shaft_senses
from rigdesign.case.rules.drivetrain import drivetrain_faults
from rigdesign.case.rules.elastic_shafts import elastic_shaft_faults
from rigdesign.case.rules.gears import bearing_faults, gearbox_faults, missing_ends
from rigdesign.case.rules.oil_circuits import lubrication_faults, oil_circuit_faults
from rigdesign.case.rules.rig_heat import loss_faults, rig_heat_faults
from rigdesign.case.rules.schedule import event_faults, schedule_faults
from rigdesign.case.rules.surfaces import housing_faults
from rigdesign.properties.fluid import ATMOSPHERE, FluidError, volumetric_heat
from rigdesign.properties.materials import MATERIALS
from rigdesign.properties.oil import OILS, OilError
from thermal.housing.housing_surfaces import body_names, exact_areas

if TYPE_CHECKING:
    from rigdesign.case.drivetrain import ShaftInput
    from rigdesign.case.model import Case

MOST_SHAFT_ELEMENTS = 500
"""Elements of all shafts together: their modes come from a dense eigenvalue problem."""


def broken_rules(case: "Case") -> list[Fault]:
    """Every rule the case breaks; empty for one that can be computed.

    The surfaces of a housing are looked at once everything else fits together.
    """
    rules: tuple[Callable[[Case], Iterator[Fault]], ...] = (
        _substances,
        gearbox_faults,
        bearing_faults,
        drivetrain_faults,
        elastic_shaft_faults,
        loss_faults,
        lubrication_faults,
        oil_circuit_faults,
        rig_heat_faults,
        schedule_faults,
        event_faults,
        _limits,
        _numerics,
    )
    faults = list(missing_ends(case)) or [fault for rule in rules for fault in rule(case)]
    if faults:
        return faults
    faults = [fault for name, box in case.gearboxes.items() for fault in housing_faults(name, box)]
    faults += rotation_faults(case)
    return faults or list(transient_faults(case))


def _substances(case: "Case") -> Iterator[Fault]:
    for name, own in case.oils.items():
        try:
            own.properties(name)
        except OilError as error:
            problem, _, remedy = str(error).rpartition("; ")
            yield Fault(f"oils.{name}", "", problem, remedy)
    oils = [*case.oils, *OILS]
    materials = [*case.materials, *MATERIALS]
    for name, box in case.gearboxes.items():
        at = f"gearboxes.{name}"
        used = {f"{at}.oil.oil": box.oil.oil, f"{at}.bearing_oil.oil": box.bearing_oil_name}
        for path, used_oil in used.items():
            if used_oil not in oils:
                yield unknown(path, used_oil, oils, "oil")
        used = {f"{at}.gears.{gear}.material": part.material for gear, part in box.gears.items()}
        if box.housing is not None:
            used |= {f"{at}.housing.material": box.housing.material}
            used |= {f"{at}.housing.field.material": box.housing.field.material}
            yield from _media(f"{at}.housing", box.housing, oils)
            used |= {
                f"{at}.housing.shafts.{s}.material": part.material for s, part in box.housing.shafts.items()
            }
        for path, material in used.items():
            if material not in materials:
                yield unknown(path, material, materials, "material")
    for shaft, part in case.power_circuit.shafts.items():
        if part.material not in materials:
            yield unknown(f"drivetrain.shafts.{shaft}.material", part.material, materials, "material")


def _media(at: str, housing: Housing, oils: Iterable[str]) -> Iterator[Fault]:
    """What flows in streams and links: an oil of the case, or a fluid that has properties there."""
    flows = [
        (f"{at}.streams.{name}.medium", stream.medium, stream.inlet_temperature, stream.pressure)
        for name, stream in housing.streams.items()
    ]
    flows += [
        (f"{at}.links.{name}.medium", link.medium, ROOM, ATMOSPHERE)
        for name, link in housing.links.items()
        if link.medium is not None
    ]
    for path, medium, temperature, pressure in flows:
        if medium not in oils:
            try:
                volumetric_heat(medium, temperature, pressure)
            except FluidError as error:
                yield Fault(
                    path,
                    written(medium),
                    str(error),
                    "name an oil of the case, or a fluid such as Water or Air",
                )


def _limits(case: "Case") -> Iterator[Fault]:
    if not case.limits.bought_parts:
        return
    plain = case.model_dump(mode="python")
    for name, bought in case.limits.bought_parts.items():
        known = slot_at(type(case), plain, bought.part.split(".")) is not None
        if not known or _missing(plain, bought.part):
            present = [path for path in known_paths(type(case), plain) if not _missing(plain, path)]
            meant = nearest_paths(bought.part, present, 2)
            yield Fault(
                f"limits.bought_parts.{name}.part", written(bought.part), "no such part in this case",
                "did you mean " + " or ".join(meant) + "?" if meant else "write the case path of the part",
            )  # fmt: skip
        elif bought.given is None and not has_result(bought.part, bought.quantity):
            yield Fault(
                f"limits.bought_parts.{name}.quantity", written(bought.quantity),
                f"the run finds none at {bought.part}",
                f"name a part that has one ({', '.join(PLACES[bought.quantity])}) or write the value as given",
            )  # fmt: skip


def _missing(plain: object, path: str) -> bool:
    node = plain
    for key in path.split("."):
        if not isinstance(node, dict) or node.get(key) is None:
            return True
        node = node[key]
    return False


def _shafts(case: "Case") -> "Iterable[ShaftInput]":
    return case.power_circuit.shafts.values()


def _numerics(case: "Case") -> Iterator[Fault]:
    numbers = case.numerics
    if numbers.curve_speed_start >= numbers.curve_speed_end:
        yield Fault(
            "numerics.curve_speed_start", show(numbers.curve_speed_start, "speed"),
            f"is not below curve_speed_end = {show(numbers.curve_speed_end, 'speed')}",
            "exchange or correct them",
        )  # fmt: skip
    if numbers.curve_speed_start <= 0.0:
        yield Fault(
            "numerics.curve_speed_start", show(numbers.curve_speed_start, "speed"),
            "is not above 0 rpm: a rig at rest has no periodic response",
            "write e.g. 500 rpm",
        )  # fmt: skip
    length = sum(s.length for shaft in _shafts(case) for s in shaft.sections)
    stated = numbers.shaft_element_length
    if stated is not None and length > MOST_SHAFT_ELEMENTS * stated:
        yield Fault(
            "numerics.shaft_element_length", show(stated, "length"),
            f"makes {length / stated:.0f} elements of the shafts, limit "
            f"{MOST_SHAFT_ELEMENTS}: the modes of more take minutes",
            f"write at least {show(length / MOST_SHAFT_ELEMENTS, 'length')}",
        )  # fmt: skip
    if not 0.0 < numbers.torque_tolerance <= 0.1:
        yield Fault(
            "numerics.torque_tolerance",
            str(numbers.torque_tolerance),
            "is not within 0 and 0.1",
            "write e.g. 0.001",
        )


# Rules of the senses of rotation: shafts that are coupled turn together.


def rotation_faults(case: "Case") -> Iterator[Fault]:
    """Gearboxes whose stated rotation does not fit that of the one they are coupled to."""
    for name, partner, needed in contradicting_rotations(case):
        yield Fault(
            f"gearboxes.{name}.rotation", case.gearboxes[name].rotation,
            f"its shafts are coupled to gearbox {partner}, whose rotation makes it {needed}",
            f"write {needed} or leave it out; correct the ends of the couplings if they meet otherwise",
        )  # fmt: skip


def contradicting_rotations(case: "Case") -> Iterator[tuple[str, str, Rotation]]:
    """(gearbox, gearbox that turns it, rotation it then has) where what the case states does not fit its couplings."""
    train = case.drivetrain
    if train is None:
        return
    meshes = [pair for box in case.gearboxes.values() for pair in mesh_shafts(box)]
    couplings = [(one.shafts, one.ends) for one in train.couplings.values()]
    firsts = {name: mesh_shafts(box)[0][0] for name, box in case.gearboxes.items()}
    settled: dict[str, str] = {}
    senses: dict[str, float] = {}
    for name, box in case.gearboxes.items():
        first = 1.0 if box.rotation == "clockwise" else -1.0
        if firsts[name] not in senses:
            found = shaft_senses({firsts[name]: first}, meshes, couplings)
            settled |= dict.fromkeys(found, name)
            senses |= found
        elif senses[firsts[name]] != first:
            yield name, settled[firsts[name]], "anticlockwise" if first > 0.0 else "clockwise"


# Rules of the thermal history: events once each, probes at places that exist.


def transient_faults(case: "Case") -> Iterator[Fault]:
    """Everything wrong with the table ``transient``; housings must be sound."""
    events = case.transient.events
    for event in dict.fromkeys(events):
        if events.count(event) > 1:
            yield Fault("transient.events", written(event), "is listed twice", "name each event once")
    for name, probe in case.transient.probes.items():
        at = f"transient.probes.{name}"
        box = case.gearboxes.get(probe.gearbox)
        if box is None:
            yield unknown(f"{at}.gearbox", probe.gearbox, case.gearboxes, "gearbox")
        elif box.housing is None:
            yield Fault(
                f"{at}.gearbox", written(probe.gearbox), "has no housing and so no temperature field",
                "name a gearbox with a housing",
            )  # fmt: skip
        else:
            geometry = housing_geometry(box)
            places = [*body_names(geometry), *exact_areas(geometry)]
            if probe.place not in places:
                yield unknown(f"{at}.place", probe.place, places, "surface or body")
