"""Defaults of room, losses, schedule, test plan and numerics."""

import math
from dataclasses import dataclass

from rigdesign.base.part_name import GearName
from rigdesign.case.defaults.drivetrains import run_up_time
from rigdesign.case.defaults.rule import (
    Filling,
    Given,
    RawTree,
    RuleBook,
    around,
    assumed,
    bearing_bore,
    follows,
)
from rigdesign.case.rotation import shaft_senses

book = RuleBook()
RPM = math.tau / 60.0
SMALLEST_RATE = 20_000
"""Sample rate [Hz] below which no default goes."""


@book.default("title")
def _title(tree: RawTree) -> Filling:
    name = tree.text("name")
    return None if name is None else follows(name.replace("_", " ") or name, "name of the case")


@book.default("ambient.temperature")
def _room(tree: RawTree) -> Filling:
    return assumed("20 degC", "test cell", "15 degC", "30 degC")


@book.default("gearboxes.*.rotation")
def _rotation(tree: RawTree, box: str) -> Filling:
    """As its couplings turn a gearbox, where another one states its rotation or that is not the usual one."""
    boxes = tree.names("gearboxes")
    stated = next((name for name in boxes if tree.text(f"gearboxes.{name}.rotation")), None)
    base = stated or boxes[0]
    pairs = {name: _mesh_shafts(tree, name) for name in boxes}
    if base == box or not pairs[base] or not pairs[box]:
        return None
    couplings = []
    for name in tree.names("drivetrain.couplings"):
        at = f"drivetrain.couplings.{name}"
        ends = [tree.text(f"{at}.{key}.{i}") for key in ("shafts", "ends") for i in (0, 1)]
        match ends:
            case [str(), str(), str(), str()]:
                couplings.append(((ends[0] or "", ends[1] or ""), (ends[2] or "", ends[3] or "")))
    first = -1.0 if tree.text(f"gearboxes.{base}.rotation") == "anticlockwise" else 1.0
    meshes = [pair for name in boxes for pair in pairs[name]]
    sense = shaft_senses({pairs[base][0][0]: first}, meshes, couplings).get(pairs[box][0][0])
    if sense is None or (stated is None and sense > 0.0):
        return None
    value, reason = "clockwise" if sense > 0.0 else "anticlockwise", f"its couplings to gearbox {base}"
    return assumed(value, reason) if stated is None else follows(value, reason)


def _mesh_shafts(tree: RawTree, box: str) -> list[tuple[str, str]]:
    """Shafts of pinion and wheel of the meshes of a gearbox; none where one is unreadable."""
    known = [_members(tree, box, mesh) for mesh in tree.names(f"gearboxes.{box}.meshes")]
    return [one.shafts for one in known if one is not None] if None not in known else []


@book.default("losses.squeeze_share")
def _squeeze(tree: RawTree) -> Filling:
    """Only of a case that says nothing about losses; the share of any other is that of the model."""
    if tree.has("losses"):
        return None
    boxes = [f"gearboxes.{box}.oil.lubrication" for box in tree.names("gearboxes")]
    if any(tree.text(path) == "dip" for path in boxes):
        return None
    return assumed(0.05, "injection into the mesh", 0.0, 0.1)


@book.default("losses.basis")
def _basis(tree: RawTree) -> Filling:
    return follows("computed", "every loss by its law; those under losses.given in their place")


@book.default("losses.chamber_density")
def _mist(tree: RawTree) -> Filling:
    if tree.text("losses.basis") != "computed":
        return None
    return assumed("5 kg/m3", "oil mist between air (1.2) and heavy spray (20)", "1.2 kg/m3", "20 kg/m3")


@book.default("schedule.stages")
def _stages(tree: RawTree) -> Filling:
    """Load at rest, run up, dwell, run down: the test of a rig that is braced at rest."""
    speed = tree.at("schedule.test_speed")
    if not isinstance(speed, str) or not tree.si("schedule.test_torque", "torque"):
        return None
    run_up = run_up_time(tree) or 4.0
    times = assumed(
        f"{run_up:g} s",
        "half of the motor torque at most accelerates, at least 4 s",
        f"{run_up / 2:g} s",
        f"{run_up * 5:g} s",
    )
    braced = assumed(1.0, "the torque is locked in at rest, as in an FZG rig")
    return [
        {"name": "bracing", "kind": "load", "torque_share": braced, "duration": follows("1 s", "at rest")},
        {"name": "run_up", "kind": "run_up", "speed": follows(speed, "test speed"), "duration": times},
        {
            "name": "test",
            "kind": "dwell",
            "duration": assumed(
                "0.5 s", "part of the dwell that is followed in time; temperatures are steady"
            ),
            "held": True,
        },
        {"name": "run_down", "kind": "run_down", "speed": "0 rpm", "duration": times},
    ]


@book.default("test_plan.time")
def _test_time(tree: RawTree) -> Filling:
    return assumed("100 h", "a test of some days; moves nothing but counts of load cycles", "10 h", "1000 h")


# ------------------------------------------------------------------ numerics


@book.default("numerics.temperature_tolerance")
def _temperature_tolerance(tree: RawTree) -> Filling:
    return assumed("0.05 K", "far below what a thermocouple reads")


@book.default("numerics.growth_tolerance")
def _growth_tolerance(tree: RawTree) -> Filling:
    return assumed("0.5 um", "far below clearances")


@book.default("numerics.torque_tolerance")
def _torque_tolerance(tree: RawTree) -> Filling:
    return assumed(0.001, "a tenth of what a torque flange reads")


@book.default("numerics.sample_rate")
def _sample_rate(tree: RawTree) -> Filling:
    speed = tree.si("schedule.test_speed", "speed")
    if speed is None:
        return None
    gear = GearName.read(tree.text("drivetrain.torque_at") or "")
    teeth = tree.number(f"gearboxes.{gear.gearbox}.gears.{gear.part}.teeth") or 0.0
    rate = max(10.0 * teeth * speed / math.tau, SMALLEST_RATE)
    return assumed(f"{math.ceil(rate / 1e3):g} kHz", "ten samples a mesh at test speed, at least 20 kHz")


@book.default("numerics.curve_speed_start")
def _curve_start(tree: RawTree) -> Filling:
    return _curve(tree, 0.25, "a quarter of the test speed")


@book.default("numerics.curve_speed_end")
def _curve_end(tree: RawTree) -> Filling:
    return _curve(tree, 1.5, "one and a half times the test speed")


def _curve(tree: RawTree, share: float, reason: str) -> Filling:
    speed = tree.si("schedule.test_speed", "speed")
    return assumed(f"{share * speed / RPM:.4g} rpm", reason) if speed else None


@book.default("numerics.response_period")
def _response_period(tree: RawTree) -> Filling:
    """Only of a loop whose meshes have no common tooth period; that of one mesh is the usual one."""
    teeth = _teeth_in_a_turn(tree)
    if teeth is None or all(_whole(passing / teeth[0], 1.0) for passing in teeth):
        return None
    passing = ", ".join(f"{number:.6g}" for number in dict.fromkeys(teeth))
    reason = f"the meshes pass {passing} teeth in a turn of the first pinion"
    if all(_whole(number, round(number)) for number in teeth):
        return follows("revolution", f"{reason}: they meet again after it")
    return follows("hunting_cycle", f"{reason}: they meet again after several turns")


def _whole(number: float, nearest: float) -> bool:
    return abs(number - nearest) < 1e-6


def _teeth_in_a_turn(tree: RawTree) -> list[float] | None:
    """Teeth that each mesh passes in a turn of the pinion of ``drivetrain.torque_at``, that mesh first.

    None where tooth numbers, shafts or couplings do not say it.
    """
    meshes = {
        (box, name): _members(tree, box, name)
        for box in tree.names("gearboxes")
        for name in tree.names(f"gearboxes.{box}.meshes")
    }
    gear = GearName.read(tree.text("drivetrain.torque_at") or "")
    control = next(
        (
            key
            for key, known in meshes.items()
            if key[0] == gear.gearbox and known and gear.part in known.gears
        ),
        None,
    )
    if control is None:
        return None
    speeds = _shaft_speeds(tree, [known for known in meshes.values() if known], meshes[control])
    passing = [
        None if known is None or known.shafts[0] not in speeds else known.teeth[0] * speeds[known.shafts[0]]
        for known in (meshes[control], *meshes.values())
    ]
    return None if None in passing else [number for number in passing if number is not None]


@dataclass(frozen=True)
class _Members:
    """Pinion and wheel of a mesh: names, shafts, tooth numbers."""

    gears: tuple[str, str]
    shafts: tuple[str, str]
    teeth: tuple[float, float]


def _members(tree: RawTree, box: str, mesh: str) -> _Members | None:
    gears = [tree.text(f"gearboxes.{box}.meshes.{mesh}.{side}") for side in ("pinion", "wheel")]
    shafts = [tree.text(f"gearboxes.{box}.gears.{gear}.shaft") for gear in gears]
    teeth = [tree.number(f"gearboxes.{box}.gears.{gear}.teeth") for gear in gears]
    match gears, shafts, teeth:
        case [str(), str()], [str(), str()], [float(first), float(second)] if first > 0.0 and second > 0.0:
            return _Members(
                (gears[0] or "", gears[1] or ""), (shafts[0] or "", shafts[1] or ""), (first, second)
            )
    return None


def _shaft_speeds(tree: RawTree, meshes: list[_Members], first: _Members | None) -> dict[str, float]:
    """Speed of every shaft per speed of the first pinion, along meshes and couplings."""
    assert first is not None
    joints = [(known.shafts, known.teeth[0] / known.teeth[1]) for known in meshes]
    for coupling in tree.names("drivetrain.couplings"):
        ends = [tree.text(f"drivetrain.couplings.{coupling}.shafts.{end}") for end in (0, 1)]
        if ends[0] is not None and ends[1] is not None:
            joints.append(((ends[0], ends[1]), 1.0))
    speeds = {first.shafts[0]: 1.0}
    for _ in joints:
        for (here, there), ratio in joints:
            if here in speeds:
                speeds.setdefault(there, speeds[here] * ratio)
            elif there in speeds:
                speeds[here] = speeds[there] / ratio
    return speeds


# The standard set of limits, for a case that states none or asks for those it leaves out.

LEAST_FILM = 7e-6 / 40e-3
"""Least film over journal diameter: 7 um at 40 mm, of the size of the guide values of ISO 7902-3."""


def standard_limits(tree: RawTree) -> dict[str, dict[str, Filling]]:
    """Limits by table and key; those that need what the case lacks are None."""
    return {
        "clearances": {
            "backlash_minimum": _of_module(tree, 0.005, "um", 1e6, "0.005 modules left when hot"),
            "tip_clearance_minimum": _of_module(tree, 0.1, "mm", 1e3, "0.1 modules left when hot"),
            "bearing_clearance_minimum": _of_journal(tree, 1e-3, "1 per mille of the smallest journal"),
        },
        "temperatures": {
            "oil_outlet_maximum": assumed("110 degC", "life of the oil", "100 degC", "120 degC"),
            "bearing_film_maximum": _journal_only(tree, assumed("120 degC", "white metal; guide value of ISO 7902-3")),
            "tempering_distance_minimum": assumed("20 K", "distance to the loss of hardness", "10 K", "40 K"),
        },
        "bearing": {
            "film_thickness_minimum": _of_journal(tree, LEAST_FILM, "guide values of ISO 7902-3 grow with the journal"),
            "specific_load_maximum": _journal_only(
                tree, assumed("5 MPa", "white metal; guide value of ISO 7902-3", "5 MPa", "7 MPa")
            ),
        },
        "dynamics": {
            "dynamic_factor_maximum": assumed(1.5, "load of the test known within half", 1.3, 1.8),
            "resonance_distance_minimum": assumed(0.1, "usual separation of a held speed", 0.05, 0.2),
            "lift_off_share_maximum": assumed(0.0, "flanks stay closed in every loaded stage"),
        },
        "strength": {
            "root_safety_minimum": assumed(1.4, "a rig gear must outlive the specimens", 1.2, 1.6),
        },
        "flanks": {
            "pitting_safety_minimum": assumed(
                1.2, "as 1.4 of the root: the stress of a flank grows with the root of its load", 1.0, 1.3
            ),
            "scuffing_safety_minimum": assumed(1.5, "friction and oil test are known within a third", 1.2, 2.0),
        },
        "bought_parts": {"motor": _motor(tree)},
    }  # fmt: skip


def fill_limits(tree: RawTree) -> None:
    """Fill in the standard set, in place: all of it where there are no limits, else what is left out if asked for."""
    given = tree.root.get("limits")
    if given is None:
        tree.root["limits"] = {}
    elif not isinstance(given, dict) or tree.at("limits.standard_set") is not True:
        return
    limits = tree.root["limits"]
    for table, keys in standard_limits(tree).items():
        known = {key: value for key, value in keys.items() if value is not None}
        place = limits.setdefault(table, {}) if known else {}
        for key, value in known.items():
            if isinstance(place, dict):
                place.setdefault(key, value.as_marked() if isinstance(value, Given) else value)


def _of_module(tree: RawTree, share: float, unit: str, scale: float, reason: str) -> Filling:
    """A share of the smallest module of the rig."""
    found = [
        tree.length(f"gearboxes.{box}.meshes.{mesh}.normal_module")
        for box in tree.names("gearboxes")
        for mesh in tree.names(f"gearboxes.{box}.meshes")
    ]
    known = [module for module in found if module is not None]
    return around(scale * share * min(known), unit, reason) if known else None


def _journals(tree: RawTree) -> list[float]:
    found = [
        bearing_bore(tree, box, name)
        for box in tree.names("gearboxes")
        for name in tree.names(f"gearboxes.{box}.bearings")
        if tree.text(f"gearboxes.{box}.bearings.{name}.type") in (None, "journal")
    ]
    return [bore for bore in found if bore is not None]


def _of_journal(tree: RawTree, share: float, reason: str) -> Filling:
    journals = _journals(tree)
    return around(1e6 * share * min(journals), "um", reason, (0.7, 1.4)) if journals else None


def _journal_only(tree: RawTree, limit: Given) -> Filling:
    return limit if _journals(tree) else None


def _motor(tree: RawTree) -> Filling:
    """Drive torque against the torque limit of the motor."""
    stated = tree.text("drivetrain.motor.torque_limit")
    if stated is None:
        return None
    reason = "torque limit of the motor"
    return {
        "title": "drive torque of the motor",
        "part": "drivetrain.motor",
        "quantity": "drive_torque",
        "limit": follows(stated, reason).as_marked(),
        "source": "drivetrain.motor.torque_limit of the case",
    }
