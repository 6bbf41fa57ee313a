"""Defaults of room, losses, schedule, test plan and numerics."""

import math

from rigdesign.case.defaults.drivetrains import run_up_time
from rigdesign.case.defaults.raw_tree import RawTree
from rigdesign.case.defaults.rule import Filling, RuleBook, assumed, follows

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
        "half of the motor torque accelerates, at least 4 s",
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
