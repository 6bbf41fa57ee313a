"""Where torque passes through the shafts and joints of a rig, on the freedoms of its linear system."""

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.drivetrain.twist_rows import TwistRows, torsional_twist_rows
from dynamics.elastic_rig.twist_rows import elastic_twist_rows
from rigdesign.rig.model import Rig


def twist_rows_of(rig: Rig, system: LinearSystem) -> TwistRows:
    """Rows of the torques on the freedoms of a system of the rig."""
    assert rig.drivetrain is not None
    if rig.shaft_model == "torsional":
        return torsional_twist_rows(rig.drivetrain)
    return elastic_twist_rows(rig.elastic.seen, system)
