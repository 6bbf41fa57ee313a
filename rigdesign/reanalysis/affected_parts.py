"""Which parts of the model an input touches, and which inputs reach the loads through temperatures alone.

The table names what is known to touch only a part of the model. An input that stands in none of them is solved
again in full and influences every check (`checks.assumptions`): a missing entry costs time, not truth.
"""

from typing import Literal

from rigdesign.checks.assumptions import is_under

Part = Literal["coupling", "curves", "time run"]
PARTS: tuple[Part, ...] = ("coupling", "curves", "time run")

SOLVED: dict[tuple[str, ...], tuple[Part, ...]] = {
    (
        "limits.dynamics.resonance_distance_minimum",
        "limits.dynamics.dangerous_amplification",
        "limits.dynamics.dangerous_force_share",
        "limits.bearing.start_torque_limit",
    ): ("curves",),
    (
        "limits",
        "test_plan",
        "gearboxes.*.seals.*.axial_travel",
        "gearboxes.*.meshes.*.face_load_factor",
        "drivetrain.couplings.*.radial_offset_maximum",
        "drivetrain.couplings.*.angle_maximum",
    ): (),
    ("schedule.stages.*.duration", "drivetrain.motor.torque_limit"): ("time run",),
    (
        "gearboxes.*.housing",
        "gearboxes.*.seals",
        "gearboxes.*.gears.*.flank_roughness",
        *(
            f"gearboxes.*.bearings.*.{key}"
            for key in ("width", "diametral_clearance", "feed_share", "axial_play", "locating")
        ),
        "losses.chamber_density",
        "losses.squeeze_share",
        "losses.friction",
    ): ("coupling",),
}
"""Inputs -> parts of the model they touch; the first entry that holds a path counts.

Heat and oil move the response over speed and the time run through drag torques and the temperature of the gears.
Where they move gears or axes more than `modified_rig.LOADS_MOVE` the loads are solved again as well; the torque of
the motor follows its losses (`motor_torque`).
"""

THROUGH_HEAT = (
    "ambient",
    "oils",
    "losses",
    *(
        f"gearboxes.*.{key}"
        for key in (
            "oil",
            "bearing_oil",
            "oil_paths",
            "oil_state",
            "loss_factors",
            "heat_split",
            "housing",
            "seals",
        )
    ),
)
"""Inputs that reach the dynamic loads through the temperatures of the gears and the drag torques alone: they change
neither drivetrain nor schedule nor the teeth as drawn."""


def parts_of(path: str) -> tuple[Part, ...]:
    """Parts of the model that have to be solved again when the value at ``path`` changes."""
    return next(
        (parts for paths, parts in SOLVED.items() if any(is_under(path, entry) for entry in paths)), PARTS
    )


def through_heat(path: str) -> bool:
    """Whether an input reaches the loads through temperatures and drag torques alone."""
    return any(is_under(path, entry) for entry in THROUGH_HEAT)
