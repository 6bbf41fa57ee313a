"""Inputs that a comparison with measurements patches: each is reached by its path and moves what it should."""

import pytest

from rigdesign.base.errors import CaseError
from rigdesign.rig.joints import FOOT_CONTACT
from tests.builders.warm_prototype import base, case_with, heat_by_kind, lost, open_share, outlet, settled
from thermal.conduction.steady import CLOSURE
from thermal.films.law import STEFAN_BOLTZMANN

pytestmark = pytest.mark.whole_run

BOX = "gearboxes.test"


def mean(name: str, *changes: tuple[str, object], remesh: bool = False) -> float:
    """Volume mean temperature of a body [K]."""
    rig, last = settled(*changes, remesh=remesh)
    return rig.conduction["test"].elements.body_mean(last.fields["test"].temperature, name)


def test_a_shell_contact_holds_the_heat_of_the_bearings_back() -> None:
    """None is perfect; a joint as good as 1e6 W/(m2 K) is nearly that, a bad one keeps the housing from the films."""
    path = f"{BOX}.bearings.*.shell_conductance"
    good, bad = (path, "1000000 W/(m2 K)"), (path, "100 W/(m2 K)")
    heats = [
        [
            row.power
            for row in last.fields["test"].solution.balance.rows
            if row.surface.startswith("bearing_bore")
        ]
        for _, last in (settled(), settled(good), settled(bad))
    ]
    sums = [sum(abs(power) for power in powers) for powers in heats]
    assert sums[1] == pytest.approx(sums[0], rel=0.01)
    assert sums[2] < 0.7 * sums[0]
    assert open_share(*settled(bad)) < 2e-3


def test_a_foot_contact_parts_the_housing_from_its_field() -> None:
    path = f"{BOX}.housing.foot_contact.conductance"
    assert base()[0].case.gearboxes["test"].housing.foot_contact.conductance == 2000.0
    joints = [(path, "1000000 W/(m2 K)"), (path, "50 W/(m2 K)")]
    fields = [mean("field"), *(mean("field", joint) for joint in joints)]
    # 300 W over 0.09 m2 of foot: 1.7 K across the joint of the case
    assert fields[0] < fields[1] < fields[0] + 2.0
    assert fields[2] < fields[0] - 3.0
    rig, last = settled(joints[1])
    rows = [r for r in last.fields["test"].solution.balance.rows if r.kind == FOOT_CONTACT]
    assert sum(row.power for row in rows) == pytest.approx(0.0, abs=1e-9)
    assert last.fields["test"].solution.balance.closure <= CLOSURE
    assert open_share(rig, last) < 2e-3


def test_a_warmer_room_warms_the_housing_and_takes_less_heat() -> None:
    warmer = ("ambient.temperature", "35 degC")
    rise = 308.15 - base()[0].case.ambient.temperature
    assert 0.0 < mean("field", warmer) - mean("field") < rise
    assert mean("field", warmer) - mean("field") > mean("housing", warmer) - mean("housing") > 0.0
    (_, before), (_, after) = settled(), settled(warmer)
    assert heat_by_kind(before)["air"] < heat_by_kind(after)["air"] < 0.0


def test_a_draught_cools_the_walls_it_blows_on() -> None:
    boundary = base()[0].case.gearboxes["test"].housing.boundary
    entries = [name for name, entry in boundary.items() if hasattr(entry, "draught_factor")]
    assert entries
    blown = tuple((f"{BOX}.housing.boundary.{name}.draught_factor", 2.0) for name in entries)
    (_, before), (rig, after) = settled(), settled(*blown)
    assert heat_by_kind(after)["air"] < 1.1 * heat_by_kind(before)["air"] < 0.0
    assert mean("housing", *blown) < mean("housing") - 0.3
    assert open_share(rig, after) < 2e-3


def test_an_emissivity_moves_radiation() -> None:
    """Of the walls whose film to room air does not hold it already: the field, and the ends of the shafts."""
    (_, before), (rig, after) = settled(), settled((f"{BOX}.housing.boundary.*.emissivity", 0.1))
    assert 0.7 * heat_by_kind(before)["radiation"] < heat_by_kind(after)["radiation"] < 0.0
    assert open_share(rig, after) < 2e-3


def test_the_loss_split_moves_heat_from_oil_to_gears_and_loses_no_more() -> None:
    was = base()[0].case.gearboxes["test"].heat_split.mesh_into_gears
    assert was is not None and was > 0.3
    less = (f"{BOX}.heat_split.mesh_into_gears", 0.2)
    (_, before), (rig, after) = settled(), settled(less)
    assert mean("gear_test_pinion", less) < mean("gear_test_pinion") - 0.5
    assert heat_by_kind(after)["mesh_loss"] == pytest.approx(0.2 * lost(after, "mesh"), rel=1e-9)
    assert lost(after, "mesh") == pytest.approx(lost(before, "mesh"), rel=0.01)
    assert outlet(after, "test.gear_oil") == pytest.approx(outlet(before, "test.gear_oil"), abs=0.3)
    assert open_share(rig, after) < 2e-3


def test_an_excess_counts_where_the_film_to_room_air_holds_the_radiation() -> None:
    """Niemann/Winter films hold radiation, so the emissivity of their walls moves nothing but its excess does."""
    path = f"{BOX}.housing.boundary.housing_radiation"
    (_, before), (_, same) = settled(), settled((f"{path}.emissivity", 0.3))
    assert heat_by_kind(same)["radiation"] == pytest.approx(heat_by_kind(before)["radiation"], rel=1e-6)
    powers = []
    for excess in (0.3, -0.3):
        rig, after = settled((f"{path}.emissivity_excess", excess))
        rows = [
            r
            for r in after.fields["test"].solution.balance.rows
            if r.kind == "radiation" and r.surface[:5] == "outer"
        ]
        powers.append(sum(row.power for row in rows))
        walls, room = rows[0].mean_temperature, rig.case.ambient.temperature
        flux = excess * STEFAN_BOLTZMANN * (room**4 - walls**4)
        assert rows[0].power == pytest.approx(flux * rows[0].area, rel=0.05)
        assert after.fields["test"].solution.balance.closure <= CLOSURE
        assert open_share(rig, after) < 2e-3
    assert powers[0] < 0.0 < powers[1]
    with pytest.raises(CaseError, match="add up to"):
        case_with(((f"{path}.emissivity_excess", 0.9),))
