"""The FZG rig of the virtual rig: laws of parts in a sump, its drawing, its heat and loop, sets of every kind."""

import dataclasses
import hashlib
import math
from functools import cache

import numpy as np
import pytest

from rigdesign.case import load_case
from rigdesign.case.geometry import housing_geometry
from rigdesign.measurement import load_measurement
from tests.builders.paths import ROOT
from tests.virtual_rig import chain as chains
from tests.virtual_rig import fzg_drawing, generate, generate_plans, sump_constants
from tests.virtual_rig.chain import draw_chain
from tests.virtual_rig.generate import KINDS, Detectors, make_set
from tests.virtual_rig.generate_effects import candidates, kind_of
from tests.virtual_rig.generate_plans import plan_points, sensors
from tests.virtual_rig.generate_truth import (
    RigTruth,
    another_day,
    case_of,
    draw_rig,
    nominal_constants,
    readings,
    true_points,
)
from tests.virtual_rig.heat_constants import step_of
from tests.virtual_rig.heat_effects import effect_names
from tests.virtual_rig.heat_places import face_of
from tests.virtual_rig.heat_truth import HeatTruth
from tests.virtual_rig.losses_sump import (
    Dipped,
    churning_power,
    drag_coefficient,
    lip_seal_power,
    roller_bearing_torque,
    roller_stiffness,
)

FULL = {"speed": 75.0 * math.pi, "torque": 372.6}


def truth(effects=None, constants=None):
    tree, boxes = case_of("fzg")
    nominal = nominal_constants("fzg").heat
    return HeatTruth(tree, {**nominal, **(constants or {})}, effects, boxes=boxes)


@cache
def healthy():
    return truth().solve(FULL)


def temperatures(answer):
    return np.array(list(answer["temperatures"].values()))


# ---------------------------------------------------------------- laws against hand values


def test_roller_bearing_by_hand():
    # d_m 60 mm, 14 mm2/s, 2250 1/min: nu n = 31500, ^(2/3) = 997.4; M_0 = 43.1 N mm, M_1 = 0.0004 x 5500 x 60 = 132
    torque = roller_bearing_torque(5500.0, 75.0 * math.pi, 14e-6, 0.060, 2.0, 4e-4)
    assert torque == pytest.approx(0.1751, rel=1e-3)
    slow = roller_bearing_torque(0.0, math.pi, 14e-6, 0.060, 2.0, 4e-4)
    assert slow == pytest.approx(160e-7 * 2.0 * 60.0**3 * 1e-3)
    assert roller_bearing_torque(5500.0, 0.0, 14e-6, 0.060, 2.0, 4e-4) == 0.0


def test_half_dipped_disc():
    disc = Dipped(radius=0.05, width=0.02, level=0.0)
    assert disc.half_angle == pytest.approx(math.pi / 2.0)
    assert disc.chord == pytest.approx(0.1)
    assert disc.wetted_area == pytest.approx(math.pi * 0.05**2 + math.pi * 0.05 * 0.02)
    assert Dipped(radius=0.05, width=0.02, level=-0.05).wetted_area == pytest.approx(0.0)
    assert Dipped(radius=0.05, width=0.02, level=-0.025).half_angle == pytest.approx(math.pi / 3.0)


def test_drag_of_a_dipped_disc_by_its_branches():
    assert drag_coefficient(1000.0) == pytest.approx(0.02)
    assert drag_coefficient(27000.0) == pytest.approx(0.0258)
    assert drag_coefficient(1e6) == pytest.approx(5e-4)
    numbers = np.geomspace(500.0, 1e6, 4000)
    values = np.array([drag_coefficient(re) for re in numbers])
    assert np.max(np.abs(np.diff(values)) / values[1:]) < 0.01, "no jump between the branches"


def test_churning_by_hand():
    # R 50 mm, 100 rad/s, chord 100 mm, 1e-5 m2/s: Re = 50000, C_m = 8.6e-4 x 36.84 = 0.03168, S = 0.010996 m2
    disc = Dipped(radius=0.05, width=0.02, level=0.0)
    assert churning_power(disc, 100.0, 850.0, 1e-5) == pytest.approx(18.51, rel=1e-3)
    assert churning_power(Dipped(radius=0.05, width=0.02, level=-0.06), 100.0, 850.0, 1e-5) == 0.0


def test_lip_seal_by_hand():
    # 90 degC, 99.4 mm2/s: 145 - 144 + 350 x 0.3012 = 106.4; 1e-7 x 106.4 x 900 x 2250 = 21.55 W
    assert lip_seal_power(0.03, 75.0 * math.pi, 363.15, 99.4e-6) == pytest.approx(21.55, rel=2e-3)
    assert lip_seal_power(0.03, 75.0 * math.pi, 313.15, 99.4e-6) > 1.5 * 21.55


def test_roller_contact_by_hand():
    # F 5500 N, 11 rollers: Q = 2300 N, Q^0.9 = 1061; l 15 mm, ^0.8 = 8.73; delta = 9.34 um; 5500 / (0.9 delta)
    assert roller_stiffness(5500.0, 11, 0.015) == pytest.approx(6.55e8, rel=5e-3)


# ---------------------------------------------------------------- drawing


RESOLVED = {
    "gears": ("shaft", "teeth", "face_width", "bore_diameter", "position", "tooth_thinning", "quality_grade"),
    "bearings": ("shaft", "side", "designation", "position"),
    "meshes": ("normal_module", "centre_distance", "pressure_angle", "helix_angle"),
}
HOUSING = (
    "wall_thickness", "floor_thickness", "top_thickness", "end_wall_thickness", "end_seal_width", "shaft_height",
    "width", "height", "warm_length", "material",
)  # fmt: skip


def same(drawn, resolved, keys):
    return all(drawn[key] == pytest.approx(getattr(resolved, key)) for key in keys)


def test_drawing_of_the_gearboxes_is_what_the_case_resolves_to():
    case, tree = load_case(ROOT / "cases" / "fzg"), case_of("fzg")[0]
    for name, box in case.gearboxes.items():
        own = tree["gearboxes"][name]
        for kind, keys in RESOLVED.items():
            for part, entry in getattr(box, kind).items():
                assert same(own[kind][part], entry, keys), (name, part)
        assert box.meshes["main"].damping_ratio == fzg_drawing.DAMPING_RATIO
        assert same(own["oil"], box.oil, ("sump_temperature", "level", "volume", "oil"))
    house, drawn = case.gearboxes["test"].housing, tree["gearboxes"]["test"]["housing"]
    assert same(drawn, house, HOUSING)
    assert same(drawn["field"], house.field, ("length", "width", "thickness", "material"))
    for name, shaft in house.shafts.items():
        assert same(drawn["shafts"][name], shaft, ("lateral_position", "outside_diameter", "overhang_rear"))


def test_drawing_of_the_circuit_is_what_the_case_resolves_to():
    power, drawn = load_case(ROOT / "cases" / "fzg").drivetrain, case_of("fzg")[0]["drivetrain"]
    for name, shaft in power.shafts.items():
        (section,), own = shaft.sections, drawn["shafts"][name]
        assert same(own["sections"][0], section, ("length", "outer_diameter", "inner_diameter")), name
        assert same(own["discs"]["coupling_half"], shaft.discs["coupling_half"], ("position", "inertia")), (
            name
        )
    for name, coupling in power.couplings.items():
        assert same(drawn["couplings"][name], coupling, ("torsional_stiffness", "torsional_damping"))
        assert list(coupling.shafts) == drawn["couplings"][name]["shafts"]
    assert same(drawn["motor"], power.motor, ("inertia", "shaft", "end"))
    assert (drawn["bracing"]["coupling"], drawn["torque_at"]) == (power.bracing.coupling, power.torque_at)


def test_slave_is_the_test_gearbox_with_wider_gears_and_without_housing():
    boxes = case_of("fzg")[0]["gearboxes"]
    assert "housing" in boxes["test"] and "housing" not in boxes["slave"]
    assert boxes["slave"]["gears"]["wheel"]["face_width"] == 0.04
    assert boxes["slave"]["gears"]["wheel"]["teeth"] == boxes["test"]["gears"]["wheel"]["teeth"] == 24


def test_thermocouples_sit_on_the_housing_that_the_checker_has():
    box = case_of("fzg")[1]["test"]
    geometry = housing_geometry(load_case(ROOT / "cases" / "fzg").gearboxes["test"])
    assert box.length == pytest.approx(geometry.length)
    assert {s.name for s in sensors("fzg", "rich") if s.at is not None and face_of(box, s.at)} == {
        f"TC0{i}" for i in range(1, 9)
    }


# ---------------------------------------------------------------- heat and loop


def test_plausible_rig():
    answer = healthy()
    assert 2000.0 < answer["motor_power"] < 2800.0
    assert abs(answer["imbalance"]["test"]) < 1e-9
    bulk = 0.5 * (
        answer["temperatures"]["test.gear_test_pinion"] + answer["temperatures"]["test.gear_test_wheel"]
    )
    assert bulk - 273.15 == pytest.approx(126.0, abs=6.0), "Michaelis for stage 10 at 90 degC"
    assert 80.0 < answer["temperatures"]["test.outer_warm"] - 273.15 < 90.0


@pytest.mark.parametrize("name", list(effect_names(case_of("fzg")[0])))
def test_effect_moves_something_and_closes_the_balance(name):
    size = 0.3 * kind_of(name).upper
    changed = truth({name: size}).solve(FULL)
    assert abs(changed["imbalance"]["test"]) < 1e-6
    moved = np.max(np.abs(temperatures(changed) - temperatures(healthy())))
    assert moved > 0.05 or abs(changed["motor_power"] - healthy()["motor_power"]) > 1.0


@pytest.mark.parametrize("name", ["film:test.oil", "oil_level:test", "churning_loss:test", "film:test.sides"])
def test_both_bounds_can_be_solved(name):
    kind = kind_of(name)
    for size in (kind.lower, kind.upper):
        assert np.isfinite(truth({name: size}).solve(FULL)["motor_power"])


def test_every_constant_matters():
    constants = nominal_constants("fzg").heat
    point = {
        **FULL,
        "speed": 60.0 * math.pi,
        "inlet_temperature": {"test.gear_oil": 340.0, "slave.gear_oil": 340.0},
    }
    base = truth().solve(point)
    for name, entry in sump_constants.CONSTANTS.items():
        moved = truth(constants={name: constants[name] + step_of(entry)}).solve(point)
        change = np.max(np.abs(temperatures(moved) - temperatures(base)))
        assert change > 1e-4 or abs(moved["motor_power"] - base["motor_power"]) > 1e-3, name


def test_directions_of_effects():
    level = truth({"oil_level:test": -0.02}).solve(FULL)
    assert level["losses"]["test.churning:wheel"] < healthy()["losses"]["test.churning:wheel"]
    assert level["losses"]["slave.churning:wheel"] == healthy()["losses"]["slave.churning:wheel"]
    warm = truth({"film:test.sides": -0.5}).solve(FULL)["temperatures"]["test.gear_test_wheel"]
    assert warm > healthy()["temperatures"]["test.gear_test_wheel"] + 0.5
    assert truth({"film:test.oil": 0.5}).solve(FULL)["temperatures"]["test.outer_warm"] > 273.15 + 85.0
    thin = truth().solve({**FULL, "inlet_temperature": {"test.gear_oil": 383.15, "slave.gear_oil": 363.15}})
    assert thin["losses"]["test.bearing:pinion_front"] < healthy()["losses"]["test.bearing:pinion_front"]


def test_loop_pays_what_the_heat_says():
    rig = RigTruth("fzg", nominal_constants("fzg"))
    own = [s for s in sensors("fzg", "sparse") if s.quantity in ("torque", "motor_power")]
    point = true_points("fzg", plan_points("fzg", 9))[4:5]
    found = dict(
        zip(((r.channel, r.order) for r in readings(own, point)), rig.values(point, own), strict=False)
    )
    assert abs(found["M_1", 0.0]) == pytest.approx(point[0].torque, rel=0.03)
    assert found["P_motor", 0.0] == pytest.approx(990.0, rel=0.05)
    assert rig.loop.cycle_turns == 3
    assert 200.0 < rig.loop.natural_frequencies(1)[0] < 450.0


def test_candidates_are_what_the_checker_can_name():
    names = candidates("fzg", sensors("fzg", "rich"), catalogue=True)
    outside = candidates("fzg", sensors("fzg", "rich"), catalogue=False)
    assert not set(names) & set(outside)
    assert {"bearing_loss:slave", "film:test.oil", "mesh_stiffness:test.main"} <= set(names)
    assert {"churning_loss:test", "oil_level:slave", "x_absorber:wheel_side"} <= set(outside)
    assert not any(
        name.startswith(("spline_stiffness", "jet", "leak", "bypass", "pump")) for name in (*names, *outside)
    )


# ---------------------------------------------------------------- sets


class Blunt:
    """A detector that sees a twentieth of every reading; sensitivities of a rig take minutes."""

    names = ("inlet:test.gear_oil", "inlet:slave.gear_oil")

    def __init__(self, rig, level, plan):
        own, points = sensors(rig, level), true_points(rig, plan_points(rig, plan))
        self.constants = np.ones((len(readings(own, points)), 2))

    def detectable_sizes(self, change, *, baseline=False):
        return float(np.linalg.norm(change))

    def partial_sizes(self, change, keep, *, baseline=False):
        return float(np.linalg.norm(change[keep]))


@pytest.fixture
def blunt(monkeypatch):
    monkeypatch.setattr(
        Detectors, "of", classmethod(lambda cls, *which: cls(Blunt(*which), Blunt(*which))), raising=True
    )
    short = {rig: points[:3] for rig, points in generate_plans._PLANS.items()}
    monkeypatch.setattr(generate_plans, "_PLANS", short)
    monkeypatch.setattr(generate, "TRIAL_POINTS", 1)


@pytest.mark.parametrize("kind", KINDS)
def test_a_set_of_every_kind_is_made_and_loads(kind, blunt, tmp_path):
    entry = make_set(
        "fzg", {"kind": kind, "sensors": "sparse", "plan": 9, "baseline": kind == "single"}, 11, tmp_path
    )
    assert entry["rig"] == "fzg" and len(entry["effects"]) == {"none": 0, "pair": 2}.get(kind, 1)
    folder = tmp_path / "set_1" if kind == "single" else tmp_path
    measured = load_measurement(folder, load_case(ROOT / "cases" / "fzg"))
    assert set(measured.channels) == {s.name for s in sensors("fzg", "sparse")}
    assert set(measured.settings[0].inlet_temperature) == {"test.gear_oil", "slave.gear_oil"}
    assert not measured.settings[0].flow
    assert kind != "single" or measured.baseline is not None


def test_a_thermometer_that_is_added_leaves_the_others_as_they_were(blunt, tmp_path):
    """Against a baseline that was read without it: the same rig with the same errors of its sensors."""
    spec = {"kind": "none", "sensors": "sparse", "plan": 9, "rig_seed": 5}
    place = "test.bearing_bore_test_pinion_rear"
    make_set("fzg", spec, 11, tmp_path / "before")
    make_set("fzg", spec, 12, tmp_path / "without", tmp_path / "before")
    make_set("fzg", {**spec, "more": [place]}, 12, tmp_path / "with", tmp_path / "before")
    case = load_case(ROOT / "cases" / "fzg")
    without, more = (load_measurement(tmp_path / name, case) for name in ("without", "with"))
    (added,) = set(more.channels) - set(without.channels)
    assert more.channels[added].channel.place == place
    assert more.baseline == without.baseline == tmp_path / "before"
    tables = [(tmp_path / name / "data.csv").read_text().splitlines() for name in ("without", "with")]
    first, second = (dict(zip(rows[0].split(","), rows[2].split(","), strict=True)) for rows in tables)
    walls = [name for name in first if name.startswith("TC")]
    assert walls
    for name in walls:
        assert float(second[name]) == pytest.approx(float(first[name]), abs=6.0 * 0.1)


def test_a_later_set_is_read_on_another_day(blunt, tmp_path):
    """Sensors and settings shift, friction and films change; the healthy set before stays what it is."""
    spec = {"kind": "none", "sensors": "sparse", "plan": 9, "baseline": True}
    for name, drift in (("changes", {}), ("stays", {"drift": 0.0})):
        make_set("fzg", {**spec, **drift}, 11, tmp_path / name)
    table = {
        (name, part): (tmp_path / name / part / "data.csv").read_text()
        for name in ("changes", "stays")
        for part in ("set_0", "set_1")
    }
    assert table["changes", "set_0"] == table["stays", "set_0"]
    assert table["changes", "set_1"] != table["stays", "set_1"]


def test_a_day_moves_sensors_friction_and_films_by_what_is_stated():
    own, rng = sensors("uhcf_prototype", "usual"), np.random.default_rng(3)
    chain, built = draw_chain(own, rng), nominal_constants("uhcf_prototype")
    days = [(chains.another_day(chain, own, rng), another_day(built, rng)) for _ in range(400)]
    shift = np.std([day.offset["TC01"] - chain.offset["TC01"] for day, _ in days])
    assert shift == pytest.approx(np.hypot(0.3 * 0.4, 0.15), rel=0.15)
    assert np.std([day.scale["P_motor"] for day, _ in days]) == pytest.approx(0.003, rel=0.15)
    assert {day.scale["TC01"] for day, _ in days} == {chain.scale["TC01"]}
    for name, spread in {"friction": 0.02, "seal_drag": 0.03, "film_chamber": 0.02, "k_field": 0.0}.items():
        assert np.std(np.log([rig.heat[name] for _, rig in days])) == pytest.approx(spread, rel=0.15)


DRAWN = {
    "uhcf_prototype": "b9ef77f6b14eb5af",
    "loop_1to1": "1507af575b5a58b8",
    "loop_hunting": "1938eaf5cf747d81",
}
"""Of rig, measuring system and points, drawn by seed 4; from before the fourth rig was put in."""
WRITTEN = {
    "uhcf_prototype": "8a4d1dab008402ad",
    "loop_1to1": "45f48a6a475e3e72",
    "loop_hunting": "868f0e357a0e4633",
}
"""Of the files of a healthy set of three points each; last digits may depend on the machine."""


@pytest.mark.parametrize("rig", DRAWN)
def test_other_rigs_are_drawn_as_before(rig):
    rng, own = np.random.default_rng(4), sensors(rig, "usual")
    drawn = [
        draw_rig(rig, rng, own, shift=True),
        draw_chain(own, rng),
        true_points(rig, plan_points(rig, 9), rng),
    ]
    text = " ".join(f"{value:.9g}" for value in flat(drawn))
    assert hashlib.sha256(text.encode()).hexdigest()[:16] == DRAWN[rig]


@pytest.mark.slow
@pytest.mark.parametrize("rig", WRITTEN)
def test_sets_of_the_other_rigs_are_as_before(rig, blunt, tmp_path):
    spec = {"kind": "none", "sensors": "usual", "plan": 9, "baseline": rig == "loop_1to1", "drift": 0.0}
    make_set(rig, spec, 4, tmp_path)
    digest = hashlib.sha256()
    for file in sorted(path for path in tmp_path.rglob("*") if path.is_file()):
        digest.update(file.read_bytes())
    assert digest.hexdigest()[:16] == WRITTEN[rig]


def flat(node):
    """All numbers of nested containers and dataclasses."""
    if isinstance(node, dict):
        return [value for key in sorted(node) for value in flat(node[key])]
    if isinstance(node, list | tuple):
        return [value for part in node for value in flat(part)]
    if isinstance(node, complex):
        return [node.real, node.imag]
    if dataclasses.is_dataclass(node):
        return [value for one in dataclasses.fields(node) for value in flat(getattr(node, one.name))]
    return [float(node)] if isinstance(node, int | float) else []
