"""Axes of all shafts in one frame: from housings, meshes and couplings."""

import math

import numpy as np
import pytest

from rigdesign import load_case
from rigdesign.base.part_name import MeshName
from rigdesign.case.shipped import case_folder
from rigdesign.rig.model import Rig, build_rig
from rigdesign.rig.shaft_axes import shaft_axes

CASES = ("fzg", "loop_1to1", "loop_hunting", "strain_gauge_rig", "uhcf_main", "uhcf_prototype")


def rig_of(name: str) -> Rig:
    return build_rig(load_case(case_folder(name)), "quick")


@pytest.mark.parametrize("name", CASES)
def test_gears_that_mesh_stand_at_their_centre_distance_and_turn_against_each_other(name: str) -> None:
    rig = rig_of(name)
    assert rig.case.drivetrain is not None and set(rig.axes) == set(rig.case.drivetrain.shafts)
    for mesh, pair in rig.pairs.items():
        box = rig.mesh(mesh)[0]
        pinion, wheel = (box.gears[full.part] for full in rig.mesh_gears(mesh))
        first, second = rig.axes[pinion.shaft], rig.axes[wheel.shaft]
        assert math.hypot(second.lateral - first.lateral, second.vertical - first.vertical) == pytest.approx(
            pair.centre_distance, rel=1e-9
        )
        assert first.sense == -second.sense
    for coupling in rig.case.drivetrain.couplings.values():
        first, second = (rig.axes[shaft] for shaft in coupling.shafts)
        assert (first.lateral, first.vertical, first.sense) == (second.lateral, second.vertical, second.sense)


def test_gears_that_mesh_stand_at_one_place_along_the_shafts() -> None:
    rig = rig_of("uhcf_prototype")
    gears = rig.case.gearboxes["test"].gears
    places = [rig.axes[gear.shaft].place(gear.position or 0.0) for gear in gears.values()]
    assert places[0] == pytest.approx(places[1], abs=1e-12)


def test_front_flanks_of_a_clockwise_pinion_push_a_wheel_on_its_left_upwards() -> None:
    """Seen from the front x runs away, y to the left, z up: the teeth at the left go up."""
    rig = rig_of("uhcf_prototype")
    line, alpha = rig.line_of_action(MeshName("test", "main")), rig.pairs["test.main"].working_pressure_angle
    assert line.centres == pytest.approx(np.array([1.0, 0.0]))
    assert line.normal(alpha, 1.0) == pytest.approx(np.array([math.sin(alpha), math.cos(alpha)]))
    assert line.normal(alpha, -1.0) == pytest.approx(np.array([math.sin(alpha), -math.cos(alpha)]))


def test_a_shaft_that_is_coupled_end_to_end_is_drawn_the_other_way() -> None:
    case = load_case(case_folder("uhcf_prototype"))
    turned = case.with_value("drivetrain.couplings.pinion_side.ends", ("end", "end"))
    rig = rig_of("uhcf_prototype")
    axes = shaft_axes(turned, rig.pairs)
    assert axes["reference_pinion"].direction == -1.0
    length = math.fsum(s.length for s in case.drivetrain.shafts["reference_pinion"].sections)  # type: ignore[union-attr]
    assert axes["reference_pinion"].place(length) == pytest.approx(rig.axes["reference_pinion"].start)
