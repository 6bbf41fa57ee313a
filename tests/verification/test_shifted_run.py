"""The time run moved by the periodic response against the run marched again, and study points against whole checks."""

from dataclasses import dataclass

import numpy as np
import pytest

from rigdesign import load_case
from rigdesign.case import Case
from rigdesign.case.fields import MODEL_PARTS
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.results.loads import StageLoad
from rigdesign.run.main import run_case
from rigdesign.studies.from_base import FromBase
from rigdesign.studies.modified_rig import Reanalysis, modified_rig
from rigdesign.studies.reference_rig import Reference, restored, solve_reference

INLET = "gearboxes.test.oil.inlet_temperature"
START_TORQUE = {"loop_1to1": 60.0, "uhcf_prototype": 90.0}
"""Mean torque from which a stage counts as loaded [N m]."""


@dataclass(frozen=True)
class Both:
    """One modified rig, its time run shifted and marched."""

    shifted: SolvedRig
    marched: SolvedRig


def both(reference: Reference, stated: SolvedRig, case: Case) -> Both:
    rigs = []
    for how in ("shifted", "marched"):
        solved, parts = modified_rig(stated, Reanalysis(case, MODEL_PARTS, how), reference.motor_losses)
        assert ("time run" in parts) == (how == "marched")
        rigs.append(solved)
    return Both(*rigs)


def loaded(rig: SolvedRig, least: float) -> dict[tuple[str, str], StageLoad]:
    assert rig.loads is not None
    return {
        (mesh, load.stage): load
        for mesh, loads in rig.loads.meshes.items()
        for load in loads.stage_loads
        if load.mean > 0.95 * least and load.least_share_mean > 0.95 * least
    }


def compared(name: str, inlet: str, fidelity: str) -> tuple[float, float, float]:
    """Largest difference of a peak and of a least torque of a loaded stage, as shares of the mean torque; of the
    highest torque that a seat, coupling or shaft carries in the run, as a share of it."""
    case = load_case(name)
    reference, _ = solve_reference(case, fidelity)  # type: ignore[arg-type]
    found = both(reference, restored(reference), case.with_value(INLET, inlet))
    one, other = (loaded(rig, START_TORQUE[name]) for rig in (found.shifted, found.marched))
    assert one.keys() == other.keys() and one
    peaks = max(abs(one[key].peak - other[key].peak) / other[key].mean for key in one)
    least = max(abs(one[key].least_share - other[key].least_share) for key in one)
    shifted, marched = (highest(rig) for rig in (found.shifted, found.marched))
    assert shifted.keys() == marched.keys() and shifted
    sections = max(abs(shifted[place] - marched[place]) for place in shifted) / max(marched.values())
    return peaks, least, sections


def highest(rig: SolvedRig) -> dict[str, float]:
    """Of every place in the time run [N m]."""
    found: dict[str, float] = {}
    for torque in rig.part_torques:
        if torque.where.startswith("time run"):
            found[torque.place] = max(found.get(torque.place, 0.0), torque.torque)
    return found


@pytest.mark.whole_run
def test_moved_envelopes_are_those_of_the_run_marched_again() -> None:
    peaks, least, sections = compared("loop_1to1", "80 degC", "quick")
    assert peaks < 0.01
    assert least < 0.02
    assert sections < 0.01


@pytest.mark.slow
@pytest.mark.parametrize("inlet", ["60 degC", "100 degC", "180 degC"])
def test_the_prototype_from_140_degc(inlet: str) -> None:
    peaks, least, sections = compared("uhcf_prototype", inlet, "standard")
    assert peaks < 0.02
    assert least < 0.03
    assert sections < 0.05


@pytest.mark.whole_run
def test_a_study_point_is_the_check_of_its_case() -> None:
    """What heat moves, within the tolerances of the coupling loop: one in a thousand of a limit."""
    case = load_case("loop_1to1")
    moved = case.with_value(INLET, "75 degC")
    point = FromBase(case, "quick")(moved, fidelity="quick")
    whole = run_case(moved, fidelity="quick")
    rows = {check.id: check for check in point.checks}
    assert rows.keys() == {check.id for check in whole.checks}
    for check in whole.checks:
        row = rows[check.id]
        if check.distance is None:
            assert row.distance is None
        elif np.isfinite(check.distance):
            assert row.distance == pytest.approx(check.distance, abs=5e-3), check.id
    assert point.verdict == whole.verdict
