"""What a bought part may be held against: which results belong to which part of the case, and on which shafts."""

from fnmatch import fnmatchcase
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rigdesign.case.limits import ResultQuantity
    from rigdesign.case.model import Case

LOADED = (
    "gearboxes.*", "gearboxes.*.meshes.*", "gearboxes.*.gears.*", "drivetrain.couplings.*", "drivetrain.shafts.*",
)  # fmt: skip
TURNING = (*LOADED, "gearboxes.*.bearings.*", "gearboxes.*.seals.*", "drivetrain.motor")
HOUSED = ("gearboxes.*", "gearboxes.*.housing", "gearboxes.*.seals.*", "gearboxes.*.housing.shafts.*")
PLACES: "dict[ResultQuantity, tuple[str, ...]]" = {
    "torque_peak": LOADED,
    "torque_mean": LOADED,
    "speed": TURNING,
    "drive_torque": ("drivetrain.motor",),
    "drive_power": ("drivetrain.motor",),
    "actuator_force": ("drivetrain.bracing",),
    "shift_travel": ("drivetrain.bracing",),
    "circulating_power": ("gearboxes.*", "drivetrain", "drivetrain.couplings.*", "drivetrain.shafts.*"),
    "seal_surface_velocity": HOUSED,
    "shaft_growth": HOUSED,
    "oil_flow": ("gearboxes", "gearboxes.*", "gearboxes.*.oil", "gearboxes.*.bearing_oil"),
    "temperature_maximum": ("gearboxes.*", "gearboxes.*.housing"),
}
"""Quantity -> patterns of the parts that have it; ``*`` stands for one name."""


def has_result(part: str, quantity: "ResultQuantity") -> bool:
    """Whether a part has a result of this quantity."""
    return any(_fits(part, pattern) for pattern in PLACES[quantity])


def shafts_of(case: "Case", part: str) -> tuple[str, ...]:
    """Shafts of a part, each once: those its gears, seals or bearings sit on, that a coupling joins, its own."""
    names = part.split(".")
    if names[0] == "drivetrain":
        power = case.power_circuit
        if case.drivetrain is None or len(names) < 2:
            return ()
        if names[1] == "motor":
            return (power.motor.shaft,)
        return power.couplings[names[2]].shafts if names[1] == "couplings" else (names[2],)
    box = case.gearboxes[names[1]]
    if len(names) == 2 or names[2:] == ["housing"]:
        return tuple(dict.fromkeys(gear.shaft for gear in box.gears.values()))
    if names[2] == "housing":
        return (names[4],)
    if names[2] == "meshes":
        mesh = box.meshes[names[3]]
        return box.gears[mesh.pinion].shaft, box.gears[mesh.wheel].shaft
    shafts = {
        "gears": {name: gear.shaft for name, gear in box.gears.items()},
        "bearings": {name: bearing.shaft for name, bearing in box.bearings.items()},
        "seals": {name: seals.shaft for name, seals in box.seals.items()},
    }
    return (shafts[names[2]][names[3]],)


def _fits(part: str, pattern: str) -> bool:
    names, wanted = part.split("."), pattern.split(".")
    return len(names) == len(wanted) and all(map(fnmatchcase, names, wanted))
