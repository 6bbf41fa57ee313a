"""Contact solved in the loop of the prototype against its contact tables: inside the error that the loads carry."""

from functools import cache

import pytest

from rigdesign.case import load_case
from rigdesign.run.main import solve_case
from rigdesign.run.mesh_convergence import TABLES_LEAVE_OUT
from tests.builders.paths import CASES
from tests.contact_in_loop.rig import LoopedContact, contact_in_loop

pytestmark = pytest.mark.slow


@cache
def found() -> tuple[LoopedContact, ...]:
    solved = solve_case(load_case(CASES / "uhcf_prototype"), "standard")
    assert solved.run is not None
    return contact_in_loop(solved.rig, solved.run)


def test_held_stage_and_peaks_of_both_meshes_are_solved_and_settle() -> None:
    places = {(row.mesh, row.stage, row.peak) for row in found()}
    assert places == {
        ("test", "test", False), ("reference", "test", False), ("test", "", True), ("reference", "", True),
    }  # fmt: skip
    for row in found():
        assert row.settled
        assert row.unconverged <= 2
        assert row.apart == 0.0


def test_dynamic_factors_by_both_models_agree() -> None:
    """Two ways to the same motion: harmonic balance on tables, and a march on the points themselves. They differ by
    tilt and shuttling in motion, which move a peak most where its mode tilts the gears.
    """
    solid, per_dynamic = TABLES_LEAVE_OUT
    for row in found():
        for loop, table in (
            (row.dynamic_factor, row.dynamic_factor_by_table),
            (row.least_share, row.least_share_by_table),
        ):
            assert abs(loop - table) < solid + per_dynamic * abs(table - 1.0)


def test_gears_tilt_most_where_their_mesh_is_excited_most() -> None:
    for mesh in ("test", "reference"):
        held, peak = (row.tilt for row in sorted(found(), key=lambda row: row.peak) if row.mesh == mesh)
        assert peak > 2.0 * held > 0.0
