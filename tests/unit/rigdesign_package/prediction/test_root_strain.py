"""What a root gauge reads: the torque of the mesh as its tooth passes, and the low-pass of its chain."""

from types import SimpleNamespace

import numpy as np
import pytest

from rigdesign.case import load_case
from rigdesign.diagnosis.library.candidates import SPARE, extra_points, spare_channels
from rigdesign.prediction.model import (
    GAUGES_AGAINST,
    MEASURED_AGAINST,
    ROOT_WINDOWS,
    Channel,
    Feature,
    OperatingCondition,
    features_of,
    measured_against,
)
from rigdesign.prediction.readings import StrainCurve, _lagged, torque_share
from tests.builders.paths import CASES

TEETH = 18
RADIUS = 0.05
PITCH = 2.0 * np.pi * RADIUS / TEETH
GAUGE = Channel(name="g", quantity="root_strain", place="test.pinion.ii", windows=("maximum", "exit"))


def mesh(turns: int = 1, flank: float = 1.0):
    """A mesh whose torque says the angle of the pinion: 100 + 10 cos(angle - 1) + 5 cos(angle / turns)."""
    angle = np.linspace(0.0, 2.0 * np.pi * turns, 720 * turns, endpoint=False)
    torque = 100.0 + 10.0 * np.cos(angle - 1.0) + (5.0 * np.cos(angle / turns) if turns > 1 else 0.0)
    law = SimpleNamespace(
        base_radius_1=RADIUS, base_pitch=PITCH, teeth_1=TEETH, teeth_2=TEETH + 1, tooth_offset_2=2,
        phase=0.001, back_phase=0.002,
    )  # fmt: skip
    wave = SimpleNamespace(angle=angle[None], torque=flank * torque[None])
    response = SimpleNamespace(flank=np.array([flank]), wave=wave, mean=np.array([100.0]))
    return SimpleNamespace(law=law), response


PATH = np.array([-0.004, 0.0, 0.003])


@pytest.mark.parametrize("tooth", [0, 5])
def test_a_tooth_of_the_pinion_sees_the_torque_at_its_own_angle(tooth) -> None:
    model, response = mesh()
    found = torque_share(model, response, 0, (tooth, 0), PATH)
    angle = (PATH + PITCH * tooth - 0.001) / RADIUS
    assert found == pytest.approx(1.0 + 0.1 * np.cos(angle - 1.0), abs=1e-4)


def test_a_tooth_of_the_wheel_is_met_by_its_partner() -> None:
    model, response = mesh()
    found = torque_share(model, response, 0, (7, 1), PATH)
    # pair p joins the wheel tooth p + 2; 19 teeth pass in one turn and a tooth of the pinion
    angle = (PATH + PITCH * 5 - 0.001) / RADIUS
    assert found == pytest.approx(1.0 + 0.1 * np.cos(angle - 1.0), abs=1e-4)


def test_all_passes_of_a_longer_period_are_averaged() -> None:
    model, response = mesh(turns=2)
    found = torque_share(model, response, 0, (0, 0), PATH)
    angle = (PATH - 0.001) / RADIUS
    assert found == pytest.approx(1.0 + 0.1 * np.cos(angle - 1.0), abs=1e-4)


def test_on_back_flanks_the_path_runs_the_other_way() -> None:
    model, response = mesh(flank=-1.0)
    found = torque_share(model, response, 0, (3, 0), PATH)
    angle = (0.002 - PATH + PITCH * 3) / RADIUS
    assert found == pytest.approx(1.0 + 0.1 * np.cos(angle - 1.0), abs=1e-4)


def test_a_low_pass_lowers_a_pulse_and_keeps_its_area() -> None:
    angle = np.linspace(-0.5, 0.5, 400)
    curve = StrainCurve(angle=angle, strain=np.exp(-((angle / 0.1) ** 2)))
    assert _lagged(curve, 0.0) is curve
    passed = _lagged(curve, 0.05)
    area = [float(np.trapezoid(one.strain, one.angle)) for one in (curve, passed)]
    assert area[1] == pytest.approx(area[0], rel=1e-3)
    assert 0.8 < passed.strain.max() < 0.95
    assert passed.angle[np.argmax(passed.strain)] > 0.02


def test_a_gauge_has_the_windows_that_are_asked_for() -> None:
    point = OperatingCondition(name="a", speed=10.0, torque=100.0)
    assert features_of([point], [GAUGE]) == (
        Feature("g", "a", part="maximum"),
        Feature("g", "a", part="exit"),
    )
    whole = Channel(name="h", quantity="root_strain", place="test.pinion.i")
    assert [feature.part for feature in features_of([point], [whole])] == list(ROOT_WINDOWS)
    assert measured_against([GAUGE]) == GAUGES_AGAINST
    assert measured_against([Channel(name="t", quantity="torque", place="c")]) == MEASURED_AGAINST


def test_half_the_torque_and_a_speed_between_are_offered_to_a_plan_of_one_torque() -> None:
    plan = [
        OperatingCondition(name=name, speed=speed, torque=100.0)
        for name, speed in (("a", 10.0), ("b", 100.0))
    ]
    found = {extra.setting.name: extra.setting for extra in extra_points(plan, ())}
    assert set(found) == {f"{SPARE}half torque", f"{SPARE}speed between"}
    assert found[f"{SPARE}half torque"].torque == 50.0
    assert found[f"{SPARE}speed between"].speed == 55.0


def test_other_gauges_are_all_that_is_offered_to_gauges() -> None:
    found = spare_channels(load_case(CASES / "strain_gauge_rig"), [GAUGE], ())
    assert {channel.place for channel in found} == {f"test.pinion.{name}" for name in ("i", "iii", "iv", "v")}
    assert {channel.face for channel in found} == {-8e-3, 0.0, 4e-3, 8e-3}
