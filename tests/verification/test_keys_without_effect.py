"""Every number that a case states is read by the run and moves a result, or the run says that it has no effect."""

from collections.abc import Sequence
from fnmatch import fnmatchcase
from typing import Any

import pytest

import rigdesign.run.main
from rigdesign.base.errors import CaseError, NotConvergedError
from rigdesign.base.units import number_match
from rigdesign.base.worker_pool import ProcessWorkers
from rigdesign.case.loader import load_case
from rigdesign.case.model import Case
from rigdesign.case.usual import stated_numbers
from rigdesign.report.results_json import results_document
from rigdesign.results.check import Check
from tests.builders.paths import CASES
from tests.builders.recorded_reads import recorded_run
from tests.builders.shared_runs import quick_run_and_idle

NAMES = ("fzg", "loop_1to1", "uhcf_prototype")
NOT_AT_QUICK = (
    "schema_version",  # read by the loader
    "numerics.curve_speeds",  # set by the fidelity
    "gearboxes.*.seals.*.radial_gap",  # orbits in their gap need shafts that bend
    "gearboxes.*.bearings.*.radial_*",  # lateral coefficients as well
)
UNMOVED = (
    "drivetrain.couplings.*.radial_stiffness",  # need shafts that bend
    "drivetrain.couplings.*.angular_stiffness",
    "drivetrain.motor.torque_limit",  # a bound that the run keeps away from
    "numerics.*_tolerance",  # ends an iteration, after as many steps
)
"""Read at quick, and a small move of them moves nothing."""
MOVE = 1.03
"""Factor of a number that is moved; a whole number moves by one."""
STATED = ("case", "inputs", "assumptions", "timings_s", "warnings", "overrides")
"""What a result repeats of its case, or that says nothing of the rig."""


FZG_AT_FEW_SPEEDS = {
    "numerics.curve_speeds": 2,
    "numerics.curve_speed_start": "1700 rpm",
    "numerics.curve_speed_end": "1750 rpm",
    "limits.bearing.start_torque_limit": "400 N m",
}
"""The curve off its resonances; errors of the checks at the held stage alone, which other processes compute."""


@pytest.mark.parametrize("name", NAMES)
def test_a_number_is_read_or_said_to_have_no_effect(name: str) -> None:
    """Reads are recorded from the build of the rig to the result, without those of the audits of the inputs."""
    if name == "fzg":
        case = load_case(CASES / name).with_values(FZG_AT_FEW_SPEEDS)
        result, idle = recorded_run(case, "quick")
    else:
        case, (result, idle) = load_case(CASES / name), quick_run_and_idle(name)
    assert _unsaid(case, result.checks, idle) == []


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_a_number_that_moves_moves_a_result_or_is_said_to_have_no_effect(name: str) -> None:
    case = load_case(CASES / name)
    stated = _outcome(case)
    paths = stated_numbers(case)
    with ProcessWorkers(2) as workers:
        moved = dict(workers.compute(_outcome_moved, [(case, path) for path in paths]))
    assert not isinstance(stated, str) and None not in moved.values()
    idle = [path for number, path in enumerate(paths) if moved[number] == stated]
    unsaid = _unsaid(case, rigdesign.run.main.run_case(case, "quick").checks, idle)
    assert [path for path in unsaid if not any(fnmatchcase(path, pattern) for pattern in UNMOVED)] == []


def _outcome(case: Case) -> Any:
    """What a result says of the rig, or why there is none."""
    try:
        document = results_document(rigdesign.run.main.run_case(case, "quick"))
    except (CaseError, NotConvergedError) as error:
        return str(error)
    return {key: content for key, content in document.items() if key not in STATED}


def _outcome_moved(task: tuple[Case, str]) -> Any:
    case, path = task
    text = str(case.origin.value_of[path])
    match = number_match(text)
    assert match is not None, (path, text)
    number = str(int(match[1]) + 1) if text.isdigit() else f"{MOVE * float(match[1]) or 0.01:.10g} {match[2]}"
    try:
        return _outcome(case.with_value(path, number.strip()))
    except CaseError as error:
        return str(error)


def _unsaid(case: Case, checks: Sequence[Check], idle: Sequence[str]) -> list[str]:
    """The idle keys of which the run does not say that they have no effect."""
    findings = rigdesign.run.main.without_effect(case, checks)
    said = [path for finding in findings for path in finding.text.partition("depends on ")[2].split(", ")]
    return [
        path for path in idle if not any(fnmatchcase(path, pattern) for pattern in (*NOT_AT_QUICK, *said))
    ]
