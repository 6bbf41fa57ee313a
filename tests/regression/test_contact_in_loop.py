"""Contact in the loop of the prototype, as fidelity reference solves it, against its contact tables."""

import pytest

from rigdesign.results.teeth import LoopedContact
from tests.builders.shared_runs import shipped

pytestmark = pytest.mark.whole_run


def found() -> tuple[LoopedContact, ...]:
    in_loop = shipped("uhcf_prototype").contact_in_loop
    assert in_loop.missing == ()
    return in_loop.meshes


def test_held_stage_and_peaks_of_both_meshes_are_solved_and_settle() -> None:
    places = {(row.mesh, row.stage, row.peak) for row in found()}
    assert places == {
        ("test", "test", False), ("reference", "test", False), ("test", "", True), ("reference", "", True),
    }  # fmt: skip
    for row in found():
        assert row.settled
        assert row.unconverged <= 2
        assert row.apart == 0.0


@pytest.mark.parametrize("peak", [False, True])
def test_dynamic_factors_by_both_models_agree(peak: bool) -> None:
    """Two ways to the same motion: harmonic balance on tables, and a march on the points themselves. They differ by
    tilt and shuttling in motion, which move a peak most where its mode tilts the gears.
    """
    for row in found():
        if row.peak is peak:
            assert row.dynamic_factor == pytest.approx(row.dynamic_factor_by_table, abs=0.1 if peak else 0.01)
            assert row.least_share == pytest.approx(row.least_share_by_table, abs=0.1 if peak else 0.02)


def test_gears_tilt_most_where_their_mesh_is_excited_most() -> None:
    for mesh in ("test", "reference"):
        held, peak = (row.tilt for row in sorted(found(), key=lambda row: row.peak) if row.mesh == mesh)
        assert peak > 2.0 * held > 0.0
