"""The gear unit of a REXS file against the numbers written into it."""

import math

import pytest

from rigdesign.rexs.gear_unit import UnitGear
from rigdesign.rexs.gear_unit_import import GearUnitImport
from rigdesign.rexs.reader import parse_rexs
from tests.builders.rexs import changed, imported


def reasons(result: GearUnitImport, component: int) -> dict[str, str]:
    """Attribute -> why it was not taken over."""
    return {item.attribute: item.reason for item in result.listed if item.component == component}


def test_gears_and_mesh() -> None:
    unit = imported().unit
    assert unit.gear(11) == UnitGear(
        id=11, name="pinion", shaft=3, position=pytest.approx(0.0675), teeth=16, normal_module=0.0045,
        pressure_angle=pytest.approx(math.radians(20.0)), helix_angle=0.0, face_width=0.014, profile_shift=0.182,
        tip_diameter=0.08246, quality_grade=5, flank_roughness=0.35e-6, material=29,
    )  # fmt: skip
    (mesh,) = unit.meshes
    assert (mesh.pinion, mesh.wheel, mesh.centre_distance) == (11, 12, 0.0915)


def test_shafts_bearings_coupling() -> None:
    unit = imported().unit
    shaft = unit.shaft(3)
    assert [(item.start, item.length, item.outer_begin) for item in shaft.sections] == [
        (0.0, 0.05, 0.03), (0.05, 0.035, 0.036), (0.085, 0.05, 0.03),
    ]  # fmt: skip
    assert (shaft.length, shaft.axis) == (pytest.approx(0.135), (1.0, 0.0, 0.0))
    bearing = unit.bearings[1]
    assert (bearing.kind, bearing.place.inner, bearing.place.outer) == ("rolling", 3, 2)
    assert (bearing.place.inner_position, bearing.width, bearing.radial_clearance) == (0.115, 0.023, 25e-6)
    assert (bearing.catalogue.designation, bearing.catalogue.dynamic_load_rating) == ("NJ 406", 60500.0)
    (coupling,) = unit.couplings
    assert (coupling.place.inner, coupling.place.outer) == (3, 25)
    assert "write drivetrain.couplings" in reasons(imported(), 24)["rotational_stiffness"]


def test_oil_material_and_load_cases() -> None:
    unit = imported().unit
    assert unit.lubricant is not None
    assert (unit.lubricant.viscosity_40, unit.lubricant.density_15) == (pytest.approx(95e-6), 885.0)
    assert unit.materials[0].designation == "16MnCr5"
    assert "write a table under materials" in reasons(imported(), 29)["elastic_modulus"]
    first, second = unit.operating_cases
    assert (first.id, first.time_share, first.lubricant_temperature) == ("1", 0.6, 363.15)
    assert first.speeds == {3: pytest.approx(2250.0 * math.pi / 30.0)}
    assert [(load.shaft, load.torque) for load in first.loads] == [(3, 372.6)]
    assert (second.speeds[3], second.loads[0].torque) == (pytest.approx(50.0 * math.pi), 302.0)
    assert second.lubricant_temperature == 353.15
    assert second.loads[0].transmits_torque is True


def test_without_a_spectrum_the_components_are_the_case() -> None:
    text = changed().decode()
    spectrum = text[text.index("  <load_spectrum") : text.index("</model>")]
    result = imported((spectrum, ""))
    (case,) = result.unit.operating_cases
    assert (case.id, case.speeds[3], case.lubricant_temperature) == (None, pytest.approx(235.6194), 363.15)
    assert [load.torque for load in case.loads] == [None]


def test_two_spectra_are_told_apart() -> None:
    text = changed().decode()
    spectrum = text[text.index("  <load_spectrum") : text.index("</model>")]
    result = imported((spectrum, spectrum + spectrum.replace('spectrum id="1"', 'spectrum id="2"')))
    assert [case.id for case in result.unit.operating_cases] == ["1.1", "1.2", "2.1", "2.2"]
    assert len({(item.load_case, item.component, item.attribute) for item in result.mapped}) == len(
        result.mapped
    )


def test_every_attribute_is_mapped_or_listed() -> None:
    model = parse_rexs(changed(), "unit")
    cases = [part for case in model.load_spectra[0].load_cases for part in case.components]
    written = sum(
        len(part.attributes) for part in (*model.components, *cases, *model.load_spectra[0].accumulation)
    )
    result = imported()
    assert (len(result.mapped), len(result.listed)) == (144, 27)
    assert len(result.mapped) + len(result.listed) == written
    width = next(item for item in result.mapped if item.attribute == "face_width" and item.component == 11)
    assert (width.written, width.target, width.value) == ("14.0 mm", "gears[11].face_width", 0.014)
    life = next(item for item in result.listed if item.load_case == "accumulation")
    assert (life.component, life.reason) == (20, "a value over all load cases")


@pytest.mark.parametrize(
    ("old", "new", "component", "attribute", "reason"),
    [
        ('unit="mm">82.46', 'unit="mm">1.0', 11, "tip_diameter", "not the tip of 16 teeth of this module"),
        ('unit="mm">82.46', 'unit="none">82.46', 11, "tip_diameter", "unit 'none' where the attribute"),
        ('unit="mm">82.46', 'unit="inch">82.46', 11, "tip_diameter", "unit 'inch' is none of REXS"),
        ('unit="mm">82.46', 'unit="mm">82,46', 11, "tip_diameter", "82,46 where a number belongs"),
        ('unit="none">16<', 'unit="none">16.5<', 11, "number_of_teeth", "16.5 where a whole number belongs"),
        ('unit="none">16<', 'unit="none">-16<', 11, "number_of_teeth", "below 3"),
        (">NJ 406<", "><", 20, "catalogue_designation", "nothing where a text belongs"),
        ('inner_diameter_begin" unit="mm">0.0', 'inner_diameter_begin" unit="mm">60', 5, "length", "a section whose"),
        ('torque" unit="none">true', 'torque" unit="none">yes', 27, "transmits_torque", "yes where"),
        ('unit="mm">23.0', 'unit="mm">23.0</attribute><attribute id="width" unit="mm">24', 20, "width", "stated twice"),
        ("<c>1.0</c><c>0.0</c><c>0.0</c>", "<c>0</c><c>0</c><c>0</c>", 3, "u_axis_vector", "no direction"),
        ("<c>1.0</c><c>0.0</c><c>0.0</c>", "<c>1</c>", 3, "u_axis_vector", "1 entries where three belong"),
        ('id="bearing_type"', 'id="data_source"', 20, "data_source", "the component stands in another file"),
    ],
)  # fmt: skip
def test_values_that_cannot_be_used_are_listed(
    old: str, new: str, component: int, attribute: str, reason: str
) -> None:
    assert reasons(imported((old, new)), component)[attribute].startswith(reason)


def test_flanks_that_differ() -> None:
    text = changed().decode()
    right = text[text.index('<component id="17"') : text.index('<component id="18"')]
    result = imported((right, right.replace("0.182", "0.3")))
    assert result.unit.gear(11).profile_shift == 0.182
    assert "left flank" in reasons(result, 17)["addendum_modification_coefficient"]


def test_profile_shift_as_a_length() -> None:
    new = (
        'id="addendum_modification_coefficient" unit="none">0.182',
        'id="addendum_modification" unit="mm">0.819',
    )
    assert imported(new).unit.gear(11).profile_shift == pytest.approx(0.182)


def test_the_position_of_a_gear_is_that_of_its_middle() -> None:
    unplaced = ('<attribute id="support_vector"', '<attribute id="vector"')
    for version in ("1.0", "2.0"):
        assert imported(version=version).unit.gear(11).position == pytest.approx(0.0675)
        assert imported(unplaced, version=version).unit.gear(11).position == pytest.approx(0.0675)
    assert "which its place" in reasons(imported(version="1.0"), 11)["u_coordinate_on_shaft"]


def test_a_shaft_that_points_the_other_way() -> None:
    """A shaft from x = 135 mm backwards: the gear at x = 67.5 mm sits 67.5 mm from its start."""
    text = changed().decode()
    shaft = text[text.index('<component id="3"') : text.index('<component id="4"')]
    turned = shaft.replace("<c>1.0</c>", "<c>-2.0</c>").replace(
        'mm"><array><c>0.0</c>', 'mm"><array><c>100.0</c>'
    )
    unit = imported((shaft, turned)).unit
    assert unit.shaft(3).axis == (-1.0, 0.0, 0.0)
    assert unit.gear(11).position == pytest.approx(0.0325)


def test_the_only_section_of_a_shaft_starts_at_zero() -> None:
    text = changed().decode()
    section = text[text.index('<component id="26"') : text.index('<component id="27"')]
    result = imported((section, section.replace("u_coordinate_on_shaft", "x")))
    (found,) = result.unit.shaft(25).sections
    assert found.start == 0.0


def test_the_wheel_may_be_named_first() -> None:
    mesh = imported(("gear_1", "gear_x"), ("gear_2", "gear_1"), ("gear_x", "gear_2")).unit.meshes[0]
    assert (mesh.pinion, mesh.wheel) == (11, 12)


def test_ring_gears_are_named_and_left_out() -> None:
    text = changed().decode()
    wheel = text[text.index('<component id="12"') : text.index('<component id="13"')]
    result = imported((wheel, wheel.replace('"cylindrical_gear"', '"ring_gear"')))
    assert result.unit.meshes == ()
    assert result.other_stages == ("ring_gear 12",)
    assert result.epicyclic
    assert not imported().epicyclic
    assert reasons(result, 12)["number_of_teeth"] == "a ring_gear has no counterpart in a case"
    assert "not of two cylindrical gears" in reasons(result, 13)["center_distance"]


def test_the_clearance_as_delivered_counts_before_that_in_operation() -> None:
    stated = '<attribute id="operating_radial_bearing_clearance" unit="mum">25.0</attribute>'
    delivered = stated.replace("operating_", "").replace("25.0", "45.0")
    for both in (stated + delivered, delivered + stated):
        result = imported((stated, both))
        assert {bearing.radial_clearance for bearing in result.unit.bearings} == {45e-6}
        reason = reasons(result, 20)["operating_radial_bearing_clearance"]
        assert reason == "the clearance as delivered counts"


def test_the_power_of_a_load_case_replaces_the_torque_of_its_component() -> None:
    """The component states 372.6 N m; a load case with 50 kW has no torque of its own, and the other way round."""
    text = changed().decode()
    start = text.index("<load_spectrum")
    torque = '<attribute id="torque_around_u_axis" unit="N m">302.0</attribute>'
    power = '<attribute id="power" unit="kW">50.0</attribute>'
    named = '<component id="27" type="external_load" name="pinion torque">'
    of_component = torque.replace("302.0", "372.6")
    unit = imported((text[start:], text[start:].replace(torque, power)), (named, named + of_component)).unit
    assert [(load.torque, load.power) for case in unit.operating_cases for load in case.loads] == [
        (372.6, None), (None, 50e3),
    ]  # fmt: skip


def test_a_hydrodynamic_bearing() -> None:
    kind = ('type="rolling_bearing_with_catalog_geometry"', 'type="hydrodynamic_radial_plain_bearing"')
    clearance = ("operating_radial_bearing_clearance", "diameter_clearance_plain_bearing")
    bearing = imported(kind, clearance).unit.bearings[0]
    assert (bearing.kind, bearing.inner_diameter, bearing.radial_clearance) == ("journal", 0.03, 25e-6)
