"""Dynamic torque in every section of the shafts and every joint at a held stage, from its periodic response."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.twist_rows import TorqueSection, TwistRows
from dynamics.response.section_torque import section_torques
from rigdesign.coupling.braced_loop import shifted_laws
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.tooth_deviations import periodic_laws
from rigdesign.coupling.twist_rows import twist_rows_of
from rigdesign.records.run_torques import place_of, shear_stress
from rigdesign.results.vibration import HeldTorque, TorquePlace, TorqueSwing
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]


def held_torques(rig: Rig, point: PointResult) -> Iterator[HeldTorque]:
    """Of every section and joint at a held point, without the peaks of the time run; none without a response."""
    last = point.last
    if last.system is None or last.response is None or point.setting is None:
        return
    laws = periodic_laws(rig, shifted_laws(rig, last.models, point.setting))
    loop = section_torques(last.system, laws, twist_rows_of(rig, point.point.speed))
    torque = loop.over_period(last.response, last.drags)
    for place, section, swing in section_swings(loop.rows, torque):
        yield HeldTorque(
            place=place,
            stage=point.point.stage,
            speed=rig.pinion_speed(point.point.speed),
            swing=swing,
            run_peak=None,
            shear_stress=shear_stress(section, swing.peak),
        )


def section_swings(
    rows: TwistRows, torque: Array
) -> Iterator[tuple[TorquePlace, TorqueSection, TorqueSwing]]:
    """Of every section and joint, from the torque (r, count) of their springs: that with the highest peak."""
    peak = np.abs(torque).max(axis=1)
    members: dict[TorqueSection, list[int]] = {}
    for i, section in enumerate(rows.sections):
        members.setdefault(section, []).append(i)
    for section, own in members.items():
        worst = own[int(np.argmax(peak[own]))]
        swing = TorqueSwing(
            mean=abs(float(torque[worst].mean())),
            half_peak_to_peak=0.5 * float(np.ptp(torque[worst])),
            peak=float(peak[worst]),
        )
        yield place_of(section), section, swing
