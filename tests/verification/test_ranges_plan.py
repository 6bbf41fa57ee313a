"""What `--ranges` solves again against the whole solved again, for every number a case states.

Every numeric path is moved by its range, a twentieth or ten kelvin. Two things are compared: the checks that move
against those that name the path among their assumptions, and the ends that solve a part of the model against the
same solved in full. The whole prototype takes about an hour and is started by hand; a sample of a rig without a
housing runs always.
"""

import sys
import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from rigdesign import load_case
from rigdesign.base.errors import CaseError
from rigdesign.case import Case
from rigdesign.case.fields import MODEL_PARTS, ModelPart
from rigdesign.case.loader import changed_together
from rigdesign.case.paths import Slot, known_paths, slot_at
from rigdesign.case.provenance import item_name, take_off
from rigdesign.checks.assumptions import depends, with_assumptions
from rigdesign.studies.assumed_ranges import (
    ALIKE,
    LEAST_MOVE,
    EndResult,
    RangeEnd,
    plan,
    solve_end,
    solve_stated,
)
from rigdesign.studies.modified_rig import parts_of
from rigdesign.studies.reference_rig import Reference
from tests.builders.checks import check, limit_of, rule_ids
from tests.builders.paths import CASES

MORE = """
[ambient]
surroundings_temperature = "20 degC"
reference_temperature = "20 degC"
[oils.own]
title = "two viscosities"
kinematic_viscosity_40 = "95 mm2/s"
kinematic_viscosity_100 = "10.7 mm2/s"
density_15 = "885 kg/m3"
heat_capacity = "1900 J/(kg K)"
conductivity = "0.13 W/(m K)"
[gearboxes.test.bearing_oil]
oil = "own"
[gearboxes.test.oil_state]
air_content = 0.02
viscosity_factor = 1.0
heat_capacity_factor = 1.0
[gearboxes.test.oil_paths]
leak_warm_cold = 0.02
bypass = 0.04
short_circuit = 0.02
[gearboxes.test.loss_factors]
windage = 1.0
seal = 1.0
jet = 1.0
squeeze = 1.0
mesh = 1.0
bearing = 1.0
[gearboxes.test.seals.pinion]
rubbing_torque = "0.02 N m"
"""
"""Inputs that the shipped cases leave at their defaults."""
SHORTER = {
    "drivetrain.motor.torque_limit": "40 N m",
    "limits.bought_parts.motor.limit": "40 N m",
    "schedule.stages.run_up.duration": "3 s",
    "schedule.stages.run_down.duration": "2 s",
}
SAMPLE = (
    "ambient.temperature",
    "ambient.reference_temperature",
    "oils.own.kinematic_viscosity_40",
    "gearboxes.test.oil_state.viscosity_factor",
    "gearboxes.test.loss_factors.bearing",
    "gearboxes.test.seals.pinion.rubbing_torque",
    "gearboxes.test.oil.inlet_temperature",
    "gearboxes.test.bearings.pinion_front.feed_share",
)
"""Of the rig without a housing: what was dropped, and what is solved again in part."""


@cache
def settled(name: str) -> tuple[Reference, EndResult]:
    """A shipped case with the inputs of `MORE`, settled."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "case.toml"
        head = f'extends = "{(CASES / name / "case.toml").as_posix()}"\nname = "swept"\ntitle = "swept"\n'
        file.write_text(head + MORE, encoding="utf-8")
        case = load_case(file)
    if name == "uhcf_prototype":
        for path, value in SHORTER.items():
            case = case.with_value(path, value)
    return solve_stated(case)


def value_at(tree: Any, keys: list[str]) -> Any:
    for key in keys:
        if isinstance(tree, list | tuple):
            names = [item_name(item, index) for index, item in enumerate(tree)]
            tree = tree[names.index(key) if key in names else int(key)]
        else:
            tree = tree.get(key) if isinstance(tree, dict) else None
    return tree


def numeric_paths(case: Case) -> dict[str, tuple[Any, Slot]]:
    """Path -> value as written and what the place holds, of every number and quantity the case states."""
    plain, _, _ = take_off(dict(case.origin.tree))
    found = {}
    for path in known_paths(Case, plain):
        value, slot = value_at(plain, path.split(".")), slot_at(Case, plain, path.split("."))
        if slot is None or value is None or isinstance(value, dict | bool):
            continue
        if isinstance(value, int | float) or (isinstance(value, str) and slot.quantity is not None):
            found[path] = value, slot
    return found


def moves(value: Any, slot: Slot) -> Iterator[object]:
    """Other values, the first that is valid counts."""
    if isinstance(value, int) and float not in slot.plain_types:
        yield from (value + 1, value - 1, value + 2)
    elif isinstance(value, int | float):
        yield from (*(value * factor for factor in (1.05, 0.95, 1.01, 0.99)), 0.05)
    else:
        number, _, unit = value.partition(" ")
        assert slot.quantity is not None
        if slot.quantity.kind == "temperature":
            yield from (f"{float(number) + step} {unit}" for step in (10, -10, 5, -5))
        else:
            yield from (f"{float(number) * factor!r} {unit}" for factor in (1.05, 0.95, 1.01, 0.99))
            yield f"1 {unit}"


def tied(case: Case, path: str) -> tuple[str, ...]:
    """The path and those that must have the same value: the other bearings of its shaft."""
    names = path.split(".")
    if len(names) != 5 or names[2] != "bearings" or names[4] not in ALIKE:
        return (path,)
    bearings = case.gearboxes[names[1]].bearings
    shaft = bearings[names[3]].shaft
    return tuple(
        f"gearboxes.{names[1]}.bearings.{b}.{names[4]}" for b, e in bearings.items() if e.shaft == shaft
    )


def ends(reference: Reference, path: str) -> tuple[EndResult, EndResult] | None:
    """The path moved: what `--ranges` solves, and all solved again; None where no other value is a valid rig."""
    case = reference.case
    value, slot = numeric_paths(case)[path]
    for other in moves(value, slot):
        try:
            changed = changed_together(case, dict.fromkeys(tied(case, path), other))
        except CaseError:
            continue

        def solved(parts: tuple[ModelPart, ...], changed: Case = changed, other: object = other) -> EndResult:
            end = RangeEnd(
                path=path, together_with=(), end="low", value=str(other), stated=str(value), parts=parts, case=changed
            )  # fmt: skip
            return solve_end(end, reference=reference)

        full = solved(MODEL_PARTS)
        if full.error is None:
            parts = parts_of(path)
            return (full if parts == MODEL_PARTS else solved(parts)), full
    return None


def differences(one: EndResult, other: EndResult) -> dict[str, float]:
    """Check -> difference of its distance, where it is more than what the report lists."""
    found = {}
    for name, left in one.checks.items():
        right = other.checks[name].distance
        if left.distance is not None and right is not None and abs(left.distance - right) > LEAST_MOVE:
            found[name] = left.distance - right
    return found


def mismatches(name: str, path: str) -> list[str]:
    """What is wrong with the plan for one path."""
    reference, stated = settled(name)
    outcomes = ends(reference, path)
    if outcomes is None:
        return []
    planned, full = outcomes
    found = [f"{path}: in part {key} differs by {gap:.4f}" for key, gap in differences(full, planned).items()]
    for key in differences(full, stated):
        source = limit_of(key) if key.count(".") else ""
        if not depends(reference.case, check(key, source), path):
            found.append(f"{path}: {key} moves and does not name it")
    return found


@pytest.mark.parametrize("path", SAMPLE)
def test_what_a_path_moves_is_solved_again_and_named(path: str) -> None:
    assert mismatches("loop_1to1", path) == []


@pytest.mark.slow
def test_every_number_of_the_prototype() -> None:
    reference, _ = settled("uhcf_prototype")
    paths = [path for path in numeric_paths(reference.case) if not path.startswith("numerics.")]
    wrong = []
    for number, path in enumerate(paths, start=1):
        wrong += mismatches("uhcf_prototype", path)
        print(f"{number}/{len(paths)} {path}: {len(wrong)} mismatches", file=sys.stderr, flush=True)
    assert len(paths) > 300
    assert wrong == []


@pytest.mark.parametrize(
    "path",
    [
        "ambient.temperature",
        "oils.own.density_15",
        "gearboxes.test.oil_state.air_content",
        "gearboxes.test.oil_paths.bypass",
        "gearboxes.test.loss_factors.mesh",
        "gearboxes.test.seals.pinion.rubbing_torque",
        "numerics.curve_speeds",
    ],
)
def test_a_path_nobody_lists_is_solved_in_full_and_decides(path: str) -> None:
    """These were left out of `--ranges` with the words that no check depends on them."""
    reference, _ = settled("loop_1to1")
    text = check("oil.cooler", "limits.oil.cooler_power_maximum")
    assert depends(reference.case, text, path)
    assert parts_of(path) == MODEL_PARTS or "seals" in path


def test_ambient_from_5_to_40_degrees_is_not_left_out(tmp_path: Path) -> None:
    file = tmp_path / "case.toml"
    file.write_text(
        f'extends = "{(CASES / "uhcf_prototype" / "case.toml").as_posix()}"\n'
        '[ambient]\ntemperature = { value = "20 degC", assumed = "hall", range = ["5 degC", "40 degC"] }\n',
        encoding="utf-8",
    )
    case = load_case(file)
    checks = [with_assumptions(case, check(key, limit_of(key))) for key in rule_ids(case)]
    found, left = plan(case, checks)
    assert [end.value for end in found if end.path == "ambient.temperature"] == ["5 degC", "40 degC"]
    assert all(end.parts == MODEL_PARTS for end in found if end.path == "ambient.temperature")
    assert "ambient.temperature" not in {row.path for row in left}
    deciding = {one.id for one in checks if "ambient.temperature" in one.assumptions}
    assert deciding >= {
        "temperature.housing", "temperature.bearing_film", "temperature.oil_outlet", "temperature.gear_bulk",
        "clearance.tip_clearance", "oil.cooler", "oil.heater", "oil.room", "alignment.coupling_offset.pinion_side",
    }  # fmt: skip
    assert "oil.flow" not in deciding and "ramp.start_torque" not in deciding
