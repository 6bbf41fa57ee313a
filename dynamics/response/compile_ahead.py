"""Compile the time integration while something else is computed, so that the first run does not wait for it."""

import numpy as np

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.mesh.law import MeshLaw
from dynamics.response.march_inputs import DriveState, MarchSettings
from dynamics.response.time_march import TimeMarch


def compile_time_integration() -> None:
    """Compile it and leave it on disk: one sample of a pair of gears that hardly turns."""
    pitch, teeth = 0.01, np.ones(1)
    law = MeshLaw(
        base_radius_1=0.05, base_radius_2=0.05, base_pitch=pitch, teeth_1=30, teeth_2=30, tooth_offset_2=0,
        path_start=-pitch, path_step=0.25 * pitch, stiffness=np.full((1, 9), 1e8), gap=np.zeros((1, 9)),
        slice_shift=np.zeros(1), deviation_1=np.zeros((1, 9)), deviation_2=np.zeros((1, 9)), scale_1=teeth,
        scale_2=teeth, backlash=1e-3, offset=0.0, phase=0.0, back_phase=0.0, damping=1e3, mean_stiffness=1e8,
        friction=0.0, rolling_radius_1=0.02, rolling_radius_2=0.02, friction_reversal_speed=0.1,
    )  # fmt: skip
    system = LinearSystem(
        inertia=0.01 * np.eye(2), damping=np.zeros((2, 2)), stiffness=np.zeros((2, 2)), dofs=("pinion", "wheel"),
        mesh_ports=np.array([[0, 1]]), rigid=np.eye(2), drive_dof=0, twist_load=np.zeros(2), drag_loads={},
    )  # fmt: skip
    rest = DriveState(angles=np.zeros(2), speeds=np.ones(2), twist=0.0)
    TimeMarch(system, [law], rest, MarchSettings(step=1e-6)).advance(np.zeros((1, 2)))
