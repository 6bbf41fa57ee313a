"""An FZG-like rig in as few lines as its owner has numbers; plain bearings stand for the roller bearings."""

from pathlib import Path

MINIMAL = """\
schema_version = 1
name = "fzg"

[gearboxes.test]
oil = { oil = "FVA 3", inlet_temperature = "90 degC" }
all_bearings = { diameter = "30 mm" }
gears.pinion = { teeth = 16, face_width = "14 mm", profile_shift = 0.182 }
gears.wheel = { teeth = 24, face_width = "14 mm" }
meshes.main = { normal_module = "4.5 mm", centre_distance = "91.5 mm" }

[gearboxes.test.housing]
warm_length = "60 mm"
cold_length_front = "20 mm"
cold_length_rear = "20 mm"
partition_thickness = "8 mm"
width = "280 mm"
height = "220 mm"

[gearboxes.slave]
like = "test"
remove = ["housing"]
gears.pinion.face_width = "40 mm"
gears.wheel.face_width = "40 mm"

[schedule]
test_speed = "2250 rpm"
test_torque = "372.6 N m"
"""
MINIMAL_ROLLING = """\
schema_version = 1
name = "fzg"

[gearboxes.test]
oil = { lubrication = "dip", oil = "FVA 3", level = "0 mm", volume = "1.25 l", sump_temperature = "90 degC" }
all_bearings = { type = "rolling", designation = "NU 406" }
bearings.pinion_rear.designation = "NJ 406"
bearings.wheel_rear.designation = "NJ 406"
gears.pinion = { teeth = 16, face_width = "14 mm", profile_shift = 0.182 }
gears.wheel = { teeth = 24, face_width = "14 mm" }
meshes.main = { normal_module = "4.5 mm", centre_distance = "91.5 mm" }
housing = { warm_length = "116 mm", width = "280 mm", height = "220 mm" }

[gearboxes.slave]
like = "test"
remove = ["housing"]
gears.pinion.face_width = "40 mm"
gears.wheel.face_width = "40 mm"

[schedule]
test_speed = "2250 rpm"
test_torque = "372.6 N m"
"""
"""The same rig on its roller bearings, dipping, in one chamber."""
MOST_LINES = 60


def minimal_case(folder: Path, more: str = "", *, without: str = "") -> Path:
    """Write the case with further lines at its end, and without one of its lines."""
    path = folder / "case.toml"
    path.write_text(MINIMAL.replace(without, "") + more, encoding="utf-8")
    return path
