"""Friction heat of the teeth: partition, oil film, energy, and the split as a result."""

import math
from dataclasses import replace

import pytest

from dynamics.gear.pair import GearPair
from rigdesign import load_case
from rigdesign.base.errors import CaseError
from rigdesign.base.part_name import MeshName
from rigdesign.case import Case
from rigdesign.coupling.flank_heat import gear_flanks, mesh_split, pinion_share, tooth_ring
from rigdesign.coupling.iteration import IterationResult, PointProblem, initial_state, run_iteration
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.losses import mesh_losses
from rigdesign.coupling.mesh_models import mesh_models
from rigdesign.coupling.time_run import held_points
from rigdesign.postprocessing.housing import friction_heat, heat_splits
from rigdesign.properties.materials import ALUMINIUM, CASE_HARDENED_STEEL
from rigdesign.rig.model import Rig, build_rig
from rigdesign.rig.oil_supply import ChamberOil
from rigdesign.rig.reuse import with_housings_of
from tests.builders.paths import CASES

VARIANT = f"""
extends = "{CASES / "uhcf_prototype" / "case.toml"}"
name = "flank_film"

[gearboxes.test.heat_split]
remove = ["mesh_into_gears", "mesh_pinion_share"]
mesh = "flank_film"

[gearboxes.test.housing.boundary.gear_rims]
surfaces = ["gear_*_rim"]
law = "flank_film"
wetted_share = {{ value = 0.8, assumed = "as it is", range = [0.5, 1.0] }}
film_factor = {{ value = 1.0, assumed = "as it is", range = [0.7, 1.4] }}
"""
STEEL = (CASE_HARDENED_STEEL, CASE_HARDENED_STEEL)
CHAMBER = ChamberOil(leaving=420.0)
"""Oil as it leaves the chamber [K]; flanks that jets wet do not feel it."""
RIMS = "gearboxes.test.housing.boundary.gear_rims"


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> Case:
    file = tmp_path_factory.mktemp("flank") / "case.toml"
    file.write_text(VARIANT)
    return load_case(file)


@pytest.fixture(scope="module")
def rig(case: Case) -> Rig:
    return build_rig(case, "quick")


@pytest.fixture(scope="module")
def done(rig: Rig) -> IterationResult:
    point = held_points(rig)[-1]
    initial = initial_state(rig, point)
    return run_iteration(PointProblem(rig=rig, point=point, initial=initial, bracing=None), initial)


def equal_gears() -> GearPair:
    return GearPair.from_centre_distance(
        normal_module=5e-3,
        teeth=(45, 45),
        centre_distance=0.225,
        face_widths=(0.045, 0.045),
        profile_shift_1="equal",
    )


def test_equal_gears_share_the_heat_by_half() -> None:
    assert pinion_share(equal_gears(), STEEL) == pytest.approx(0.5, abs=1e-12)


def test_heat_prefers_the_better_conductor() -> None:
    """B = sqrt(k rho c): aluminium 20.3e3, steel 12.4e3; about B_1/(B_1 + B_2) of it."""
    found = pinion_share(equal_gears(), (ALUMINIUM, CASE_HARDENED_STEEL))
    effusivity = [
        math.sqrt(m.conductivity * m.density * m.heat_capacity) for m in (ALUMINIUM, CASE_HARDENED_STEEL)
    ]
    assert found == pytest.approx(effusivity[0] / sum(effusivity), abs=0.01)
    assert found + pinion_share(equal_gears(), (CASE_HARDENED_STEEL, ALUMINIUM)) == pytest.approx(1.0)


def test_contact_behind_the_pitch_point_heats_the_pinion_more(rig: Rig) -> None:
    """All recess: the contact runs faster over the pinion, rho_1 = T1C + s against rho_2 = T2C - s."""
    pair = rig.pairs["test.main"]
    reach, middle = pair.rolling_radii, 0.5 * (pair.path.start + pair.path.end)
    first = math.sqrt(reach[0] + middle)
    second = math.sqrt((reach[1] - middle) / pair.gear_ratio)
    assert pair.path.start > 0.0
    assert pinion_share(pair, STEEL) == pytest.approx(first / (first + second), abs=0.01)


def test_teeth_of_an_uncorrected_gear() -> None:
    """m 5, z 45: height 11.25 mm, half a pitch thick at the pitch circle, flank some 4 % longer than high."""
    ring = tooth_ring(equal_gears(), 0, 0.045, 42.0)
    assert ring.height == pytest.approx(11.25e-3, rel=1e-9)
    assert ring.tooth_thickness == pytest.approx(0.5 * math.pi * 5e-3, rel=0.08)
    length = ring.flank_area / (2 * 45 * 0.045)
    assert 1.02 * ring.height < length < 1.1 * ring.height


def test_oil_is_warmed_by_its_impact(rig: Rig) -> None:
    """Into the mesh, 20 m/s at 62 m/s: 42 m/s lost on impact, v^2/(2 c) above the feed."""
    condition = rig.case.gearboxes["test"].housing.boundary["gear_rims"]  # type: ignore[union-attr]
    point = held_points(rig)[-1]
    flanks = gear_flanks(rig, "test", "pinion", point, condition, CHAMBER)  # type: ignore[arg-type]
    inlet = rig.case.gearboxes["test"].oil.inlet_temperature
    lost = point.speed * rig.pairs["test.main"].working_radii[0] - 20.0
    heat_capacity = rig.oils["MIL-PRF-23699"].heat_capacity(inlet)
    assert flanks.oil_temperature - inlet == pytest.approx(lost**2 / (2.0 * heat_capacity), rel=1e-9)


def test_an_idler_is_wetted_twice_a_turn() -> None:
    main = build_rig(load_case(CASES / "uhcf_main"), "quick")
    condition = main.case.gearboxes["test"].housing.boundary["gear_rims"]  # type: ignore[union-attr]
    point = held_points(main)[-1]
    pinion, wheel = (
        gear_flanks(main, "test", gear, point, condition, CHAMBER).law(480.0, 415.0)  # type: ignore[arg-type]
        for gear in ("pinion", "wheel_a")
    )
    assert (pinion.inputs["wettings_per_turn"], wheel.inputs["wettings_per_turn"]) == (2.0, 1.0)
    assert pinion.inputs["oil_flow"] == main.case.gearboxes["test"].oil.flow
    assert pinion.value == pytest.approx(2.0 * wheel.value, rel=0.02)


def test_assumed_split_stays_what_the_case_says() -> None:
    plain = build_rig(load_case(CASES / "uhcf_prototype"), "quick")
    point = held_points(plain)[-1]
    split = mesh_split(plain, MeshName("test", "main"), point, initial_state(plain, point))
    assert (split.pinion, split.kept) == (0.5, (0.5, 0.5))
    assert mesh_split(plain, MeshName("reference", "main"), point, None).into_rims == (0.0, 0.0)


def test_friction_goes_into_rims_and_oil_and_nowhere_else(rig: Rig, done: IterationResult) -> None:
    mesh = next(p for p in done.losses if p.name == "test.main" and p.loss.kind == "mesh")
    assert mesh.split is not None
    assert 0.5 < mesh.split.pinion < 0.6
    assert all(0.8 < kept < 1.0 for kept in mesh.split.kept)
    sources = [c for c in done.fields["test"].conditions if getattr(c, "kind", "") == "mesh_loss"]
    into_rims = math.fsum(source.power for source in sources)  # type: ignore[union-attr]
    assert into_rims == pytest.approx(mesh.into_body, rel=1e-12)
    assert mesh.into_oil + into_rims == pytest.approx(mesh.loss.power, rel=1e-12)
    assert done.fields["test"].solution.balance.closure < 1e-8
    oil = -math.fsum(r.power for r in done.fields["test"].solution.balance.rows if r.kind == "gear_oil")
    assert done.wall_heat["test.gear_oil"] == pytest.approx(oil)


def test_kept_share_follows_the_temperature_of_the_flank(rig: Rig, done: IterationResult) -> None:
    """A hotter flank thins its oil: less film, more of the heat reaches the rim."""
    hot = replace(
        done.coupling_state, gear_temperature=dict.fromkeys(done.coupling_state.gear_temperature, 500.0)
    )
    cold, warm = (mesh_losses(rig, done.point, done.models, None, f) for f in (done.coupling_state, hot))
    assert warm[0].into_body > cold[0].into_body


def test_split_is_a_result_with_a_range(rig: Rig, done: IterationResult) -> None:
    result = PointResult(point=done.point, last=done, setting=None, residuals=())
    splits = {split.gear: split for split in heat_splits(rig, result, done.fields["test"])}
    assert set(splits) == {"test.pinion", "test.wheel"}
    assert math.fsum(friction_heat(rig, result, "test").values()) == pytest.approx(
        next(p.loss.power for p in done.losses if p.name == "test.main" and p.loss.kind == "mesh")
    )
    for split in splits.values():
        weak, strong = split.weak_film, split.strong_film
        assert split.share_into_oil + split.share_into_bodies == pytest.approx(1.0)
        assert split.share_into_oil == pytest.approx((split.at_once + split.film) / split.friction)
        assert weak is not None and strong is not None and split.tooth is not None
        assert weak.flank_film < split.flank_film < strong.flank_film  # type: ignore[operator]
        assert weak.share_into_oil < split.share_into_oil < strong.share_into_oil
        assert weak.bulk > split.bulk > strong.bulk
        assert split.tooth > split.bulk


def test_without_ranges_the_split_has_none(rig: Rig, done: IterationResult) -> None:
    case = rig.case.with_value(f"{RIMS}.wetted_share", 0.8).with_value(f"{RIMS}.film_factor", 1.0)
    plain = with_housings_of(replace(rig, case=case), rig)
    result = PointResult(point=done.point, last=done, setting=None, residuals=())
    assert all(split.weak_film is None for split in heat_splits(plain, result, done.fields["test"]))


@pytest.mark.parametrize(
    ("path", "value", "said"),
    [
        ("gearboxes.test.heat_split.mesh_into_gears", 0.5, "is not used: the film on the flanks decides"),
        ("gearboxes.test.heat_split.mesh", "assumed", "mesh_into_gears is missing"),
        (f"{RIMS}.surfaces", ["gear_*_rim", "chamber_wall"], "has no teeth"),
        (f"{RIMS}.correlation", "constant", 'correlation = "constant" needs it'),
        (f"{RIMS}.heat_transfer_coefficient", "3000 W/(m2 K)", "is not used"),
        (f"{RIMS}.wetted_share", 1.5, "wetted_share"),
    ],
)
def test_splits_that_cannot_be_are_refused(case: Case, path: str, value: object, said: str) -> None:
    with pytest.raises(CaseError) as error:
        case.with_value(path, value)
    assert said in str(error.value)


def test_a_rim_without_a_film_cannot_decide() -> None:
    with pytest.raises(CaseError, match="has no flank film that could decide"):
        shipped = load_case(CASES / "uhcf_main")
        tree = shipped.origin.tree["gearboxes"]["test"]["housing"]["boundary"]["gear_rims"]
        assert tree["law"] == "flank_film"
        sides = RIMS.replace("gear_rims", "gear_sides")
        shipped.with_values(
            {
                f"{RIMS}.surfaces": ["gear_test_pinion_rim"],
                f"{sides}.surfaces": ["gear_*_side_*", "gear_*_wheel_*_rim"],
            }
        )


def test_constant_film_on_the_flanks(case: Case) -> None:
    text = VARIANT.replace(
        'law = "flank_film"\n',
        'law = "flank_film"\ncorrelation = "constant"\nheat_transfer_coefficient = "3000 W/(m2 K)"\n',
    )
    file = case.path.with_name("constant.toml")
    file.write_text(text)
    given = build_rig(load_case(file), "quick")
    condition = given.case.gearboxes["test"].housing.boundary["gear_rims"]  # type: ignore[union-attr]
    flanks = gear_flanks(given, "test", "wheel", held_points(given)[-1], condition, CHAMBER)  # type: ignore[arg-type]
    assert flanks.law(450.0, 413.0).value == 3000.0


def test_a_standing_gear_has_no_film(rig: Rig) -> None:
    condition = rig.case.gearboxes["test"].housing.boundary["gear_rims"]  # type: ignore[union-attr]
    still = replace(held_points(rig)[-1], speed=0.0)
    flanks = gear_flanks(rig, "test", "pinion", still, condition, CHAMBER)  # type: ignore[arg-type]
    assert flanks.law(450.0, 413.0).value == 0.0
    assert flanks.kept(450.0) == 1.0
    assert flanks.oil_temperature == rig.case.gearboxes["test"].oil.inlet_temperature


def test_models_of_the_whole_rig_are_split(rig: Rig) -> None:
    point = held_points(rig)[-1]
    coupling_state = initial_state(rig, point)
    for placed in mesh_losses(rig, point, mesh_models(rig, point, coupling_state)):
        assert placed.split is not None
        assert placed.into_body == pytest.approx(math.fsum(placed.split.into_rims) * placed.loss.power)
