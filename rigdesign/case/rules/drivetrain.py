"""Rules of the drivetrain that span several keys: references, places on shafts, bracing."""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from rigdesign.base.errors import Fault
from rigdesign.base.part_name import GearName
from rigdesign.base.units import show
from rigdesign.case.faults import unknown, written

if TYPE_CHECKING:
    from rigdesign.case.gears import Gear
    from rigdesign.case.model import Case

MOST_TWIST = 1.0
"""Of a joint under the test torque [rad]."""


def drivetrain_faults(case: "Case") -> Iterator[Fault]:
    """Everything wrong with the power circuit; nothing for a case without one."""
    train = case.drivetrain
    if train is None:
        return
    shafts = list(train.shafts)
    gears = {
        f"{name}.{gear}": part for name, box in case.gearboxes.items() for gear, part in box.gears.items()
    }
    lengths = {name: math.fsum(s.length for s in shaft.sections) for name, shaft in train.shafts.items()}
    for name, shaft in train.shafts.items():
        for index, section in enumerate(shaft.sections):
            if section.inner_diameter >= section.outer_diameter:
                yield Fault(
                    f"drivetrain.shafts.{name}.sections.{index}.inner_diameter",
                    show(section.inner_diameter, "length"),
                    f"is not below the outer diameter {show(section.outer_diameter, 'length')}",
                    "write the bore of the section",
                )
        for disc_name, disc in shaft.discs.items():
            yield from _on_shaft(
                f"drivetrain.shafts.{name}.discs.{disc_name}.position", disc.position, lengths[name]
            )
    lines = {name: {name} for name in shafts}
    for name, coupling in train.couplings.items():
        for shaft_name in coupling.shafts:
            if shaft_name not in shafts:
                yield unknown(f"drivetrain.couplings.{name}.shafts", shaft_name, shafts, "shaft")
        if coupling.shafts[0] == coupling.shafts[1]:
            yield Fault(
                f"drivetrain.couplings.{name}.shafts", written(coupling.shafts[0]), "joins a shaft to itself",
                "name two shafts",
            )  # fmt: skip
        elif set(coupling.shafts) <= lines.keys():
            front, rear = (lines[shaft] for shaft in coupling.shafts)
            if front is rear:
                yield Fault(
                    f"drivetrain.couplings.{name}.shafts", ", ".join(map(written, coupling.shafts)),
                    "joins shafts that other couplings make one line already, so that the loop stays open",
                    "name the shafts of the line that is left, e.g. those of the wheels",
                )  # fmt: skip
            joined = front | rear
            lines |= dict.fromkeys(joined, joined)
    if train.motor.shaft not in shafts:
        yield unknown("drivetrain.motor.shaft", train.motor.shaft, shafts, "shaft")
    if train.torque_at not in gears:
        yield unknown("drivetrain.torque_at", train.torque_at, list(gears), "gear (gearbox.gear)")
    yield from _bracing(case, gears)
    yield from _soft(case)
    for name, box in case.gearboxes.items():
        for kind, parts in (("gears", box.gears), ("bearings", box.bearings)):
            for part_name, part in parts.items():
                path = f"gearboxes.{name}.{kind}.{part_name}"
                if part.shaft not in shafts:
                    yield unknown(f"{path}.shaft", part.shaft, shafts, "shaft in the drivetrain")
                elif part.position is None:
                    yield Fault(
                        f"{path}.position", "", "a part on a shaft of the drivetrain needs its place",
                        "add the distance of its middle from the start of the shaft",
                    )  # fmt: skip
                else:
                    yield from _on_shaft(f"{path}.position", part.position, lengths[part.shaft])
        for gear_name, gear in box.gears.items():
            if gear.seat_offset and gear.seat_position is not None and gear.shaft in shafts:
                yield from _seat_on_shaft(
                    f"gearboxes.{name}.gears.{gear_name}.seat_offset", gear, lengths[gear.shaft]
                )


def _soft(case: "Case") -> Iterator[Fault]:
    """Joints that the test torque would wind up."""
    joints = {f"drivetrain.couplings.{name}": part for name, part in case.power_circuit.couplings.items()} | {
        f"gearboxes.{name}.gears.{gear}.spline": part.spline
        for name, box in case.gearboxes.items()
        for gear, part in box.gears.items()
        if part.spline is not None
    }
    for path, joint in joints.items():
        twist = case.schedule.test_torque / joint.torsional_stiffness
        if twist > MOST_TWIST:
            yield Fault(
                f"{path}.torsional_stiffness", show(joint.torsional_stiffness, "torsional_stiffness"),
                f"twists by {twist:.3g} rad under schedule.test_torque, limit {MOST_TWIST:g} rad",
                "write the torque per angle of twist in radians; a soft elastic coupling reaches 0.3 rad",
            )  # fmt: skip


def _seat_on_shaft(path: str, gear: "Gear", length: float) -> Iterator[Fault]:
    seat = gear.seat_position
    if seat is not None and not -1e-9 * length <= seat <= length * (1.0 + 1e-9):
        yield Fault(
            path, show(gear.seat_offset, "length"),
            f"puts the middle of the seat at {show(seat, 'length')} of a shaft of {show(length, 'length')}",
            "write the distance of the face from the seat, positive towards the end of the shaft",
        )  # fmt: skip


def _on_shaft(path: str, position: float, length: float) -> Iterator[Fault]:
    if position > length * (1.0 + 1e-9):
        yield Fault(
            path, show(position, "length"), f"lies beyond the end of the shaft at {show(length, 'length')}",
            "move the part or lengthen the shaft",
        )  # fmt: skip


def _bracing(case: "Case", gears: "dict[str, Gear]") -> Iterator[Fault]:
    bracing, couplings = case.power_circuit.bracing, case.power_circuit.couplings
    at = "drivetrain.bracing"
    if bracing.coupling is not None and bracing.coupling not in couplings:
        yield unknown(f"{at}.coupling", bracing.coupling, list(couplings), "coupling")
    if bracing.shifted_gear is not None and bracing.shifted_gear not in gears:
        yield unknown(f"{at}.shifted_gear", bracing.shifted_gear, list(gears), "gear (gearbox.gear)")
    if bracing.mode == "twist_held" and bracing.coupling is None:
        yield Fault(f"{at}.coupling", "", "a held twist needs the coupling it is made in", "name a coupling")
    if bracing.mode == "shift_held" and bracing.shifted_gear is None:
        yield Fault(
            f"{at}.shifted_gear", "", "a held shift needs the gear that is shifted", "name a helical gear"
        )
    if bracing.coupling is None and bracing.shifted_gear is None:
        yield Fault(
            at,
            "",
            "nothing makes the torque",
            "name the coupling that is twisted or the helical gear that is shifted",
        )
    if bracing.shifted_gear in gears:
        shifted = GearName.read(bracing.shifted_gear)
        meshes = case.gearboxes[shifted.gearbox].meshes.values()
        helices = [mesh.helix_angle for mesh in meshes if shifted.part in (mesh.pinion, mesh.wheel)]
        if len(helices) > 1:
            yield Fault(
                f"{at}.shifted_gear", written(bracing.shifted_gear),
                f"is in {len(helices)} meshes: an idler that is shifted only turns, it braces nothing",
                "name one of its partners",
            )  # fmt: skip
        if not any(helices):
            yield Fault(
                f"{at}.shifted_gear", written(bracing.shifted_gear),
                "its helix angle is zero, a shift makes no torque",
                "name a helical gear or brace by the twist of a coupling",
            )  # fmt: skip
