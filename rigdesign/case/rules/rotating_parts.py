"""Rules of what shakes the shafts: unbalance, bow, flanges out of true, axes out of line."""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from rigdesign.base.errors import Fault
from rigdesign.base.units import show

if TYPE_CHECKING:
    from rigdesign.case.drivetrain import CouplingInput, DrivetrainInput, ShaftInput
    from rigdesign.case.model import Case

OF_SHAFT = ("unbalances", "balance_grade", "balance_speed", "balance_angles", "bow")
OF_SPLINE = ("radial_stiffness", "axial_stiffness", "angular_stiffness", "lateral_damping_time")
OF_COUPLING = ("flange_run_out", "flange_tilt", "cold_angle_lateral", "cold_angle_vertical")


def rotating_part_faults(case: "Case") -> Iterator[Fault]:
    """Parts off their shaft, bows without bearings, offsets at couplings that do not resist, shafts that only twist."""
    train = case.drivetrain
    assert train is not None
    if train.shaft_model == "torsional":
        yield from _torsional(case)
        return
    for name, shaft in train.shafts.items():
        yield from _of_shaft(case, name, shaft)
    for name, coupling in train.couplings.items():
        yield from _of_coupling(f"drivetrain.couplings.{name}", coupling)


def sideways_keys(case: "Case") -> list[str]:
    """Paths of the keys a case states that nothing but shafts that bend reads."""
    stated = [] if case.drivetrain is None else _of_circuit(case.drivetrain)
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
        if key in coupling.model_fields_set and not (coupling.joint == "hooke" and key.startswith("cold"))
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
        yield from _bow(case, name, shaft)


def _bow(case: "Case", name: str, shaft: "ShaftInput") -> Iterator[Fault]:
    bow, at = shaft.bow, f"drivetrain.shafts.{name}.bow"
    assert bow is not None
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
    if coupling.joint != "hooke":
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
