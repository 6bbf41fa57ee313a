"""Clearances over time count from the temperature at which drawings hold, not from that of the room."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rigdesign.case import load_case
from rigdesign.rig.model import build_rig
from rigdesign.transient.phases import schedule_phases
from rigdesign.transient.thermal_history import BranchPlan, _read
from tests.builders.paths import CASES

BASE = (CASES / "uhcf_prototype" / "given_losses.toml").as_posix()
WARM_ROOM = (
    f'extends = "{BASE}"\nname = "warm_room"\ntitle = "warm room"\n[ambient]\ntemperature = "35 degC"\n'
)


def test_in_a_warm_room_a_rig_at_20_degrees_has_the_clearances_of_its_drawing(tmp_path: Path) -> None:
    file = tmp_path / "case.toml"
    file.write_text(WARM_ROOM)
    rig = build_rig(load_case(file), "quick")
    assert rig.case.ambient.temperature == pytest.approx(308.15)
    nodes = len(rig.models["test"].mesh.points)
    drawing, room = (np.full(nodes, temperature, dtype=np.float32) for temperature in (293.15, 308.15))
    solution: Any = SimpleNamespace(
        times=np.array([0.0, 1.0]), stages=np.zeros(2, dtype=np.int32), probes={}, warnings=(),
        energy=SimpleNamespace(closure=0.0),
    )  # fmt: skip
    history: Any = SimpleNamespace(
        plan=BranchPlan(name="schedule", phases=schedule_phases(rig.case)),
        solution=solution,
        fields=[drawing, room],
    )
    heating: Any = SimpleNamespace(seated_bearings=lambda *_: {})
    (branch,), _ = _read(rig, heating, "test", [history])
    cold, warm = branch.clearances
    assert cold["backlash"]["test.main"] == pytest.approx(
        rig.pairs["test.main"].transverse_backlash, abs=1e-8
    )
    assert all(gap == pytest.approx(0.6e-3, abs=1e-8) for gap in cold["seal_gap"].values())
    assert all(size < 1e-7 for size in branch.alignment[0]["bearing_tilt"].values())
    # the room warms box and gears alike: everything swells by alpha 15 K, the axes by 15 K of 290 mm
    rise = branch.axes[1]["test_pinion"].offset[1] - branch.axes[0]["test_pinion"].offset[1]
    assert rise == pytest.approx(
        rig.materials["structural_steel"].expansion_coefficient * 15.0 * 0.29, rel=1e-3
    )
    assert warm["backlash"]["test.main"] == pytest.approx(cold["backlash"]["test.main"], abs=2e-6)
