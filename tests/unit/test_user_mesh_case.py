"""A case whose housing is a mesh file: the same numbers as the box it was made of, and honest about what it lacks."""

from functools import cache
from pathlib import Path

import pytest

from rigdesign import load_case, run_case
from rigdesign.case.model import Case
from rigdesign.errors import CaseError
from rigdesign.results import RunResult
from rigdesign.rig.model import build_rig
from tests.msh_file import write_msh
from thermal.fe.mesh import NamedMesh

GIVEN = Path(__file__).parents[2] / "cases" / "uhcf_prototype" / "given_losses.toml"
END = "shaft_test_pinion_end_front"


@cache
def box() -> tuple[RunResult, NamedMesh]:
    """The shipped case with given losses, on its quick mesh."""
    case = load_case(GIVEN)
    return run_case(case, "quick"), build_rig(case, "quick").models["test"].mesh


def on_file(folder: Path, body: str = "", name: str = "box.msh") -> Case:
    file = folder / "case.toml"
    file.write_text(
        f'extends = "{GIVEN.as_posix()}"\nname = "v"\ntitle = "v"\n'
        f'[gearboxes.test.housing]\nmesh_file = "{name}"\n{body}',
        encoding="utf-8",
    )
    return load_case(file)


def test_the_mesh_of_the_box_gives_the_results_of_the_box(tmp_path: Path) -> None:
    whole, mesh = box()
    write_msh(mesh, tmp_path / "box.msh")
    found = run_case(on_file(tmp_path), "quick")
    ours, theirs = whole.thermal[0], found.thermal[0]
    assert theirs.max_temperature_degC == pytest.approx(ours.max_temperature_degC, abs=1e-3)
    assert {row.surface: row.power_W for row in theirs.heat} == pytest.approx(
        {row.surface: row.power_W for row in ours.heat}, rel=1e-4, abs=1e-3
    )
    gaps = [
        {gap["seal"]: gap["hot_min_mm"] for gap in result.growth[0].seal_gaps} for result in (whole, found)
    ]
    assert gaps[1] == pytest.approx(gaps[0], abs=2e-5)
    assert [check.verdict for check in found.checks] == [check.verdict for check in whole.checks]
    assert [row.quantity for row in found.discretisation] == ["temperature_gradient"]


def test_without_its_stations_heat_is_solved_and_clearances_are_not_applicable(tmp_path: Path) -> None:
    whole, mesh = box()
    write_msh(mesh, tmp_path / "box.msh", renamed={END: "shaft_test_pinion_end_nose"})
    found = run_case(on_file(tmp_path), "quick")
    assert found.thermal[0].max_temperature_degC == pytest.approx(
        whole.thermal[0].max_temperature_degC, abs=1.0
    )
    assert found.growth == []
    gap = next(check for check in found.checks if check.id == "clearance.seal_gap")
    assert gap.verdict == "not applicable"
    assert gap.reason == f"gearbox test: clearances need surface {END}"


def refused(case: Case, *words: str) -> None:
    with pytest.raises(CaseError) as error:
        run_case(case, "quick")
    assert error.value.exit_code == 2
    for word in words:
        assert word in str(error.value)


def test_faults_of_a_mesh_file_are_faults_of_its_key(tmp_path: Path) -> None:
    key = 'gearboxes.test.housing.mesh_file = "box.msh"'
    refused(on_file(tmp_path), key, "correct the path of the mesh")
    _, mesh = box()
    file = write_msh(
        mesh, tmp_path / "box.msh", renamed={"chamber_floor": "sump", "gear_test_pinion": "gear"}
    )
    refused(on_file(tmp_path), key, "body 'gear' has no material", "chamber_floor", "sump")
    file.write_text(file.read_text()[:100_000])
    refused(on_file(tmp_path), key, "section $Nodes has no end", "write it again")


def test_the_content_of_the_mesh_is_part_of_the_case(tmp_path: Path) -> None:
    case = on_file(tmp_path)
    before = case.hash
    (tmp_path / "box.msh").write_text("a mesh")
    assert case.hash != before
    with pytest.raises(CaseError, match="element sizes do nothing"):
        on_file(tmp_path, '[gearboxes.test.housing.mesh]\nwalls = "20 mm"\n')
