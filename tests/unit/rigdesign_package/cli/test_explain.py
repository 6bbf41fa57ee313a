"""`rigdesign explain`, the key reference and the completion: what they say, and that it is complete."""

import json
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from rigdesign.case import Case, load_case
from rigdesign.case.paths import known_paths
from rigdesign.explanation.check import explain_check
from rigdesign.explanation.keys import case_keys, entry_at, explain_path, key_reference
from tests.builders.checks import rule_ids
from tests.builders.commands import SMALL, Rigdesign, Write
from tests.builders.paths import CASES

PROTOTYPE = CASES / "uhcf_prototype"
LOOP = CASES / "loop_1to1"
OIL = "gearboxes.test.oil.inlet_temperature"


@pytest.fixture(scope="module")
def prototype() -> Case:
    return load_case(PROTOTYPE)


# ---------------------------------------------------------------------------- a key


def test_a_key_says_what_it_is_where_it_comes_from_and_what_it_moves(rigdesign: Rigdesign) -> None:
    ended = rigdesign("explain", PROTOTYPE, OIL)
    assert ended.status == 0 and ended.err == ""
    words = " ".join(ended.out.split())
    for said in (
        "Temperature at which the oil enters the gearbox.",
        "temperature in degC, K, degF; at least -60 degC and at most 600 degC",
        "140 degC (assumed: the prototype runs at the temperature of the main rig; range 90 degC to 140 degC)",
        "of 101 depend on it",
    ):
        assert said in words


def test_the_document_of_a_key_holds_the_same(rigdesign: Rigdesign) -> None:
    found = json.loads(rigdesign("explain", PROTOTYPE, OIL, "--json").out)
    assert found["key"]["kind"] == "temperature" and found["key"]["required"]
    assert found["values"][0] == {
        "path": OIL, "value": "140 degC", "basis": "assumed",
        "reason": "the prototype runs at the temperature of the main rig", "range": ["90 degC", "140 degC"],
        "description": "", "table": False,
    }  # fmt: skip
    assert "temperature.oil_outlet" in found["checks"] and "oil.flow" not in found["checks"]


def test_a_star_stands_for_any_name(prototype: Case) -> None:
    found = explain_path(prototype, "gearboxes.*.bearings.*.diametral_clearance")
    assert len(found.values) == 8 and found.key.path == "gearboxes.NAME.bearings.NAME.diametral_clearance"


def test_a_table_lists_its_keys(prototype: Case, rigdesign: Rigdesign) -> None:
    found = explain_path(prototype, "gearboxes.test.oil")
    names = [key.path.rpartition(".")[2] for key in found.keys]
    assert names[:4] == ["lubrication", "oil", "inlet_temperature", "flow"] and found.checks == ()
    rows = [line.split() for line in rigdesign("explain", PROTOTYPE, "gearboxes.test.oil").out.splitlines()]
    assert ["flow", "5", "l/min", "*", "Flow", "per", "mesh."] in rows and ["*", "assumed"] in rows


def test_a_table_without_parts_says_what_a_part_would_hold(prototype: Case) -> None:
    found = explain_path(prototype, "oils")
    assert found.keys[0].path == "oils.NAME.title" and found.keys[0].value == "required"


@pytest.mark.parametrize(
    ("path", "basis", "value"),
    [
        ("gearboxes.test.oil.blocked_jets", "default", "0"),
        ("gearboxes.test.oil.outlet_temperature", "left out", ""),
        ("schedule.test_speed", "source", "12000 rpm"),
    ],
)
def test_where_a_value_comes_from(prototype: Case, path: str, basis: str, value: str) -> None:
    listed = {key.path: key for key in explain_path(prototype, path.rpartition(".")[0]).keys}
    for found in (listed[path], *explain_path(prototype, path).values):
        assert (found.basis, found.value) == (basis, value)


def test_a_part_that_is_left_out_and_assumed_says_so(write: Write) -> None:
    """No joint under the foot is an assumption that the case makes by saying nothing."""
    base = f'extends = "{(PROTOTYPE / "case.toml").as_posix()}"\nname = "fixed"\n'
    case = load_case(write(base + '[gearboxes.test.housing]\nremove = ["foot_contact"]\n'))
    listed = {key.path: key for key in explain_path(case, "gearboxes.test.housing").keys}
    found = listed["gearboxes.test.housing.foot_contact"]
    assert found.basis == "assumed" and found.value == "perfect"


def test_every_path_of_the_shipped_cases_is_explained() -> None:
    """No path of a case is unknown to the schema, and each says what it is."""
    for name in ("uhcf_prototype", "loop_1to1", "uhcf_main"):
        case = load_case(CASES / name)
        for path in known_paths(Case, case.model_dump(mode="python")):
            entry = entry_at(path)
            assert entry is not None and entry.description, path


def test_a_condition_has_the_keys_of_its_law(prototype: Case) -> None:
    conditions = prototype.gearboxes["test"].housing.boundary  # type: ignore[union-attr]
    for name, condition in conditions.items():
        path = f"gearboxes.test.housing.boundary.{name}"
        found = explain_path(prototype, path)
        assert {key.path.rpartition(".")[2] for key in found.keys} == set(type(condition).model_fields), path


# ---------------------------------------------------------------------------- a check


@pytest.mark.parametrize("name", ["uhcf_prototype", "loop_1to1", "loop_hunting"])
def test_whether_a_check_applies_is_known_before_anything_is_solved(name: str) -> None:
    expected = json.loads((CASES / name / "expected.json").read_text(encoding="utf-8"))
    case = load_case(CASES / name)
    for identity in rule_ids(case):
        assert explain_check(case, identity).applicable == (identity in expected["checks"]), identity


def test_a_check_says_rule_procedure_source_and_inputs(rigdesign: Rigdesign) -> None:
    ended = rigdesign("explain", PROTOTYPE, "--check", "specimen.root_stress_iso.test.pinion")
    words = " ".join(ended.out.split())
    assert "within 700 MPa to 1100 MPa (limits.specimen.root_stress_minimum" in words
    assert "ISO 6336-3:2006 method B with the simulated K_V" in words
    assert "needs a drivetrain" in words and "sigma_F of ISO 6336-3:2006 at every held stage" in words


def test_a_limit_that_has_a_default_is_shown_with_it(prototype: Case) -> None:
    found = explain_check(prototype, "transient.soak.test")
    assert found.applicable and found.needs == ("check --transient",)
    assert found.limits[0].path == "transient.warm_up" and found.limits[0].value == "4 h by default"


def test_a_check_without_a_limit_says_so(rigdesign: Rigdesign) -> None:
    out = rigdesign("explain", LOOP, "--check", "clearance.backlash").out
    assert "the case states no limit" in out and "the check does not apply to this case" in out


def results_in(folder: Path, case: Case, *, ranges: Mapping[str, Any] | None) -> Path:
    """A results.json as far as explain reads it."""
    folder.mkdir()
    row = {
        "id": "clearance.backlash", "value": 0.05, "unit": "mm", "margin": 0.03, "distance": 0.6,
        "verdict": "open", "flags": [], "reason": "test.main, stage test",
    }  # fmt: skip
    document = {"case": {"name": case.name, "hash": case.hash}, "checks": [row], "ranges": ranges}
    (folder / "results.json").write_text(json.dumps(document), encoding="utf-8")
    return folder


def test_ranges_of_a_finished_check_sort_its_inputs(
    prototype: Case, tmp_path: Path, rigdesign: Rigdesign
) -> None:
    shifts = {OIL: (0.03, 0.01), "ambient.temperature": (0.029, 0.031), "schedule.test_torque": (None, 0.03)}
    margins = [
        {"check": "clearance.backlash", "path": path, "margin_low": low, "margin_high": high}
        for path, (low, high) in shifts.items()
    ]
    folder = results_in(tmp_path / "out", prototype, ranges={"margins": margins})
    document = json.loads(
        rigdesign("explain", PROTOTYPE, "--check", "clearance.backlash", "--results", folder, "--json").out
    )
    assert [one["path"] for one in document["inputs"][:2]] == [OIL, "ambient.temperature"]
    assert document["inputs"][0]["shift"] == pytest.approx(0.02) and document["finished"]["same_case"]
    out = rigdesign("explain", PROTOTYPE, "--check", "clearance.backlash", "--results", folder).out
    words = " ".join(out.split())
    assert f"moved by {OIL} = 90 degC to 140 degC: margin 0.03 to 0.01 mm" in words
    assert "open: 0.05 mm, margin 0.03 mm, distance 60 %" in words
    assert "not ranked inputs without a range" in words and "* stands for any name" not in words


def test_without_ranges_inputs_are_listed_and_not_ranked(prototype: Case, rigdesign: Rigdesign) -> None:
    """By table, the assumed ones first, each key once; how a ranking is had is said."""
    out = rigdesign("explain", PROTOTYPE, "--check", "oil.flow").out
    words = " ".join(out.split())
    assert "ranking none without --ranges" in words
    assert f"rigdesign check {PROTOTYPE} --ranges --out DIR" in words
    assert f"rigdesign explain {PROTOTYPE} --check oil.flow --results DIR" in words
    assert "gearboxes.*.oil: flow gearboxes.*.bearing_oil: flow" in words
    whole = rigdesign("explain", PROTOTYPE, "--check", "temperature.oil_outlet").out
    assert max(map(len, whole.splitlines())) <= 80
    assumed, others = whole.split("assumed inputs;")[1].split("other inputs;")
    assert "numerics: " in others and "numerics: " not in assumed
    found = explain_check(prototype, "temperature.oil_outlet")
    assert not found.ranked and [one.assumed for one in found.inputs] == sorted(
        (one.assumed for one in found.inputs), reverse=True
    )
    names = {one.key.rpartition(".")[2] for one in found.inputs}
    assert {name for name in names if name not in whole} == set()


def test_results_of_another_case_are_refused(prototype: Case, tmp_path: Path, rigdesign: Rigdesign) -> None:
    folder = results_in(tmp_path / "out", prototype, ranges=None)
    ended = rigdesign("explain", CASES / "loop_1to1", "--check", "clearance.backlash", "--results", folder)
    assert ended.status == 2 and "results of case uhcf_prototype, not of loop_1to1" in ended.err


def test_results_of_another_state_and_without_ranges_are_said(
    prototype: Case, tmp_path: Path, rigdesign: Rigdesign
) -> None:
    folder = results_in(
        tmp_path / "out", prototype.with_value("schedule.test_torque", "170 N m"), ranges=None
    )
    out = rigdesign("explain", PROTOTYPE, "--check", "clearance.backlash", "--results", folder).out
    words = " ".join(out.split())
    assert "holds results of another state of the case" in words and "holds no ranges" in words
    assert "ranking none without --ranges" in words


# ---------------------------------------------------------------------------- an overview


def test_without_a_path_the_case_is_seen_at_a_glance(rigdesign: Rigdesign, prototype: Case) -> None:
    ended = rigdesign("explain", PROTOTYPE)
    document = json.loads(rigdesign("explain", PROTOTYPE, "--json").out)
    assert len(ended.out.splitlines()) < 30
    assert "test: specimen; pinion 99 / wheel 102 teeth, module 1 mm; 4 bearings;" in ended.out
    assert sum(document["inputs"].values()) == len(prototype.inputs)
    assert [stage["name"] for stage in document["stages"] if stage["held"]] == ["test"]
    listed = {identity for found in document["checks"].values() for identity in found}
    assert listed | set(document["unlimited"]) == rule_ids(prototype)


# ---------------------------------------------------------------------------- bad input


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["gearboxes.test.oil.inlet_temprature"], ["no such path", OIL]),
        (["gearboxes.*.seel"], ["no such path"]),
        (["*"], ["different keys", "leave the path out"]),
        (["--check", "clearance.backlsh"], ["no such check", "clearance.backlash"]),
        ([OIL, "--check", "oil.flow"], ["two questions", "leave one of them out"]),
        ([OIL, "--results", "out"], ["add --check"]),
        (["--check", "oil.flow", "--results", "nowhere"], ["nowhere/results.json", "rigdesign check --out"]),
    ],
)
def test_a_wrong_question_is_answered_with_the_nearest(
    arguments: list[str], said: list[str], rigdesign: Rigdesign
) -> None:
    ended = rigdesign("explain", PROTOTYPE, *arguments)
    assert ended.status == 2 and ended.out == ""
    assert [words for words in said if words not in ended.err] == []


@pytest.mark.parametrize("text", ["{", "[]", "{}", '{"checks": [{"id": "oil.flow"}]}', '{"checks": 3}'])
def test_a_file_that_holds_no_results_is_refused(text: str, tmp_path: Path, rigdesign: Rigdesign) -> None:
    (tmp_path / "results.json").write_text(text, encoding="utf-8")
    ended = rigdesign("explain", PROTOTYPE, "--check", "oil.flow", "--results", tmp_path)
    assert ended.status == 2 and str(tmp_path / "results.json") in ended.err


def test_a_case_with_faults_is_refused_as_everywhere(rigdesign: Rigdesign, write: Write) -> None:
    ended = rigdesign("explain", write(SMALL.replace('"1000 h"', '"1000 kg"')))
    assert ended.status == 2 and "test_plan.time" in ended.err


# ---------------------------------------------------------------------------- the reference


def test_the_key_reference_is_current() -> None:
    """`rigdesign schema --reference > cases/keys.md` carries it over."""
    assert (CASES / "keys.md").read_text(encoding="utf-8") == key_reference()


def test_the_reference_names_every_key(rigdesign: Rigdesign) -> None:
    text = rigdesign("schema", "--reference").out
    assert text == key_reference()
    rows = [line for line in text.splitlines() if line.startswith("| `")]
    assert len(rows) == sum(not entry.path.endswith((".NAME", ".N")) for entry in case_keys())


# ---------------------------------------------------------------------------- completion

COMPLETE = """
source "$1"
COMP_WORDS=(rigdesign "${@:2}"); COMP_CWORD=$(($# - 1)); _rigdesign
printf '%s\\n' "${COMPREPLY[@]}"
"""


@pytest.fixture
def completed(rigdesign: Rigdesign, tmp_path: Path) -> Any:
    """What bash completes the last of some words to."""
    script = tmp_path / "rigdesign.bash"
    script.write_text(rigdesign("completion", "bash").out, encoding="utf-8")
    subprocess.run(["bash", "-n", str(script)], check=True)

    def call(*words: str) -> list[str]:
        done = subprocess.run(
            ["bash", "-c", COMPLETE, "bash", str(script), *words],
            capture_output=True, text=True, check=True, cwd=CASES.parent,
        )  # fmt: skip
        return done.stdout.split()

    return call


def test_bash_completes_commands_options_choices_and_cases(completed: Any) -> None:
    assert completed("expl") == ["explain"]
    assert {"check", "study", "completion"} <= set(completed(""))
    assert "--fidelity" in completed("check", "--fi") and "--quiet" in completed("--qu")
    assert set(completed("check", "--fidelity", "")) == {"quick", "standard", "reference"}
    assert "cases/loop_1to1" in completed("check", "cases/loop_1")


@pytest.mark.parametrize(("shell", "begins"), [("zsh", "#compdef rigdesign"), ("fish", "# Fish completion")])
def test_other_shells_have_their_scripts(shell: str, begins: str, rigdesign: Rigdesign) -> None:
    assert rigdesign("completion", shell).out.startswith(begins)


def test_an_unknown_shell_is_refused_with_those_there_are(rigdesign: Rigdesign) -> None:
    ended = rigdesign("completion", "csh")
    assert ended.status == 2 and all(shell in ended.err for shell in ("csh", "bash", "zsh", "fish"))
