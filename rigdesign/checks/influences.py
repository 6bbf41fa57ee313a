"""Which inputs move a part of the checks only.

An input that no group names moves every check: a missing entry costs time, not truth. A limit that a check names as
its source always belongs to it, and no other limit does unless it stands here. `tests/verification/test_ranges_plan`
perturbs every number of a case and compares.
"""

from collections.abc import Mapping
from typing import Literal

Influence = Literal[
    "start torque", "ramp limits", "resonance limits", "specimen limits", "strength limits", "test time",
    "thermal history", "coupling offset", "time run", "spline friction", "gear rating", "housing", "axial play",
    "rig heat", "flank rating", "events", "gear seats",
]  # fmt: skip
"""``housing``: what the temperature fields move; the teeth of the loop feel it by less than a thousandth of a limit."""

MOVE_NO_CHECK = ("gearboxes.*.gears.*.strain_gauges", "numerics.root_stress_speeds")
"""Inputs of what is measured or shown, not of the rig."""
INPUTS: Mapping[tuple[str, ...], tuple[Influence, ...]] = {
    ("limits.bearing.start_torque_limit",): ("start torque",),
    ("limits.ramp",): ("ramp limits",),
    (
        "limits.dynamics.dangerous_amplification",
        "limits.dynamics.dangerous_force_share",
        "limits.dynamics.resonance_distance_minimum",
    ): ("resonance limits",),
    ("limits.specimen",): ("specimen limits",),
    ("limits.strength",): ("strength limits",),
    ("limits",): (),
    ("test_plan",): ("test time",),
    ("events",): ("events",),
    ("transient",): ("thermal history",),
    (
        "gearboxes.*.seals.*.axial_travel",
        "drivetrain.couplings.*.radial_offset_maximum",
        "drivetrain.couplings.*.angle_maximum",
        "gearboxes.{film}.radial_stiffness",
        "gearboxes.{film}.radial_damping",
        "gearboxes.*.bearings.*.torsional_damping{drag}",
        "gearboxes.{bare}.heat_split",
        "gearboxes.{bare}.seals.*.radial_gap{torsional}",
        "gearboxes.{bare}.bearings.*.locating{torsional}",
    ): (),
    ("drivetrain.couplings.*.cold_offset_lateral", "drivetrain.couplings.*.cold_offset_vertical"): (
        "coupling offset",
    ),
    ("drivetrain.motor.torque_limit", "schedule.stages.*.duration"): ("time run",),
    ("drivetrain.bracing.spline_friction_coefficient", "drivetrain.bracing.spline_pitch_radius"): (
        "spline friction",
    ),
    ("gearboxes.*.gears.*.spline.toothing", "gearboxes.*.gears.*.shaft_interference_minimum"): ("gear seats",),
    ("gearboxes.*.meshes.*.face_load_factor", "gearboxes.*.gears.*.quality_grade"): ("gear rating",),
    (
        "gearboxes.*.oil.scuffing_load_stage",
        "gearboxes.*.oil.scuffing_temperature",
        "oils.*.scuffing_load_stage",
        "materials.*.scuffing_factor",
    ): ("flank rating",),
    ("gearboxes.*.housing", "gearboxes.*.seals"): ("housing",),
    ("gearboxes.*.bearings.*.axial_play",): ("axial play",),
    ("rig_heat.room", "rig_heat{dry}"): ("rig heat",),
}  # fmt: skip
"""Inputs -> what they move; the first entry that holds a path counts. ``*`` stands for any name, ``{bare}`` for a
gearbox without a housing, ``{film}`` for a plain bearing whose coefficients are computed; an entry with ``{dry}``
counts where no machine heats an oil circuit, which feeds gearboxes, one with ``{torsional}`` where they only
twist, one with ``{drag}`` where the films give the drag of the bearings."""
OF_ONE_GEARBOX: tuple[Influence, ...] = ("gear rating",)
"""Influences of an input that stay in its gearbox: the place of a check begins with it."""
SPEEDS = (
    "schedule", "gearboxes.*.gears.*.teeth", "gearboxes.*.gears.*.shaft", "gearboxes.*.gears.*.role",
    "gearboxes.*.meshes.*.pinion", "gearboxes.*.meshes.*.wheel", "drivetrain.couplings.*.shafts",
    "drivetrain.torque_at",
)  # fmt: skip
"""Inputs behind the stated speeds and torques of all shafts: the schedule and the ratios."""
