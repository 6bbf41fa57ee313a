"""Defaults of the power circuit of two gearboxes: places on the shafts, sections, couplings, motor, bracing.

The first gearbox of the case stands at the front: its shafts start at their front bearing and end in a coupling. The
second stands behind it: its shafts start at the coupling; that of the wheel goes on to the motor.
"""

import math

from rigdesign.base.part_name import GearName
from rigdesign.case.defaults.rule import (
    Filling,
    RawTree,
    RuleBook,
    around,
    assumed,
    bearing_bores,
    bearing_distance,
    bearings_on,
    follows,
    gear_on,
    millimetres,
    normal_module,
    only_mesh,
    shaft_diameter,
    shaft_of,
    shafts_of,
)

book = RuleBook()
STEEL = 7850.0
"""Density of steel [kg/m3]."""
STUB = 2.5
"""Length from the last bearing to the coupling, in diameters of the shaft."""
FLANGE = (3.25, 0.35)
"""Diameter and width of half a coupling, in diameters of the shaft: a steel flange."""
FOUR_POLE = 1500.0 * math.tau / 60.0
"""Synchronous speed of a four-pole motor [rad/s]: the size of a rotor goes with torque, at whatever speed it turns."""
STEEPEST = 1.875
"""Largest slope of a stage over its mean, see `dynamics.vibration.schedule.s_derivative`."""
DAMPING_TIME = 2e-5
"""Damping over stiffness of a coupling [s]: a loss factor of 0.06 at 500 Hz."""


def _two_boxes(tree: RawTree) -> list[str]:
    """Front and rear gearbox; empty where the circuit is another one, or losses are given and there is none."""
    boxes = tree.names("gearboxes")
    given = tree.text("losses.basis") == "input" and not tree.has("drivetrain")
    return boxes if len(boxes) == 2 and not given and all(only_mesh(tree, box) for box in boxes) else []


def _side(tree: RawTree, box: str, side: str) -> str | None:
    """Shaft of the pinion or wheel of the only mesh of a gearbox."""
    gear = tree.text(f"gearboxes.{box}.meshes.{only_mesh(tree, box)}.{side}")
    return None if gear is None else shaft_of(tree, box, "gears", gear)


def _stub(tree: RawTree, box: str, shaft: str) -> float | None:
    diameter = shaft_diameter(tree, box, shaft)
    return None if diameter is None else math.ceil(1e3 * STUB * diameter) * 1e-3


def _start(tree: RawTree, box: str, shaft: str) -> float | None:
    """Place of the front bearing on a shaft [m]; None in a circuit of another kind."""
    boxes = _two_boxes(tree)
    if box not in boxes:
        return None
    return 0.0 if box == boxes[0] else _stub(tree, box, shaft)


@book.default("gearboxes.*.bearings.*.position")
def _bearing_position(tree: RawTree, box: str, bearing: str) -> Filling:
    at = f"gearboxes.{box}.bearings.{bearing}"
    shaft = tree.text(f"{at}.shaft")
    start = None if shaft is None else _start(tree, box, shaft)
    distance = None if shaft is None else bearing_distance(tree, box, shaft)
    if start is None or distance is None:
        return None
    place = start if tree.text(f"{at}.side") == "front" else start + distance
    if tree.has(f"gearboxes.{box}.housing"):
        return follows(millimetres(place), "at the inner side of its end wall, from the start of the shaft")
    return assumed(millimetres(place), "three shaft diameters beside the gear, from the start of the shaft")


@book.default("gearboxes.*.gears.*.position")
def _gear_position(tree: RawTree, box: str, gear: str) -> Filling:
    shaft = shaft_of(tree, box, "gears", gear)
    if shaft is None or _start(tree, box, shaft) is None:
        return None
    found = (
        tree.length(f"gearboxes.{box}.bearings.{name}.position") for name in bearings_on(tree, box, shaft)
    )
    places = [place for place in found if place is not None]
    return (
        assumed(millimetres(sum(places) / 2.0), "middle between its bearings") if len(places) == 2 else None
    )


@book.default("drivetrain.shafts", completes=True)
def _shafts(tree: RawTree) -> Filling:
    return {shaft: {} for box in _two_boxes(tree) for shaft in shafts_of(tree, box)} or None


@book.default("drivetrain.shafts.*.material")
def _shaft_material(tree: RawTree, shaft: str) -> Filling:
    return assumed("case_hardened_steel", "usual for shafts")


@book.default("drivetrain.shafts.*.material_damping")
def _material_damping(tree: RawTree, shaft: str) -> Filling:
    reason = "steel in torsion; without it nothing damps a mode that lies within one shaft"
    return assumed(0.001, reason, 0.0002, 0.002)


@book.default("drivetrain.shafts.*.sections")
def _sections(tree: RawTree, shaft: str) -> Filling:
    """As thick as in the bearings, from the front bearing to the coupling, or on to the motor.

    None where the bearings differ in bore: the case says where the shaft steps.
    """
    boxes = _two_boxes(tree)
    box = next((name for name in boxes if shaft in shafts_of(tree, name)), None)
    if box is None:
        return None
    found = (
        tree.length(f"gearboxes.{box}.bearings.{name}.position") for name in bearings_on(tree, box, shaft)
    )
    places = [place for place in found if place is not None]
    diameter, stub = shaft_diameter(tree, box, shaft), _stub(tree, box, shaft)
    if not places or diameter is None or stub is None or max(bearing_bores(tree, box, shaft)) > diameter:
        return None
    reaches_out = box == boxes[0] or shaft == (
        tree.text("drivetrain.motor.shaft") or _side(tree, box, "wheel")
    )
    length = max(places) + (stub if reaches_out else 0.0)
    reason = "one diameter from bearing to bearing and 2.5 diameters on to the coupling"
    section = {"length": millimetres(length), "outer_diameter": millimetres(diameter)}
    return assumed([section], reason)


@book.default("drivetrain.shafts.*.discs")
def _discs(tree: RawTree, shaft: str) -> Filling:
    """Half of a coupling at its end of a shaft of two gearboxes whose couplings the case does not state."""
    boxes = _two_boxes(tree)
    box = next((name for name in boxes if shaft in shafts_of(tree, name)), None)
    if box is None or tree.has("drivetrain.couplings"):
        return None
    diameter, length = (
        shaft_diameter(tree, box, shaft),
        tree.length(f"drivetrain.shafts.{shaft}.sections.0.length"),
    )
    if diameter is None or length is None or tree.count(f"drivetrain.shafts.{shaft}.sections") != 1:
        return None
    outer, width = FLANGE[0] * diameter, FLANGE[1] * diameter
    inertia = math.pi * STEEL * width * outer**4 / 32.0
    reason = "half of a coupling: steel flange of 3.25 x 0.35 shaft diameters"
    return {
        "coupling_half": {
            "position": follows(
                millimetres(length if box == boxes[0] else 0.0), "end of the shaft at the coupling"
            ),
            "inertia": around(inertia, "kg m2", reason, (0.3, 4.0)),
            "mass": assumed(f"{8.0 * inertia / outer**2:.3g} kg", reason),
        }
    }


@book.default("drivetrain.torque_at")
def _torque_at(tree: RawTree) -> Filling:
    for box in _two_boxes(tree):
        if tree.text(f"gearboxes.{box}.role") == "specimen":
            pinion = tree.text(f"gearboxes.{box}.meshes.{only_mesh(tree, box)}.pinion")
            return None if pinion is None else follows(f"{box}.{pinion}", "pinion of the specimens")
    return None


@book.default("drivetrain.couplings")
def _couplings(tree: RawTree) -> Filling:
    boxes = _two_boxes(tree)
    names = {side: [_side(tree, box, side) for box in boxes] for side in ("pinion", "wheel")}
    if not boxes or any(None in pair for pair in names.values()):
        return None
    return {
        f"{side}_side": {
            "shafts": follows(pair, f"{side} to {side}"),
            "ends": follows(["end", "start"], "end of the front shaft, start of the rear one"),
        }
        for side, pair in names.items()
    }


@book.default("drivetrain.couplings.*.torsional_stiffness")
def _coupling_stiffness(tree: RawTree, coupling: str) -> Filling:
    torque = tree.si("schedule.test_torque", "torque")
    if not torque:
        return None
    if coupling == "wheel_side":
        return around(
            200.0 * torque, "N m/rad", "disc coupling with torque flange: 5 mrad at test torque", (0.25, 5.0)
        )
    return around(1000.0 * torque, "N m/rad", "clamping coupling: 1 mrad at test torque", (0.3, 3.0))


@book.default("drivetrain.couplings.*.torsional_damping")
def _coupling_damping(tree: RawTree, coupling: str) -> Filling:
    stiffness = tree.si(f"drivetrain.couplings.{coupling}.torsional_stiffness", "torsional_stiffness")
    if stiffness is None:
        return None
    return around(DAMPING_TIME * stiffness, "N m s/rad", "loss factor of 0.06 at 500 Hz", (0.25, 4.0))


# ------------------------------------------------------------------ motor, bracing


@book.default("drivetrain.motor.shaft")
def _motor_shaft(tree: RawTree) -> Filling:
    boxes = _two_boxes(tree)
    shaft = _side(tree, boxes[1], "wheel") if boxes else None
    return None if shaft is None else follows(shaft, "the motor drives the wheel of the second gearbox")


@book.default("drivetrain.motor.end")
def _motor_end(tree: RawTree) -> Filling:
    return follows("end", "free end of that shaft") if _two_boxes(tree) else None


@book.default("drivetrain.motor.torque_limit")
def _motor_torque(tree: RawTree) -> Filling:
    torque = _torque_at_motor(tree)
    if torque is None:
        return None
    return around(0.1 * torque, "N m", "a tenth of the locked torque: losses of some per cent and run-up")


@book.default("drivetrain.motor.inertia")
def _motor_inertia(tree: RawTree) -> Filling:
    limit = tree.si("drivetrain.motor.torque_limit", "torque")
    if not limit:
        return None
    reason = "rotor of a four-pole motor of this torque, 0.0019 kg m2 (P/kW)^1.4 with P at 1500 rpm"
    return around(0.0019 * (1e-3 * limit * FOUR_POLE) ** 1.4, "kg m2", reason)


def _ratio_to_motor(tree: RawTree) -> float | None:
    """Torque of the motor shaft over that at which the case counts, without losses."""
    counted = GearName.read(tree.text("drivetrain.torque_at") or "")
    shaft = tree.text("drivetrain.motor.shaft")
    driven = next((name for name in tree.names("gearboxes") if shaft in shafts_of(tree, name)), None)
    if shaft is None or driven is None:
        return None
    mesh, other = (
        f"gearboxes.{driven}.meshes.{only_mesh(tree, driven)}",
        f"gearboxes.{counted.gearbox}.meshes",
    )
    pinion, wheel = tree.text(f"{mesh}.pinion"), tree.text(f"{mesh}.wheel")
    teeth = [tree.number(f"gearboxes.{driven}.gears.{gear}.teeth") for gear in (pinion, wheel)]
    if not teeth[0] or not teeth[1]:
        return None
    at_pinion = counted.part == tree.text(f"{other}.{only_mesh(tree, counted.gearbox)}.pinion")
    drives_pinion = gear_on(tree, driven, shaft) == pinion
    return (1.0 if drives_pinion else teeth[1] / teeth[0]) * (1.0 if at_pinion else teeth[0] / teeth[1])


def _torque_at_motor(tree: RawTree) -> float | None:
    torque, ratio = tree.si("schedule.test_torque", "torque"), _ratio_to_motor(tree)
    return torque * ratio if torque and ratio else None


def _speed_at_motor(tree: RawTree) -> float | None:
    speed, ratio = tree.si("schedule.test_speed", "speed"), _ratio_to_motor(tree)
    return speed / ratio if speed and ratio else None


def run_up_time(tree: RawTree) -> float | None:
    """Time [s] in which half of the motor torque brings rotor, gears and couplings up to speed, at least 4 s."""
    limit, speed = tree.si("drivetrain.motor.torque_limit", "torque"), _speed_at_motor(tree)
    rotor, driven = tree.si("drivetrain.motor.inertia", "inertia"), tree.text("drivetrain.motor.shaft")
    if not limit or speed is None or rotor is None:
        return None
    total = rotor
    motor_side = (
        "pinion" if any(_side(tree, box, "pinion") == driven for box in _two_boxes(tree)) else "wheel"
    )
    for box in _two_boxes(tree):
        mesh = f"gearboxes.{box}.meshes.{only_mesh(tree, box)}"
        sides = {side: tree.text(f"{mesh}.{side}") for side in ("pinion", "wheel")}
        teeth = {side: tree.number(f"gearboxes.{box}.gears.{gear}.teeth") for side, gear in sides.items()}
        for side, gear in sides.items():
            width = tree.length(f"gearboxes.{box}.gears.{gear}.face_width")
            module, own, motor = normal_module(tree, box, gear or ""), teeth[side], teeth[motor_side]
            if not own or not motor or width is None or module is None:
                continue
            inertia = math.pi * STEEL * width * (module * own) ** 4 / 32.0
            shaft = f"drivetrain.shafts.{_side(tree, box, side)}.discs"
            inertia += sum(tree.si(f"{shaft}.{disc}.inertia", "inertia") or 0.0 for disc in tree.names(shaft))
            total += inertia * (motor / own) ** 2
    return max(math.ceil(STEEPEST * total * speed / (0.5 * limit)), 4.0)


@book.default("drivetrain.bracing.mode")
def _bracing(tree: RawTree) -> Filling:
    if not _two_boxes(tree) or tree.has("drivetrain.bracing.shifted_gear"):
        return None
    return assumed("twist_held", "load clutch that is twisted at rest, as in an FZG rig")


@book.default("drivetrain.bracing.coupling")
def _bracing_coupling(tree: RawTree) -> Filling:
    couplings = tree.names("drivetrain.couplings")
    if tree.text("drivetrain.bracing.mode") != "twist_held" or not couplings:
        return None
    return assumed(couplings[0], "the first coupling of the case is the load clutch")
