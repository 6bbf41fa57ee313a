"""Periodic response of the warm rig at a speed that no stage holds, under the torque of the governing held point."""

from dataclasses import dataclass

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.drivetrain.loop_load import LoopLoad
from dynamics.drivetrain.static_loop import port_model
from dynamics.response.harmonic_walk import MOST_HARMONICS, mesh_cells
from dynamics.response.response_curve import CurvePoint
from dynamics.response.speed_sweep import SweepSettings, periodic_response
from rigdesign.coupling.braced_loop import signed_torque
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.mesh_models import MeshModel, laws_of
from rigdesign.coupling.time_run import drags_at
from rigdesign.coupling.tooth_deviations import periodic_laws
from rigdesign.records.loop_states import state_at
from rigdesign.rig.model import Rig

REACH = 1.5
"""Harmonics go up to this times the highest mode that counts (`dynamics.response.speed_sweep`)."""
BELOW = 0.98
"""Share of the frequency that the harmonics reach up to which modes count."""


@dataclass(frozen=True)
class SpeedResponse:
    """A periodic state with the loop it was sought in; stage : empty where none holds the speed.

    speed : stated [rad/s]; torque : with its sign, at the control mesh [N m]
    response : None where none was found, with the reason
    """

    stage: str
    speed: float
    torque: float
    models: tuple[MeshModel, ...]
    system: LinearSystem
    response: CurvePoint | None
    reason: str = ""


def held_response(rig: Rig, point: PointResult) -> SpeedResponse:
    """That of a held point."""
    last = point.last
    assert last.system is not None and last.response is not None
    torque = signed_torque(rig, point.point)
    return SpeedResponse(
        point.point.stage, point.point.speed, torque, last.models, last.system, last.response
    )


def response_at(rig: Rig, held: PointResult, speed: float) -> SpeedResponse:
    """At a stated speed [rad/s], gears as warm as at the held point, bearings as they run at the speed.

    By harmonic balance; far below the curves of the case its harmonics end below the highest modes, which then answer
    as springs.
    """
    last = held.last
    system = state_at(rig, held, speed).system
    laws = periodic_laws(rig, laws_of(last.models))
    period = rig.case.numerics.response_period
    _, cell_angle = mesh_cells(port_model(system, laws), period, 0)
    reached = MOST_HARMONICS / REACH * rig.drive_speed(speed) / cell_angle
    torque = signed_torque(rig, held.point)
    curve = periodic_response(
        system,
        laws,
        [rig.pinion_speed(speed)],
        LoopLoad(torque=torque),
        drag_torques=drags_at(rig, last, last.coupling_state, speed),
        settings=SweepSettings(
            period=period,
            cutoff=min(rig.highest_mode, BELOW * reached),
            methods=("harmonic_balance",),
        ),
    )
    if curve.failed:
        return SpeedResponse("", speed, torque, last.models, system, None, curve.failed[0][1])
    return SpeedResponse("", speed, torque, last.models, system, curve.points[0])
