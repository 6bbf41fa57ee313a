"""Defaults of room, losses, schedule, test plan and numerics."""

import math
from dataclasses import dataclass

from rigdesign.case.defaults.drivetrains import run_up_time
from rigdesign.case.defaults.raw_tree import RawTree
from rigdesign.case.defaults.rule import Filling, RuleBook, assumed, follows
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
    box, _, gear = (tree.text("drivetrain.torque_at") or "").partition(".")
    teeth = tree.number(f"gearboxes.{box}.gears.{gear}.teeth") or 0.0
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
    box, _, gear = (tree.text("drivetrain.torque_at") or "").partition(".")
    control = next(
        (key for key, known in meshes.items() if key[0] == box and known and gear in known.gears), None
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
