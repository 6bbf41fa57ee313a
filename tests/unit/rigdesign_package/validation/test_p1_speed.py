"""What speed does to the stress at a gauge of P1's rig: dynamic over quasi-static root stress on the curve of the
gauge."""

import numpy as np
import pytest

from rigdesign.base.part_name import MeshName
from rigdesign.postprocessing.dynamic_root import dynamic_root
from rigdesign.strain_gauge.measuring_point import GaugeCurve
from tests.builders.solved_loop import solved
from tests.published import p1_speed
from tests.published.p1_speed import _ratio, speed_effect, with_feather_keys


def test_the_ratio_is_that_of_the_stresses_where_the_tooth_is_loaded_and_one_elsewhere() -> None:
    path = np.linspace(0.0, 1.0, 101)
    still = np.sin(np.pi * path)
    found = _ratio((path, 1.2 * still), (path, still), path)
    loaded = still > 0.3
    assert found[loaded] == pytest.approx(1.2)
    assert found[~loaded] == pytest.approx(1.0)


def test_the_effect_on_the_most_stressed_point_is_its_dynamic_over_quasi_static_stress(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A gauge whose quasi-static curve is that of the root itself: the record of the root knows the same ratio."""
    found = solved()
    record = dynamic_root(found.rig, found.run)
    own = next(one for one in record.curves if (one.mesh, one.gear, one.stage) == ("test", "pinion", "test"))
    curve = GaugeCurve(angle=np.array(own.angle), stress=np.array(own.quasi_static))
    monkeypatch.setattr(p1_speed, "solve_point", lambda *_: found.test)
    effect = speed_effect(found.rig, MeshName("test", "main"), curve)
    assert effect.maximum == pytest.approx(own.ratio - 1.0, abs=2e-3)
    assert effect.maximum != 0.0
    halved = GaugeCurve(angle=curve.angle, stress=0.5 * curve.stress)
    assert speed_effect(found.rig, MeshName("test", "main"), halved).maximum == pytest.approx(
        effect.maximum, abs=1e-9
    )


def test_feather_keys_are_springs_between_every_gear_and_its_shaft() -> None:
    keyed = with_feather_keys(solved().rig)
    for box in keyed.case.gearboxes.values():
        for gear in box.gears.values():
            assert gear.spline is not None
            assert gear.spline.torsional_stiffness == pytest.approx(5e5)
            assert gear.spline.torsional_damping == pytest.approx(500.0)
    assert keyed.shaft_model == solved().rig.shaft_model
