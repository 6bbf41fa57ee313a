"""Modes of root gauges over the face, and the catalogue that they show."""

import numpy as np
import pytest

from rigdesign.case import load_case
from rigdesign.diagnosis.catalogue import effects_of
from rigdesign.diagnosis.library.build import _reaches
from rigdesign.diagnosis.residual.healthy import gauge_rows, mode_columns, shapes_over
from rigdesign.prediction.model import Channel, OperatingCondition, changed_case, features_of
from tests.builders.paths import CASES

FACE = {"i": -8e-3, "ii": -4e-3, "iv": 4e-3, "v": 8e-3}
CHANNELS = {
    name: Channel(name=name, quantity="root_strain", place=f"test.pinion.{name}", face=face)
    for name, face in FACE.items()
}
POINTS = (
    OperatingCondition(name="a", speed=10.0, torque=100.0),
    OperatingCondition(name="b", speed=10.0, torque=200.0),
)


@pytest.fixture(scope="module")
def case():
    return load_case(CASES / "strain_gauge_rig")


def test_shapes_are_orthonormal_and_rise_to_the_rear() -> None:
    shapes = shapes_over(np.array(list(FACE.values())))
    basis = np.array(list(shapes.values()))
    assert basis @ basis.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.all(shapes["common"] > 0.0) and np.all(np.diff(shapes["tilt"]) > 0.0)
    assert list(shapes_over(np.array([-4e-3, 4e-3]))) == ["common", "tilt"]


def test_gauges_are_gathered_by_window_and_point() -> None:
    features = features_of(POINTS, CHANNELS.values())
    rows = list(gauge_rows(features, CHANNELS))
    assert {(row.window, row.point) for row in rows} == {
        (window, point) for window in ("entry", "maximum", "exit") for point in "ab"
    }
    assert all(len(row.rows) == 4 for row in rows)
    columns = mode_columns(features, np.ones(len(features)), CHANNELS)
    alike = [one for one in columns if one.name == "tilt of the gauges of test.pinion, maximum"]
    assert len(alike) == 1 and np.count_nonzero(alike[0].values) == 8
    assert float(np.mean(alike[0].values[alike[0].values != 0.0] ** 2)) == pytest.approx(1.0)


def test_only_cases_with_gauges_have_the_effects_that_gauges_show(case) -> None:
    kinds = {effect.kind for effect in effects_of(case)}
    assert {
        "misalignment",
        "lead_crowning",
        "twist",
        "tooth_friction",
        "gauge_face_position",
        "gauge_lag",
    } <= kinds
    other = {effect.kind for effect in effects_of(load_case(CASES / "loop_1to1"))}
    assert other.isdisjoint({"misalignment", "gauge_lag"})


def test_their_changes_fit_the_case(case) -> None:
    for effect in effects_of(case):
        if effect.family.strain:
            low, high = effect.parameters[0].bounds
            for share in (0.3, -0.3 if low < 0.0 else 0.1):
                changed_case(case, effect.changes(case, (share * (high if share > 0 else -low),)))


def test_heat_is_left_out_where_gauges_are_all_that_is_read(case) -> None:
    by_kind = {effect.kind: effect for effect in effects_of(case)}
    power = Channel(name="power", quantity="motor_power")
    gauges = tuple(CHANNELS.values())
    assert _reaches(by_kind["misalignment"], gauges) and _reaches(by_kind["run_out"], gauges)
    assert not _reaches(by_kind["mesh_loss"], gauges)
    assert _reaches(by_kind["mesh_loss"], (*gauges, power))
    assert not _reaches(by_kind["misalignment"], (power,))
