"""Alignment by the names of the case: a box heated evenly, couplings cold and hot, checks, the course over time."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rigdesign.case import load_case
from rigdesign.case.limits import AlignmentLimits
from rigdesign.case.model import Case
from rigdesign.checks.alignment import checks
from rigdesign.checks.transient import transient_checks
from rigdesign.coupling.alignment import (
    CouplingEnd,
    CouplingPlace,
    alignment,
    axis_deviation,
    clearance_share,
    coupled_ends,
    coupling_places,
)
from rigdesign.records.alignment import axis_rows, bore_rows, coupling_rows
from rigdesign.records.hand import axis_rise
from rigdesign.results.result import Check, ExpansionResult
from rigdesign.rig.model import Rig, build_rig
from rigdesign.run import transient_alignment
from rigdesign.run.transient_alignment import misalignments, worst_misalignments
from thermal.expansion.alignment import ShaftAxis
from thermal.expansion.expansion import Expansion, expand

CASE = Path(__file__).parents[2] / "cases" / "uhcf_prototype"
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
    return expand(model, field, cold, setup.elastic.elastic, reuse=setup)


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
    rows = {row["coupling"]: row for row in coupling_rows(rig, point, "test")}
    assert set(rows) == {"pinion_side", "wheel_side"}
    for name, shaft in (("pinion_side", "test_pinion"), ("wheel_side", "test_wheel")):
        row, station = rows[name], next(s for s in model.shafts if s.name == shaft)
        up = 1e3 * strain * (box.shaft_height + box.field.thickness)
        across = 1e3 * strain * (box.shafts[shaft].lateral_position - middle[1])
        assert row["vertical_hot_mm"] == pytest.approx(up, rel=1e-4)
        assert row["lateral_hot_mm"] == pytest.approx(across, rel=1e-3)
        assert row["offset_hot_mm"] == pytest.approx(np.hypot(up, across), rel=1e-4)
        assert row["recommended_cold_vertical_mm"] == pytest.approx(-up, rel=1e-4)
        assert (row["offset_cold_mm"], row["angle_cold_mrad"]) == (0.0, 0.0)
        assert row["angle_hot_mrad"] < 1e-4
        assert row["first"] == shaft and row["second"].endswith("(cold)")
        locating = next(b for b in model.bearings if b.shaft == shaft and b.locating).centre[0]
        travel = strain * (locating - middle[0]) + steel * (station.end - locating)
        assert row["ends_nearer_mm"] == pytest.approx(1e3 * travel, rel=1e-3)


def test_the_rise_of_a_shaft_is_that_by_hand_where_all_is_evenly_warm(rig: Rig, point: Any) -> None:
    model = rig.models["test"]
    field = np.full(len(model.mesh.points), rig.case.ambient.reference_temperature + RISE)
    last = SimpleNamespace(fields={"test": SimpleNamespace(temperature=field)})
    subject: Any = SimpleNamespace(
        case=rig.case, rig=rig, points=[SimpleNamespace(point=SimpleNamespace(stage="test"), last=last)]
    )
    by_hand = axis_rise(subject, expansion("test", 0.0, 0.0, (0.0, 0.0)))
    for row in coupling_rows(rig, point, "test"):
        assert row["vertical_hot_mm"] == pytest.approx(by_hand, rel=1e-4)


def test_the_recommended_cold_offset_makes_the_hot_one_zero(rig: Rig, shape: Expansion) -> None:
    for place in coupling_places(rig):
        hot = coupled_ends(place, {"test": shape.axes})
        reset = replace(place, offset=(-hot.offset[0], -hot.offset[1]))
        assert coupled_ends(reset, {"test": shape.axes}).radial_offset == pytest.approx(0.0, abs=1e-15)
        assert coupled_ends(reset, {}).radial_offset == pytest.approx(hot.radial_offset)


def test_even_heat_tilts_nothing_and_leaves_bores_round(rig: Rig, point: Any, shape: Expansion) -> None:
    bores = bore_rows(rig, point, "test", shape)
    assert [row["bearing"] for row in bores] == [f"test.{b}" for b in rig.case.gearboxes["test"].bearings]
    for row in bores:
        assert row["tilt_mrad"] < 1e-4
        assert row["out_of_round_um"] < 0.01
        assert row["out_of_round_share"] == pytest.approx(row["out_of_round_um"] / 30.0)
    (axes,) = axis_rows(rig, "test", shape)
    strain = rig.materials["structural_steel"].expansion_coefficient * RISE
    assert axes["centre_distance_change_um"] == pytest.approx(1e6 * strain * 0.0995, rel=1e-4)
    assert abs(axes["inclination_um"]) < 1e-3 and abs(axes["skew_um"]) < 1e-3
    assert axes["face_width_mm"] == pytest.approx(7.0)


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


def expansion(stage: str, tilt: float, share: float, offset: tuple[float, float]) -> ExpansionResult:
    """Records of one stage; offset : of the coupling, cold and hot [mm]."""
    return ExpansionResult(
        gearbox="test", stage=stage, seal_gaps=[], shafts=[], gears=[], bearings=[],
        bores=[{"bearing": "test.front", "tilt_mrad": tilt, "out_of_round_share": share}],
        axes=[{"gear_pair": "test.main", "inclination_um": -6.0, "skew_um": 1.0}],
        couplings=[
            {
                "coupling": "pinion_side", "first": "test_pinion", "second": "reference_pinion (cold)",
                "offset_cold_mm": offset[0], "offset_hot_mm": offset[1], "angle_cold_mrad": 0.0,
                "angle_hot_mrad": 0.4, "recommended_cold_lateral_mm": 0.02, "recommended_cold_vertical_mm": -0.16,
            }
        ],
    )  # fmt: skip


def held(case: Case, *rows: ExpansionResult) -> dict[str, Check]:
    subject: Any = SimpleNamespace(case=case, expansion=list(rows), no_clearances="no gearbox has a housing")
    return {check.id: check for check in checks(subject)}


def test_the_worst_stage_is_held_against_each_limit(case: Case) -> None:
    found = held(case, expansion("low", 0.1, 0.3, (0.0, 0.1)), expansion("test", 0.2, 0.1, (0.0, 0.2)))
    tilt, bores, axes = (
        found[f"alignment.{key}"] for key in ("bearing_tilt", "bore_out_of_round", "axis_inclination")
    )
    assert (tilt.value, tilt.limit, tilt.verdict) == (0.2, pytest.approx(0.3), "pass")
    assert tilt.reason.endswith("stage test")
    assert (bores.value, bores.limit, bores.verdict) == (0.3, 0.25, "fail")
    assert (axes.value, axes.unit) == (6.0, "um")
    assert axes.utilisation == pytest.approx(6.0 / 8.0)


def test_a_coupling_is_held_cold_and_hot_and_told_its_cold_offset(case: Case) -> None:
    hot = held(case, expansion("test", 0.1, 0.1, (0.1, 0.2)))["alignment.coupling_offset.pinion_side"]
    cold = held(case, expansion("test", 0.1, 0.1, (0.4, 0.2)))["alignment.coupling_offset.pinion_side"]
    assert (hot.value, hot.verdict) == (0.2, "pass")
    assert "stage test" in hot.reason and "-0.160 mm up" in hot.reason
    assert (cold.value, cold.verdict) == (0.4, "fail")
    assert "(cold), cold;" in cold.reason
    assert hot.source == "drivetrain.couplings.pinion_side.radial_offset_maximum"


def test_limits_and_housings_that_are_not_there_leave_checks_out(case: Case) -> None:
    bare = case.model_copy(update={"limits": case.limits.model_copy(update={"alignment": AlignmentLimits()})})
    found = held(bare, expansion("test", 0.1, 0.1, (0.0, 0.2)))
    assert found["alignment.bearing_tilt"].verdict == "not applicable"
    assert found["alignment.bearing_tilt"].reason == "the case states no limit"
    nothing = held(case)
    assert {check.verdict for check in nothing.values()} == {"not applicable"}
    assert nothing["alignment.coupling_angle.wheel_side"].reason == "no gearbox has a housing"
    assert (
        "neither of its shafts"
        in held(case, expansion("test", 0.1, 0.1, (0.0, 0.2)))["alignment.coupling_angle.wheel_side"].reason
    )


def branch(gearbox: str, times: list[float], lift: list[float]) -> Any:
    """A course in which the shaft of a gearbox rises by ``lift`` [m] and tilts by a thousandth of its figure."""
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
    """The partner's course has times of its own and is read between them."""
    first, second = branch("a", [0.0, 10.0, 20.0], [0.0, 2e-4, 2e-4]), branch("b", [0.0, 20.0], [0.0, 1e-4])
    rig: Any = None
    found = misalignments(rig, first, [first, second])
    assert found["coupling_offset"]["pinion_side"] == pytest.approx([0.05, 0.1, 0.05])
    assert found["coupling_angle"]["pinion_side"] == pytest.approx([0.0, 1.5e-4, 1e-4])
    assert found["bearing_tilt"]["a.front"] == pytest.approx([0.1, 0.2, 0.3])
    alone = misalignments(rig, first, [first])
    assert alone["coupling_offset"]["pinion_side"] == pytest.approx([0.05, 0.15, 0.15])
    assert misalignments(rig, second, [first, second])["coupling_offset"] == {}


@pytest.mark.usefixtures("between")
def test_worst_moments_carry_limit_and_steady_value_into_the_checks(case: Case) -> None:
    course = branch("a", [0.0, 10.0, 20.0], [0.0, 4e-4, 2e-4])
    subject: Any = SimpleNamespace(case=case, rig=None, expansion=[expansion("test", 0.25, 0.1, (0.0, 0.15))])
    found = {m.quantity: m for m in worst_misalignments(subject, [course], [course], planned=True)}
    assert set(found) == {"bearing_tilt", "coupling_offset", "coupling_angle"}
    offset = found["coupling_offset"]
    assert (offset.value, offset.unit, offset.time_s) == (pytest.approx(0.35), "mm", 10.0)
    assert (offset.limit, offset.steady, offset.place) == (pytest.approx(0.3), 0.15, "pinion_side")
    assert found["bearing_tilt"].time_s == 20.0
    record: Any = SimpleNamespace(worst=list(found.values()), soak=[])
    held_over_time = {check.id: check for check in transient_checks(case, record)}
    check = held_over_time["transient.coupling_offset.pinion_side"]
    assert (check.verdict, check.comparison) == ("fail", "<=")
    assert check.source.startswith("drivetrain.couplings.pinion_side.radial_offset_maximum")
    assert held_over_time["transient.bearing_tilt"].utilisation == pytest.approx(1.0)
