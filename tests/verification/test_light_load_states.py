"""Light loads at which contact is lost and jumps are near: which motion there is, by Floquet exponents and by marches.

Speeds of the first pinion, synthetic laws of P2's size. Found:

| | torsional | shafts that bend on films |
|---|---|---|
| 20 N m, 1700 rpm | unstable (period doubling), quasi-periodic | unstable (second frequency), peaks swing over 1 s |
| 10 N m, 1500 rpm | unstable (period doubling), does not repeat | unstable (second frequency), chaotic |
| 10 N m, 2400 rpm | stable, peaks 19.53 / 15.12 N m | stable, peaks 18.56 / 18.08 N m |
"""

import math
from functools import cache

import numpy as np
import pytest

from dynamics.drivetrain.graph import assemble
from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.drivetrain.loop_load import LoopLoad
from dynamics.response.initial_state import wound_state
from dynamics.response.march_inputs import DriveLoads, MarchSettings
from dynamics.response.periodic_response import periodic_by_time
from dynamics.response.response_curve import ResponseCurve
from dynamics.response.speed_sweep import SweepSettings, periodic_response
from dynamics.response.time_march import TimeMarch
from tests.builders.rig import prototype, prototype_laws
from tests.unit.dynamics_package.elastic_rig.test_seen_system import films, seen

RPM = math.pi / 30.0


@cache
def rig(kind: str, rpm: float) -> LinearSystem:
    return assemble(prototype()) if kind == "torsional" else seen().system(films(rpm * RPM))


@cache
def by_harmonics(kind: str, torque: float, rpm: float) -> ResponseCurve:
    settings = SweepSettings(methods=("harmonic_balance",))
    return periodic_response(
        rig(kind, rpm), prototype_laws(), [rpm * RPM], LoopLoad(torque=torque), settings=settings
    )


def peaks(kind: str, torque: float, rpm: float, seconds: float) -> np.ndarray:
    """Highest torque of the test mesh [N m] in every period of the mesh of the second half of a march, twist held."""
    wound = wound_state(rig(kind, rpm), prototype_laws(), rpm * RPM, LoopLoad(torque=torque))
    march = TimeMarch(
        rig(kind, rpm),
        prototype_laws(),
        wound.state,
        MarchSettings(step=1.0 / 320e3, substeps=8, accounts=False, record_all=False),
        DriveLoads(drive_torque=wound.drive_torque),
    )
    given = np.tile([wound.drive_torque, wound.state.twist, 0.0, 0.0], (round(seconds * 40e3), 1))
    force = march.advance(given).force[0] * prototype_laws()[0].base_radius_1
    late = force[force.size // 2 :]
    period = round(320e3 * 2.0 * math.pi / (99 * rpm * RPM))
    return late[: late.size // period * period].reshape(-1, period).max(axis=1)


@pytest.mark.parametrize("kind", ["torsional", "elastic"])
def test_the_state_at_2400_rpm_is_stable_and_that_of_a_march(kind: str) -> None:
    curve = by_harmonics(kind, 10.0, 2400.0)
    (point,) = curve.points
    assert not curve.failed and point.lift_off_share[0] > 0.05
    marched = periodic_by_time(rig(kind, 2400.0), prototype_laws(), 2400.0 * RPM, LoopLoad(torque=10.0))
    highest = np.maximum(marched.greatest_torque, -marched.least_torque)
    print(kind, point.maximum, highest)
    assert marched.motion.kind == "periodic"
    assert point.maximum == pytest.approx(highest, rel=1e-3)


@pytest.mark.parametrize(
    ("kind", "torque", "rpm", "way"),
    [
        pytest.param("torsional", 20.0, 1700.0, "period doubling", marks=pytest.mark.slow),
        pytest.param("torsional", 10.0, 1500.0, "period doubling", marks=pytest.mark.slow),
        ("elastic", 20.0, 1700.0, "second frequency"),
        pytest.param("elastic", 10.0, 1500.0, "second frequency", marks=pytest.mark.slow),
    ],
)
def test_where_the_mesh_periodic_state_is_unstable_no_march_repeats(
    kind: str, torque: float, rpm: float, way: str
) -> None:
    curve = by_harmonics(kind, torque, rpm)
    ((_, reason),) = curve.failed
    assert f"is unstable ({way}" in reason
    found = peaks(kind, torque, rpm, 2.0)
    print(kind, torque, rpm, found.min(), found.max())
    assert np.ptp(found) > 0.05 * found.mean()


def test_both_methods_together_leave_no_speed_without_a_point() -> None:
    curve = periodic_response(rig("elastic", 1700.0), prototype_laws(), [1700.0 * RPM], LoopLoad(torque=20.0))
    (point,) = curve.points
    assert not curve.failed and point.method == "time_integration"
    assert point.mean == pytest.approx([20.0, 20.0], rel=0.05)
