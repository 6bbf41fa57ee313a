"""Keys of tip edge, protuberance, body and hand of a gear: what they build, what is refused and how."""

from dataclasses import replace
from math import pi, radians

import pytest

from rigdesign.base.errors import CaseError, Fault
from rigdesign.case import Case, load_case
from rigdesign.case.rules.gears import halves_faults, hand_faults
from rigdesign.rig.drivetrain import gear_inertia
from rigdesign.rig.model import build_rig
from rigdesign.rig.tooth_influence import gear_model
from rigdesign.run.solver_errors import solver_errors
from tests.builders.paths import CASES

PINION, MESH = "gearboxes.test.gears.pinion", "gearboxes.test.meshes.main"
HELICAL = "gearboxes.reference"


def fzg(**values: object) -> Case:
    """The FZG rig; values : by path below the pinion of its test gearbox, ``__`` for a point."""
    case = load_case(CASES / "fzg")
    return case.with_values({f"{PINION}.{path.replace('__', '.')}": value for path, value in values.items()})


def test_details_of_the_case_reach_pair_and_influence_numbers() -> None:
    case = load_case(CASES / "uhcf_prototype").with_values(
        {
            f"{PINION}.tip_edge.rounding": "0.05 mm",
            f"{PINION}.rim_thickness": "9 mm",
            f"{PINION}.web_thickness": "3 mm",
            f"{PINION}.bore_diameter": "20 mm",
            f"{MESH}.rack.dedendum": 1.4,
            f"{MESH}.rack.protuberance": 0.005,
            f"{MESH}.rack.protuberance_angle": "8 deg",
        }
    )
    pair = build_rig(case, "quick").pairs["test.main"]
    model = gear_model(pair, 0)
    assert model.form.tip_edge.rounding == pytest.approx(0.05e-3)
    assert model.form.protuberance == pytest.approx(0.005e-3)
    assert model.form.protuberance_angle == pytest.approx(radians(8.0))
    assert (model.body.rim_thickness, model.body.web_thickness) == (pytest.approx(9e-3), pytest.approx(3e-3))
    assert model.body.bore_radius == pytest.approx(10e-3)
    wheel = gear_model(pair, 1)
    assert wheel.form.tip_edge.rounding == 0.0 and wheel.body.rim_thickness is None
    assert wheel.form.protuberance == model.form.protuberance


def test_numbers_are_those_of_the_cold_gear() -> None:
    pair = build_rig(fzg(tip_edge__chamfer="0.2 mm"), "quick").pairs["test.main"]
    warm = pair.warm(393.15, 383.15, pair.centre_distance + 20e-6)
    assert gear_model(warm, 0) == gear_model(pair, 0)
    assert gear_model(pair, 0) != gear_model(replace(pair, details=pair.details[::-1]), 0)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (
            {"web_thickness": "6 mm"},
            r"pinion\.web_thickness = .*begins inside of a rim.*write rim_thickness too",
        ),
        (
            {"rim_thickness": "9 mm", "web_thickness": "15 mm"},
            r"web_thickness = 15 mm.*above the face width, 14 mm",
        ),
        ({"rim_thickness": "0 mm"}, r"rim_thickness = .*0 mm"),
        (
            {"tip_edge__rounding": "0.2 mm", "tip_edge__chamfer": "0.1 mm"},
            r"tip_edge.*exclude each other; write one",
        ),
        ({"tip_edge__rounding": "-0.2 mm"}, r"tip_edge\.rounding = .*is below 0 um"),
        ({"tip_edge__chamfer": "2 mm"}, r"tip_edge\.chamfer = .*is above 1 mm"),
        ({"helix_hand": "right"}, r"pinion\.helix_hand = .*the gear has spur teeth; leave it out"),
        ({"helix_hand": "up"}, r"helix_hand"),
    ],
)
def test_keys_that_do_not_fit_are_named(values: dict[str, object], message: str) -> None:
    with pytest.raises(CaseError, match=message):
        fzg(**values)


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        (
            f"{MESH}.rack.protuberance_angle",
            "20 deg",
            r"protuberance_angle = 20 deg.*below the pressure angle, 20 deg",
        ),
        (f"{MESH}.rack.protuberance_angle", "-1 deg", r"protuberance_angle = -1 deg.*above 0 deg"),
        (f"{MESH}.rack.protuberance", 0.5, r"rack\.protuberance = 0\.5"),
        ("gearboxes.test.rotation", "forward", r"gearboxes\.test\.rotation"),
    ],
)
def test_tool_and_rotation_that_do_not_fit_are_named(path: str, value: object, message: str) -> None:
    with pytest.raises(CaseError, match=message):
        load_case(CASES / "fzg").with_values({f"{MESH}.rack.protuberance": 0.02, path: value})


def test_hands_that_contradict_each_other_through_an_idler_are_refused() -> None:
    """p-i-w: p and w are both of the other hand than i."""
    box = load_case(CASES / "uhcf_prototype").gearboxes["reference"]
    mesh = box.meshes["main"].model_copy(update={"double_helical": False})
    gear = box.gears[mesh.pinion]

    def faults(**hands: str) -> list[Fault]:
        gears = {name: gear.model_copy(update={"helix_hand": hands.get(name)}) for name in "piw"}
        meshes = {f"{a}{b}": mesh.model_copy(update={"pinion": a, "wheel": b}) for a, b in ("pi", "iw")}
        return list(hand_faults(HELICAL, box.model_copy(update={"gears": gears, "meshes": meshes})))

    assert not faults(p="right", w="right")
    (found,) = faults(p="right", w="left")
    said = f"{found.path} {found.problem}"
    assert all(f"{HELICAL}.gears.{name}.helix_hand" in said for name in "pw")
    (direct,) = faults(p="right", i="right")
    assert (direct.path, direct.problem) == (f"{HELICAL}.gears.i.helix_hand", "is that of its partner p")


def test_all_meshes_of_an_idler_have_its_body_alike() -> None:
    """Its inertia is one number: that of one half and that of two do not fit together."""
    box = load_case(CASES / "uhcf_prototype").gearboxes["reference"]
    mesh, gear = box.meshes["main"], box.gears["pinion"]
    gears = dict.fromkeys("piw", gear)

    def faults(**changed: object) -> list[Fault]:
        second = mesh.model_copy(update={"pinion": "i", "wheel": "w", **changed})
        meshes = {"first": mesh.model_copy(update={"pinion": "p", "wheel": "i"}), "second": second}
        return list(halves_faults(HELICAL, box.model_copy(update={"gears": gears, "meshes": meshes})))

    assert not faults()
    other = 3 - mesh.carrying_halves
    (found,) = faults(carrying_halves=other)
    assert (found.path, found.given) == (f"{HELICAL}.meshes.second.carrying_halves", str(other))
    assert found.problem.startswith(f"gear i is in mesh first as well, where it is {mesh.carrying_halves}")
    assert found.remedy.startswith(f"write {mesh.carrying_halves} in both meshes")
    (single,) = faults(double_helical=False)
    assert (single.path, single.given) == (f"{HELICAL}.meshes.second.double_helical", "false")
    assert not list(halves_faults(HELICAL, box))


def test_partners_of_one_hand_are_refused() -> None:
    case = load_case(CASES / "uhcf_prototype").with_value(f"{HELICAL}.meshes.main.double_helical", False)
    assert case.with_value(f"{HELICAL}.gears.pinion.helix_hand", "right")
    with pytest.raises(
        CaseError, match=r"wheel\.helix_hand = .*is that of its partner pinion; write the opposite"
    ):
        case.with_values({f"{HELICAL}.gears.{gear}.helix_hand": "right" for gear in ("pinion", "wheel")})


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (
            {f"{PINION}.rim_thickness": "30 mm", f"{PINION}.bore_diameter": "20 mm"},
            r"test\.meshes\.main.*rim_thickness",
        ),
        ({f"{MESH}.rack.protuberance": 0.02}, r"pinion: protuberance = 0\.090 mm takes .* path of contact"),
        (
            {f"{PINION}.tip_edge.rounding": "1 mm", f"{PINION}.profile_shift": 0.8},
            r"tip_edge\.rounding = 1\.000 mm.*reduce",
        ),
        # pointed: full tips on a large shift
        ({f"{PINION}.profile_shift": 1.2}, r"(tip thickness|pointed|tip clearance).*reduce|shorten"),
        # undercut within the path
        (
            {f"{PINION}.profile_shift": -0.45},
            r"pinion: undercut takes .* mm of the path of contact|interference",
        ),
    ],
)
def test_gears_that_cannot_be_made_end_as_faults_of_the_case(values: dict[str, object], message: str) -> None:
    case = load_case(CASES / "fzg").with_values(values)
    with pytest.raises(CaseError, match=message), solver_errors(case):
        build_rig(case, "quick")


def test_inertia_of_a_webbed_gear_is_that_of_rim_and_web() -> None:
    values = {"rim_thickness": "9 mm", "web_thickness": "6 mm", "bore_diameter": "20 mm"}
    rig = build_rig(fzg(**values), "quick")
    gear, density = rig.pairs["test.main"].gears[0], rig.materials["case_hardened_steel"].density
    inner = gear.root_radius - 9e-3
    ring = 14e-3 * (gear.reference_radius**4 - inner**4)
    web = 6e-3 * (inner**4 - 10e-3**4)
    found = gear_inertia(rig.case, "test", "pinion", rig.pairs, rig.materials)
    assert found == pytest.approx(0.5 * pi * density * (ring + web))
    solid = build_rig(fzg(bore_diameter="20 mm", rim_thickness="9 mm"), "quick")
    plain = build_rig(fzg(bore_diameter="20 mm"), "quick")
    inertias = [gear_inertia(r.case, "test", "pinion", r.pairs, r.materials) for r in (solid, plain)]
    assert inertias[0] == inertias[1] > found


def assumed_senses(case: Case) -> list[str]:
    """Senses of rotation and hands that the case assumes."""
    return [found.path for found in case.assumptions if found.path.endswith(("rotation", "helix_hand"))]


def test_a_sense_that_skewed_axes_need_is_an_assumption_until_it_is_stated() -> None:
    spur = load_case(CASES / "fzg")
    assert assumed_senses(spur) == assumed_senses(spur.with_value(f"{MESH}.axis_inclination", "20 um")) == []
    skewed = spur.with_value(f"{MESH}.axis_skew", "20 um")
    assert assumed_senses(skewed) == ["gearboxes.test.rotation"]
    assert assumed_senses(skewed.with_value("gearboxes.test.rotation", "clockwise")) == []


@pytest.mark.parametrize(
    ("key", "hand", "missing"),
    [
        ("axis_skew", None, ["gears.pinion.helix_hand", "rotation"]),
        ("axis_skew", "right", []),
        ("axis_inclination", None, ["gears.pinion.helix_hand"]),
        ("axis_inclination", "right", ["rotation"]),
    ],
)
def test_helical_gears_need_their_hand_and_a_sense_where_it_counts(
    key: str, hand: str | None, missing: list[str]
) -> None:
    values = {f"{HELICAL}.meshes.main.double_helical": False, f"{HELICAL}.meshes.main.{key}": "20 um"}
    stated = {} if hand is None else {f"{HELICAL}.gears.wheel.helix_hand": hand}
    case = load_case(CASES / "uhcf_prototype").with_values(values | stated)
    assert assumed_senses(case) == [f"{HELICAL}.{path}" for path in missing]


def test_a_press_fit_on_a_shaft_with_too_wide_a_bore_is_named() -> None:
    case = load_case(CASES / "uhcf_main")
    seat = "gearboxes.test.gears.pinion"
    gear = case.gearboxes["test"].gears["pinion"]
    assert case.drivetrain is not None and gear.position is not None
    sections = case.drivetrain.shafts[gear.shaft].sections
    section = case.drivetrain.shafts[gear.shaft].section_at(gear.position)
    index = next(i for i, one in enumerate(sections) if one is section)
    inner = f"drivetrain.shafts.{gear.shaft}.sections.{index}.inner_diameter"
    hollow = case.with_values({f"{seat}.shaft_interference": "20 um", inner: "60 mm"})
    assert hollow.with_value(f"{seat}.bore_diameter", "61 mm")
    with pytest.raises(
        CaseError,
        match=r"test\.gears\.pinion\.shaft_interference = .*bore is 60 mm there.*correct bore_diameter",
    ):
        hollow.with_value(f"{seat}.bore_diameter", "60 mm")
    # a seat without interference is no press fit
    assert case.with_values({inner: "60 mm", f"{seat}.bore_diameter": "60 mm"})
