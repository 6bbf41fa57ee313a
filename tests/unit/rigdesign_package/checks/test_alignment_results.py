"""Alignment by the names of the case: a box heated evenly, couplings as set and warm, checks, the history over time."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rigdesign.case import load_case
from rigdesign.case.limits import AlignmentLimits
from rigdesign.case.model import Case
from rigdesign.checks.alignment import checks
from rigdesign.checks.transient import checks as transient_checks
from rigdesign.coupling.alignment import (
    CouplingEnd,
    CouplingPlace,
    alignment,
    axis_deviation,
    clearance_share,
    coupled_ends,
    coupling_places,
)
from rigdesign.postprocessing.hand_calculation import axis_rise
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.postprocessing.warm_gearbox import axis_alignments, bore_alignments, coupling_alignments
from rigdesign.results.check import Check
from rigdesign.results.serialisation.warm_gearbox import expansion_row
from rigdesign.results.thermal import HistoryExtremes
from rigdesign.results.warm_gearbox import (
    AxisAlignment,
    BoreAlignment,
    CouplingAlignment,
    ShaftOffset,
    WarmGearbox,
)
from rigdesign.rig.model import Rig, build_rig
from rigdesign.run import transient as transient_alignment
from rigdesign.run.transient import misalignments, worst_misalignments
from tests.builders.paths import CASES
from thermal.expansion.alignment import ShaftAxis
from thermal.expansion.expansion import Expansion, expand

CASE = CASES / "uhcf_prototype"
RISE = 60.0


@pytest.fixture(scope="module")
def case() -> Case:
    return load_case(CASE)


@pytest.fixture(scope="module")
def rig(case: Case) -> Rig:
    return build_rig(case, "quick")


@pytest.fixture(scope="module")
def shape(rig: Rig) -> Expansion:
    """Everything evenly 60 K warmer than the drawing."""
    model, setup = rig.models["test"], rig.expansion["test"]
    cold = rig.case.ambient.reference_temperature
    field = np.full(len(model.mesh.points), cold + RISE)
    return expand(setup, field, cold)


@pytest.fixture(scope="module")
def point(rig: Rig, shape: Expansion) -> Any:
    clearances = {f"test.{name}": 60e-6 for name in rig.case.gearboxes["test"].bearings}
    last = SimpleNamespace(
        expansion={"test": SimpleNamespace(deformed=shape)},
        coupling_state=SimpleNamespace(bearing_clearance=clearances),
    )
    return SimpleNamespace(last=last)


def test_even_heat_offsets_a_coupling_by_its_height(rig: Rig, point: Any) -> None:
    """The box grows from the middle of the foot of its field; the partner has no housing and stays cold."""
    box, model = rig.case.gearboxes["test"].housing, rig.models["test"]
    assert box is not None
    strain = rig.materials[box.material].expansion_coefficient * RISE
    steel = rig.materials["case_hardened_steel"].expansion_coefficient * RISE
    foot = model.mesh.points[np.unique(model.mesh.surfaces[model.foot_surface])]
    middle = 0.5 * (foot.min(axis=0) + foot.max(axis=0))
    found = {one.coupling: one for one in coupling_alignments(rig, point, "test")}
    assert set(found) == {"pinion_side", "wheel_side"}
    for name, shaft in (("pinion_side", "test_pinion"), ("wheel_side", "test_wheel")):
        one, station = found[name], next(s for s in model.shafts if s.name == shaft)
        up = strain * (box.shaft_height + box.field.thickness)
        across = strain * (box.shafts[shaft].lateral_position - middle[1])
        assert one.warm.vertical == pytest.approx(up, rel=1e-4)
        assert one.warm.lateral == pytest.approx(across, rel=1e-3)
        assert one.warm.radial_offset == pytest.approx(np.hypot(up, across), rel=1e-4)
        assert one.moved[1] == pytest.approx(up, rel=1e-4)
        assert (one.as_set.radial_offset, one.as_set.angle) == (0.0, 0.0)
        assert one.warm.angle < 1e-7
        assert one.shown(0) == shaft and one.shown(1).endswith("(cold)")
        locating = next(b for b in model.bearings if b.shaft == shaft and b.locating).centre[0]
        travel = strain * (locating - middle[0]) + steel * (station.end - locating)
        assert one.ends_nearer == pytest.approx(travel, rel=1e-3)


def test_rows_of_a_coupling_show_both_states_and_the_offset_to_be_set() -> None:
    (row,) = expansion_row(warm("test", 0.1, 0.1, (0.1, 0.2))).couplings
    assert row == {
        "coupling": "pinion_side",
        "first": "test_pinion",
        "second": "reference_pinion (cold)",
        "offset_cold_mm": pytest.approx(0.1),
        "offset_hot_mm": pytest.approx(0.2),
        "lateral_hot_mm": pytest.approx(-0.02),
        "vertical_hot_mm": pytest.approx(0.16),
        "angle_cold_mrad": 0.0,
        "angle_hot_mrad": pytest.approx(0.4),
        "ends_nearer_mm": 0.0,
        "recommended_cold_lateral_mm": pytest.approx(0.02),
        "recommended_cold_vertical_mm": pytest.approx(-0.16),
    }


def test_the_rise_of_a_shaft_is_that_by_hand_where_all_is_evenly_warm(rig: Rig, point: Any) -> None:
    model = rig.models["test"]
    field = np.full(len(model.mesh.points), rig.case.ambient.reference_temperature + RISE)
    last = SimpleNamespace(fields={"test": SimpleNamespace(temperature=field)})
    solved: Any = SimpleNamespace(
        case=rig.case, rig=rig, points=[SimpleNamespace(point=SimpleNamespace(stage="test"), last=last)]
    )
    by_hand = axis_rise(solved, warm("test", 0.0, 0.0, (0.0, 0.0)))
    for one in coupling_alignments(rig, point, "test"):
        assert one.warm.vertical == pytest.approx(by_hand, rel=1e-4)


def test_the_recommended_cold_offset_makes_the_hot_one_zero(rig: Rig, shape: Expansion) -> None:
    for place in coupling_places(rig):
        hot = coupled_ends(place, {"test": shape.axes})
        reset = replace(place, offset=(-hot.offset[0], -hot.offset[1]))
        assert coupled_ends(reset, {"test": shape.axes}).radial_offset == pytest.approx(0.0, abs=1e-15)
        assert coupled_ends(reset, {}).radial_offset == pytest.approx(hot.radial_offset)


def test_even_heat_tilts_nothing_and_leaves_bores_round(rig: Rig, point: Any, shape: Expansion) -> None:
    bores = list(bore_alignments(rig, point, "test", shape))
    assert [bore.bearing for bore in bores] == [f"test.{b}" for b in rig.case.gearboxes["test"].bearings]
    for bore in bores:
        assert bore.tilt < 1e-7
        assert bore.out_of_round < 1e-8
        assert bore.out_of_round_share == pytest.approx(bore.out_of_round / 30e-6)
    (axes,) = axis_alignments(rig, "test", shape)
    strain = rig.materials["structural_steel"].expansion_coefficient * RISE
    assert axes.centre_distance_change == pytest.approx(strain * 0.0995, rel=1e-4)
    assert abs(axes.inclination) < 1e-9 and abs(axes.skew) < 1e-9
    assert axes.face_width == pytest.approx(7e-3)


def test_recommended_deviation_follows_the_quality_grade(rig: Rig, shape: Expansion) -> None:
    """ISO 1328-1:2013, grade 5, d = 102 mm, b = 15 mm: f_H 5.9, f_f 6.4 um, F_beta = 8.7 um, rounded."""
    found = axis_deviation(rig, "test", "main", shape)
    slope, form = 0.05 * np.sqrt(102) + 0.35 * np.sqrt(15) + 4, 0.07 * np.sqrt(102) + 0.45 * np.sqrt(15) + 4
    assert found.recommended_inclination == pytest.approx(1e-6 * np.hypot(slope, form), rel=0.06)
    assert found.recommended_skew == pytest.approx(0.5 * found.recommended_inclination)


def test_places_of_the_alignment_carry_the_names_of_the_case(rig: Rig, shape: Expansion) -> None:
    clearances = {f"test.{name}": 60e-6 for name in rig.case.gearboxes["test"].bearings}
    found = alignment(rig, "test", shape, clearances)
    assert set(found["bearing_tilt"]) == set(found["bore_out_of_round"]) == set(clearances)
    assert set(found["axis_inclination"]) == set(found["axis_skew"]) == {"test.main"}


def test_share_of_the_clearance_is_finite_where_none_is_left() -> None:
    assert clearance_share(3e-6, 60e-6) == pytest.approx(0.1)
    assert clearance_share(3e-6, 0.0) == clearance_share(3e-6, -1e-6) == clearance_share(3e-6, 1e-9) == 10.0


def warm(stage: str, tilt: float, share: float, offset: tuple[float, float]) -> WarmGearbox:
    """Records of one stage; tilt [mrad]; offset : of the coupling, as set and warm [mm]."""
    bore = BoreAlignment(
        bearing="test.front", tilt=1e-3 * tilt, tilt_lateral=0.0, tilt_vertical=0.0, width=0.03, out_of_round=0.0,
        second_harmonic=0.0, long_axis=0.0, out_of_round_share=share,
    )  # fmt: skip
    axes = AxisAlignment(
        mesh="test.main", centre_distance_change=0.0, face_width=7e-3, inclination=-6e-6,
        recommended_inclination=8e-6, skew=1e-6, recommended_skew=4e-6,
    )  # fmt: skip
    coupling = CouplingAlignment(
        coupling="pinion_side",
        first="test_pinion",
        second="reference_pinion",
        housed=(True, False),
        as_set=ShaftOffset(lateral=0.0, vertical=0.0, radial_offset=1e-3 * offset[0], angle=0.0),
        warm=ShaftOffset(lateral=-2e-5, vertical=16e-5, radial_offset=1e-3 * offset[1], angle=4e-4),
        ends_nearer=0.0,
    )
    return WarmGearbox(gearbox="test", stage=stage, bores=(bore,), axes=(axes,), couplings=(coupling,))


def held(case: Case, *found: WarmGearbox) -> dict[str, Check]:
    solved: Any = SimpleNamespace(case=case, warm=list(found), no_clearances="no gearbox has a housing")
    return {check.id: check for check in checks(solved)}


def test_the_worst_stage_is_held_against_each_limit(case: Case) -> None:
    found = held(case, warm("low", 0.1, 0.3, (0.0, 0.1)), warm("test", 0.2, 0.1, (0.0, 0.2)))
    tilt, bores, axes = (
        found[f"alignment.{key}"] for key in ("bearing_tilt", "bore_out_of_round", "axis_inclination")
    )
    assert (tilt.value, tilt.limit, tilt.verdict) == (pytest.approx(0.2), pytest.approx(0.3), "pass")
    assert tilt.reason.endswith("stage test")
    assert (bores.value, bores.limit, bores.verdict) == (0.3, 0.25, "fail")
    assert (axes.value, axes.unit) == (pytest.approx(6.0), "um")
    assert axes.distance == pytest.approx(1.0 - 6.0 / 8.0)


def test_a_coupling_is_held_as_set_and_warm_with_the_offset_to_be_set(case: Case) -> None:
    hot = held(case, warm("test", 0.1, 0.1, (0.1, 0.2)))["alignment.coupling_offset.pinion_side"]
    cold = held(case, warm("test", 0.1, 0.1, (0.4, 0.2)))["alignment.coupling_offset.pinion_side"]
    assert (hot.value, hot.verdict) == (pytest.approx(0.2), "pass")
    assert "stage test" in hot.reason and "-0.160 mm up" in hot.reason
    assert (cold.value, cold.verdict) == (pytest.approx(0.4), "fail")
    assert "(cold), cold;" in cold.reason
    assert hot.source == "drivetrain.couplings.pinion_side.radial_offset_maximum"


def test_limits_and_housings_that_are_not_there_leave_checks_out(case: Case) -> None:
    bare = case.model_copy(update={"limits": case.limits.model_copy(update={"alignment": AlignmentLimits()})})
    found = held(bare, warm("test", 0.1, 0.1, (0.0, 0.2)))
    assert found["alignment.bearing_tilt"].verdict == "not applicable"
    assert found["alignment.bearing_tilt"].reason == "the case states no limit"
    nothing = held(case)
    assert {check.verdict for check in nothing.values()} == {"open"}
    assert nothing["alignment.coupling_angle.wheel_side"].reason == "no gearbox has a housing"
    assert (
        "neither of its shafts"
        in held(case, warm("test", 0.1, 0.1, (0.0, 0.2)))["alignment.coupling_angle.wheel_side"].reason
    )


def branch(gearbox: str, times: list[float], lift: list[float]) -> Any:
    """A history in which the shaft of a gearbox rises by ``lift`` [m] and tilts by a thousandth of its figure."""
    sizes = [1e-4 * (1.0 + i) for i in range(len(times))]
    return SimpleNamespace(
        gearbox=gearbox, name="schedule", times=np.array(times), phase=np.zeros(len(times), dtype=int),
        phases=(SimpleNamespace(name="test"),),
        axes=tuple(
            {gearbox: ShaftAxis(name=gearbox, at=0.0, offset=(0.0, z), slope=(0.0, 1e-3 * z))} for z in lift
        ),
        alignment=tuple(
            {"bearing_tilt": {f"{gearbox}.front": size}, "bore_out_of_round": {}, "axis_inclination": {},
             "axis_skew": {}}
            for size in sizes
        ),
    )  # fmt: skip


@pytest.fixture
def between(monkeypatch: pytest.MonkeyPatch) -> None:
    """One coupling between the shafts of gearboxes a and b, the first set 0.05 mm low when cold."""
    ends = (CouplingEnd(shaft=name, gearbox=name) for name in ("a", "b"))
    place = CouplingPlace(name="pinion_side", first=next(ends), second=next(ends), offset=(0.0, -5e-5))
    monkeypatch.setattr(transient_alignment, "coupling_places", lambda rig: iter([place]))


@pytest.mark.usefixtures("between")
def test_two_hot_machines_move_against_each_other_in_time() -> None:
    """The partner's history has times of its own and is read between them."""
    first, second = branch("a", [0.0, 10.0, 20.0], [0.0, 2e-4, 2e-4]), branch("b", [0.0, 20.0], [0.0, 1e-4])
    rig: Any = None
    found = misalignments(rig, first, [first, second])
    assert found["coupling_offset"]["pinion_side"] == pytest.approx([5e-5, 1e-4, 5e-5])
    assert found["coupling_angle"]["pinion_side"] == pytest.approx([0.0, 1.5e-7, 1e-7])
    assert found["bearing_tilt"]["a.front"] == pytest.approx([1e-4, 2e-4, 3e-4])
    alone = misalignments(rig, first, [first])
    assert alone["coupling_offset"]["pinion_side"] == pytest.approx([5e-5, 1.5e-4, 1.5e-4])
    assert misalignments(rig, second, [first, second])["coupling_offset"] == {}


@pytest.mark.usefixtures("between")
def test_worst_moments_carry_limit_and_steady_value_into_the_checks(case: Case, rig: Rig) -> None:
    history = branch("a", [0.0, 10.0, 20.0], [0.0, 4e-4, 2e-4])
    solved: Any = SimpleNamespace(case=case, rig=None, warm=[warm("test", 0.25, 0.1, (0.0, 0.15))])
    found = {m.quantity: m for m in worst_misalignments(solved, [history], [history], planned=True)}
    assert set(found) == {"bearing_tilt", "coupling_offset", "coupling_angle"}
    offset = found["coupling_offset"]
    assert (offset.value, offset.time) == (pytest.approx(3.5e-4), 10.0)
    assert (offset.limit, offset.steady, offset.place) == (
        pytest.approx(3e-4),
        pytest.approx(1.5e-4),
        "pinion_side",
    )
    assert found["bearing_tilt"].time == 20.0
    extremes = HistoryExtremes(extremes=tuple(found.values()), soak=())
    held_over_time = {
        check.id: check for check in transient_checks(SolvedRig(rig=rig, points=(), history=extremes))
    }
    check = held_over_time["transient.coupling_offset.pinion_side"]
    assert (check.verdict, check.comparison) == ("fail", "<=")
    assert (check.value, check.unit) == (pytest.approx(0.35), "mm")
    assert check.source.startswith("drivetrain.couplings.pinion_side.radial_offset_maximum")
    assert held_over_time["transient.bearing_tilt"].distance == pytest.approx(0.0, abs=1e-9)
