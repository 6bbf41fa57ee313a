"""Values outside of the range that is usual for their key: computed all the same, and warned of.

A key states its usual range where it is declared, `Usual` beside its type and its possible range: between two
values, or as multiples of a measure of its part that is worked out here, so that a shaft is held against its bearings,
a stiffness against the shaft beside it and a limit against the material.
"""

import math
import typing
from collections import defaultdict
from collections.abc import Iterator, Mapping
from itertools import pairwise
from statistics import median
from typing import TYPE_CHECKING, Any

from rigdesign.base import units
from rigdesign.case.defaults.rule import BY_THE_TOOL
from rigdesign.case.fields import Part, Quantity
from rigdesign.case.geometry import pitch_diameters
from rigdesign.case.paths import Slot, slot_of, slot_of_field
from rigdesign.case.provenance import item_name
from rigdesign.case.rules.gears import diameter_at
from rigdesign.properties.materials import MATERIALS

if TYPE_CHECKING:
    from rigdesign.case.drivetrain import DrivetrainInput
    from rigdesign.case.gearbox import Gearbox
    from rigdesign.case.model import Case

Measures = dict[str, dict[str, float]]
"""Path of a part -> name of a measure -> its value in SI; a part has those of the parts it stands in as well."""
SHEAR_MODULUS, DENSITY, TOOTH_STIFFNESS = 8e10, 7850.0, 1.4e10
"""Of steel shafts [Pa], of gear bodies [kg/m3], of meshes over their face width [Pa], for measures."""
USUAL_FILM = {"ambient": 10.0, "gear_oil": 300.0, "bearing_oil": 300.0}
"""Film on a surface by the fluid that wets it [W/(m2 K)]."""
REMEDY = 'check unit and power of ten; if it is right, write { value = …, confirmed = "why" }'


def unusual_inputs(case: "Case") -> dict[str, str]:
    """Path -> what is unusual about its value, for every value that the case states and does not confirm."""
    marks, value_of, known = case.origin.mark_of, case.origin.value_of, _measures(case)
    found = {path: _beyond(path, value, slot, known) for path, (value, slot) in _stated(case).items()}
    found |= dict(_misplaced(case))
    return {
        path: f"{path} = {value_of[path]} {text}: {REMEDY}"
        for path, text in found.items()
        if text and not (path in marks and marks[path].confirmed)
    }


def stated_numbers(case: "Case") -> list[str]:
    """Paths of the numbers that the case states, those of its defaults left out."""
    return list(_stated(case))


def _stated(case: "Case") -> dict[str, tuple[float, Slot]]:
    marks = case.origin.mark_of.values()
    filled = {mark.path for mark in marks if (mark.assumed or mark.source or "").startswith(BY_THE_TOOL)}
    numbers = _numbers(case, slot_of(type(case)), "")
    return {path: (value, slot) for path, value, slot in numbers if path not in filled}


def _numbers(node: Any, slot: Slot, path: str) -> Iterator[tuple[str, float, Slot]]:
    """Path, value and slot of every number that is stated at a place of the case and below it."""
    below = f"{path}." if path else ""
    if isinstance(node, Part):
        for key in type(node).model_fields:
            inner = slot_of_field(type(node), key)
            if key in node.model_fields_set and inner is not None:
                yield from _numbers(getattr(node, key), inner, below + key)
    elif isinstance(node, Mapping | tuple):
        kinds = [typing.get_args(kind) for kind, _ in slot.choices if typing.get_args(kind)]
        inner = slot_of(kinds[0][1 if isinstance(node, Mapping) else 0]) if kinds else slot
        named = (item_name({"name": getattr(item, "name", None)}, number) for number, item in enumerate(node))
        for name, item in node.items() if isinstance(node, Mapping) else zip(named, node):
            yield from _numbers(item, inner, below + name)
    elif isinstance(node, int | float) and not isinstance(node, bool):
        yield path, float(node), slot


def _beyond(path: str, value: float, slot: Slot, known: Measures) -> str:
    """What is unusual about a value; empty where nothing is, or where its measure is not known."""
    quantity = slot.quantity
    is_point = quantity is not None and quantity.kind == "temperature"
    for usual in reversed(slot.usual):
        scale = _measure(known, path, usual.of) if usual.of else 1.0
        if not scale or not value:
            continue
        low, high = (scale * _si(end, quantity) for end in (usual.low, usual.high))
        if low * (1.0 - 1e-9) <= (value if is_point else abs(value)) <= high * (1.0 + 1e-9):
            continue
        ends = [_written(number, quantity) for number in (low, high)]
        times = f", {usual.words}" if usual.of else ""
        return f"is outside of its usual range, {ends[0]} to {ends[1]}{times}"
    return ""


def _measure(known: Measures, path: str, name: str) -> float | None:
    """A measure of the nearest part round a value that has it."""
    while path:
        path = path.rpartition(".")[0]
        if name in known[path]:
            return known[path][name]
    return None


def _si(end: str | float, quantity: Quantity | None) -> float:
    return units.parse(end, quantity.kind) if isinstance(end, str) and quantity is not None else float(end)


def _written(value: float, quantity: Quantity | None) -> str:
    if quantity is None:
        return f"{value:.4g}"
    return units.show(value, quantity.kind, quantity.shown_example.partition(" ")[2], 4)


def _misplaced(case: "Case") -> Iterator[tuple[str, str]]:
    """Gears and bearings that reach into their neighbour, off their bearings or off the section they fit on."""
    if case.drivetrain is None:
        return
    on_shafts = defaultdict[str, list[tuple[float, float, float, str]]](list)
    for box_name, box in case.gearboxes.items():
        at = f"gearboxes.{box_name}"
        for name, gear in box.gears.items():
            spots = [part.position or 0.0 for part in box.bearings.values() if part.shaft == gear.shaft]
            path, place = f"{at}.gears.{name}.position", gear.position or 0.0
            on_shafts[gear.shaft].append((place, box.body_width(name), gear.bore_diameter, path))
            if len(spots) > 1 and not min(spots) < place < max(spots):
                yield (
                    path,
                    f"is not between the bearings of its shaft, {_mm(min(spots))} and {_mm(max(spots))}",
                )
        for name, bearing in box.bearings.items():
            path, place = f"{at}.bearings.{name}.position", bearing.position or 0.0
            on_shafts[bearing.shaft].append((place, bearing.width, bearing.shaft_diameter, path))
    for shaft, parts in on_shafts.items():
        for place, _, bore, path in parts:
            section = diameter_at(case.power_circuit.shafts[shaft], place)
            if section and bore and not 0.6 < bore / section < 1.7:
                yield path, f"puts a bore of {_mm(bore)} on a section of {_mm(section)} of shaft {shaft}"
        for (place, width, _, path), (other, other_width, _, other_path) in pairwise(sorted(parts)):
            if other - place < 0.4995 * (width + other_width):
                yield (
                    path,
                    (
                        f"puts the part into its neighbour on shaft {shaft}, {other_path} = {_mm(other)}: they are "
                        f"{_mm(width)} and {_mm(other_width)} wide"
                    ),
                )


def _mm(length: float) -> str:
    return units.show(length, "length", digits=4)


# ------------------------------------------------------------------ measures


def _measures(case: "Case") -> Measures:
    """Measures of every part that a usual range counts from."""
    known: Measures = defaultdict(dict)
    schedule, boxes = case.schedule, case.gearboxes.values()
    torque, speed = schedule.test_torque, schedule.test_speed
    known[""] |= {
        "test torque": torque,
        "test speed": speed,
        "circulating power": torque * speed,
        "turns of the planned test": speed / math.tau * case.test_plan.time,
        "module": min(mesh.normal_module for box in boxes for mesh in box.meshes.values()),
        "face width": min(gear.face_width for box in boxes for gear in box.gears.values()),
        "smallest bearing": min(part.shaft_diameter for box in boxes for part in box.bearings.values()),
        "bearing clearance": max(part.drawn_clearance for box in boxes for part in box.bearings.values()),
        "axial play": max(part.axial_play for box in boxes for part in box.bearings.values()),
        "seal gap": max((part.radial_gap for box in boxes for part in box.seals.values()), default=0.0),
        "tooth thinning": max(gear.tooth_thinning for box in boxes for gear in box.gears.values()),
        "oil fed": sum(feed.flow * number for box in boxes for feed, number in box.feeds.values()),
        "root_stress_maximum": case.limits.specimen.root_stress_maximum or 0.0,
    }
    materials = [
        case.materials.get(gear.material) or MATERIALS.get(gear.material)
        for box in boxes
        for gear in box.gears.values()
    ]
    for name, key in (("root strength", "root_strength"), ("flank strength", "flank_strength")):
        known[""][name] = max((getattr(entry, key, None) or 0.0 for entry in materials), default=0.0)
    for name, oil in case.oils.items():
        known[f"oils.{name}"]["viscosity at 100 degC"] = oil.kinematic_viscosity_100
    for name, circuit in case.oil_circuits.items():
        known[f"oil_circuits.{name}"]["tank volume"] = circuit.tank.volume
        known[f"oil_circuits.{name}"]["pump flow"] = 0.0 if circuit.pump is None else circuit.pump.flow
    for name, box in case.gearboxes.items():
        _of_gearbox(known, f"gearboxes.{name}", box)
    if case.drivetrain is not None:
        _of_drivetrain(known, case, case.drivetrain)
    return known


def _of_gearbox(known: Measures, at: str, box: "Gearbox") -> None:
    diameters = pitch_diameters(box)
    distance = max(mesh.centre_distance for mesh in box.meshes.values())
    bores = [part.shaft_diameter * part.width for part in box.bearings.values()]
    known[at] |= {
        "centre distance": distance,
        "cube of the centre distance": distance**3,
        "face width": max(box.body_width(name) for name in box.gears),
        "bore times width of the bearings": math.fsum(bores) / len(bores),
    }
    for name, bearing in box.bearings.items():
        known[f"{at}.bearings.{name}"]["bore of the bearing"] = bearing.shaft_diameter
    for name, mesh in box.meshes.items():
        discs = []
        for gear, mate in ((mesh.pinion, mesh.wheel), (mesh.wheel, mesh.pinion)):
            width = box.gears[gear].face_width * (mesh.sharing if mesh.double_helical else 1)
            inertia = math.pi / 32.0 * DENSITY * width * diameters[gear] ** 4
            known[f"{at}.gears.{gear}"] |= {
                "module": mesh.normal_module,
                "face width": box.gears[gear].face_width,
                "face width of its mate": box.gears[mate].face_width,
                "inertia of a disc of its size": inertia,
            }
            discs.append(inertia / (0.5 * diameters[gear]) ** 2)
        stiffness = TOOTH_STIFFNESS * min(box.gears[gear].face_width for gear in (mesh.pinion, mesh.wheel))
        reduced = discs[0] * discs[1] / sum(discs)
        known[f"{at}.meshes.{name}"]["critical damping of the mesh"] = 2.0 * math.sqrt(stiffness * reduced)
    for name, film in {} if box.housing is None else box.housing.boundary.items():
        fluid = str(film.wetted_by or "").removesuffix("_inlet").removesuffix("_mean").removesuffix("_outlet")
        known[f"{at}.housing.boundary.{name}"]["usual film of its fluid"] = USUAL_FILM.get(fluid, 0.0)


def _of_drivetrain(known: Measures, case: "Case", train: "DrivetrainInput") -> None:
    """Shafts by their sections, bearings and gear bores; what sits on a shaft is held against its diameter."""
    diameters = {
        name: [part.outer_diameter for part in shaft.sections] for name, shaft in train.shafts.items()
    }
    places: list[tuple[str, str]] = [(f"drivetrain.shafts.{name}", name) for name in train.shafts]
    for box_name, box in case.gearboxes.items():
        at = f"gearboxes.{box_name}"
        for kind, parts in (("gears", box.gears), ("bearings", box.bearings), ("seals", box.seals)):
            places += [(f"{at}.{kind}.{name}", part.shaft) for name, part in parts.items()]
        places += [
            (f"{at}.housing.shafts.{name}", name)
            for name in ([] if box.housing is None else box.housing.shafts)
        ]
        for gear in box.gears.values():
            diameters[gear.shaft] += [gear.bore_diameter] if gear.bore_diameter else []
        for bearing in box.bearings.values():
            diameters[bearing.shaft].append(bearing.shaft_diameter)
    typical = {name: median(sizes) for name, sizes in diameters.items()}
    stiffness = {
        name: math.pi
        / 32.0
        * SHEAR_MODULUS
        * typical[name] ** 4
        / sum(part.length for part in shaft.sections)
        for name, shaft in train.shafts.items()
    }
    for path, shaft in places:
        known[path] |= {"shaft diameter": typical[shaft], "stiffness of the shaft": stiffness[shaft]}
    for name, coupling in train.couplings.items():
        known[f"drivetrain.couplings.{name}"] |= {
            "stiffness of the shaft": max(stiffness[shaft] for shaft in coupling.shafts),
            "stiffness of the coupling times 1 s": coupling.torsional_stiffness,
        }
    for name, entry in train.shafts.items():
        for disc_name, disc in entry.discs.items():
            known[f"drivetrain.shafts.{name}.discs.{disc_name}"]["mass times the shaft diameter squared"] = (
                disc.mass or 0.0
            ) * typical[name] ** 2
    known["drivetrain.bracing"]["shaft diameter"] = max(typical.values())
    known["drivetrain.motor"]["torque of the motor"] = train.motor.torque_limit
    name = train.counting_gear
    box = case.gearboxes[name.gearbox]
    diameter, gear = pitch_diameters(box)[name.part], box.gears[name.part]
    known[""]["tooth force"] = 2.0 * case.schedule.test_torque / diameter
    known["schedule"] |= {
        "speed of 1 m/s at the pitch circle": 2.0 / diameter,
        "torque of 1 Pa on face width times module": 0.5
        * diameter
        * gear.face_width
        * box.halves(name.part)
        * known[f"gearboxes.{name.gearbox}.gears.{name.part}"]["module"],
    }
