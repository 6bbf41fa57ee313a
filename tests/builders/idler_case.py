"""The shipped prototype rebuilt as a rig with idlers: in both gearboxes the pinion stands between two wheels."""

import json
import tomllib
from copy import deepcopy
from pathlib import Path
from typing import Any

from tests.builders.paths import CASES

PROTOTYPE = CASES / "uhcf_prototype" / "case.toml"
SIDES = ("left", "right")
Tree = dict[str, Any]


def idler_case(folder: Path, *, housing: bool) -> Path:
    """Write the case; the wheel shafts of both sides close the loop, the pinion shafts are joined to nothing."""
    tree = tomllib.loads(PROTOTYPE.read_text())
    tree["name"] = "idlers"
    for box in ("test", "reference"):
        _two_wheels(box, tree["gearboxes"][box])
    train = tree["drivetrain"]
    for box in ("test", "reference"):
        shaft = train["shafts"].pop(f"{box}_wheel")
        train["shafts"] |= {f"{box}_{side}": deepcopy(shaft) for side in SIDES}
    joint = train["couplings"].pop("wheel_side")
    del train["couplings"]["pinion_side"]
    for side in SIDES:
        train["couplings"][side] = joint | {"shafts": [f"test_{side}", f"reference_{side}"]}
    train["motor"]["shaft"] = "reference_left"
    train["bracing"] |= {"coupling": "left", "shifted_gear": "reference.right"}
    tree["limits"]["bought_parts"]["torque_flange"]["part"] = "drivetrain.couplings.left"
    if not housing:
        del tree["gearboxes"]["test"]["housing"]
    path = folder / "case.toml"
    path.write_text("".join(f"{key} = {_toml(value)}\n" for key, value in tree.items()))
    return path


def _two_wheels(name: str, box: Tree) -> None:
    wheel, mesh = box["gears"].pop("wheel"), box["meshes"].pop("main")
    for side in SIDES:
        box["gears"][side] = deepcopy(wheel) | {"shaft": f"{name}_{side}"}
        box["meshes"][side] = deepcopy(mesh) | {"wheel": side}
        box["seals"][side] = box["seals"]["wheel"] | {"shaft": f"{name}_{side}"}
        for end in ("front", "rear"):
            bearing = box["bearings"][f"wheel_{end}"]
            box["bearings"][f"{side}_{end}"] = bearing | {"shaft": f"{name}_{side}"}
    for part in (box["seals"], box["bearings"]):
        for key in [key for key in part if key.startswith("wheel")]:
            del part[key]
    if "housing" in box:
        _three_axes(box["housing"])


def _three_axes(housing: Tree) -> None:
    shafts = housing["shafts"]
    wheel = shafts.pop("test_wheel")
    shafts["test_pinion"]["lateral_position"] = "0 mm"
    for side, y in zip(SIDES, ("-99.5 mm", "99.5 mm")):
        shafts[f"test_{side}"] = wheel | {"lateral_position": y}
    housing["width"] = "420 mm"
    films = housing["boundary"]
    films["shaft_ends"]["surfaces"] = ["shaft_test_pinion_end_*", "shaft_*t_end_rear"]
    films["shaft_end_behind_cover"]["surfaces"] = ["shaft_*t_end_front"]


def _toml(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)} = {_toml(entry)}" for key, entry in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_toml, value)) + "]"
    return json.dumps(value, ensure_ascii=False)
