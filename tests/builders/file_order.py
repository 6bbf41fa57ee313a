"""Order in which the processes of pytest-xdist take up the test files: the long ones first, so that none is waited for.

The first two also share out what is made once and kept: one computes the influence numbers of the gears while the
other compiles the kernels, and each finds what the other has stored.
"""

from collections import Counter
from pathlib import Path

import pytest

from tests.builders.paths import ROOT

LONGEST = (
    "regression/test_cases.py",
    "unit/rigdesign_package/studies/test_ranges_solve.py",
    "regression/test_frozen_sets.py",
    "regression/test_published_rows.py",
    "regression/test_readme_recipe.py",
    "verification/test_coupling_arrows.py",
    "verification/test_keys_without_effect.py",
    "unit/rigdesign_package/studies/test_study.py",
    "unit/rigdesign_package/run/test_transient_run.py",
    "verification/test_ranges_plan.py",
    "unit/rigdesign_package/run/test_step_case.py",
    "regression/test_tutorial.py",
    "unit/rigdesign_package/studies/test_cluster.py",
    "unit/rigdesign_package/studies/test_execution.py",
    "unit/rigdesign_package/report/test_viewer_in_browser.py",
    "unit/rigdesign_package/cli/test_cli.py",
    "verification/test_repeated_checks.py",
    "verification/test_shifted_run.py",
    "regression/test_readme.py",
    "verification/test_contact_in_the_loop.py",
    "unit/rigdesign_package/diagnosis/test_rig_calibration.py",
    "unit/rigdesign_package/prediction/test_predictor.py",
    "unit/rigdesign_package/postprocessing/test_events.py",
    "unit/rigdesign_package/prediction/test_warm_up.py",
    "regression/test_mutants.py",
    "unit/rigdesign_package/measurement/test_measurement_limits.py",
)
"""Files of the tests folder that take more than 20 s of a processor, the longest first."""


def longest_first(items: list[pytest.Item]) -> None:
    """Sort tests by file: `LONGEST`, files with whole runs, then the rest; most tests first, in each as they stand."""
    first = {ROOT / "tests" / name: place for place, name in enumerate(LONGEST)}
    gone = [str(file) for file in first if not file.is_file()]
    if gone:
        raise pytest.UsageError(f"tests/builders/file_order.py: no such file: {', '.join(gone)}")
    counts = Counter(item.path for item in items)
    whole = {item.path for item in items if item.get_closest_marker("whole_run")}

    def place(item: pytest.Item) -> tuple[int, bool, int, Path]:
        return first.get(item.path, len(first)), item.path not in whole, -counts[item.path], item.path

    items.sort(key=place)
