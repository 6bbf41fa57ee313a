"""Where torque passes through the shafts and joints of a rig, on the freedoms of its linear system."""

from dynamics.drivetrain.loss_factor import with_spline_dampers
from dynamics.drivetrain.twist_rows import TwistRows, torsional_twist_rows
from dynamics.elastic_rig.twist_rows import elastic_twist_rows
from rigdesign.rig.model import Rig


def twist_rows_of(rig: Rig, speed: float | None = None) -> TwistRows:
    """Rows of the torques on the freedoms of the linear systems of the rig.

    speed : of the schedule [rad/s], at which the dampers of splines with a loss factor carry torque too; None leaves
        their share out, a factor sqrt(1 + eta^2)
    """
    assert rig.drivetrain is not None
    rows = (
        torsional_twist_rows(rig.drivetrain)
        if rig.shaft_model == "torsional"
        else elastic_twist_rows(rig.elastic.seen)
    )
    return rows if speed is None else with_spline_dampers(rows, rig.drivetrain, rig.drive_speed(speed))
