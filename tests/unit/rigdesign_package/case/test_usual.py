"""A slip of a power of ten in any number of a case is refused or warned of, or its key is listed here with a reason."""

import re
from collections.abc import Iterator
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import pytest

from rigdesign.base.errors import CaseError
from rigdesign.case.loader import load_case
from rigdesign.case.model import Case
from rigdesign.case.paths import slot_at
from rigdesign.case.provenance import item_name, take_off
from rigdesign.case.usual import unusual_inputs
from rigdesign.explanation.keys import explain_path
from rigdesign.explanation.overview import overview
from rigdesign.run.main import _doubts
from tests.builders.paths import CASES

BOTH, UP, DOWN = (10.0, 0.1), (10.0,), (0.1,)
DO_NOT_MATTER = {
    # values that a tenfold change leaves within what is built; loads, modes and stresses with them are reported
    "drivetrain.couplings.*_stiffness": BOTH,
    "gearboxes.*.gears.*.spline.torsional_stiffness": BOTH,
    "gearboxes.*.gears.*.flank.*_crowning": BOTH,
    "gearboxes.*.housing.foot_contact.conductance": BOTH,
    "gearboxes.*.heat_transfer_coefficient": DOWN,
    # damping is known to a power of ten; modes that ring or are overdamped are reported
    "drivetrain.couplings.*.torsional_damping": BOTH,
    "gearboxes.*.gears.*.spline.torsional_damping": BOTH,
    # read only where the case asks for them, bearing_coefficients = "stated" and bearing_drag = "constant"
    "gearboxes.*.bearings.*.radial_stiffness": BOTH,
    "gearboxes.*.bearings.*.radial_damping": BOTH,
    "gearboxes.*.bearings.*.torsional_damping": BOTH,
    # places and lengths near the start of a shaft, within a few per cent of its length
    "drivetrain.shafts.*.discs.*.position": DOWN,
    "drivetrain.shafts.*.sections.*.length": BOTH,
    "gearboxes.*.bearings.*.position": DOWN,
    # a limit that is tighter than meant fails the run
    "drivetrain.couplings.*.radial_offset_maximum": DOWN,
    "limits.alignment.axis_*_maximum": DOWN,
    "limits.oil.*_maximum": DOWN,
    "limits.ramp.run_up_torque_share_maximum": DOWN,
    "limits.temperatures.tempering_distance_minimum": UP,
    # a finer model takes longer; a coarser one is named by the findings `sampling` and `response`
    "numerics.*": BOTH,
    # the ramp: a motor that cannot follow, and a speed or torque against the rules of the run-up, fail
    "schedule.stages.*.duration": BOTH,
    "schedule.stages.*.speed": BOTH,
    "schedule.stages.*.torque": DOWN,
    # a test at a tenth of the load is one; the window of the root stress of the specimens says what it is worth
    "schedule.test_torque": DOWN,
    # moves nothing but counted load cycles, which are results
    "test_plan.time": BOTH,
}
"""Keys whose slip by one power of ten is silent, and in which direction."""


@pytest.mark.parametrize(
    "file", sorted(CASES.glob("*/*.toml")), ids=lambda file: f"{file.parent.name}/{file.stem}"
)
def test_every_shipped_value_is_usual(file: Path) -> None:
    assert unusual_inputs(load_case(file)) == {}


@pytest.mark.parametrize("name", ["fzg", "loop_1to1", "uhcf_prototype"])
def test_no_slip_of_a_power_of_ten_passes_in_silence(name: str) -> None:
    case = load_case(CASES / name)
    slips = [(path, factor, new) for path, value in _keys(case) for factor, new in _slipped(value)]
    silent = {
        (path, factor)
        for path, factor, new in slips
        if not _excused(path, factor) and not _noticed(case, path, new)
    }
    assert len(slips) > 20
    assert silent == set()


@pytest.mark.parametrize("factor", [1e-3, 1e3])
def test_three_powers_of_ten_are_noticed_in_what_one_leaves_plausible(factor: float) -> None:
    case = load_case(CASES / "loop_1to1")
    for path in (
        "drivetrain.couplings.pinion_side.torsional_stiffness",
        "gearboxes.test.gears.pinion.flank_roughness",
    ):
        value = case.origin.value_of[path]
        number, unit = value.split(" ", 1)
        assert _noticed(case, path, f"{float(number) * factor:g} {unit}")


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"limits.specimen.root_stress_maximum": "600 GPa"}, "0.2 to 2 times the root strength"),
        ({"limits.dynamics.dynamic_factor_maximum": 150}, "1.02 to 4"),
        ({"ambient.temperature": "293 degC"}, "-45 degC to 60 degC"),
        (
            {"gearboxes.test.bearings.pinion_rear.position": "72 mm"},
            "into its neighbour on shaft test_pinion",
        ),
        (
            {"gearboxes.test.gears.pinion.position": "150 mm"},
            "is not between the bearings of its shaft, 0 mm and 140 mm",
        ),
        ({"gearboxes.test.bearings.pinion_rear.diameter": "90 mm"}, "a bore of 90 mm on a section of 40 mm"),
        ({"schedule.test_torque": "30000 N m"}, "N m, 1e+06 to 6e+08 times"),
    ],
)
def test_a_warning_names_key_value_and_range(changes: dict[str, Any], named: str) -> None:
    found = unusual_inputs(load_case(CASES / "loop_1to1").with_values(changes))
    path, value = next(iter(changes.items()))
    value = value if isinstance(value, str) else f"{value:g}"
    text = " ".join(found.values())
    assert path.rpartition(".")[0] in text and value in text and named in text and "confirmed" in text


def test_a_reason_confirms_a_value(tmp_path: Path) -> None:
    written = 'extends = "{}"\n[ambient]\ntemperature = {{ value = "-50 degC"{} }}\n'
    for mark, unusual in (("", {"ambient.temperature"}), (', confirmed = "cold chamber"', set())):
        file = tmp_path / "case.toml"
        file.write_text(written.format(CASES / "loop_1to1" / "case.toml", mark), encoding="utf-8")
        assert set(unusual_inputs(load_case(file))) == unusual


def _noticed(case: Case, path: str, new: Any) -> bool:
    try:
        return bool(unusual_inputs(case.with_values({path: new})))
    except CaseError:
        return True


def _excused(path: str, factor: float) -> bool:
    return any(fnmatchcase(path, pattern) and factor in way for pattern, way in DO_NOT_MATTER.items())


def _keys(case: Case) -> Iterator[tuple[str, Any]]:
    """A number that the case states, one for each key of like parts."""
    plain = take_off(dict(case.origin.stated))[0]
    seen = set()
    for path, value in _leaves(plain, ""):
        slot = slot_at(Case, plain, path.split("."))
        key = re.sub(
            r"(?:^|\.)(gearboxes|shafts|discs|couplings|gears|bearings|meshes|seals|stages|sections|boundary)\.\w+",
            r".\1",
            path,
        )
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        if slot is not None and key not in seen and (slot.quantity is not None or is_number):
            seen.add(key)
            yield path, value


def _leaves(node: Any, path: str) -> Iterator[tuple[str, Any]]:
    if isinstance(node, dict):
        for key, value in node.items():
            yield from _leaves(value, f"{path}.{key}" if path else key)
    elif isinstance(node, tuple):
        for number, value in enumerate(node):
            yield from _leaves(value, f"{path}.{item_name(value, number)}")
    else:
        yield path, node


def _slipped(value: Any) -> Iterator[tuple[float, Any]]:
    """The value ten times larger and smaller; degrees Celsius are never divided by ten."""
    number, _, unit = value.partition(" ") if isinstance(value, str) else (str(value), "", "")
    for factor in UP if unit == "degC" else BOTH:
        slipped = float(number) * factor
        if slipped:
            as_written = int(slipped) if isinstance(value, int) and factor > 1.0 else slipped
            yield factor, f"{slipped:.12g} {unit}" if unit else as_written


def test_run_and_explain_say_what_is_unusual() -> None:
    case = load_case(CASES / "loop_1to1").with_value("ambient.temperature", "293 degC")
    (finding,) = _doubts(case)
    assert finding.id == "unusual_input" and finding.text == unusual_inputs(case)["ambient.temperature"]
    assert overview(case).unusual == (finding.text,)
    explained = explain_path(case, "ambient.temperature")
    assert explained.unusual == (finding.text,)
    assert explained.key.bounds == "at least -60 degC and at most 600 degC; usually -45 degC to 60 degC"
