"""`rigdesign new case`: what it writes loads and says what its keys are; what contradicts itself writes nothing."""

from pathlib import Path

import pytest

from rigdesign.base.errors import OutputError, UsageError
from rigdesign.case import load_case
from rigdesign.case.shipped import shipped_cases
from rigdesign.cli.application import run
from rigdesign.new_case.outline import QUESTIONS, outline_from
from rigdesign.new_case.write import schema_text, write_case

ANSWERS = {
    "name": "fzg",
    "teeth": "16,24",
    "module": "4.5 mm",
    "centre_distance": "91.5 mm",
    "face_width": "14 mm",
    "torque": "372.6 N m",
    "speed": "2250 rpm",
    "bearings": "30 mm",
    "oil": "FVA 3",
    "oil_temperature": "90 degC",
    "box": "176 x 280 x 220 mm",
}
CASES = Path(__file__).parents[4] / "cases"


@pytest.mark.parametrize(
    "changed", [{}, {"lubrication": "dip"}, {"box": ""}, {"profile_shift": "0.182"}, {"box": "", "lubrication": "dip"}]
)  # fmt: skip
def test_what_is_written_loads_with_what_was_answered(tmp_path: Path, changed: dict[str, str]) -> None:
    answers = {key: value for key, value in (ANSWERS | changed).items() if value}
    file, _ = write_case(outline_from(answers), tmp_path / "rig")
    case = load_case(file)
    box = case.gearboxes["test"]
    assert (box.gears["pinion"].teeth, box.gears["wheel"].teeth) == (16, 24)
    assert box.meshes["main"].centre_distance == pytest.approx(0.0915)
    assert case.gearboxes["slave"].gears["pinion"].face_width == pytest.approx(0.028)
    assert (box.sump is not None) == (changed.get("lubrication") == "dip")
    assert (box.housing is not None) == ("box" in answers)
    assert {bearing.diameter for bearing in box.bearings.values()} == {0.03}


def test_outer_measures_are_those_that_were_asked_for(tmp_path: Path) -> None:
    from rigdesign.case.geometry import housing_geometry

    file, _ = write_case(outline_from(ANSWERS), tmp_path)
    geometry = housing_geometry(load_case(file).gearboxes["test"])
    assert (geometry.length, geometry.width, geometry.height) == pytest.approx(
        (0.176, 0.280, 0.220), abs=1e-4
    )


def test_every_key_says_what_it_is_and_which_checks_depend_on_it(tmp_path: Path) -> None:
    file, schema = write_case(outline_from(ANSWERS), tmp_path)
    lines = file.read_text(encoding="utf-8").splitlines()
    assert lines[0] == f"#:schema {schema.name}"
    keys = [number for number, line in enumerate(lines) if " = " in line and not line.startswith("#")]
    bare = [lines[number] for number in keys if not lines[number - 1].startswith("# ")]
    assert set(bare) == {'remove = ["housing"]'} or bare == []
    assert sum("depend" in line for line in lines) >= 15
    assert schema.read_text(encoding="utf-8") == schema_text()


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"teeth": "24,16"}, "--teeth 24,16: the pinion has more teeth than the wheel"),
        ({"teeth": "16"}, '--teeth "16": no two tooth numbers'),
        ({"centre_distance": "120 mm"}, "--centre-distance"),
        ({"module": "4.5"}, '--module "4.5"'),
        ({"speed": "0 rpm"}, "is not above 0"),
        ({"box": "176 x 190 x 220 mm"}, "does not hold both gears"),
        ({"box": "60 x 280 x 220 mm"}, "--box: a length of 60 mm does not hold gears, bearings and seals"),
        ({"box": "176 x 280 x 60 mm"}, "--box: gearboxes.test.housing"),
        ({"box": "0 x 280 x 220 mm"}, "a side that is not above 0"),
        ({"box": "176 x -280 x 220 mm"}, "a side that is not above 0"),
        ({"box": "280 mm"}, "no three sides"),
        ({"bearings": "70 mm"}, "--bearings"),
        ({"oil": "FVA 99"}, '--oil "FVA 99": no built-in oil; write one of FVA 3'),
        ({"bearings": "NU 999"}, "nearest: NU"),
        ({"lubrication": "spray"}, "write jet or dip"),
        ({"name": "My Rig"}, '--name "My Rig"'),
        ({"profile_shift": "much"}, '--profile-shift "much"'),
        ({"profile_shift": "nan"}, "must lie within -1.5 to 1.5 modules"),
        ({"profile_shift": "-inf"}, "must lie within -1.5 to 1.5 modules"),
        ({"bearings": "-30 mm"}, "a diameter that is not above 0"),
    ],
)
def test_contradicting_answers_are_named_and_nothing_is_written(
    tmp_path: Path, changed: dict[str, str], words: str
) -> None:
    out = tmp_path / "rig"
    with pytest.raises(UsageError) as caught:
        write_case(outline_from(ANSWERS | changed), out)
    assert words in str(caught.value)
    assert not out.exists()


def test_everything_missing_is_named_at_once() -> None:
    with pytest.raises(UsageError) as caught:
        outline_from({})
    assert all(question.flag in str(caught.value) for question in QUESTIONS if question.required)


def test_nothing_is_overwritten(tmp_path: Path) -> None:
    write_case(outline_from(ANSWERS), tmp_path)
    before = (tmp_path / "case.toml").read_bytes()
    with pytest.raises(OutputError, match="is there already"):
        write_case(outline_from(ANSWERS | {"teeth": "17,25"}), tmp_path)
    assert (tmp_path / "case.toml").read_bytes() == before


FLAGS = {key: f"--{key.replace('_', '-')}" for key in ANSWERS}


def _command(out: Path, *left_out: str) -> list[str]:
    """`new case` with all answers but some."""
    given = [text for key, flag in FLAGS.items() if key not in left_out for text in (flag, ANSWERS[key])]
    return ["new", "case", "--out", str(out), *given]


def _terminal(monkeypatch: pytest.MonkeyPatch, answers: list[str]) -> list[str]:
    """A terminal that gives these answers and then ends; the questions that were asked."""
    left, asked = iter(answers), list[str]()

    def answer(prompt: str) -> str:
        asked.append(prompt)
        try:
            return next(left)
        except StopIteration:
            raise EOFError from None

    monkeypatch.setattr("sys.stdin.isatty", lambda: True)
    monkeypatch.setattr("builtins.input", answer)
    return asked


def test_answers_that_are_left_out_are_asked_for_in_a_terminal(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """What cannot be is said with its limit and asked again at once; an empty answer leaves out what is not needed."""
    asked = _terminal(
        monkeypatch, ["", "sixteen", "16,24", "372.6 Nmm/s", "0 N m", "372.6 N m", "", "", "", ""]
    )
    assert run(_command(tmp_path / "my rig", "name", "box", "teeth", "torque")) == 0
    assert [prompt.startswith("teeth of pinion and wheel") for prompt in asked[:4]] == [
        True,
        True,
        True,
        False,
    ]
    said = capsys.readouterr().out
    assert "is empty; write e.g. 16,24" in said and "no two tooth numbers" in said
    assert "units: N m" in said and "is not above 0" in said
    case = load_case(tmp_path / "my rig")
    assert case.name == "my_rig" and case.gearboxes["test"].housing is None


def test_answers_that_contradict_each_other_are_asked_for_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Only those that have to change, with the former answer kept by an empty line; faults of the case as well."""
    again = ["", "", "91.5 mm"]
    asked = _terminal(monkeypatch, ["120 mm", "", "176 x 280 x 60 mm", "", "", *again, "176 x 280 x 220 mm"])
    assert run(_command(tmp_path / "rig", "centre_distance", "box", "name")) == 0
    assert [prompt.split(" (e.g.")[0] for prompt in asked[-4:]] == [
        "teeth of pinion and wheel", "normal module", "centre distance",
        "outer length x width x height of the test gearbox",
    ]  # fmt: skip
    assert asked[-4].endswith("[16,24]: ")
    assert "their reference centre distance is 90 mm" in capsys.readouterr().out
    assert load_case(tmp_path / "rig").gearboxes["test"].meshes["main"].centre_distance == pytest.approx(
        0.0915
    )


def test_an_input_that_ends_or_is_interrupted_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _terminal(monkeypatch, ["16,24"])
    with pytest.raises(UsageError, match="no answer to --torque: the input has ended"):
        run(_command(tmp_path / "rig", "teeth", "torque"))

    def interrupt(prompt: str) -> str:
        raise KeyboardInterrupt

    monkeypatch.setattr("builtins.input", interrupt)
    with pytest.raises(KeyboardInterrupt):
        run(_command(tmp_path / "rig", "teeth"))
    assert list(tmp_path.iterdir()) == []


def test_a_folder_with_a_case_is_refused_before_anything_is_asked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_case(outline_from(ANSWERS), tmp_path)
    asked = _terminal(monkeypatch, [])
    with pytest.raises(OutputError, match="is there already"):
        run(_command(tmp_path, "teeth"))
    assert asked == []


def test_shipped_cases_name_their_schema() -> None:
    for name, folder in shipped_cases().items():
        first = (folder / "case.toml").read_text(encoding="utf-8").partition("\n")[0]
        assert first == "#:schema ../case.schema.json", name


def test_the_shipped_schema_is_current() -> None:
    """`rigdesign.new_case.write.schema_text` makes it."""
    assert (CASES / "case.schema.json").read_text(encoding="utf-8") == schema_text()
