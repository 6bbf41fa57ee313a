"""Rows of the approach: what no flank may feel, and how a helicoid answers a screw motion."""

import math
from dataclasses import replace
from typing import Literal

import numpy as np
import pytest

from dynamics.rotor.assembly import assemble_rig
from dynamics.rotor.craig_bampton import approach_row, mesh_directions, mesh_ports
from dynamics.rotor.rotor_model import ElasticRig
from dynamics.rotor.shaft import DrivetrainError
from tests.builders.elastic_rig import motion_of_all, prototype_rig

Face = Literal["front", "back"]


def turned_rig(sense: int, angle: float, helix: float) -> ElasticRig:
    """The prototype turned about x by an angle, the pinions turning with a sense, helical meshes."""
    rig = prototype_rig(0.05)
    cos, sin = math.cos(angle), math.sin(angle)
    placements = tuple(
        replace(p, sense=sense * p.sense, y=cos * p.y - sin * p.z, z=sin * p.y + cos * p.z)
        for p in rig.placements
    )
    meshes = tuple(replace(mesh, base_helix_angle=helix) for mesh in rig.drivetrain.meshes)
    return replace(rig, placements=placements, drivetrain=replace(rig.drivetrain, meshes=meshes))


CASES = [(sense, angle, helix) for sense in (1, -1) for angle in (0.0, 2.1) for helix in (0.0, 0.3, -0.3)]


@pytest.mark.parametrize(("sense", "angle", "helix"), CASES)
@pytest.mark.parametrize("face", ["front", "back"])
def test_a_rig_that_moves_as_a_whole_closes_no_mesh(
    sense: int, angle: float, helix: float, face: Face
) -> None:
    model = assemble_rig(turned_rig(sense, angle, helix))
    rng = np.random.default_rng(5)
    for position in (0.0, 0.003):
        motion = motion_of_all(model, rng.normal(size=3), rng.normal(size=3))
        for mesh in ("test", "reference"):
            row = approach_row(model, mesh, face, position)
            assert row @ motion == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(("sense", "angle", "helix"), CASES)
def test_force_turns_the_wheel_on_and_the_pinion_back(sense: int, angle: float, helix: float) -> None:
    """Line of action: r_b1 from the pinion, r_b2 from the wheel, pushing the wheel away and forward."""
    rig = turned_rig(sense, angle, helix)
    mesh = rig.drivetrain.meshes[0]
    for face, drives in (("front", 1.0), ("back", -1.0)):
        d = getattr(mesh_directions(rig, mesh.name), face)
        directions = mesh_directions(rig, mesh.name)
        across = np.array([0.0, *d[1:]])
        assert np.linalg.norm(across) == pytest.approx(1.0)
        assert across @ directions.centre_line > 0.0
        for i, (gear, sign) in enumerate(((mesh.pinion, 1.0), (mesh.wheel, -1.0))):
            placement = rig.placement(rig.drivetrain.gear(gear).shaft)
            arm = sign * directions.radii[i] * directions.centre_line
            torque = placement.sense * np.cross(arm, across)[0]
            # on the wheel +d drives, on the pinion d is where its teeth go
            assert torque == pytest.approx(drives * mesh.base_radii[i], rel=1e-9)


@pytest.mark.parametrize(("sense", "angle", "helix"), [case for case in CASES if case[2]])
@pytest.mark.parametrize("face", ["front", "back"])
def test_a_helical_gear_that_screws_along_its_helix_stays_in_its_flanks(
    sense: int, angle: float, helix: float, face: Face
) -> None:
    """A right-hand gear (positive angle) moves by r_b / tan(beta_b) along +x per radian about +x."""
    model = assemble_rig(turned_rig(sense, angle, helix))
    mesh = model.rig.drivetrain.meshes[0]
    row = approach_row(model, mesh.name, face)
    for gear, radius, hand in (
        (mesh.pinion, mesh.base_radii[0], 1.0),
        (mesh.wheel, mesh.base_radii[1], -1.0),
    ):
        place = model.freedoms.place(gear)
        own = model.rig.placement(place.shaft).sense
        motion = np.zeros(model.size)
        motion[place.base], motion[place.turn] = hand * radius / math.tan(helix), own * 1.0
        assert row @ motion == pytest.approx(0.0, abs=1e-12)


def test_ports_are_turns_of_the_contract() -> None:
    """x = r_b1 p_1 - r_b2 p_2; p holds n . u / r_b and the tilt at a face position, zero at the centre plane."""
    model = assemble_rig(turned_rig(1, 0.0, 0.0))
    mesh = model.rig.drivetrain.meshes[0]
    ports = mesh_ports(model, "test")
    assert approach_row(model, "test") == pytest.approx(
        mesh.base_radii[0] * ports[0] - mesh.base_radii[1] * ports[1]
    )
    rows = model.rows(mesh.pinion)
    alpha = math.acos(sum(mesh.base_radii) / mesh.centre_distance)
    expected = rows[3] + (math.sin(alpha) * rows[1] + math.cos(alpha) * rows[2]) / mesh.base_radii[0]
    assert ports[0] == pytest.approx(expected, abs=1e-15)
    edge = mesh_ports(model, "test", position=0.002)[0] - ports[0]
    tilt = 0.002 * (math.sin(alpha) * rows[5] - math.cos(alpha) * rows[4]) / mesh.base_radii[0]
    assert edge == pytest.approx(tilt, abs=1e-15)


def test_halves_of_a_double_helical_mesh_press_against_each_other() -> None:
    rig = turned_rig(1, 0.0, 0.3)
    one, other = (mesh_directions(rig, "test", half) for half in (1, -1))
    assert one.front[0] == pytest.approx(-math.tan(0.3))
    assert other.front[0] == -one.front[0]
    assert one.back[0] == -one.front[0]


def test_unknown_mesh() -> None:
    with pytest.raises(DrivetrainError, match="mesh 'third' does not exist"):
        mesh_directions(prototype_rig(0.05), "third")
