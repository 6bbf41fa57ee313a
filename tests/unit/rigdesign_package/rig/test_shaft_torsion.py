"""Torsion of shafts: sections between gears carry the loop, those to the motor its torque; thin ones are refused."""

import math
from dataclasses import replace

import pytest

from dynamics.rotor.graph import Drivetrain
from dynamics.rotor.parts import Coupling
from dynamics.rotor.shaft import Section, Shaft
from rigdesign.base.errors import CaseError
from rigdesign.case import Case, load_case
from rigdesign.rig.drivetrain import LARGEST_STRAIN, section_torsions
from rigdesign.rig.model import build_rig
from tests.builders.paths import CASES
from tests.builders.rig import prototype

PROTOTYPE = CASES / "uhcf_prototype"
FORCE, MOTOR = 5000.0, 20.0


def torques(rig: Drivetrain) -> dict[str, float]:
    """Torque of every loaded section by ``shaft.index``."""
    return {".".join(row.path.split(".")[2:5:2]): row.torque for row in section_torsions(rig, FORCE, MOTOR)}


def with_section(path: str, diameter: str) -> Case:
    return load_case(PROTOTYPE).with_value(f"drivetrain.shafts.{path}.outer_diameter", diameter)


def test_sections_from_gear_to_coupling_carry_force_times_base_radius() -> None:
    """The reference wheel sits in its third section and is coupled at the start; the motor drives at the end."""
    rig = prototype()
    found = torques(rig)
    wheel = max(mesh.base_radii[1] for mesh in rig.meshes)
    loaded = {index: found.get(f"reference_wheel.{index}") for index in range(5)}
    assert loaded == {0: FORCE * wheel, 1: FORCE * wheel, 2: FORCE * wheel, 3: MOTOR, 4: MOTOR}
    pinion = max(mesh.base_radii[0] for mesh in rig.meshes)
    assert {found.get(f"test_pinion.{index}") for index in (2, 3, 4)} == {FORCE * pinion}
    assert "test_pinion.0" not in found and "test_wheel.0" not in found


def test_strain_at_the_surface_of_a_section() -> None:
    """gamma = 16 T / (pi D^3 G)"""
    path = "drivetrain.shafts.test_pinion.sections.4.outer_diameter"
    row = next(row for row in section_torsions(prototype(), FORCE, MOTOR) if row.path == path)
    by_hand = 16.0 * row.torque / (math.pi * 40e-3**3) / prototype().shaft("test_pinion").shear_modulus
    assert row.strain == pytest.approx(by_hand)


def test_shaft_beyond_a_coupling_without_a_gear_carries_no_loop_torque() -> None:
    """A motor shaft of its own behind the reference wheel: the loop ends at the gear, not at the coupling."""
    rig = prototype()
    spindle = Shaft(name="spindle", sections=(Section(length=0.1, outer_diameter=0.02),))
    behind = Coupling(name="behind", shafts=("reference_wheel", "spindle"), stiffness=1e4)
    longer = replace(
        rig,
        shafts=(*rig.shafts, spindle),
        couplings=(*rig.couplings, behind),
        motor=replace(rig.motor, shaft="spindle", position=0.1),
    )
    found = torques(longer)
    assert found["spindle.0"] == MOTOR
    assert "reference_wheel.4" not in found


def test_thin_section_is_refused_with_its_place() -> None:
    with pytest.raises(CaseError) as raised:
        build_rig(with_section("test_pinion.sections.4", "6 mm"))
    (fault,) = raised.value.faults
    assert fault.path == "drivetrain.shafts.test_pinion.sections.4.outer_diameter"
    assert fault.given == "6 mm"
    strain = 16.0 * 180.0 / (math.pi * 6e-3**3) / 79.2e9
    assert f"{100.0 * strain:.2g} % under 180 N m, limit {100.0 * LARGEST_STRAIN:g} %" in fault.problem
    assert "enlarge" in fault.remedy


def test_doubtful_section_is_a_finding_and_a_sound_one_is_none() -> None:
    rig = build_rig(with_section("test_pinion.sections.4", "12 mm"))
    (text,) = (torsion.finding for torsion in rig.shaft_torsions if torsion.finding)
    for words in ("sections.4.outer_diameter = 12 mm", "0.67 %", "180 N m", "limit 0.5 %", "enlarge"):
        assert words in text
    assert not any(torsion.finding for torsion in build_rig(load_case(PROTOTYPE)).shaft_torsions)
    assert build_rig(load_case(PROTOTYPE / "given_losses.toml")).shaft_torsions == ()
