"""Which inputs a check depends on.

An input that no table names influences every check: a missing entry costs time, not truth. The tables name what is
known to touch only a part. ``*`` stands for any name, ``{box}`` in the id of a check for the gearbox of the input,
``{bare}`` in an input for a gearbox without a housing; bought parts go by their quantity. The limit a check names as
its source always belongs to it, and no other limit does unless it stands here. `tests/verification/test_ranges_plan`
perturbs every number of a case and compares.
"""

import re
from collections.abc import Mapping
from dataclasses import replace
from fnmatch import fnmatchcase

from rigdesign.case.model import Case
from rigdesign.results.result import Check

Checks = tuple[str, ...]

HEAT: Checks = (
    "temperature.*", "clearance.*", "alignment.*", "transient.*", "bearing.*", "oil.cooler", "oil.heater", "oil.room",
    *(f"bought_part.{key}" for key in (
        "temperature_maximum", "shaft_growth", "drive_torque", "drive_power", "actuator_force"
    )),
)  # fmt: skip
"""What the housing moves; the teeth of the loop feel it by less than a thousandth of a limit."""
TIME_RUN: Checks = (
    "dynamics.ramp_peak.*", "dynamics.lift_off.*", "dynamics.contact_margin.*", "bought_part.drive_torque",
    "bought_part.drive_power", "bought_part.torque_peak",
)  # fmt: skip
ISO: Checks = ("specimen.root_stress_iso.{box}.*", "strength.root_safety_iso.{box}.*")

TOUCHES: Mapping[tuple[str, ...], Checks] = {
    ("limits.bearing.start_torque_limit",): ("dynamics.*", "bearing.transition_speed", "ramp.*"),
    ("limits.ramp",): ("ramp.*", "bearing.transition_speed"),
    ("limits.dynamics.dangerous_amplification", "limits.dynamics.dangerous_force_share"): (
        "dynamics.resonance_distance.*",
    ),
    ("limits.dynamics.resonance_distance_minimum",): ("dynamics.resonance_distance.*",),
    ("limits.specimen",): ("specimen.*",),
    ("limits.strength",): ("strength.*",),
    ("limits",): (),
    ("test_plan",): ("specimen.load_cycles", "strength.*", "transient.*"),
    ("transient",): ("transient.*",),
    (
        "gearboxes.*.seals.*.axial_travel",
        "drivetrain.couplings.*.radial_offset_maximum",
        "drivetrain.couplings.*.angle_maximum",
        "gearboxes.*.bearings.*.radial_stiffness",
        "gearboxes.*.bearings.*.radial_damping",
        "gearboxes.{bare}.heat_split",
        "gearboxes.{bare}.bearings.*.locating",
    ): (),
    ("drivetrain.couplings.*.cold_offset_lateral", "drivetrain.couplings.*.cold_offset_vertical"): (
        "alignment.coupling_*", "transient.coupling_*",
    ),
    ("drivetrain.motor.torque_limit", "schedule.stages.*.duration"): TIME_RUN,
    ("drivetrain.bracing.spline_friction_coefficient", "drivetrain.bracing.spline_pitch_radius"): (
        "bought_part.actuator_force",
    ),
    ("gearboxes.*.meshes.*.face_load_factor", "gearboxes.*.gears.*.quality_grade"): ISO,
    ("gearboxes.*.housing", "gearboxes.*.seals"): HEAT,
    ("gearboxes.*.bearings.*.axial_play",): ("clearance.axial_play", "transient.axial_play"),
}  # fmt: skip
"""Inputs -> checks they can move, besides those that name them as their source; the first that holds a path counts."""

SPEEDS = ("schedule", "gearboxes.*.gears", "gearboxes.*.meshes")
ARITHMETIC: Mapping[str, tuple[str, ...]] = {
    "specimen.load_cycles": ("test_plan", "limits.specimen", *SPEEDS),
    "ramp.*": ("limits.ramp", "limits.bearing.start_torque_limit", *SPEEDS),
    "oil.flow": ("gearboxes.*.oil.flow", "gearboxes.*.bearing_oil.flow"),
    "bought_part.torque_mean": SPEEDS,
    "bought_part.speed": SPEEDS,
    "bought_part.circulating_power": SPEEDS,
    "bought_part.oil_flow": ("gearboxes.*.oil.flow", "gearboxes.*.bearing_oil.flow"),
    "bought_part.seal_surface_velocity": (
        *SPEEDS,
        "gearboxes.*.housing.shafts",
        "gearboxes.*.bearings",
        "drivetrain.shafts",
    ),
    "bought_part.given": (),
}
"""Checks that are arithmetic of a few inputs: nothing else moves them."""

PATH = re.compile(r"[a-z_0-9]+(?:\.[a-z_0-9]+)+")


def with_assumptions(case: Case, check: Check) -> Check:
    """The check with the paths of the assumed inputs it depends on; none where it does not apply."""
    if check.verdict == "not applicable":
        return check
    found = tuple(record.path for record in case.assumptions if depends(case, check, record.path))
    return replace(check, assumptions=found)


def depends(case: Case, check: Check, path: str) -> bool:
    """Whether the value or limit of a check depends on an input."""
    group, _, name = check.id.partition(".")
    own = [*PATH.findall(check.source), *([f"limits.bought_parts.{name}"] if group == "bought_part" else [])]
    if any(is_under(path, part) for part in own):
        return True
    key = key_of(case, check)
    inputs = next((parts for pattern, parts in ARITHMETIC.items() if fnmatchcase(key, pattern)), None)
    if inputs is not None:
        return any(is_under(path, part) for part in inputs)
    touched = _touched(case, path)
    return touched is None or any(fnmatchcase(key, pattern) for pattern in touched)


def _touched(case: Case, path: str) -> Checks | None:
    """Patterns of the checks an input can move; None for all."""
    names = path.split(".")
    box = names[1] if names[0] == "gearboxes" and len(names) > 1 else ""
    bare = [name for name, entry in case.gearboxes.items() if entry.housing is None]
    for inputs, touched in TOUCHES.items():
        for part in inputs:
            filled = [part.replace("{bare}", name) for name in bare] if "{bare}" in part else [part]
            if any(is_under(path, one) for one in filled):
                return tuple(pattern.replace("{box}", box) for pattern in touched)
    return None


def key_of(case: Case, check: Check) -> str:
    """Id of a check; of a bought part its quantity instead of its name, ``given`` where the case gives the value."""
    group, _, name = check.id.partition(".")
    if group != "bought_part":
        return check.id
    bought = case.limits.bought_parts[name]
    return f"{group}.{bought.quantity if bought.given is None else 'given'}"


def is_under(path: str, part: str) -> bool:
    """Whether a path of the case is the part or lies under it."""
    names, wanted = path.split("."), part.split(".")
    return len(names) >= len(wanted) and all(want in ("*", name) for name, want in zip(names, wanted))
