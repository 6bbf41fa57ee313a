"""Accelerations and shaft displacements in a measurement set: units, directions, orders from tables and recordings."""

import math
from pathlib import Path

import pytest

from rigdesign.base.errors import MeasurementError
from rigdesign.case import Case
from rigdesign.diagnosis.document.outcome import of_data
from rigdesign.measurement import features, load_measurement
from rigdesign.measurement.reading.columns import AXES, direction_of, direction_text
from rigdesign.prediction.model import Feature
from tests.builders.measurement import replaced
from tests.builders.order import shipped
from tests.builders.recording import UNITS, signals, write_recorded_set, write_recording

CHANNELS = """
[channels.a_front]
quantity = "acceleration"
place = "test.pinion_front"
direction = "45 deg"
unit = "g"
uncertainty = "0.01 g"
orders = [1, 2]
signal = "M_wheel"

[channels.s_shaft]
quantity = "shaft_displacement"
place = "test_pinion"
position = "60 mm"
direction = "-z"
unit = "um"
uncertainty = "0.2 um"
orders = [0, 1]
"""
SECOND = """
[channels.s_front]
quantity = "shaft_displacement"
place = "test.pinion_front"
direction = "30 deg"
unit = "um"
uncertainty = "0.2 um"
orders = [1]
"""
G = 9.80665


@pytest.fixture
def case() -> Case:
    return shipped("loop_1to1")


def lateral_set(folder: Path) -> Path:
    """The torque of a recorded set read as an acceleration in g, an orbit from a table."""
    write_recorded_set(folder, "csv")
    replaced(folder, "measurement.toml", "[channels.T_out]", f"{CHANNELS}\n[channels.T_out]")
    replaced(folder, "measurement.toml", "[data]", '[data]\norders = "orders.csv"')
    replaced(
        folder, "measurement.toml", '[channels.M_wheel]\nquantity = "torque"\nplace = "wheel_side"\nunit = "N m"\n'
        'uncertainty = "0.05 N m"\norders = [0, 1, 2]\n', "",
    )  # fmt: skip
    rows = [f"P01,{repeat},s_shaft,1,3.{repeat},-0.5" for repeat in (1, 2)]
    (folder / "orders.csv").write_text(
        "\n".join(["point,repeat,channel,order,real,imaginary", *rows]) + "\n", encoding="utf-8"
    )
    for repeat in (1, 2):
        write_recording(folder / f"P01_{repeat}.csv", signals(repeat), UNITS | {"M_wheel": "g"})
    return folder


def test_orders_of_recordings_and_tables_in_their_units(tmp_path: Path, case: Case) -> None:
    measurement = load_measurement(lateral_set(tmp_path), case)
    front, shaft = measurement.channels["a_front"].channel, measurement.channels["s_shaft"].channel
    assert front.direction == pytest.approx((0.0, math.sqrt(0.5), math.sqrt(0.5)))
    assert (shaft.direction, shaft.position, shaft.orders) == ((0.0, 0.0, -1.0), 0.06, (1.0,))
    real = measurement.readings[Feature("a_front", "P01", 1.0, "real")]
    imaginary = measurement.readings[Feature("a_front", "P01", 1.0, "imaginary")]
    # 0.6 cos(phi) of the recording, the angle counted from the pulse 0.2 rad later
    amplitude = complex(real[0], imaginary[0])
    assert abs(amplitude) == pytest.approx(0.6 * G, rel=0.01)
    assert measurement.readings[Feature("s_shaft", "P01", 1.0, "real")] == pytest.approx([3.1e-6, 3.2e-6])
    data = features(measurement)
    said = {finding.id: finding.text for finding in data.findings}
    assert "support_stiffness" in said["acceleration_of_shaft"]
    assert {one.channel for one in data.features} >= {"a_front", "s_shaft"}


WRONG = (
    ('direction = "45 deg"\n', "", "channels.a_front.direction.*an acceleration has a direction"),
    ('direction = "45 deg"', 'direction = "up"', 'channels.a_front.direction = "up".*"45 deg"'),
    ('place = "test.pinion_front"', 'place = "test.pinion"', "no such place of a channel of acceleration"),
    ('unit = "g"', 'unit = "um"', "is a unit of length, not of acceleration.*m/s2, g"),
    ('position = "60 mm"\n', "", "channels.s_shaft.position.*distance from its start"),
    ('position = "60 mm"', 'position = "300 mm"', "beyond the end of test_pinion.*at most 210 mm"),
    ('place = "test_pinion"', 'place = "test.pinion_rear"', "channels.s_shaft.position.*name a shaft"),
    ("orders = [0, 1]", "orders = [0]", "the mean of a shaft displacement says nothing"),
    ('uncertainty = "0.01 g"', 'uncertainty = "0.01 g"\ntorque = "3 N m"', "has no torque of its own"),
    (
        'uncertainty = "0.1 K"',
        'uncertainty = "0.1 K"\ndirection = "y"',
        "channels.T_out.direction.*has no direction",
    ),
)


@pytest.mark.parametrize(("old", "new", "said"), WRONG)
def test_faults_name_key_and_remedy(tmp_path: Path, case: Case, old: str, new: str, said: str) -> None:
    folder = lateral_set(tmp_path)
    replaced(folder, "measurement.toml", old, new)
    with pytest.raises(MeasurementError, match=f"(?s){said}"):
        load_measurement(folder, case)


@pytest.mark.parametrize("text", [*AXES, "30 deg", "-120 deg"])
def test_directions_are_spelled_and_read_alike(text: str) -> None:
    vector = direction_of(text)
    assert math.hypot(*vector) == pytest.approx(1.0)
    assert direction_text(vector) == text


def test_exchanged_sensors_change_direction_and_position_too(tmp_path: Path, case: Case) -> None:
    folder = lateral_set(tmp_path)
    replaced(folder, "measurement.toml", "[channels.T_out]", f"{SECOND}\n[channels.T_out]")
    rows = (folder / "orders.csv").read_text(encoding="utf-8").replace("s_shaft", "s_front").splitlines()[1:]
    with (folder / "orders.csv").open("a", encoding="utf-8") as file:
        file.write("\n".join(rows) + "\n")
    correction = of_data("swapped_channels:s_shaft,s_front", load_measurement(folder, case))
    operations = {one["path"]: one.get("value") for one in correction.operations}
    assert operations["/channels/s_front/direction"] == "-z"
    assert operations["/channels/s_front/position"] == "0.06 m"
    assert operations["/channels/s_shaft/direction"] == "30 deg"
    removed = [one["path"] for one in correction.operations if one["op"] == "remove"]
    assert removed == ["/channels/s_shaft/position"]
