"""What the writer of a measurement set doubts is told as suspected, and has to name channels of the set."""

from pathlib import Path

import pytest

from rigdesign.base.errors import MeasurementError
from rigdesign.case import load_case
from rigdesign.measurement import features, load_measurement
from tests.builders.motor_power_set import motor_power_set
from tests.builders.paths import CASES

DOUBT = """
[[doubts]]
what = "power of the motor"
size = "470 W printed, 390 W from its current"
source = "test report 7"
channels = ["{channel}"]
"""


def written(folder: Path, channel: str) -> Path:
    return motor_power_set(folder, last=DOUBT.format(channel=channel))


def test_a_doubt_is_told_and_its_channel_is_used(tmp_path: Path) -> None:
    data = features(load_measurement(written(tmp_path, "P"), load_case(CASES / "loop_1to1")))
    [doubt] = [finding for finding in data.findings if finding.id == "doubt"]
    assert doubt.weight == "suspect" and doubt.channels == ("P",)
    assert doubt.text == "power of the motor: 470 W printed, 390 W from its current (test report 7)"
    assert data.usable.all()


def test_a_doubt_of_a_channel_that_is_not_there_is_a_fault(tmp_path: Path) -> None:
    with pytest.raises(MeasurementError, match=r"doubts\[0\].channels.*no such channel.*known: P"):
        load_measurement(written(tmp_path, "Q"), load_case(CASES / "loop_1to1"))
