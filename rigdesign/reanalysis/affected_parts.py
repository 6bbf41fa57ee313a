"""Which parts of the model an input touches, and which inputs reach the loads through temperatures alone.

The table names what is known to touch only a part of the model. An input that stands in none of them is solved
again in full and influences every check (`checks.assumptions`): a missing entry costs time, not truth.
"""

from collections.abc import Collection
from dataclasses import dataclass
from typing import Literal

from rigdesign.case.model import Case
from rigdesign.checks.assumptions import is_under

Part = Literal["coupling", "curves", "time run"]
PARTS: tuple[Part, ...] = ("coupling", "curves", "time run")
TimeRun = Literal["marched", "shifted"]
"""How the time run follows loads that move."""

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
        "gearboxes.*.oil.scuffing_load_stage",
        "gearboxes.*.oil.scuffing_temperature",
        "oils.*.scuffing_load_stage",
        "materials.*.scuffing_factor",
        "drivetrain.couplings.*.radial_offset_maximum",
        "drivetrain.couplings.*.angle_maximum",
        "rig_heat.room",
    ): (),
    ("schedule.stages.*.duration", "drivetrain.motor.torque_limit"): ("time run",),
    (
        "gearboxes.*.housing",
        "gearboxes.*.seals",
        "gearboxes.*.gears.*.flank_roughness",
        *(
            f"gearboxes.*.bearings.*.{key}"
            for key in (
                "width",
                "diametral_clearance",
                "feed_share",
                "feed",
                "friction_factor",
                "axial_play",
                "locating",
            )
        ),
        "losses.chamber_density",
        "losses.squeeze_share",
        "losses.friction",
        "rig_heat",
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
    "rig_heat",
    *(
        f"losses.{key}"
        for key in ("given", "chamber_density", "squeeze_share", "friction", "mesh_damping_heats_oil")
    ),
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
"""Inputs that reach the dynamic loads through the temperatures of the gears, the drag torques and the friction of the
teeth: they change neither drivetrain nor schedule nor the teeth as drawn. `reanalysis` names the exceptions."""


@dataclass(frozen=True)
class Reanalysis:
    """A case with changed inputs, and what of it is solved again.

    parts : of the model that the changed inputs touch
    time_run : ``shifted`` where the periodic response may move its envelopes (`shifted_run`), else ``marched``
    """

    case: Case
    parts: tuple[Part, ...]
    time_run: TimeRun = "marched"


def reanalysis(case: Case, changed: Collection[str]) -> Reanalysis | None:
    """What is solved again of ``case`` where these inputs change; None where everything is.

    The time run is marched where heat moves the mean torque of the loop: a bracing that holds twist or shift winds up
    with warm gears, and one with a temperature drift follows the oil. With a constant bearing drag the factor of
    that loss is part of the drivetrain.
    """
    parts = tuple(part for part in PARTS if any(part in parts_of(path) for path in changed))
    in_heat = [path for path in changed if through_heat(path)]
    if any(path not in in_heat and parts_of(path) == PARTS for path in changed):
        return None
    if case.losses.bearing_drag == "constant" and any(".loss_factors" in path for path in in_heat):
        return None
    power = case.drivetrain
    steady = power is None or (
        power.bracing.mode == "torque_controlled" and power.bracing.temperature_drift == 0.0
    )
    shifted = steady and all(path in in_heat or "time run" not in parts_of(path) for path in changed)
    return Reanalysis(case, parts, "shifted" if shifted else "marched")


def parts_of(path: str) -> tuple[Part, ...]:
    """Parts of the model that have to be solved again when the value at ``path`` changes."""
    return next(
        (parts for paths, parts in SOLVED.items() if any(is_under(path, entry) for entry in paths)), PARTS
    )


def through_heat(path: str) -> bool:
    """Whether an input reaches the loads through temperatures and drag torques alone."""
    return any(is_under(path, entry) for entry in THROUGH_HEAT)
