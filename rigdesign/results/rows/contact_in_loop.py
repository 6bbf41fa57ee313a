"""Contact in the loop as rows of the result."""

from typing import Any

from rigdesign.results.contact_in_loop import LoopedContact
from rigdesign.results.units import RPM


def contact_in_loop_row(found: LoopedContact) -> dict[str, Any]:
    """K_V and least torque by both models, speed of the pinion."""
    return {
        "gearbox": found.mesh,
        "stage": found.stage,
        "peak": found.peak,
        "pinion_speed_rpm": found.speed * RPM,
        "torque_Nm": found.torque,
        "dynamic_factor": found.dynamic_factor,
        "dynamic_factor_by_table": found.dynamic_factor_by_table,
        "shift": found.shift,
        "least_share": found.least_share,
        "least_share_by_table": found.least_share_by_table,
        "other_flank_share": found.other_flank,
        "without_contact_share": found.apart,
        "tilt_urad": 1e6 * found.tilt,
        "still_changing": found.still_changing,
        "settled": found.settled,
        "time_s": found.time,
        "unconverged_steps": found.unconverged,
    }
