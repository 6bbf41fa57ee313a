"""What can be hidden in a set, with units and physical bounds: effects of the loop, of heat, of sensors and inputs."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tests.virtual_rig.chain import UNITS
from tests.virtual_rig.generate_plans import Sensor, TruePoint
from tests.virtual_rig.generate_truth import case_of, has_loop
from tests.virtual_rig.heat_effects import EFFECTS, effect_names, effect_of, heat_key


@dataclass(frozen=True)
class Kind:
    """Size in ``unit`` between bounds; zero is a healthy rig. ``family`` groups what a rival would be taken from."""

    unit: str
    lower: float
    upper: float
    family: str
    meaning: str
    catalogue: bool = True


LOOP: Mapping[str, Kind] = {
    "run_out": Kind("m", 0.0, 50e-6, "excitation", "half of F_r, with phase"),
    "cumulative_pitch": Kind("m", 0.0, 40e-6, "excitation", "wave of order 2 to 4 over the turn, with phase"),
    "single_pitch": Kind("m", -20e-6, 20e-6, "excitation", "pitch deviation of one tooth"),
    "motor_ripple": Kind("N m", 0.0, 20.0, "excitation", "torque at an order of the motor, with phase"),
    "coupling_order_2": Kind("N m", 0.0, 20.0, "excitation", "torque between the halves of a coupling, with phase"),
    "weak_tooth": Kind("1", 0.0, 0.9, "tooth", "stiffness lost by one tooth"),
    "coupling_stiffness": Kind("1", -0.8, 4.0, "stiffness", "relative change"),
    "spline_stiffness": Kind("1", -0.8, 4.0, "stiffness", "relative change"),
    "mesh_stiffness": Kind("1", -0.3, 0.3, "stiffness", "relative change"),
    "mesh_damping": Kind("1", -0.8, 4.0, "damping", "relative change"),
    "coupling_damping": Kind("1", -0.8, 4.0, "damping", "relative change"),
    "inertia": Kind("1", -0.2, 0.2, "inertia", "relative change, gear or motor"),
    "tip_relief": Kind("m", 0.0, 25e-6, "flank", "relief beyond that of the case"),
    "profile_slope": Kind("m", -25e-6, 25e-6, "flank", "f_Halpha of all teeth"),
    "bracing_drift": Kind("1/K", -4e-3, 4e-3, "bracing", "locked twist per kelvin of gear oil above the reference"),
    "x_cell_lag": Kind("s", 0.0, 3e-4, "torque cell", "low-pass of a torque cell that nobody stated"),
    # ---------------------------------------------------------------- outside the catalogue
    "x_torque_squared": Kind("N m", 0.0, 20.0, "order 3", "torque at order 3, with the bracing torque squared", False),
    "x_mains": Kind("N m", 0.0, 20.0, "order near 100 Hz", "inverter's 100 Hz, leaking into the nearest order", False),
    "x_speed_ripple": Kind("N m", 0.0, 20.0, "order 4", "motor torque at order 4 with the square of the speed", False),
    "x_alternate_teeth": Kind("m", 0.0, 20e-6, "order z/2", "every second tooth ahead", False),
    "x_rub": Kind("N m", 0.0, 5.0, "orders 1 to 6", "a touch once a turn, growing with speed", False),
    "x_absorber": Kind("kg m2", 0.0, 4e-3, "shaft", "loose ring that swings at 150 Hz on a coupling flange", False),
    "x_stiffening": Kind("1", -0.3, 0.4, "mesh", "mesh stiffness that follows the torque", False),
    "x_encoder_wobble": Kind("rad", 0.0, 5e-4, "encoder", "encoder off centre", False),
    "x_rattle": Kind("1", 0.0, 20.0, "noise", "broadband noise of torque and angle at low torque", False),
}  # fmt: skip
SENSOR_KINDS = (
    "sensor_offset", "sensor_scale", "flow_scale", "inlet_offset", "torque_zero", "swapped_channels", "swapped_points",
    "unit", "angle_zero",
)  # fmt: skip
CHAIN_KINDS = frozenset({*SENSOR_KINDS, "x_cell_lag", "x_encoder_wobble", "x_rattle"})
"""Effects of the measuring system, not of the rig."""


def kind_of(effect: str) -> Kind:
    """Entry of an effect by its name; KeyError when unknown."""
    kind = effect.partition(":")[0]
    if kind in LOOP:
        return LOOP[kind]
    entry = effect_of(effect)[0]
    return Kind(entry.unit, entry.lower, entry.upper, entry.family, entry.meaning, entry.catalogue)


def candidates(rig: str, own: Sequence[Sensor], *, catalogue: bool) -> list[str]:
    """Names of all physical effects that make sense on a rig, in or outside the catalogue."""
    tree, _ = case_of(rig)
    if not has_loop(rig):
        test = [n for n in effect_names(tree, catalogue) if not n.partition(":")[2].startswith("reference")]
        return [
            *test,
            *(
                n
                for n in effect_names(tree, catalogue)
                if n.startswith(("mesh_loss:ref", "bearing_loss:ref"))
            ),
        ]
    heat = list(effect_names(tree, catalogue))
    gears = [f"{box}.{gear}" for box, entry in tree["gearboxes"].items() for gear in entry["gears"]]
    meshes = [f"{box}.{mesh}" for box, entry in tree["gearboxes"].items() for mesh in entry["meshes"]]
    couplings = list(tree["drivetrain"]["couplings"])
    # a catalogue changes reliefs that a gear has; on another gear a relief is news to the case
    relieved = [gear for gear in gears if _flank(tree, gear).get("tip_relief_length", 0.0) > 0.0]
    splined = [gear for gear in gears if "spline" in _gear(tree, gear)]
    cells = [s.name for s in own if s.quantity == "torque"]
    if catalogue:
        places = {
            "coupling_order_2": couplings, "coupling_stiffness": couplings, "coupling_damping": couplings,
            "spline_stiffness": splined,
            "mesh_stiffness": meshes, "mesh_damping": meshes, "inertia": [*gears, "motor"], "motor_ripple": [""],
            "bracing_drift": [""], "x_cell_lag": cells,
        }  # fmt: skip
        kinds = [kind for kind, entry in LOOP.items() if entry.catalogue]
        places["tip_relief"] = relieved
    else:
        encoders = [s.name for s in own if s.quantity == "angle"]
        places = {
            "x_torque_squared": couplings, "x_mains": [""], "x_speed_ripple": [""],
            "x_rub": gears, "x_absorber": couplings, "x_stiffening": [""], "x_rattle": [""],
            "x_encoder_wobble": encoders, "x_alternate_teeth": gears if rig == "loop_1to1" else
            [g for g in gears if g.endswith("pinion")],
        }  # fmt: skip
        kinds = [kind for kind, entry in LOOP.items() if not entry.catalogue] + ["tip_relief"]
        places["tip_relief"] = [gear for gear in gears if gear not in relieved]
    found = [f"{kind}:{place}" if place else kind for kind in kinds for place in places.get(kind, gears)]
    return [*found, *heat]


def _gear(tree: Mapping[str, Any], gear: str) -> Mapping[str, Any]:
    box, name = gear.split(".")
    entry: Mapping[str, Any] = tree["gearboxes"][box]["gears"][name]
    return entry


def _flank(tree: Mapping[str, Any], gear: str) -> Mapping[str, Any]:
    flank: Mapping[str, Any] = _gear(tree, gear).get("flank", {})
    return flank


def draw_effect(rig: str, own: Sequence[Sensor], rng: np.random.Generator, *, catalogue: bool, avoid: Sequence[str] = ()
                ) -> dict[str, Any]:  # fmt: skip
    """An effect without its size: kind drawn evenly, then place, sign, phase, order, tooth."""
    names = [n for n in candidates(rig, own, catalogue=catalogue) if kind_of(n).family not in avoid]
    kinds = sorted({heat_key(n) for n in names})
    chosen = kinds[rng.integers(len(kinds))]
    mine = [n for n in names if heat_key(n) == chosen]
    name = mine[rng.integers(len(mine))]
    entry = kind_of(name)
    effect: dict[str, Any] = {"effect": name, "unit": entry.unit, "family": entry.family}
    effect["sign"] = (
        1 if entry.lower >= 0.0 else (1 if rng.random() < entry.upper / (entry.upper - entry.lower) else -1)
    )
    kind = name.partition(":")[0]
    if kind in ("run_out", "cumulative_pitch", "motor_ripple", "coupling_order_2") or kind.startswith("x_"):
        effect["phase"] = float(rng.uniform(-math.pi, math.pi))
    if kind == "cumulative_pitch":
        effect["order"] = int(rng.integers(2, 5))
    if kind == "motor_ripple":
        effect["order"] = int(rng.choice([1, 2, 3, 4]))
    if kind in ("single_pitch", "weak_tooth"):
        effect["tooth"] = int(rng.integers(_teeth(rig, name.partition(":")[2])))
    return effect


def sized(effect: Mapping[str, Any], size: float) -> dict[str, Any]:
    """The effect with a positive ``size`` along its sign, inside its bounds."""
    entry = kind_of(effect["effect"])
    value = min(max(effect["sign"] * size, entry.lower), entry.upper)
    return {**effect, "size": float(value)}


def reach(effect: Mapping[str, Any]) -> float:
    """Largest size along the sign of the effect."""
    entry = kind_of(effect["effect"])
    return entry.upper if effect["sign"] > 0 else -entry.lower


def draw_input_error(
    own: Sequence[Sensor], points: Sequence[TruePoint], rng: np.random.Generator
) -> dict[str, Any]:
    """An error of sensor or input, with its size: three to ten of its spreads, or a swap."""
    cells = [s for s in own if s.quantity == "torque"]
    kinds = [
        k
        for k in SENSOR_KINDS
        if (k not in ("torque_zero", "angle_zero") or cells) and (k != "flow_scale" or points[0].flow)
    ]
    kind = kinds[rng.integers(len(kinds))]
    big = float(rng.choice([-1.0, 1.0]) * math.exp(rng.uniform(math.log(3.0), math.log(10.0))))
    tested = [stream for stream in points[0].inlet if stream.startswith("test.")]
    stream = tested[rng.integers(len(tested))]

    def one(group: Sequence[Sensor]) -> Sensor:
        return group[rng.integers(len(group))]

    match kind:
        case "sensor_offset":
            sensor = one([s for s in own if s.offset and s.quantity != "torque"])
            return _input(
                f"{kind}:{sensor.name}", big * sensor.offset, "K" if "temp" in sensor.quantity else "W"
            )
        case "sensor_scale":
            sensor = one([s for s in own if s.scale])
            return _input(f"{kind}:{sensor.name}", big * sensor.scale, "1")
        case "torque_zero":
            sensor = one(cells)
            return _input(f"{kind}:{sensor.name}", big * sensor.offset, "N m")
        case "flow_scale":
            return _input(f"{kind}:{stream}", 0.01 * big * 1.5, "1")
        case "inlet_offset":
            return _input(f"{kind}:{stream}", 0.3 * big * 1.5, "K")
        case "angle_zero":
            return _input(kind, 3.0 * big * math.pi / 180.0 * 0.5, "rad")
        case "swapped_points":
            first, second = rng.choice(len(points), 2, replace=False)
            return _input(f"{kind}:{points[first].name},{points[second].name}", 0.0, "")
        case "swapped_channels":
            groups: dict[tuple[str, tuple[float, ...]], list[Sensor]] = {}
            for sensor in own:
                groups.setdefault((sensor.quantity, sensor.orders), []).append(sensor)
            able = [g for g in groups.values() if len(g) > 1]
            if not able:
                return draw_input_error(own, points, rng)
            group = able[rng.integers(len(able))]
            first, second = rng.choice(len(group), 2, replace=False)
            return _input(f"{kind}:{group[first].name},{group[second].name}", 0.0, "")
    sensor = one([s for s in own if UNITS[s.quantity][0] in ("degC", "W", "N m", "mrad")])
    factor, addend = {
        "degC": (1.8, 32.0),
        "W": (1e-3, 0.0),
        "N m": (8.850746, 0.0),
        "mrad": (0.0572958, 0.0),
    }[UNITS[sensor.quantity][0]]
    return {**_input(f"unit:{sensor.name}", 0.0, ""), "factor": factor, "addend": addend}


def _input(name: str, size: float, unit: str) -> dict[str, Any]:
    return {"effect": name, "size": size, "unit": unit, "family": "input"}


def _teeth(rig: str, gear: str) -> int:
    tree, _ = case_of(rig)
    box, name = gear.split(".")
    return int(tree["gearboxes"][box]["gears"][name]["teeth"])


__all__ = [
    "CHAIN_KINDS",
    "EFFECTS",
    "LOOP",
    "Kind",
    "candidates",
    "draw_effect",
    "draw_input_error",
    "kind_of",
    "reach",
    "sized",
]
