"""Where the keys of the power circuit enter the flow."""

from collections.abc import Mapping

from rigdesign.explanation.station import Station, stations_at

_BENDING = "spring and damper between the ends of two shafts that bend"
_UNBALANCE = "force once a turn on a shaft that bends, with the square of its speed"
_LIMIT = "limit that a result is held against"

DRIVETRAIN_STATIONS: Mapping[str, tuple[Station, ...]] = {
    "drivetrain": stations_at(
        rig__drivetrain="shafts, couplings and motor of the power circuit; without it no loads are computed"
    ),
    "drivetrain.shaft_model": stations_at(
        rig__model="shafts that bend or only twist, at the fidelity of the run",
        coupling__loop_system="matrices of the loop: elastic with bearings, or torsional",
    ),
    "drivetrain.balance_grade": stations_at(rig__rotating_parts=_UNBALANCE),
    "drivetrain.shafts.*.balance_grade": stations_at(rig__rotating_parts=_UNBALANCE),
    "drivetrain.shafts.*.balance_speed": stations_at(rig__rotating_parts=_UNBALANCE),
    "drivetrain.shafts.*.balance_angles": stations_at(rig__rotating_parts=_UNBALANCE),
    "drivetrain.shafts.*.unbalances.*": stations_at(rig__rotating_parts=_UNBALANCE),
    "drivetrain.shafts.*.bow": stations_at(
        rig__rotating_parts="shape of a shaft without load, turning with it"
    ),
    **{
        f"drivetrain.couplings.*.{key}": stations_at(
            rig__rotating_parts="flange out of true: load once a turn on two shafts"
        )
        for key in ("flange_run_out", "flange_run_out_angle", "flange_tilt", "flange_tilt_angle")
    },
    **{
        f"drivetrain.couplings.*.cold_angle_{key}": stations_at(
            rig__rotating_parts="moment on two shafts by an angle between their axes",
            rig__drivetrain="torque twice a turn of a cross joint",
            coupling__misalignment="moment of a cross joint on the bearings of its shafts",
        )
        for key in ("lateral", "vertical")
    },
    "drivetrain.couplings.*.joint": stations_at(
        rig__drivetrain="torque twice a turn of a cross joint",
        rig__rotating_parts="moment of a cross joint on both of its shafts, all the time and twice a turn",
    ),
    "drivetrain.bearing_coefficients": stations_at(
        coupling__loop_system="stiffness and damping under the shafts: of each operating point, or as stated"
    ),
    "drivetrain.shafts.*": stations_at(rig__drivetrain="shaft of the power circuit"),
    "drivetrain.shafts.*.material_damping": stations_at(rig__drivetrain="dampers of the shaft elements"),
    "drivetrain.shafts.*.sections.*": stations_at(
        rig__drivetrain="stiffness and inertia of the shaft in torsion and bending",
        rig__shaft_torsion="torsional stress of the shaft",
    ),
    "drivetrain.shafts.*.discs.*": stations_at(rig__drivetrain="inertia on the shaft"),
    "drivetrain.shafts.*.discs.*.mass": stations_at(rig__drivetrain="mass on a shaft that bends"),
    "drivetrain.shafts.*.discs.*.diametral_inertia": stations_at(
        rig__drivetrain="inertia against the tilt of a shaft that bends"
    ),
    "drivetrain.couplings.*": stations_at(rig__drivetrain="spring and damper between two shafts"),
    **{
        f"drivetrain.couplings.*.{key}": stations_at(rig__drivetrain=_BENDING)
        for key in ("radial_stiffness", "axial_stiffness", "angular_stiffness", "lateral_damping_time")
    },
    "drivetrain.couplings.*.excitation.*": stations_at(
        rig__drivetrain="alternating torque between two shafts"
    ),
    "drivetrain.couplings.*.radial_offset_maximum": stations_at(checks__alignment=_LIMIT),
    "drivetrain.couplings.*.angle_maximum": stations_at(checks__alignment=_LIMIT),
    "drivetrain.couplings.*.cold_offset_lateral": stations_at(
        coupling__alignment="place of the shafts before they warm up"
    ),
    "drivetrain.couplings.*.cold_offset_vertical": stations_at(
        coupling__alignment="place of the shafts before they warm up"
    ),
    "drivetrain.motor": stations_at(rig__drivetrain="inertia and place of the drive"),
    "drivetrain.motor.torque_limit": stations_at(
        coupling__time_run="most torque of the speed control over the schedule"
    ),
    "drivetrain.motor.ripple.*": stations_at(rig__drivetrain="alternating torque of the drive"),
    "drivetrain.bracing": stations_at(
        coupling__braced_loop="how the torque is locked in: what is held while parts expand"
    ),
    "drivetrain.torque_at": stations_at(rig__model="gear at which torque and speed of the schedule count"),
    "drivetrain.mesh_stiffness": stations_at(
        rig__model="tooth model at the fidelity of the run", coupling__tooth_springs="mesh law from it"
    ),
}
"""By path, ``*`` for a name."""
