"""Measured flank topographies of a case: what the file may look like, what reaches the mesh law, what is refused."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from dynamics.gear.flank import FlankField
from dynamics.gear.microgeometry import Microgeometry
from rigdesign import load_case
from rigdesign.base.errors import CaseError
from rigdesign.case import Case
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.mesh_models import mesh_models
from rigdesign.coupling.state import OperatingPoint
from rigdesign.rig.model import Rig
from tests.builders.twisting import twisting_rig

FLANK = "gearboxes.test.gears.pinion.flank"
POINT = OperatingPoint(stage="test", speed=100.0, torque=200.0)
STATED = load_case("cases/loop_1to1")
PLAIN = STATED.with_values(
    {f"{FLANK}.{key}": "0 um" for key in ("profile_crowning", "lead_crowning", "tip_relief")}
)
PAIR = twisting_rig(PLAIN).pairs["test.main"]
GEAR, WIDTH = PAIR.gears[0], PAIR.face_widths[0]
ROLLS = np.linspace(GEAR.roll_length(GEAR.form_radius) - 1e-5, GEAR.roll_length(GEAR.tip_radius) + 1e-5, 9)
FACES = np.linspace(-0.5 * WIDTH, 0.5 * WIDTH, 7)


def tilted(roll: float, face: float) -> float:
    """Metal removed [m]: helix slope of 6 um."""
    return 6e-6 * face / WIDTH


def grid_text(
    removed: Callable[[float, float], float] = tilted,
    coordinate: str = "roll_length",
    sign: str = "removed",
    delimiter: str = ",",
    falling: bool = False,
) -> str:
    """A topography file of the pinion."""
    places = {
        "roll_length": (ROLLS * 1e3, "mm"),
        "diameter": (2e3 * np.hypot(ROLLS, GEAR.base_radius), "mm"),
        "roll_angle": (np.degrees(ROLLS / GEAR.base_radius), "deg"),
    }
    shown, unit = places[coordinate]
    rows = [[coordinate, "face", sign], [unit, "mm", "um"]]
    order = range(len(ROLLS))[:: -1 if falling else 1]
    for i in order:
        for face in FACES:
            amount = removed(ROLLS[i], face) * (1e6 if sign == "removed" else -1e6)
            rows.append([f"{shown[i]:.9f}", f"{1e3 * face:.9f}", f"{amount:.9f}"])
    return "\n".join(delimiter.join(row) for row in rows) + "\n"


def measured(folder: Path, text: str, **more: object) -> Case:
    file = folder / "pinion.csv"
    file.write_text(text, encoding="utf-8")
    return PLAIN.with_values(
        {f"{FLANK}.topography": str(file)} | {f"{FLANK}.{key}": value for key, value in more.items()}
    )


def gap_of(rig: Rig) -> np.ndarray:
    return mesh_models(rig, POINT, initial_state(rig, POINT))[0].law.gap


def slices(case: Case) -> Case:
    return case.with_value("numerics.slices_spur", 8)


def test_a_measured_slope_is_the_stated_slope(tmp_path: Path) -> None:
    """The gap of the mesh law, place by place."""
    plain = gap_of(twisting_rig(slices(PLAIN.with_value(f"{FLANK}.helix_slope", "6 um"))))
    found = gap_of(twisting_rig(slices(measured(tmp_path, grid_text()))))
    assert np.ptp(plain[:, plain.shape[1] // 2]) > 5e-6
    np.testing.assert_allclose(found, plain, atol=1e-14)


@pytest.mark.parametrize(
    "spelled",
    [
        {"coordinate": "diameter"},
        {"coordinate": "roll_angle"},
        {"sign": "deviation"},
        {"delimiter": ";"},
        {"falling": True},
    ],
)
def test_every_way_to_write_a_grid_gives_the_same_flank(tmp_path: Path, spelled: dict[str, str]) -> None:
    def bumpy(roll: float, face: float) -> float:
        return 4e-6 + 6e-6 * face / WIDTH + 3e-6 * (roll - ROLLS[0]) / np.ptp(ROLLS)

    front, back = twisting_rig(measured(tmp_path, grid_text(bumpy, **spelled))).topography("test.pinion")  # type: ignore[arg-type]
    assert front is not None and back is None
    flank = FlankField(pair=PAIR, index=0, micro=Microgeometry(topography=front))
    roll, face = np.linspace(*flank.profile, 7)[:, None], np.linspace(FACES[0], FACES[-1], 5)
    expected = np.vectorize(bumpy)(roll, face)
    atol = 2e-9 if spelled.get("coordinate") == "diameter" else 1e-13
    np.testing.assert_allclose(flank.modification(roll, face), expected, atol=atol)


def test_every_tooth_of_its_own_and_the_back_flanks(tmp_path: Path) -> None:
    names, unit, *rows = grid_text().splitlines()
    text = "\n".join(
        [f"tooth,{names}", f",{unit}", *(f"{t},{row}" for t in range(PAIR.teeth[0]) for row in rows)]
    )
    case = measured(tmp_path, text).with_value(f"{FLANK}.back_topography", str(tmp_path / "pinion.csv"))
    front, back = twisting_rig(case).topography("test.pinion")
    assert front is not None and back is not None and front.teeth == back.teeth == PAIR.teeth[0]
    shorter = "\n".join(text.splitlines()[: 2 + 3 * len(rows)])
    with pytest.raises(CaseError, match=r"topography.*3 teeth, the gear has .*give all teeth or one for all"):
        twisting_rig(measured(tmp_path, shorter))


def test_the_hash_of_the_case_follows_the_content_of_the_file(tmp_path: Path) -> None:
    first = measured(tmp_path, grid_text()).hash
    assert measured(tmp_path, grid_text(lambda roll, face: 0.0)).hash != first
    assert measured(tmp_path, grid_text()).hash == first


def replaced(row: int, column: int, cell: str) -> str:
    rows = [line.split(",") for line in grid_text().splitlines()]
    rows[row][column] = cell
    return "\n".join(",".join(row) for row in rows) + "\n"


def without(row: int) -> str:
    rows = grid_text().splitlines()
    return "\n".join(rows[:row] + rows[row + 1 :]) + "\n"


def shuffled() -> str:
    rows = grid_text().splitlines()
    return "\n".join([*rows[:2], *rows[16:23], *rows[2:16], *rows[23:]]) + "\n"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (replaced(7, 2, "nan"), r"line 8, removed = \"nan\": is not finite; fill the holes"),
        (replaced(7, 2, ""), r"line 8, removed: has no value; fill the holes"),
        (replaced(7, 2, "3 mm"), r"line 8, removed = \"3 mm\": has a unit of its own; write bare numbers"),
        (replaced(7, 2, "3.4.5"), r"line 8, removed = \"3.4.5\": is no number"),
        (replaced(7, 2, "2500"), r"line 8, removed = 2500: is above 1 mm; correct the unit"),
        (replaced(0, 2, "height"), r"height.*unknown column; known: tooth, roll_length"),
        (replaced(0, 1, "diameter"), r"roll_length and diameter both say the place on the profile"),
        (replaced(0, 2, "face"), r"no column says the sign of the amounts; write one of removed, deviation"),
        (replaced(1, 2, "deg"), r"line 2 = \"deg\": is no unit of removed"),
        (replaced(1, 0, ""), r"is no unit of roll_length; write one of mm"),
        (without(12), r"1 of 1 x 9 x 7 places of the grid are missing"),
        (grid_text() + grid_text().splitlines()[4], "line 66: this place is there already"),
        (shuffled(), r"roll_length: neither grows nor falls from row to row"),
        ("roll_length,face,removed\nmm,mm,um\n", "holds no grid"),
        (
            "\n".join(grid_text().splitlines()[:30]) + "\n",
            r"does not cover the flank from form to tip circle",
        ),
        (
            "\n".join(row for row in grid_text().splitlines() if f",{1e3 * FACES[-1]:.9f}," not in row)
            + "\n",
            r"face position .* does not cover the face.*measure the whole width",
        ),
    ],
)
def test_a_grid_that_cannot_be_used_is_refused(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(CaseError, match=words) as caught:
        twisting_rig(measured(tmp_path, text))
    assert caught.value.faults and all(fault.remedy for fault in caught.value.faults)


def test_files_that_are_no_grids(tmp_path: Path) -> None:
    for content, words in ((b"PK\x03\x04....", "a zip archive"), (b"roll\xff", "not UTF-8")):
        (tmp_path / "flank.csv").write_bytes(content)
        with pytest.raises(CaseError, match=words):
            twisting_rig(PLAIN.with_value(f"{FLANK}.topography", str(tmp_path / "flank.csv")))
    with pytest.raises(CaseError, match="No such file"):
        twisting_rig(PLAIN.with_value(f"{FLANK}.topography", str(tmp_path / "none.csv")))


def test_a_diameter_below_the_base_circle_has_no_involute(tmp_path: Path) -> None:
    first = 2e3 * np.hypot(ROLLS[0], GEAR.base_radius)
    text = grid_text(coordinate="diameter").replace(f"{first:.9f}", f"{1.99e3 * GEAR.base_radius:.9f}")
    with pytest.raises(CaseError, match="below the base diameter"):
        twisting_rig(measured(tmp_path, text))


@pytest.mark.parametrize(
    ("values", "words"),
    [
        (
            {"topography": "a.csv", "lead_crowning": "3 um"},
            "lead_crowning: is part of the measured topography",
        ),
        ({"root_relief": "3 um"}, r"root_relief_length = 0: is needed with root_relief = 3 um"),
        ({"end_relief": "3 um"}, r"end_relief_length = 0: is needed"),
        ({"end_relief": "3 um", "end_relief_length": "900 mm"}, r"end_relief_length = 900 mm: is above"),
        ({"manufacturing_twist": 1.5}, "manufacturing_twist"),
        ({"tip_relief_exponent": 0.1}, "tip_relief_exponent"),
        ({"lead_crowning_form": "cubic"}, "circular"),
    ],
)
def test_modifications_that_do_not_fit_are_refused(values: dict[str, object], words: str) -> None:
    with pytest.raises(CaseError, match=words):
        PLAIN.with_values({f"{FLANK}.{key}": value for key, value in values.items()})


def test_reliefs_of_the_case_reach_the_mesh_law() -> None:
    """Root relief at the start of the path of the pinion, end relief at the rear slice: amounts by hand."""
    reliefs = {
        "root_relief": "10 um", "root_relief_length": "0.5 mm", "root_relief_exponent": 2.0,
        "end_relief": "8 um", "end_relief_length": "5 mm", "end_relief_at": "rear",
    }  # fmt: skip
    rig = twisting_rig(slices(PLAIN.with_values({f"{FLANK}.{key}": value for key, value in reliefs.items()})))
    (model, *_) = mesh_models(rig, POINT, initial_state(rig, POINT))
    plain = gap_of(twisting_rig(slices(PLAIN)))
    added = model.law.gap - plain
    path = model.law.path_start + model.law.path_step * np.arange(added.shape[1])
    assert added[0, path < model.pair.path.start] == pytest.approx(10e-6, abs=1e-12)
    gear = model.pair.gears[0]
    start = model.pair.rolling_radii[0] + model.pair.path.start
    reach = gear.roll_length(np.hypot(gear.base_radius, start) + 0.5e-3) - start
    middle = np.argmin(np.abs(path - model.pair.path.start - 0.5 * reach))
    share = 1.0 - (path[middle] - model.pair.path.start) / reach
    assert added[0, middle] == pytest.approx(10e-6 * share**2, rel=1e-6)
    assert not added[0, path > model.pair.path.start + reach].any()
    assert added[-1, -1] == pytest.approx(8e-6 * (1.0 - model.pair.face_width / 16 / 5e-3), rel=1e-6)
