"""What the case of the FZG rig leaves to defaults, as numbers of the drawing of the rig that is simulated here.

`cases/fzg/case.toml` states teeth, bearings, oil and box; shafts, couplings, motor and walls are not in it. They stand
here with the values that the checker assumes for them, so that the middle of the population is the rig of the case; a
test holds the two against each other. SI units.
"""

import copy
from collections.abc import Mapping
from typing import Any

from tests.virtual_rig.teeth import read_teeth

SHAFT = 0.03
"""Diameter of every shaft, and bore of gears and bearings [m]."""
DAMPING_RATIO = 0.06
"""Of every mesh."""
BEARING: Mapping[str, float] = {
    "diameter": SHAFT, "outside": 0.09, "width": 0.023, "inner_raceway": 0.045, "outer_raceway": 0.073, "rollers": 11,
    "roller_length": 0.015,
}  # fmt: skip
"""NU 406 and NJ 406 (DIN 5412-1, heavy series): 30 x 90 x 23 mm; raceways, rollers and their length estimated."""
MESH: Mapping[str, Any] = {
    "pinion": "pinion", "wheel": "wheel", "pressure_angle": 0.3490658503988659, "helix_angle": 0.0,
    "rack": {"addendum": 1.0, "dedendum": 1.25, "tip_radius": 0.38},
}  # fmt: skip
GEAR: Mapping[str, Any] = {
    "bore_diameter": SHAFT, "tooth_thinning": 6.75e-5, "material": "case_hardened_steel", "flank": {},
}  # fmt: skip
PLACES: Mapping[str, Mapping[str, float]] = {
    "test": {"front": 0.0, "gear": 0.0545, "rear": 0.109},
    "slave": {"front": 0.075, "gear": 0.14, "rear": 0.205},
}
"""Along the shafts [m]."""
LIPS: Mapping[str, int] = {"test_pinion": 1, "test_wheel": 1, "slave_pinion": 1, "slave_wheel": 2}
"""Radial lip seals: one wherever a shaft leaves its gearbox."""
HOUSING: Mapping[str, Any] = {
    "wall_thickness": 0.0088, "floor_thickness": 0.011, "top_thickness": 0.0088, "end_wall_thickness": 0.03,
    "end_seal_width": 0.007, "shaft_height": 0.11, "material": "grey_iron",
    "field": {"length": 0.272, "width": 0.66, "thickness": 0.05, "material": "structural_steel"},
    "shafts": {
        f"test_{gear}": {
            "lateral_position": at, "seal_diameter": SHAFT, "outside_diameter": SHAFT, "overhang_front": 0.0,
            "overhang_rear": 0.0565,
        }
        for gear, at in (("pinion", -0.04575), ("wheel", 0.04575))
    },
}  # fmt: skip
LENGTHS: Mapping[str, tuple[float, float]] = {
    "test_pinion": (0.184, 0.184), "test_wheel": (0.184, 0.184),
    "slave_pinion": (0.205, 0.0), "slave_wheel": (0.28, 0.0),
}  # fmt: skip
"""Of each shaft, and where the half of its coupling sits [m]."""
COUPLING_HALF = 7.31e-4
"""[kg m2]"""
DRIVETRAIN: Mapping[str, Any] = {
    "shafts": {
        name: {
            "sections": [{"length": length, "outer_diameter": SHAFT, "inner_diameter": 0.0}],
            "discs": {"coupling_half": {"position": disc, "inertia": COUPLING_HALF}},
        }
        for name, (length, disc) in LENGTHS.items()
    },
    "couplings": {
        "pinion_side": {
            "shafts": ["test_pinion", "slave_pinion"], "ends": ["end", "start"],
            "torsional_stiffness": 373000.0, "torsional_damping": 7.46,
        },
        "wheel_side": {
            "shafts": ["test_wheel", "slave_wheel"], "ends": ["end", "start"],
            "torsional_stiffness": 74500.0, "torsional_damping": 1.49,
        },
    },
    "motor": {"shaft": "slave_wheel", "end": "end", "inertia": 0.0398},
    "bracing": {"mode": "twist_held", "coupling": "pinion_side"},
    "torque_at": "test.pinion",
}  # fmt: skip


def dips(tree: Mapping[str, Any]) -> bool:
    """Whether the gears of a rig run in sumps."""
    return any(box.get("oil", {}).get("lubrication") == "dip" for box in tree["gearboxes"].values())


def drawn(stated: Mapping[str, Any]) -> dict[str, Any]:
    """Tree of the whole rig from what its case states; a case of jets is returned as it is."""
    tree = copy.deepcopy(dict(stated))
    boxes = tree["gearboxes"]
    if not dips(tree):
        return tree
    for name in boxes:
        boxes[name] = _box(name, _alike(boxes, boxes[name]))
    tree["drivetrain"] = copy.deepcopy(dict(DRIVETRAIN))
    tree["ambient"] = {"temperature": 293.15, "reference_temperature": 293.15}
    tree["losses"] = {"squeeze_share": 0.0}
    tree["schedule"]["stages"] = [{"kind": "load", "torque_share": 1.0}]
    for name in boxes:
        mesh = boxes[name]["meshes"]["main"]
        mesh["damping"] = 0.0
        teeth = read_teeth(tree, name, "main")
        mean = teeth.peak_stiffness * teeth.contact_ratio * (1.0 - 0.42 / 3.0)
        mass = 1.0 / sum(r * r / j for r, j in zip(teeth.base_radii, teeth.inertias, strict=True))
        mesh["damping"] = 2.0 * DAMPING_RATIO * (mean * mass) ** 0.5
    return tree


def _alike(boxes: Mapping[str, Any], box: Mapping[str, Any]) -> dict[str, Any]:
    """A gearbox that is like another one but for what it states or takes away."""
    if "like" not in box:
        return copy.deepcopy(dict(box))
    base = {k: v for k, v in copy.deepcopy(boxes[box["like"]]).items() if k not in box.get("remove", ())}
    return _over(base, {k: v for k, v in box.items() if k not in ("like", "remove")})


def _over(base: dict[str, Any], change: Mapping[str, Any]) -> dict[str, Any]:
    for key, value in change.items():
        both = isinstance(value, Mapping) and isinstance(base.get(key), Mapping)
        base[key] = _over(base[key], value) if both else copy.deepcopy(value)
    return base


def _box(name: str, box: dict[str, Any]) -> dict[str, Any]:
    at = PLACES[name]
    for gear, entry in box["gears"].items():
        box["gears"][gear] = {**GEAR, "shaft": f"{name}_{gear}", "position": at["gear"], **entry}
        box["gears"][gear].update(shaft=f"{name}_{gear}", position=at["gear"])
    box["meshes"]["main"] = {**MESH, **box["meshes"]["main"]}
    stated = box.get("bearings", {})
    box["bearings"] = {
        f"{gear}_{side}": {
            **BEARING, "designation": box["all_bearings"]["designation"], **stated.get(f"{gear}_{side}", {}),
            "shaft": f"{name}_{gear}", "side": side, "position": at[side],
        }
        for gear in ("pinion", "wheel")
        for side in ("front", "rear")
    }  # fmt: skip
    box["heat_split"] = {"seal_into_shaft": 0.25, "seal_into_housing": 0.25}
    if "housing" in box:
        box["housing"] = {**HOUSING, **box["housing"]}
    return box
