"""Which inputs a check rests on: one table from checks to parts of the case.

A part is a dotted path; ``*`` stands for one name, ``{box}`` for the gearbox in the id of the check, ``{housed}``
for every gearbox with a housing. The limit a check names as its source always belongs to it.
"""

import re
from dataclasses import replace
from fnmatch import fnmatchcase

from rigdesign.case.model import Case
from rigdesign.results import Check

LOOP = (
    *(f"gearboxes.*.gears.*.{key}" for key in (
        "profile_shift", "tooth_thinning", "face_width", "flank", "inertia", "position", "spline"
    )),
    *(f"gearboxes.*.meshes.*.{key}" for key in (
        "contact_ratio", "tip_cut", "profile_shift_split", "rack", "damping"
    )),
    "drivetrain.shafts", "drivetrain.couplings.*.torsional_stiffness", "drivetrain.couplings.*.torsional_damping",
    "drivetrain.motor.inertia",
)  # fmt: skip
"""What the torsional response of the loop is made of."""
RATING = ("gearboxes.{box}.gears", "gearboxes.{box}.meshes")
BEARINGS = (
    *(f"gearboxes.*.bearings.*.{key}" for key in (
        "diameter", "width", "diametral_clearance", "feed_share", "position"
    )),
    "gearboxes.*.bearing_oil",
)  # fmt: skip
LOSSES = ("losses", "gearboxes.*.oil", "gearboxes.*.gears.*.flank_roughness", *BEARINGS)
HEAT = (
    "gearboxes.{housed}.housing", "gearboxes.{housed}.heat_split", "gearboxes.{housed}.gears.*.profile_shift", *LOSSES
)  # fmt: skip
"""Temperatures of the housings: what makes heat and what takes it; the profile shift decides the sliding."""
RAMP = ("schedule.stages.*.torque", "schedule.stages.*.torque_share", "schedule.stages.*.speed")
RUN = (*LOOP, "schedule.stages")
DANGER = ("limits.dynamics.dangerous_amplification", "limits.dynamics.dangerous_force_share")
CYCLES = ("test_plan.time", "test_plan.specimens")
GROWN = ("gearboxes.{housed}.bearings.*.locating", *HEAT)

RESTS = {
    "dynamics.dynamic_factor.*": LOOP,
    "dynamics.ramp_peak.*": RUN,
    "dynamics.resonance_distance.*": (*LOOP, *DANGER),
    "dynamics.lift_off.*": RUN,
    "dynamics.contact_margin.*": RUN,
    "specimen.root_stress_iso.*": (*RATING, *LOOP, "limits.specimen"),
    "specimen.root_stress_path.*": (*LOOP, "limits.specimen"),
    "strength.root_safety_iso.*": (*RATING, *LOOP, *CYCLES, "limits.strength", "materials"),
    "strength.root_safety_path.*": (*LOOP, *CYCLES, "limits.strength", "materials"),
    "specimen.load_cycles": CYCLES,
    "temperature.*": (*HEAT, "materials"),
    "clearance.seal_gap": (*GROWN, "gearboxes.{housed}.seals.*.radial_gap"),
    "clearance.axial_play": (*GROWN, "gearboxes.{housed}.bearings.*.axial_play"),
    "clearance.backlash": (*GROWN, "gearboxes.{housed}.gears.*.tooth_thinning"),
    "clearance.tip_clearance": (
        *GROWN, *(f"gearboxes.{{housed}}.meshes.*.{key}" for key in ("contact_ratio", "tip_cut", "rack")),
    ),
    "clearance.bearing_clearance": HEAT,
    "clearance.seal_travel.*": GROWN,
    "alignment.coupling_*": (
        *GROWN, "drivetrain.couplings.*.cold_offset_lateral", "drivetrain.couplings.*.cold_offset_vertical",
    ),
    "alignment.*": GROWN,
    "transient.*": (*GROWN, "transient"),
    "bearing.*": (*BEARINGS, *HEAT, "gearboxes.*.gears.*.position"),
    "oil.flow": ("gearboxes.*.oil.flow", "gearboxes.*.bearing_oil.flow"),
    "oil.*": HEAT,
    "ramp.*": RAMP,
}  # fmt: skip
"""Pattern of the id -> parts of the case; the first that fits counts."""

BOUGHT = {
    "torque_peak": RUN,
    "torque_mean": RAMP,
    "speed": RAMP,
    "circulating_power": RAMP,
    "drive_torque": (*RUN, *LOSSES, "drivetrain.motor"),
    "drive_power": (*RUN, *LOSSES, "drivetrain.motor"),
    "actuator_force": (*LOOP, *HEAT, "drivetrain.bracing"),
    "shaft_growth": GROWN,
    "oil_flow": ("gearboxes.*.oil.flow", "gearboxes.*.bearing_oil.flow"),
    "temperature_maximum": HEAT,
    "seal_surface_velocity": ("gearboxes.{housed}.housing.shafts",),
}
"""The same for bought parts, by the quantity held against their limit."""

PATH = re.compile(r"[a-z_0-9]+(?:\.[a-z_0-9]+)+")


def with_assumptions(case: Case, check: Check) -> Check:
    """The check with the paths of the assumed inputs it rests on; none where it does not apply."""
    if check.verdict == "not applicable":
        return check
    parts = parts_of(case, check)
    found = tuple(
        record.path for record in case.assumptions if any(is_under(record.path, part) for part in parts)
    )
    return replace(check, assumptions=found)


def parts_of(case: Case, check: Check) -> list[str]:
    """Parts of the case behind a check, names filled in."""
    group, _, name = check.id.partition(".")
    if group == "bought_part":
        bought = case.limits.bought_parts[name]
        own = (f"limits.bought_parts.{name}",)
        patterns = own if bought.given is not None else (*own, *BOUGHT[bought.quantity])
    else:
        patterns = next(parts for key, parts in RESTS.items() if fnmatchcase(check.id, key))
    box = check.id.split(".")[2] if check.id.count(".") >= 2 else "*"
    housed = [name for name, entry in case.gearboxes.items() if entry.housing is not None]
    filled = [
        pattern.replace("{box}", box).replace("{housed}", name)
        for pattern in patterns
        for name in (housed if "{housed}" in pattern else [""])
    ]
    return [*filled, *PATH.findall(check.source)]


def is_under(path: str, part: str) -> bool:
    """Whether a path of the case is the part or lies under it."""
    names, wanted = path.split("."), part.split(".")
    return len(names) >= len(wanted) and all(want in ("*", name) for name, want in zip(names, wanted))
