"""Rules of shafts that bend: what holds each of them along its axis and sideways, and what its parts have to state.

The same as `dynamics.rotor.location` asks of the assembled rig, from the keys of the case alone.
"""

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.errors import Fault
from rigdesign.base.units import show
from rigdesign.case.rotation import has_hands, pinion_hand, shaft_senses

if TYPE_CHECKING:
    from rigdesign.case.bearings import BearingInput
    from rigdesign.case.drivetrain import BowInput, CouplingInput, DrivetrainInput, ShaftInput
    from rigdesign.case.gearbox import Gearbox
    from rigdesign.case.model import Case

FREE = 1e-9
"""Sum of squared motions at bearings and couplings, each as a row of length 1, below which a lateral motion of rigid
shafts counts as free; and the share of a shaft in such a motion below which it stands still."""
LEAST_DIAMETRAL = 0.5
"""Of a thin disc: its inertia about a diameter over the polar one; thickness adds to it."""


def elastic_shaft_faults(case: "Case") -> Iterator[Fault]:
    """What keeps the shafts from bending in their bearings; nothing where they only twist."""
    train = case.drivetrain
    if train is None:
        return
    yield from rotating_part_faults(case)
    if train.shaft_model != "elastic":
        return
    yield from _supported_twice(case)
    yield from _thin_discs(train)
    yield from _stated_bearings(case)
    couplings = [
        one for one in train.couplings.values() if all(shaft in train.shafts for shaft in one.shafts)
    ]
    yield from _axial(case, train.shafts, couplings)
    yield from _lateral(case, couplings)


def _supported_twice(case: "Case") -> Iterator[Fault]:
    """Bearings whose support is stated in a housing that is condensed to its seats."""
    for box_name, box in case.gearboxes.items():
        if box.housing is None or box.housing.bearing_seats != "elastic":
            continue
        for name, bearing in box.bearings.items():
            if bearing.support_stiffness is not None:
                yield Fault(
                    f"gearboxes.{box_name}.bearings.{name}.support_stiffness",
                    show(bearing.support_stiffness, "linear_stiffness"),
                    f'gearboxes.{box_name}.housing.bearing_seats = "elastic" gives it from the mesh of the housing',
                    'leave it out, or write bearing_seats = "rigid"',
                )


def _thin_discs(train: "DrivetrainInput") -> Iterator[Fault]:
    for shaft, part in train.shafts.items():
        for name, disc in part.discs.items():
            least = LEAST_DIAMETRAL * disc.inertia
            if disc.diametral_inertia is not None and disc.diametral_inertia < least * (1.0 - 1e-9):
                yield Fault(
                    f"drivetrain.shafts.{shaft}.discs.{name}.diametral_inertia",
                    show(disc.diametral_inertia, "inertia"),
                    f"is below {show(least, 'inertia')}, half of its polar inertia: no body is thinner than a disc",
                    "write the inertia about a diameter, or leave it out for a thin disc",
                )


def _stated_bearings(case: "Case") -> Iterator[Fault]:
    if case.power_circuit.bearing_coefficients != "stated":
        return
    for box_name, box in case.gearboxes.items():
        for name, bearing in box.bearings.items():
            if bearing.radial_stiffness is None:
                yield Fault(
                    f"gearboxes.{box_name}.bearings.{name}.radial_stiffness",
                    "",
                    'drivetrain.bearing_coefficients = "stated" takes it from every bearing, this one states none',
                    'add it, e.g. "1e8 N/m", or write bearing_coefficients = "computed"',
                )


def _axial(case: "Case", shafts: Collection[str], couplings: Sequence["CouplingInput"]) -> Iterator[Fault]:
    """Shafts that nothing ties to one that a bearing locates, neither coupling nor double-helical mesh, and that no
    meshes of different lead hold."""
    ties = [coupling.shafts for coupling in couplings if coupling.axial_stiffness]
    ties += [
        pair for box in case.gearboxes.values() for pair in _double_helical(box) if set(pair) <= set(shafts)
    ]
    located = {
        bearing.shaft
        for box in case.gearboxes.values()
        for bearing in box.bearings.values()
        if bearing.locating
    }
    floating = [group for group in _joined(shafts, ties) if located.isdisjoint(group)]
    for group in _screwing(case, shafts, floating) if floating else []:
        screws = [name for name, pair in _single_helical(case) if not set(pair).isdisjoint(group)]
        yield Fault(
            f"drivetrain.shafts.{group[0]}", "",
            f"nothing locates it{_and(group[1:])} axially: 0 of the bearings do, must be 1{_screws(screws)}",
            _locate(case, group),
        )  # fmt: skip


def _screwing(
    case: "Case", shafts: Collection[str], floating: Sequence[list[str]]
) -> Iterator[Sequence[str]]:
    """Those of the floating groups that helical meshes do not hold (`dynamics.rotor.location`)."""
    from dynamics.rotor.location import HelicalTie, not_held, turning_together

    couplings = case.power_circuit.couplings
    twisted = case.power_circuit.bracing.coupling or next(iter(couplings), None)
    known = {name: one for name, one in couplings.items() if set(one.shafts) <= set(shafts)}
    meshes = [(box, name, pair) for box in case.gearboxes.values() for name, pair in _mesh_shafts(box)]
    meshes = [mesh for mesh in meshes if set(mesh[2]) <= set(shafts)]
    senses = shaft_senses(
        {next(iter(shafts)): 1.0},
        [pair for _, _, pair in meshes],
        [(one.shafts, ("end", "start")) for one in known.values()],  # about x, however they are drawn
    )
    ties = []
    for box, name, pair in meshes:
        mesh = box.meshes[name]
        scale = 0.5 * mesh.normal_module / math.cos(mesh.helix_angle)
        radii = (scale * box.gears[mesh.pinion].teeth, scale * box.gears[mesh.wheel].teeth)
        thrust = pinion_hand(box, name) * senses.get(pair[0], 1.0) * math.tan(mesh.helix_angle)
        ties.append(HelicalTie(*pair, radii, thrust))
    turning = turning_together(shafts, [one.shafts for name, one in known.items() if name != twisted])
    yield from not_held(turning, floating, ties)


def _mesh_shafts(box: "Gearbox") -> Iterator[tuple[str, tuple[str, str]]]:
    """Meshes by name with the shafts of pinion and wheel; those of unknown gears are a fault of their own."""
    for name, mesh in box.meshes.items():
        if mesh.pinion in box.gears and mesh.wheel in box.gears:
            yield name, (box.gears[mesh.pinion].shaft, box.gears[mesh.wheel].shaft)


def _double_helical(box: "Gearbox") -> Iterator[tuple[str, str]]:
    """Shafts whose gears hold each other axially."""
    for name, pair in _mesh_shafts(box):
        if box.meshes[name].helix_angle and box.meshes[name].double_helical:
            yield pair


def _single_helical(case: "Case") -> Iterator[tuple[str, tuple[str, str]]]:
    """Full names of meshes with the shafts that they push along x."""
    for box_name, box in case.gearboxes.items():
        yield from (
            (f"{box_name}.{name}", pair) for name, pair in _mesh_shafts(box) if has_hands(box.meshes[name])
        )


def _screws(meshes: Sequence[str]) -> str:
    if not meshes:
        return ""
    return (
        f"; a single-helical mesh ({', '.join(meshes)}) gives no axial restraint: the shaft can move axially as it "
        "turns"
    )


def _locate(case: "Case", group: Sequence[str]) -> str:
    own = [
        f"{box_name}.bearings.{name}"
        for box_name, box in case.gearboxes.items()
        for name, bearing in box.bearings.items()
        if bearing.shaft in group
    ]
    at = f" at gearboxes.{' or gearboxes.'.join(own)}" if own else " at a bearing of it"
    return f"write locating = true{at}, or axial_stiffness at a coupling to a located shaft"


def _lateral(case: "Case", couplings: Sequence["CouplingInput"]) -> Iterator[Fault]:
    """Shafts that can move sideways as rigid bodies while their bearings stand still."""
    shafts = case.power_circuit.shafts
    lengths = {name: math.fsum(section.length for section in part.sections) for name, part in shafts.items()}
    bearings = [bearing for box in case.gearboxes.values() for bearing in box.bearings.values()]
    stiff = [
        one
        for one in couplings
        if (one.radial_stiffness or one.angular_stiffness) and one.shafts[0] != one.shafts[1]
    ]
    for group in _joined(shafts, [coupling.shafts for coupling in stiff]):
        columns = {shaft: 2 * number for number, shaft in enumerate(group)}
        own = [bearing for bearing in bearings if bearing.shaft in columns]
        if any(bearing.position is None for bearing in own):
            continue  # a fault of its own
        rows = [_bearing_row(bearing, columns, lengths) for bearing in own]
        for coupling in stiff:
            if coupling.shafts[0] in columns:
                rows += _coupling_rows(coupling, columns, lengths)
        free = _free_shares(rows, len(group))
        if free.max() > FREE:
            shaft = group[int(np.argmax(free))]
            places = [bearing.position or 0.0 for bearing in own if bearing.shaft == shaft]
            others = [name for name, share in zip(group, free, strict=True) if share > FREE and name != shaft]
            yield Fault(
                f"drivetrain.shafts.{shaft}", "",
                f"has {_counted(places)} and can move sideways{_together(others)}: it needs two at different "
                "positions, or one and a coupling with lateral stiffness to a held shaft",
                "add or move a bearing, or add radial_stiffness and angular_stiffness at a coupling to a held shaft",
            )  # fmt: skip


def _counted(places: Sequence[float]) -> str:
    """How many bearings, and how far the outer ones stand apart."""
    if len(places) < 2:
        return "1 bearing" if places else "0 bearings"
    apart = show(max(places) - min(places), "length")
    return f"{len(places)} bearings {apart} apart, must be above 0 mm,"


def _bearing_row(
    bearing: "BearingInput", columns: Mapping[str, int], lengths: Mapping[str, float]
) -> NDArray[np.float64]:
    """Motion of a shaft at a bearing in a plane: its shift, and its tilt times the place, -1 at its start, 1 at its
    end."""
    row, column = np.zeros(2 * len(columns)), columns[bearing.shaft]
    row[column : column + 2] = 1.0, 2.0 * (bearing.position or 0.0) / lengths[bearing.shaft] - 1.0
    return row


def _coupling_rows(
    coupling: "CouplingInput", columns: Mapping[str, int], lengths: Mapping[str, float]
) -> Iterator[NDArray[np.float64]]:
    """Offset and angle between two ends in a plane; the shafts point away from it, on either side."""
    outward = [1.0 if end == "end" else -1.0 for end in coupling.ends]
    offset, angle = np.zeros((2, 2 * len(columns)))
    for sign, shaft, end in zip((1.0, -1.0), coupling.shafts, outward, strict=True):
        offset[columns[shaft] : columns[shaft] + 2] = sign, sign * end
        angle[columns[shaft] + 1] = end / lengths[shaft]
    if coupling.radial_stiffness:
        yield offset
    if coupling.angular_stiffness:
        yield angle


def _free_shares(rows: Sequence[NDArray[np.float64]], shafts: int) -> NDArray[np.float64]:
    """(shafts,) share of each shaft in the motions that no row resists; zero where every motion is resisted."""
    table = np.array([np.zeros(2 * shafts), *rows])
    size = np.linalg.norm(table, axis=1, keepdims=True)
    scaled = table / np.where(size > 0.0, size, 1.0)
    values, vectors = np.linalg.eigh(scaled.T @ scaled)
    free = vectors[:, values <= FREE]
    return np.asarray((free**2).sum(axis=1).reshape(shafts, 2).sum(axis=1))


def _joined(names: Collection[str], ties: Iterable[tuple[str, str]]) -> list[list[str]]:
    """Groups of names that ties join, in the order of the names."""
    group = {name: [name] for name in names}
    for first, second in ties:
        if group[first] is not group[second]:
            for name in group[second]:
                group[first].append(name)
                group[name] = group[first]
    order = {name: number for number, name in enumerate(names)}
    return [sorted(one, key=order.__getitem__) for one in {id(one): one for one in group.values()}.values()]


def _and(others: Sequence[str]) -> str:
    return f" and {', '.join(others)}" if others else ""


def _together(others: Sequence[str]) -> str:
    return f" together with {', '.join(others)}" if others else ""


# Rules of what shakes the shafts: unbalance, bow, flanges out of true, axes out of line.

OF_SHAFT = ("unbalances", "balance_grade", "balance_speed", "balance_angles", "bow")
OF_SPLINE = ("radial_stiffness", "axial_stiffness", "angular_stiffness", "lateral_damping_time")
OF_COUPLING = ("flange_run_out", "flange_tilt", "cold_angle_lateral", "cold_angle_vertical")


def rotating_part_faults(case: "Case") -> Iterator[Fault]:
    """Parts off their shaft, bows without bearings, offsets at couplings that do not resist, shafts that only twist."""
    train = case.power_circuit
    if train.shaft_model == "torsional":
        yield from _torsional(case)
        return
    for name, shaft in train.shafts.items():
        yield from _of_shaft(case, name, shaft)
    for name, coupling in train.couplings.items():
        yield from _of_coupling(f"drivetrain.couplings.{name}", coupling)


def sideways_keys(case: "Case") -> list[str]:
    """Paths of the keys a case states that nothing but shafts that bend reads."""
    stated = _of_circuit(case.power_circuit)
    for name, box in case.gearboxes.items():
        at = f"gearboxes.{name}"
        if box.housing is not None and box.housing.bearing_seats == "elastic":
            stated.append(f"{at}.housing.bearing_seats")
        stated += [
            f"{at}.bearings.{part}.support_stiffness"
            for part, bearing in box.bearings.items()
            if bearing.support_stiffness is not None
        ]
        stated += [
            f"{at}.gears.{part}.spline.{key}"
            for part, gear in box.gears.items()
            for key in OF_SPLINE
            if gear.spline is not None and key in gear.spline.model_fields_set
        ]
    return stated


def _of_circuit(train: "DrivetrainInput") -> list[str]:
    stated = [
        f"drivetrain.shafts.{name}.{key}"
        for name, shaft in train.shafts.items()
        for key in OF_SHAFT
        if key in shaft.model_fields_set
    ]
    stated += ["drivetrain.balance_grade"] if train.balance_grade is not None else []
    return stated + [
        f"drivetrain.couplings.{name}.{key}"
        for name, coupling in train.couplings.items()
        for key in OF_COUPLING
        if key in coupling.model_fields_set and not (coupling.alternates and key.startswith("cold"))
    ]


def _torsional(case: "Case") -> Iterator[Fault]:
    for path in sideways_keys(case):
        yield Fault(
            path, "",
            'is read by shafts that bend, but shaft_model = "torsional" lets them only twist',
            'write drivetrain.shaft_model = "elastic", or leave it out',
        )  # fmt: skip


def _of_shaft(case: "Case", name: str, shaft: "ShaftInput") -> Iterator[Fault]:
    length = math.fsum(section.length for section in shaft.sections)
    at = f"drivetrain.shafts.{name}"
    places = {f"{at}.unbalances.{own}.position": part.position for own, part in shaft.unbalances.items()}
    if shaft.bow is not None and shaft.bow.position is not None:
        places[f"{at}.bow.position"] = shaft.bow.position
    for path, position in places.items():
        if position > length * (1.0 + 1e-9):
            yield Fault(
                path, show(position, "length"),
                f"lies beyond the end of the shaft at {show(length, 'length')}",
                "write a distance from the start of the shaft that lies on it",
            )  # fmt: skip
    if shaft.balance_speed == 0.0:
        yield Fault(
            f"{at}.balance_speed", "0 rpm", "is not above 0 rpm: a grade is the speed of the centre of mass",
            "write the highest service speed, or leave it out for that of the schedule",
        )  # fmt: skip
    if shaft.bow is not None:
        yield from _bow(case, name, shaft.bow)


def _bow(case: "Case", name: str, bow: "BowInput") -> Iterator[Fault]:
    at = f"drivetrain.shafts.{name}.bow"
    places = {
        bearing.position
        for box in case.gearboxes.values()
        for bearing in box.bearings.values()
        if bearing.shaft == name and bearing.position is not None
    }
    if len(places) < 2:
        yield Fault(
            at, "",
            f"the bow of a shaft counts from the line through its bearings: {len(places)} at places of their own, must "
            "be 2",
            "add a bearing to the shaft, or leave the bow out and state an unbalance",
        )  # fmt: skip
    elif bow.position is not None and bow.amplitude:
        nearest = min(places, key=lambda place: abs(place - (bow.position or 0.0)))
        if abs(nearest - bow.position) < 1e-3 * (max(places) - min(places)):
            yield Fault(
                f"{at}.position", show(bow.position, "length"),
                f"is at a bearing, {show(nearest, 'length')}, where a bent shaft has no distance from its line",
                "write a place between the bearings or beyond them",
            )  # fmt: skip
    if not (bow.amplitude or bow.temperature_difference):
        yield Fault(
            at, "", "has neither an amplitude nor a temperature difference",
            'write amplitude = "10 um" or temperature_difference = "5 K", or leave the bow out',
        )  # fmt: skip


def _of_coupling(at: str, coupling: "CouplingInput") -> Iterator[Fault]:
    rests = {"flange_run_out": "radial_stiffness", "flange_tilt": "angular_stiffness"}
    if not coupling.alternates:
        rests |= {"cold_angle_lateral": "angular_stiffness", "cold_angle_vertical": "angular_stiffness"}
    for key, stiffness in rests.items():
        value = getattr(coupling, key)
        if value and getattr(coupling, stiffness) is None:
            kind = "length" if key == "flange_run_out" else "angle"
            yield Fault(
                f"{at}.{key}", show(value, kind),
                f"loads no shaft: the coupling states no {stiffness}, it gives way to it freely",
                f"add {stiffness} from its data sheet, or leave {key} out",
            )  # fmt: skip
