"""A case whose housing is a mesh file: the same numbers as the box it was made of, and honest about what it lacks."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from rigdesign import load_case
from rigdesign.base.errors import CaseError, UsageError
from rigdesign.case.model import Case
from rigdesign.cli import exit_status as ending
from rigdesign.cli import main as cli
from rigdesign.cli.mesh_export import export_meshes
from rigdesign.results.result import RunResult
from rigdesign.rig.model import build_rig
from rigdesign.run.main import run_case
from tests.builders.msh_file import write_msh
from tests.builders.paths import CASES
from tests.builders.shared_runs import quick_run
from thermal.fe.mesh import NamedMesh, named_mesh
from thermal.housing.mesh_file import read_mesh

pytestmark = pytest.mark.whole_run

GIVEN = CASES / "uhcf_prototype" / "given_losses.toml"
END = "shaft_test_pinion_end_front"


@cache
def box() -> tuple[RunResult, NamedMesh]:
    """The shipped case with given losses, on its quick mesh."""
    mesh = build_rig(load_case(GIVEN), "quick").models["test"].mesh
    return quick_run("uhcf_prototype", "given_losses.toml"), mesh


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
    assert theirs.max_temperature == pytest.approx(ours.max_temperature, abs=1e-3)
    assert {row.surface: row.power for row in theirs.heat} == pytest.approx(
        {row.surface: row.power for row in ours.heat}, rel=1e-4, abs=1e-3
    )
    gaps = [
        {gap["seal"]: gap["hot_min_mm"] for gap in result.expansion[0].seal_gaps} for result in (whole, found)
    ]
    assert gaps[1] == pytest.approx(gaps[0], abs=2e-5)
    assert [check.verdict for check in found.checks] == [check.verdict for check in whole.checks]
    assert [row.quantity for row in found.discretisation] == ["temperature_gradient"]


def _least_cold_gap(case: Case) -> float:
    """Least radial gap of the contactless seals [m]."""
    seals = [one for box in case.gearboxes.values() for one in box.seals.values()]
    return min(one.radial_gap for one in seals if one.kind == "contactless")


def test_without_its_stations_heat_is_solved_and_clearances_are_those_of_the_drawing(tmp_path: Path) -> None:
    whole, mesh = box()
    write_msh(mesh, tmp_path / "box.msh", renamed={END: "shaft_test_pinion_end_nose"})
    found = run_case(on_file(tmp_path), "quick")
    assert found.thermal[0].max_temperature == pytest.approx(whole.thermal[0].max_temperature, abs=1.0)
    assert found.expansion == []
    gap = next(check for check in found.checks if check.id == "clearance.seal_gap")
    assert (gap.verdict, gap.value) == ("open", pytest.approx(1e3 * _least_cold_gap(on_file(tmp_path))))
    assert f"thermal expansion of gearbox test: clearances need surface {END}" in gap.left_out


def refused(case: Case, *words: str) -> None:
    with pytest.raises(CaseError) as error:
        run_case(case, "quick")
    assert error.value.exit_code == 2
    for word in words:
        assert word in str(error.value)


def test_faults_of_a_mesh_file_are_faults_of_its_key(tmp_path: Path) -> None:
    key = 'gearboxes.test.housing.mesh_file = "box.msh"'
    refused(on_file(tmp_path), key, "correct the path of the file")
    (tmp_path / "file").write_text("", encoding="utf-8")
    refused(on_file(tmp_path, name="file/box.msh"), "file/box.msh", "correct the path of the file")
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


def test_the_exported_mesh_works_when_given_back(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """`rigdesign mesh` writes the box with all its names: the same temperatures, clearances and verdicts."""
    whole, mesh = box()
    tokens = ["mesh", str(GIVEN), "--fidelity", "quick", "--out", str(tmp_path)]
    assert ending.exit_status(lambda: cli.app(tokens, result_action="return_value")) == 0
    assert 'mesh_file = "test.msh" reads it' in capsys.readouterr().out
    assert [path.name for path in tmp_path.iterdir()] == ["test.msh"]
    read = read_mesh(tmp_path / "test.msh")
    assert read.surfaces.keys() == mesh.surfaces.keys() and read.bodies.keys() == mesh.bodies.keys()
    assert read.numbering is not None
    places = read.numbering.given_cells(read.points[read.cells])
    for body, cells in mesh.bodies.items():
        assert_array_equal(places[read.bodies[body]], mesh.points[mesh.cells[cells]])
    found = run_case(on_file(tmp_path, name="test.msh"), "quick")
    ours, theirs = whole.thermal[0], found.thermal[0]
    assert theirs.max_temperature == pytest.approx(ours.max_temperature, abs=1e-4)
    assert {row.surface: row.power for row in theirs.heat} == pytest.approx(
        {row.surface: row.power for row in ours.heat}, rel=1e-5, abs=1e-4
    )
    off = {}
    for here, there in zip(whole.checks, found.checks, strict=True):
        assert (here.id, here.verdict) == (there.id, there.verdict)
        if here.distance:
            assert there.distance is not None
            off[here.id] = abs(there.distance - here.distance)
    # bearings of a mesh file are circles fitted to it: the tilts between them are differences of micrometres
    tilts = {name: value for name, value in off.items() if name.startswith("alignment.")}
    assert max(tilts.values()) < 2e-4, tilts
    assert max(value for name, value in off.items() if name not in tilts) < 2e-5, off


def test_a_case_without_a_housing_has_no_mesh_to_export(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(
        f'extends = "{GIVEN.as_posix()}"\n[gearboxes.test]\nremove = ["housing"]\n'
    )
    with pytest.raises(UsageError, match="no gearbox has a housing"):
        export_meshes(load_case(tmp_path), tmp_path / "out", "quick")
    assert not (tmp_path / "out").exists()


ALONE = """
[gearboxes.test.housing.boundary]
remove = [
    "bearings", "shaft_seal", "shaft_warm", "shaft_cold", "shaft_outside", "shaft_outside_radiation", "shaft_ends",
    "shaft_end_behind_cover", "gear_rims", "gear_sides",
]
[gearboxes.test.housing.boundary.bores]
surfaces = ["bearing_bore_*"]
law = "constant_film"
fluid = "bearing_oil_mean"
heat_transfer_coefficient = "100 W/(m2 K)"
[gearboxes.test.heat_split]
"""


def housing_alone(mesh: NamedMesh) -> NamedMesh:
    """Housing and field of a box, without shafts and gears."""
    counts = [len(mesh.bodies[name]) for name in ("housing", "field")]
    cells = mesh.cells[np.concatenate([mesh.bodies[name] for name in ("housing", "field")])]
    used, packed = np.unique(cells, return_inverse=True)
    index = np.full(len(mesh.points), -1, dtype=np.int32)
    index[used] = np.arange(len(used))
    surfaces = {name: index[nodes] for name, nodes in mesh.surfaces.items() if (index[nodes] >= 0).all()}
    numbers = np.arange(sum(counts), dtype=np.int32)
    bodies = {"housing": numbers[: counts[0]], "field": numbers[counts[0] :]}
    return named_mesh(mesh.points[used], packed.reshape(cells.shape).astype(np.int32), bodies, surfaces)


def test_a_housing_alone_gets_its_shafts_and_gears_from_the_tables(tmp_path: Path) -> None:
    """Housing and field from the file, shafts and gears drawn as in the box: the same temperatures and verdicts."""
    whole, mesh = box()
    write_msh(housing_alone(mesh), tmp_path / "box.msh")
    found = run_case(on_file(tmp_path), "quick")
    ours, theirs = whole.thermal[0], found.thermal[0]
    assert theirs.max_temperature == pytest.approx(ours.max_temperature, abs=1e-3)
    assert {row.surface: row.power for row in theirs.heat} == pytest.approx(
        {row.surface: row.power for row in ours.heat}, rel=1e-4, abs=1e-3
    )
    assert [(check.id, check.verdict) for check in found.checks] == [
        (check.id, check.verdict) for check in whole.checks
    ]


def test_heat_into_parts_that_are_nowhere_is_refused(tmp_path: Path) -> None:
    """No condition on shafts and gears: they are left out, and the case may let no heat go there."""
    _, mesh = box()
    write_msh(housing_alone(mesh), tmp_path / "box.msh")
    shares = (
        "mesh_into_gears = {0}\nwindage_into_gears = {0}\nseal_into_shaft = {0}\nseal_into_housing = {0}\n"
    )
    refused(
        on_file(tmp_path, ALONE + shares.format(0.2)),
        "has the bodies field, housing and lacks gear_test_pinion_rim, gear_test_wheel_rim for",
        "gear_test_pinion, gear_test_wheel for heat_split.windage_into_gears", "shaft_test_pinion_seal_front",
        "rigdesign mesh CASE --out DIR writes an example", "drawn from the tables", "shares of heat_split",
    )  # fmt: skip
    found = run_case(on_file(tmp_path, ALONE + shares.format(0.0)), "quick")
    assert 303.15 < found.thermal[0].max_temperature < 463.15
    assert abs(found.thermal[0].closure_relative) < 1e-6
    gap = next(check for check in found.checks if check.id == "clearance.seal_gap")
    assert gap.verdict == "open" and "body shaft_test_pinion" in gap.left_out[0]
